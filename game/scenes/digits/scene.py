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
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.sky import NightSky
from game.drawing.tokens import LABEL, MUTE, SMALL, TITLE
from game.input.controls import Command
from game.scenes.digits.answer import FIX_TOP, LEFT, DigitRow, draw_answer, draw_fix
from game.scenes.digits.before_after import BeforeAfter
from game.scenes.digits.explanation import LEFT as EXPLANATION_LEFT
from game.scenes.digits.explanation import STEPS, ExplanationView, StageSwitch
from game.scenes.digits.fixing import AccuracyMeasurement, FixRunner
from game.scenes.digits.network_tabs import draw_problems, network_tabs
from game.scenes.digits.pad import DrawingPad, make_pen
from game.scenes.digits.pad_words import add_below, add_row, draw_keys
from game.scenes.digits.reader import LiveReading, Numbers, Reading, Verdict
from game.training.digit_models import NAMES, called
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.form_scene import FOOT, FormScene
from game.ui.hints import HintRow
from game.ui.widgets import Choice, TextButton

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier

PAD: Final = pygame.Rect(40, 70, 520, 520)
_BELOW: Final = 602  # top of the buttons under the pad
_RIGHT: Final = 1244.0
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
        before_after: what a switch has changed.
        fixing: teaches a network a drawing that it misreads.
        measuring: measures what each step of the preprocessing is worth.

    """

    def __init__(self, context: Context, chosen: str = NAMES[0]) -> None:
        super().__init__(context)
        self.pad = DrawingPad(PAD)
        self.live = LiveReading(self.pad, chosen, self._show_bars)
        self._explanation = ExplanationView()
        self.before_after = BeforeAfter()
        self._unfix: TextButton | None = None
        self._fix_of = -1  # revision of the drawing that was fixed last
        self._sky = NightSky(np.random.default_rng(11), ember=0.2, stars=40)
        self.fixing = FixRunner(context.user_dir, context.models_dir)
        self.measuring = AccuracyMeasurement(lambda: self.live.sources)
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
        """End the processes that measure and learn."""
        self.fixing.close()
        self.measuring.close()

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
        """Choose another network, go back; undo and clear, told beside their buttons; correct by a digit's key."""
        return [
            Action(Command.NEXT, lambda: self._turn(1), texts.DIGITS_HINT_NETWORK),
            Action(Command.PREVIOUS, lambda: self._turn(-1)),
            self.form.goes_back(texts.HINT_BACK),
            *self._gamepad_actions,
            *(Action(key, self.pad.clear) for key in (Command.RETRY, pygame.K_DELETE)),
            *(Action(key, partial(self._correct, digit)) for key, digit in _DIGITS.items()),
        ]

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        """Return the hints below the pad."""
        return [HintRow(self.hints, (PAD.left, FOOT[1]))]

    @property
    def _gamepad_actions(self) -> tuple[Action, Action]:
        """Undo and clear, which buttons below the pad do as well."""
        return Action(pygame.K_z, self._undo, gamepad=Command.HANDOVER), Action(Command.CHOICES, self.pad.clear)

    def update(self) -> Transition | None:
        """Read the drawing if it changed, and receive finished measurements."""
        self.live.update()
        self.measuring.listen()
        self._follow_fix()
        held = any(each.focused and (each.ringed or each.mouse_x is not None) for each in self._switches)
        self.before_after.update(self.pad.revision, held=held)
        return self.form.update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the pad, the answer and its explanation."""
        self._sky.draw(canvas)
        canvas.text(texts.DIGITS_TITLE, (PAD.left, 45), size=TITLE)
        self.pad.draw(canvas)
        if self.chosen in self.reading.probabilities:
            draw_answer(canvas, self.reading, self.chosen)
        steps = list(asdict(self.live.switches).values())
        compares = self.before_after.compared is not None
        self._explanation.draw(canvas, self.reading, self.chosen, self.live.why, steps, aside=compares)
        self.before_after.draw(canvas)
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

    # Preprocessing steps and their measured effect

    def _switch(self, step: str, on: bool) -> None:
        self.live.catch_up()
        before = self.reading
        self.live.switches = replace(self.live.switches, **{step: on})
        self.live.anew()
        self.before_after.begin(step, on, self.chosen, before, self.reading, self.pad.revision)
        self.measuring.ask(self.live.switches)

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
        self.measuring.anew(self.live.switches)

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
        below = (texts.DIGITS_UNDO, self._undo), (texts.DIGITS_CLEAR, self.pad.clear)
        self._under = add_below(self.form, below, PAD.left, _BELOW)
        above = (
            (texts.DIGITS_QUIZ, self._quiz),
            (texts.DIGITS_TRAIN, partial(push, "digit_training")),
            (texts.DIGITS_DREAM, self._dream),
        )
        add_row(self.form, above, PAD.right, 24)
        add_row(self.form, [(texts.PATCH_WORD, partial(self._ask, "digit_inside"))], _RIGHT, 24)
        why = self.form.manager, _WHY_NOT, texts.WHY_NOT_WORD, partial(self._ask, "why_not")
        add(TextButton(*why, size=SMALL + 1))
        self._rows = [add(DigitRow(manager, digit, self._correct)) for digit in range(10)]
        self._switches = [
            add(StageSwitch(manager, number, partial(self._switch, step))) for number, step in enumerate(STEPS)
        ]

    def _make_tabs(self) -> Choice:
        return network_tabs(self.form.manager, list(self.fixing.networks), self.chosen, self._choose, self._pick)

    def _choose(self, index: int) -> None:
        """Choose another network; if it can't be loaded, say so and keep the last one."""
        names, before = list(self.fixing.networks), self.live.pair
        if names[index] not in self.live.reader.classifiers:
            self._load(names[index])
        if names[index] not in self.live.reader.classifiers:
            self._tabs.index = names.index(self.chosen)
            return
        self.live.chosen = names[index]
        self.live.anew()
        self._offer_undo()
        if set(self.live.pair) != set(before):
            self.measuring.anew(self.live.switches)

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

    def _undo(self) -> None:
        self.pad.undo()

    def _draw_words(self, canvas: Canvas) -> None:
        if self.reading.verdict(self.chosen) is not Verdict.EMPTY:
            draw_fix(canvas, self.fixing, same=self._fix_of == self.pad.revision)
        measured = self.measuring.words(self.live.switches)
        place, width = (EXPLANATION_LEFT, 184), _RIGHT - EXPLANATION_LEFT
        draw_wrapped(canvas, measured, place, width, size=LABEL, colour=MUTE, leading=15)
        draw_problems(canvas, self.live.reader.problems)
        draw_keys(canvas, self._under, [each.key_word(self.context.controls) for each in self._gamepad_actions])
        self.draw_hints(canvas)
