"""Themes of the landscape: the same land on other worlds and by night, in other light and air."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from ai.lander.missions import MISSIONS
from game.drawing.paint import Picture
from game.drawing.tokens import NIGHT0, Colour

Light = tuple[float, float, float]  # red, green, blue
HORIZON: Final = 0.80  # where the sky ends, as a share of the page's height


@dataclass(frozen=True)
class Theme:
    """Colour transformation of the landscape, relative to the moon at dawn.

    Attributes:
        sky, land: factors (red, green, blue) on their colours.
        air: light added to the sky, 0 to 255 at the horizon; at the top, only the share `thick` of it.
        dust: light added to the land.
        light: ambient light on a craft, 0 to 1.
        stars, earth: whether they are visible.

    """

    sky: Light = (1.0, 1.0, 1.0)
    land: Light = (1.0, 1.0, 1.0)
    air: Light = (0.0, 0.0, 0.0)
    thick: float = 0.0
    dust: Light = (0.0, 0.0, 0.0)
    light: float = 1.0
    stars: bool = True
    earth: bool = True

    def on_dust(self, colour: Colour) -> Colour:
        """Return the colour of flying dust: that of the land, but never too dark to be visible."""
        red, green, blue = (
            round(min(255.0, value * max(share, _LEAST_DUST) + more))
            for value, share, more in zip(colour, self.land, self.dust, strict=True)
        )
        return red, green, blue

    def on_sky(self, colour: Sequence[Picture], down: Picture) -> list[Picture]:
        """Return colours of the sky under this theme, `down` the way from its top, 0, to the horizon, 1."""
        depth = self.thick + (1 - self.thick) * np.minimum(down, 1).astype(np.float32) ** np.float32(1.5)
        return [
            part * np.float32(gain) + np.float32(more) * depth
            for part, gain, more in zip(colour, self.sky, self.air, strict=True)
        ]

    def on_land(self, colour: Sequence[Picture]) -> list[Picture]:
        """Return colours of land under this theme."""
        return [
            part * np.float32(gain) + np.float32(more)
            for part, gain, more in zip(colour, self.land, self.dust, strict=True)
        ]


_DARK: Final = 0.1
_LEAST_DUST: Final = 0.45  # the engine's own light falls on it
_NIGHT: Final[Light] = (0.9 * NIGHT0[0], 0.9 * NIGHT0[1], 0.9 * NIGHT0[2])
MOON: Final = Theme()
LOOKS: Final[dict[str, Theme]] = {
    "moon": MOON,
    "mars": Theme(
        (1.0, 0.62, 0.45), (1.55, 0.92, 0.62), (104.0, 58.0, 36.0), 0.18, (12.0, 2.0, 0.0), stars=False, earth=False
    ),
    "earth": Theme(
        (0.85, 0.95, 1.0), (0.75, 1.05, 0.95), (40.0, 74.0, 112.0), 0.18, (0.0, 4.0, 4.0), stars=False, earth=False
    ),
    "titan": Theme(
        (0.9, 0.6, 0.34), (1.25, 0.86, 0.5), (150.0, 92.0, 30.0), 0.42, (26.0, 13.0, 2.0), stars=False, earth=False
    ),
    "night": Theme((_DARK,) * 3, (_DARK,) * 3, _NIGHT, 1.0, _NIGHT, light=0.4, earth=False),
}


def look_of(mission: str) -> str:
    """Return the theme's name for a mission; "moon" where it has none of its own."""
    found = MISSIONS.get(mission)
    return "moon" if found is None else "night" if found.night else found.world
