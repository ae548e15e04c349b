"""Digits scene: a drawing pad, the networks' live readings of it, and their explanation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, replace
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from game.core import texts
from game.core.scene import Push, Transition, push
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.sky import NightSky
from game.drawing.tokens import SMALL, TEXT, TITLE
from game.input.controls import Command
from game.scenes.digits.answer import (
    END,
    FIX_TOP,
    LEFT,
    STEPS,
    DigitRow,
    Explanation,
    StageSwitch,
    draw_answer,
    draw_fix,
)
from game.scenes.digits.fixing import FixRunner
from game.scenes.digits.pad import DrawingPad, make_pen
from game.scenes.digits.reader import LiveReading, Numbers, Reading, Verdict
from game.training.digit_models import NAMES, called
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.form_scene import FOOT, FormScene
from game.ui.hints import HintRow
from game.ui.pick import ChoiceOrList
from game.ui.widget import OnPress
from game.ui.widgets import Choice, TextButton

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier

PAD: Final = pygame.Rect(40, 70, 520, 520)
_BELOW: Final = 602  # top of the buttons under the pad
_TABS: Final = (LEFT, 26, 252, 24)  # above the chosen one's answer
_LONGEST: Final = 16  # letters of a network's name
_PROBLEMS: Final = 650.0  # baseline of what is wrong with networks
_APART: Final = 26.0  # points between two words
_WHY_NOT: Final = (LEFT, 233, 120, 20)  # of the word below the answer
_DIGITS: Final = {
    **{pygame.K_0 + digit: digit for digit in range(10)},
    **{pygame.K_KP1 + digit - 1: digit for digit in range(1, 10)},
    pygame.K_KP0: 0,
}


class DigitsScene(FormScene):
    """Digits scene. `chosen` is the name of the network that is explained first.

    Attributes:
        pad: the drawing pad.
        live: reads and explains the drawing.
        fixing: teaches a network a drawing that it misreads.

    """

    def __init__(self, context: Context, chosen: str = NAMES[0]) -> None:
        super().__init__(context)
        self.pad = DrawingPad(PAD)
        self.live = LiveReading(self.pad, chosen, self._show_bars)
        self._explanation = Explanation()
        self._unfix: TextButton | None = None
        self._fix_of = -1  # revision of the drawing that was fixed last
        self._sky = NightSky(np.random.default_rng(11), ember=0.2, stars=40)
        self.fixing = FixRunner(context.user_dir, context.models_dir)
        for name in dict.fromkeys((*NAMES, chosen)):
            self._load(name)
        if not self.live.known:
            self.live.chosen = next(iter(self.live.reader.classifiers), chosen)
        self._tabs = self.form.add(self._make_tabs())
        self._pen = self.form.add(make_pen(self.form.manager, lambda: self.pad))
        self._add_words()
        self.live.anew()
        self._offer_undo()

    def enter(self) -> None:
        """Refresh the list of networks."""
        before = set(self.fixing.networks)
        self.fixing.refresh()
        if set(self.fixing.networks) == before:
            return
        if self.chosen not in self.fixing.networks:
            self.live.chosen = NAMES[0]
            self.live.anew()
        tabs = self._make_tabs()
        self.form.replace([self._tabs], [tabs])
        self._tabs = tabs

    def exit(self) -> None:
        """End the current stroke."""
        self.pad.lift()

    def close(self) -> None:
        """End the process that learns."""
        self.fixing.close()

    @property
    def chosen(self) -> str:
        """Name of the network that is explained."""
        return self.live.chosen

    @property
    def reading(self) -> Reading:
        """The latest reading of the drawing."""
        return self.live.reading

    @property
    def canvas_rect(self) -> pygame.Rect:
        """The drawing area, in the window's pixels."""
        return self.context.in_window(self.pad.rect)

    @property
    def probabilities(self) -> Numbers | None:
        """The chosen network's probabilities (10,); None while nothing is drawn, or it can't be loaded."""
        return self.live.probabilities

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Handle drawing, and pass any other event to the actions and the widgets."""
        return None if self.pad.handle_event(event) else super().handle_event(event)

    def actions(self) -> Table:
        """Choose another network, go back; undo and clear; correct by a digit's key."""
        return [
            Action(Command.NEXT, lambda: self._turn(1), texts.DIGITS_HINT_NETWORK),
            Action(Command.PREVIOUS, lambda: self._turn(-1)),
            self.form.goes_back(texts.HINT_BACK),
            Action(pygame.K_z, self.pad.undo, texts.DIGITS_UNDO.lower(), gamepad=Command.HANDOVER),
            Action(Command.CHOICES, self.pad.clear, texts.DIGITS_CLEAR.lower()),
            *(Action(key, self.pad.clear) for key in (Command.RETRY, pygame.K_DELETE)),
            *(Action(key, partial(self._correct, digit)) for key, digit in _DIGITS.items()),
        ]

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        """Return the hints below the pad."""
        return [HintRow(self.hints, (PAD.left, FOOT[1]))]

    def update(self) -> Transition | None:
        """Read the drawing if it changed, and see whether a fix is done."""
        self.live.update()
        self._follow_fix()
        return self.form.update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the pad, the answer and its explanation."""
        self._sky.draw(canvas)
        canvas.text(texts.DIGITS_TITLE, (PAD.left, 45), size=TITLE)
        self.pad.draw(canvas)
        if self.chosen in self.reading.probabilities:
            draw_answer(canvas, self.reading, self.chosen)
        steps = list(asdict(self.live.switches).values())
        self._explanation.draw(canvas, self.reading, self.chosen, self.live.why, steps)
        self.form.draw(canvas)
        self._draw_words(canvas)

    # Reading

    def _load(self, name: str) -> None:
        """Load a network with the player's fixes, or with fewer of them if some are damaged."""
        if network := self.fixing.networks.get(name):
            self.live.reader.load(name, *network.versions())

    def _show_bars(self) -> None:
        for row in self._rows:
            row.values, row.best = self.live.bars(row.digit)

    def _switch(self, step: str, on: bool) -> None:
        """Switch a step of the preprocessing on or off."""
        self.live.switches = replace(self.live.switches, **{step: on})
        self.live.anew()

    # Fixing a wrong answer

    def _correct(self, digit: int) -> None:
        """Teach the chosen network that what is drawn is this digit."""
        self.live.catch_up()
        image = self.reading.stages.centred
        if image.any() and self.live.known:
            self.fixing.begin(self.chosen, image, digit, self.live.reader.sources[self.chosen])
            self._fix_of = self.pad.revision

    def _undo_fix(self) -> None:
        if self.fixing.undo(self.chosen):
            self._take_anew(self.chosen)

    def _follow_fix(self) -> None:
        if self.fixing.poll():
            self._take_anew(self.fixing.name)

    def _take_anew(self, name: str) -> None:
        """Reload a network after a fix or its undo."""
        self._load(name)
        self.live.anew()
        self._offer_undo()

    def _offer_undo(self) -> None:
        """Show the button that undoes a fix while there is one."""
        wanted = self.fixing.count(self.chosen) > 0
        if wanted and self._unfix is None:
            box = (LEFT, FIX_TOP + 48, 96, 24)
            self._unfix = TextButton(self.form.manager, box, texts.DIGITS_UNDO_FIX, self._undo_fix, size=SMALL + 1)
            self.form.replace([], [self._unfix])
        elif self._unfix and not wanted:
            self.form.replace([self._unfix], [])
            self._unfix = None

    # Words

    def _add_words(self) -> None:
        manager, add = self.form.manager, self.form.add
        below = (texts.DIGITS_UNDO, self.pad.undo), (texts.DIGITS_CLEAR, self.pad.clear)
        self._add_row(PAD.left, _BELOW, *below, at=0.0)
        train = (texts.DIGITS_TRAIN, partial(push, "digit_training"))
        self._add_row(PAD.right, 24, (texts.DIGITS_QUIZ, self._quiz), train, (texts.DIGITS_DREAM, self._dream))
        self._add_row(END, 24, (texts.PATCH_WORD, partial(self._ask, "digit_inside")))
        why = self.form.manager, _WHY_NOT, texts.WHY_NOT_WORD, partial(self._ask, "why_not")
        add(TextButton(*why, size=SMALL + 1))
        self._rows = [add(DigitRow(manager, digit, self._correct)) for digit in range(10)]
        for number, step in enumerate(STEPS):
            add(StageSwitch(manager, number, partial(self._switch, step)))

    def _add_row(self, x: float, top: float, *words: tuple[str, OnPress], at: float = 1.0) -> None:
        """Add words to press, in a row of which x is that share: 0 its left end, 1 its right one."""
        widths = [typeface.width(word, TEXT, "medium") for word, _ in words]
        left = x - at * (sum(widths) + _APART * (len(widths) - 1))
        for (word, press), width in zip(words, widths, strict=True):
            self.form.add(TextButton(self.form.manager, (left, top, width, 28), word, press, weight="medium"))
            left += width + _APART

    def _make_tabs(self) -> Choice:
        """Return the row of networks; with networks of the player's own, it also leads to a list of all."""
        names = list(self.fixing.networks)
        words = [word if len(word) <= _LONGEST else word[:_LONGEST] + "…" for word in map(called, names)]
        index = names.index(self.chosen) if self.chosen in names else 0
        row = self.form.manager, _TABS, "", words, index, self._choose
        if len(names) == len(NAMES):
            return Choice(*row)
        return ChoiceOrList(*row, self._pick, texts.DIGITS_ALL.format(count=len(names)), size=TEXT)

    def _choose(self, index: int) -> None:
        """Choose another network; if it can't be loaded, say so and keep the last one."""
        names = list(self.fixing.networks)
        if names[index] not in self.live.reader.classifiers:
            self._load(names[index])
        if names[index] not in self.live.reader.classifiers:
            self._tabs.index = names.index(self.chosen)
            return
        self.live.chosen = names[index]
        self.live.anew()
        self._offer_undo()

    def _turn(self, direction: int) -> None:
        """Choose the next network that can be loaded."""
        index, count = self._tabs.index, len(self._tabs.options)
        for distance in range(1, count):
            self._tabs.choose((index + direction * distance) % count)
            if self._tabs.index != index:
                return

    def _pick(self) -> Transition:
        """Open a list of all networks with their accuracy."""
        from game.scenes.menus.dialogs import ListDialog

        damaged = self.live.reader.problems
        rows = [
            (called(name), texts.DIGIT_MODEL_DAMAGED if name in damaged else network.said)
            for name, network in self.fixing.networks.items()
        ]
        return Push(ListDialog(self, texts.DIGITS_PICK, rows, self._tabs.choose))

    def _quiz(self) -> Transition | None:
        return self._with_chosen(partial(push, "quiz"))

    def _dream(self) -> Transition | None:
        """Open the dream scene with the drawing."""
        seen = self.probabilities
        digit = 0 if seen is None else int(seen.argmax())
        return self._with_chosen(lambda classifier: push("dream", classifier, digit, self.reading.stages.centred))

    def _ask(self, route: str) -> Transition | None:
        """Open a scene about what the chosen network makes of the drawing."""
        if self.probabilities is None:
            self.context.note(texts.DIGITS_EMPTY)
            return None
        return self._with_chosen(lambda classifier: push(route, classifier, self.reading.stages.centred))

    def _with_chosen(self, lead: Callable[[DigitClassifier], Transition]) -> Transition | None:
        """Open a scene about the chosen network, if it could be loaded."""
        classifier = self.live.reader.classifiers.get(self.chosen)
        return lead(classifier) if classifier else None

    def _draw_words(self, canvas: Canvas) -> None:
        if self.reading.verdict(self.chosen) is not Verdict.EMPTY:
            draw_fix(canvas, self.fixing, same=self._fix_of == self.pad.revision)
        problems = [
            texts.DIGITS_PROBLEM.format(name=called(name), problem=problem)
            for name, problem in reversed(self.live.reader.problems.items())
        ]
        colour = canvas.palette.warn
        draw_wrapped(canvas, "  ".join(problems), (LEFT, _PROBLEMS), _TABS[2], colour=colour, leading=17, most=4)
        self.draw_hints(canvas)
