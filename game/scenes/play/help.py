"""How much a network helps, in three words: off, guard, guide; one of them is chosen by keys, wheel or mouse."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pygame

from game.core import texts
from game.core.settings import Settings
from game.drawing.tokens import INK, MUTE, NET, SMALL
from game.flight.credit import GUARDIAN, HELP, OTHER, help_word
from game.input.controls import Command, translate
from game.ui.rows import percent

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas, Now

MODES: Final = ("tolerance", GUARDIAN)
_APART: Final = 20.0
_SHOWN: Final = 120  # steps that the words are seen after a change
_STEPS: Final = {Command.SLOWER: -1, Command.FASTER: 1}


def word_of(settings: Settings) -> str:
    """Return the word for the help that is set, a key of `HELP`, or `OTHER`."""
    return help_word(settings.assist, settings.copilot)


def means(settings: Settings) -> str:
    """Say what the help that is set means."""
    word = word_of(settings)
    return texts.HELP_MEANS[settings.copilot if word == OTHER else word]


def choose(settings: Settings, word: str) -> None:
    """Set the help of a word."""
    settings.assist = HELP[word]
    if settings.assist:
        settings.copilot = GUARDIAN


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
            word = next((word for word, box in boxes.items() if box.collidepoint(event.pos)), OTHER)
            if word != OTHER:
                self._choose(word)
            return word != OTHER
        command = translate(event)
        by = (1 if event.y > 0 else -1) if event.type == pygame.MOUSEWHEEL else _STEPS.get(command, 0) if command else 0
        beyond = [word for word, assist in HELP.items() if by * (assist - self._settings.assist) > 0]
        if beyond:  # the nearest word that helps more, or less
            self._choose(beyond[0] if by > 0 else beyond[-1])
        return bool(by)

    def _choose(self, word: str) -> None:
        choose(self._settings, word)
        self.shown = _SHOWN

    def boxes(self, canvas: Canvas, middle: float, y: float) -> dict[str, pygame.FRect]:
        """Return where each word stands, around a middle, on a baseline; and the dial's place, if it is another."""
        words = [*HELP, *([OTHER] if word_of(self._settings) == OTHER else [])]
        widths = {word: canvas.text_width(self._label(word), size=SMALL) for word in words}
        x, found = middle - (sum(widths.values()) + _APART * (len(widths) - 1)) / 2, {}
        for word, width in widths.items():
            found[word] = pygame.FRect(x - _APART / 2, y - 18, width + _APART, 28)
            x += width + _APART
        return found

    def _label(self, word: str) -> str:
        return percent(self._settings.assist) if word == OTHER else texts.HELP[word]

    def draw(self, canvas: Canvas, middle: float, y: float, says: Now) -> None:
        """Draw the words, with a line under the one that is chosen; `says` tells what that does now."""
        now, boxes = word_of(self._settings), self.boxes(canvas, middle, y)
        (first, *others) = boxes.values()
        canvas.explain(first.unionall(others), means(self._settings), says)  # so that no tooltip covers a word
        for word, box in boxes.items():
            chosen = word == now
            canvas.text(self._label(word), (box.centerx, y), size=SMALL, colour=INK if chosen else MUTE, align="centre")
            if chosen:
                canvas.line((box.left + _APART / 2, y + 6), (box.right - _APART / 2, y + 6), NET, 2)
