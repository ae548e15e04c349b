"""How much a network helps, in three words: off, guard, guide; one of them is chosen by keys, wheel or mouse."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pygame

from game.core import texts
from game.core.settings import HELP, Settings
from game.drawing.tokens import INK, MUTE, NET, SMALL
from game.input.controls import Command, translate

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas, Now

_APART: Final = 20.0
_SHOWN: Final = 120  # steps that the words are seen after a change
_STEPS: Final = {Command.SLOWER: -1, Command.FASTER: 1}


class HelpWords:
    """The three words of one flight, which set `settings`; they are seen while they are of use.

    Attributes:
        shown: steps for which they are still seen after a change.

    """

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self.shown = 0

    def take(self, event: pygame.event.Event, boxes: dict[str, pygame.FRect]) -> bool:
        """Choose by an event, a mouse's among the words in their boxes; return whether it was meant for them."""
        if event.type == pygame.MOUSEBUTTONDOWN and event.button == 1:
            word = next((word for word, box in boxes.items() if box.collidepoint(event.pos)), "")
            if word:
                self._choose(word)
            return bool(word)
        command = translate(event)
        by = (1 if event.y > 0 else -1) if event.type == pygame.MOUSEWHEEL else _STEPS.get(command, 0) if command else 0
        if by:
            number = HELP.index(self._settings.help) + by
            self._choose(HELP[min(max(number, 0), len(HELP) - 1)])
        return bool(by)

    def _choose(self, word: str) -> None:
        self._settings.help = word
        self.shown = _SHOWN

    def boxes(self, canvas: Canvas, middle: float, y: float) -> dict[str, pygame.FRect]:
        """Return where each word stands, around a middle, on a baseline."""
        widths = {word: canvas.text_width(texts.HELP[word], size=SMALL) for word in HELP}
        x, found = middle - (sum(widths.values()) + _APART * (len(widths) - 1)) / 2, {}
        for word, width in widths.items():
            found[word] = pygame.FRect(x - _APART / 2, y - 18, width + _APART, 28)
            x += width + _APART
        return found

    def draw(self, canvas: Canvas, middle: float, y: float, says: Now, keys: str) -> None:
        """Draw the words behind their keys, with a line under the chosen one; `says` tells what that does now."""
        now, boxes = self._settings.help, self.boxes(canvas, middle, y)
        (first, *others) = boxes.values()
        canvas.explain(first.unionall(others), texts.HELP_MEANS[now], says)  # so that no tooltip covers a word
        canvas.text(keys, (first.left, y), size=SMALL, colour=INK, align="right", weight="medium")
        for word, box in boxes.items():
            colour = INK if word == now else MUTE
            canvas.text(texts.HELP[word], (box.centerx, y), size=SMALL, colour=colour, align="centre")
            if word == now:
                canvas.line((box.left + _APART / 2, y + 6), (box.right - _APART / 2, y + 6), NET, 2)
