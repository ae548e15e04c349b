"""Design tokens: colours, type sizes and spacing for the world, the widgets and the charts.

Amber is the person, blue is the network, everywhere. Lengths are points: 1280 x 720 of them fill the view
at any window size; `game.drawing.canvas.Canvas` turns them into pixels.
"""

from dataclasses import dataclass
from typing import Final

Colour = tuple[int, int, int]

VIEW_SIZE: Final = (1280, 720)
NARROW, LOW = 860.0, 480.0  # a window with less has no room for a flight beside words

NIGHT0: Final[Colour] = (9, 12, 24)
NIGHT1: Final[Colour] = (19, 26, 48)
DUSK: Final[Colour] = (58, 52, 78)
EMBER: Final[Colour] = (214, 132, 92)
PANEL: Final[Colour] = (14, 19, 36)
PANEL_ALPHA: Final = 0.74
LINE: Final[Colour] = (40, 47, 70)
FAINT: Final[Colour] = (58, 68, 92)
INK: Final[Colour] = (232, 236, 244)
MUTE: Final[Colour] = (138, 149, 173)
HUMAN: Final[Colour] = (255, 196, 112)
NET: Final[Colour] = (112, 200, 255)
# None, bronze, silver, gold; also distinguished by words and by the number of lit lamps.
MEDALS: Final[tuple[Colour, ...]] = (MUTE, (205, 140, 96), (196, 206, 224), (255, 208, 110))

FIGURE: Final = 34.0
TITLE: Final = 22.0
TEXT: Final = 15.0
SMALL: Final = 12.5
LABEL: Final = 12.0  # the least size

# Factors by which text is enlarged, by the setting's name.
TEXT_SIZES: Final = {"normal": 1.0, "large": 1.3, "largest": 1.6}

STEP: Final = 8
MARGIN: Final = 64


@dataclass(frozen=True)
class Palette:
    """Colours for values within and beyond limits; always used together with a shape or a mark."""

    good: Colour
    warn: Colour


PALETTE: Final = Palette(good=(124, 220, 178), warn=(255, 124, 86))
# Bluish green and vermillion, as Okabe and Ito chose them, lifted to the lightness of the colours above:
# the two stay half as far apart again for eyes without the red or the green cones.
COLOUR_SAFE: Final = Palette(good=(86, 220, 196), warn=(255, 134, 70))
