"""What a switch of the preprocessing changes: the picture fed in and the answer, before and after, side by side."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from game.core import texts
from game.digits import percent
from game.digits.pictures import Numbers, picture
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import INK, LABEL, LINE, MUTE, NET, TEXT
from game.scenes.digits.explanation import LEFT, STEPS
from game.scenes.digits.reader import Reading

MOMENT: Final = 300  # updates that it is shown after the switch has been left
_TOP: Final = 224.0  # baseline of the headings
_TILE: Final = 132.0
_SECOND: Final = 184.0  # from the left of one picture to the other


@dataclass(frozen=True, eq=False)
class Compared:
    """Two readings of one drawing by one network: (28, 28) images and probabilities (10,)."""

    words: str
    images: tuple[Numbers, Numbers]
    probabilities: tuple[Numbers, Numbers]


class BeforeAfter:
    """Comparison that stays for a moment, or as long as its switch is held in focus or pointed at.

    Attributes:
        compared: what is shown; None for nothing.

    """

    def __init__(self) -> None:
        self.compared: Compared | None = None
        self._left = 0
        self._revision = -1
        self._painted = PaintCache()

    def begin(self, step: str, on: bool, name: str, before: Reading, after: Reading, revision: int) -> None:
        """Show what a switch has changed for a network; nothing without ink."""
        self.compared, self._left, self._revision = None, MOMENT, revision
        both = before, after
        if before.stages.centred.any() and all(name in each.probabilities for each in both):
            words = texts.DIGITS_STEP_ON if on else texts.DIGITS_STEP_OFF
            said = words.format(step=texts.DIGITS_STAGES[STEPS.index(step) + 1])
            one, other = (each.stages.centred for each in both)
            first, second = (each.probabilities[name] for each in both)
            self.compared = Compared(said, (one, other), (first, second))

    def update(self, revision: int, *, held: bool) -> None:
        """Count the moment, unless the switch is held; another drawing ends it."""
        self._left = MOMENT if held else self._left - 1
        if self._left <= 0 or revision != self._revision:
            self.compared = None

    def draw(self, canvas: Canvas) -> None:
        """Draw both pictures with both answers, if there is something to compare."""
        if self.compared:
            compared = self.compared
            self._painted.draw(canvas, (LEFT, 200, 370, 210), compared, lambda sheet: _paint(sheet, compared))


def _paint(sheet: Canvas, compared: Compared) -> None:
    for number, word in enumerate((texts.DIGITS_BEFORE, texts.DIGITS_AFTER)):
        x, top = number * _SECOND, _TOP - 200
        heading = sheet.text(word, (x, top), size=LABEL, colour=MUTE, weight="medium")
        if number:
            sheet.text(compared.words, (heading.right + 10, top), size=LABEL, colour=NET)
        area = sheet.rect(x, top + 16, _TILE, _TILE)
        sheet.surface.blit(picture(compared.images[number], area.size), area)
        sheet.outline((x, top + 16, _TILE, _TILE), 0, LINE)
        probabilities = compared.probabilities[number]
        best = int(probabilities.argmax())
        words = texts.DIGITS_NOW_READS.format(digit=best, percent=percent(float(probabilities[best])))
        sheet.text(words, (x, top + _TILE + 38), size=TEXT, colour=INK if number else MUTE, tabular=True)
    y = _TOP - 200 + 16 + _TILE / 2
    sheet.text("→", ((_TILE + _SECOND) / 2, y + 5), size=TEXT, colour=MUTE, align="centre")
