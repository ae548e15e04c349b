"""Rows of knobs: a page of all of them, or few with their experiments; and where they are in the panel."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Final, NamedTuple

import pygame

from ai.training.experiments import experiments
from game.core import texts
from game.drawing.tokens import LABEL, SMALL
from game.panels import knob_foot, knob_page
from game.panels.knob import MARGIN, Knob, SliderKnob, SwitchKnob, WordsKnob
from game.panels.knob_words import word_width
from game.panels.lab import TOP, experiment_word
from game.panels.seed_knob import SeedKnob
from game.training.knob_descriptions import KnobDescription, label, pages
from game.training.run_settings import SEED, RunSettings
from game.ui.widget import OnPress, PointsManager, Widget
from game.ui.widgets import Choice, TextButton

_KINDS: Final[dict[str, type[Knob]]] = {"slider": SliderKnob, "switch": SwitchKnob, "words": WordsKnob}
_TABS: Final = 36  # from the line under the head to the first row: the tabs are in between
_PITCH: Final = 26  # of the rows, where there is room
_TAB_GAP: Final = 13.0
_FEW: Final = 12  # from the line under the head to the first of few knobs
_SWITCH: Final = {False: 76, True: 121}  # from the bottom to the word that shows all knobs, and few again
_ADVICE: Final = 24  # from the last row of few knobs to the first line about one
_LINES: Final = 82, 64  # from the bottom to the first line about one of all knobs, and from there to the last


class Deeds(NamedTuple):
    """What knobs ask the panel for.

    Attributes:
        turn: sets a knob, given its name and value.
        enter: answers Enter on a slider.
        open: opens the page of a knob.
        fly: flies an experiment on a knob; None where there are none.

    """

    turn: Callable[[str, Any], None]
    enter: Callable[[], None]
    open: Callable[[str], None] = lambda _: None
    fly: knob_page.Try | None = None


class KnobRows:
    """Maker of the rows in the panel's box."""

    def __init__(self, manager: PointsManager, box: pygame.Rect, run_settings: RunSettings, deeds: Deeds) -> None:
        self._manager, self._box, self._run_settings, self._deeds = manager, box, run_settings, deeds
        self._descriptions = run_settings.knob_descriptions
        self.pages = pages(self._descriptions.values())

    def few(self, names: Sequence[str]) -> list[Widget]:
        """Return the rows of few knobs, with room for experiments below each."""
        box, found = self._box, list[Widget]()
        for number, name in enumerate(names):
            top = box.top + TOP + _FEW + number * knob_page.PITCH
            place = pygame.Rect(box.left - MARGIN, top, box.width + MARGIN, _PITCH)
            found.append(self._knob(self._descriptions[name], place))
        return found

    def tries(self, rows: Sequence[Widget]) -> list[Widget]:
        """Return the experiments below rows, from the configuration in force."""
        fly, found = self._deeds.fly, list[Widget]()
        for knob in rows:
            if isinstance(knob, Knob) and fly is not None:
                words = [
                    (experiment_word(each, knob.description), partial(fly, each, knob.description))
                    for each in experiments(self._run_settings.config, knob.description.name)
                ]
                found += knob_page.try_buttons(self._manager, knob, words)
        return found

    def page(self, number: int) -> list[Widget]:
        """Return the rows of a page, and the signs that open the page of each knob."""
        rows: list[Widget] = []
        for description in self._descriptions.values():
            if description.page == self.pages[number]:
                rows.append(self._knob(description, self._row(len(rows))))
        more = [knob_page.more_button(self._manager, knob) for knob in rows if isinstance(knob, Knob) and knob.more]
        if self.pages[number] == self._run_settings.run_kind.seed_page:
            turn = partial(self._deeds.turn, SEED)
            rows.append(SeedKnob(self._manager, self._row(len(rows)), label(SEED), turn))
        return [*rows, *more]

    def tabs(self, number: int, turn_page: Callable[[int], None]) -> Choice:
        """Return the choice of a page."""
        words = [texts.KNOB_PAGES.get(page, page.capitalize()) for page in self.pages]
        box = (self._box.left, self._box.top + TOP + 8, self._box.width, 22)
        return Choice(self._manager, box, "", words, number, turn_page, size=LABEL, gap=_TAB_GAP)

    def switch(self, word: str, press: OnPress, *, every: bool) -> TextButton:
        """Return the word that shows all knobs, or few."""
        box = (self._box.left, self._box.bottom - _SWITCH[every], word_width(word, SMALL), 22)
        return TextButton(self._manager, box, word, press, size=SMALL)

    def advice_room(self, few: int) -> pygame.Rect | None:
        """Return the box for all that there is to say about one of few knobs, or of all (0); None for the foot's."""
        box = self._box
        if self._deeds.fly is None:
            return None
        if not few:
            return pygame.Rect(box.left, box.bottom - _LINES[0], box.width, _LINES[1])
        top = box.top + TOP + _FEW + few * knob_page.PITCH + _ADVICE
        return pygame.Rect(box.left, top, box.width, box.bottom - _SWITCH[False] - 6 - top)

    def _knob(self, description: KnobDescription, box: pygame.Rect) -> Knob:
        knob = _KINDS[description.kind](self._manager, box, description, self._deeds.turn, self._deeds.enter)
        if self._deeds.fly is not None:
            knob.more = partial(self._deeds.open, description.name)
        return knob

    def _row(self, number: int) -> pygame.Rect:
        """Return the box of a row; the longest page sets the distance between rows."""
        box, descriptions = self._box, self._descriptions.values()
        longest = max(sum(description.page == page for description in descriptions) for page in self.pages)
        foot = knob_foot.TALL if self._deeds.fly else knob_foot.HEIGHT
        pitch = min(_PITCH, (box.height - TOP - _TABS - foot) // longest)
        return pygame.Rect(box.left - MARGIN, box.top + TOP + _TABS + number * pitch, box.width + MARGIN, pitch)
