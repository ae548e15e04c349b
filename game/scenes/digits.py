"""Draw a digit: a pad to draw on, what two networks read there as the pen moves, and how they know."""

from __future__ import annotations

from dataclasses import asdict, replace
from functools import partial
from typing import Final

import numpy as np
import pygame

from ai.digit_stages import StageAccuracy, stage_accuracy
from game import texts
from game.context import Context
from game.controls import Command, translate
from game.digits.answer import LEFT, DigitRow, draw_answer, percent
from game.digits.pad import DrawingPad
from game.digits.reader import NAMES, Explanation, Numbers, Reader, Switches, Verdict
from game.digits.sight import LEFT as SIGHT_LEFT
from game.digits.sight import STEPS, Sight, StageSwitch
from game.scene import Pop, Transition
from game.ui import typeface
from game.ui.canvas import Canvas
from game.ui.form import Form
from game.ui.hints import draw_hints
from game.ui.prose import wrapped
from game.ui.sky import NightSky
from game.ui.tokens import LABEL, MUTE, SMALL, TEXT, TITLE, VIEW_SIZE
from game.ui.widgets import Choice, Word
from game.worker import State, Worker

PAD: Final = pygame.Rect(40, 70, 520, 520)
_TABS: Final = (232, 26, 24)  # left, top and height of the row beside the title
_BELOW: Final = 602  # top of the words under the pad
_RIGHT: Final = 1244.0


class Digits:
    """Draw, and be read. `chosen` is the network that is looked into, by its name.

    Attributes:
        pad: what is drawn on.
        reading: the last look at it.

    """

    def __init__(self, chosen: str = NAMES[0]) -> None:
        self.chosen = chosen
        self.pad = DrawingPad(PAD)
        self._context: Context | None = None
        self._switches = Switches()
        self._worker: Worker | None = None
        self._accuracy: dict[Switches, StageAccuracy] = {}
        self._sight = Sight()
        self._seen = -1
        self._why: Explanation | None = None

    def enter(self, context: Context) -> None:
        """Read the networks and build the widgets, the first time."""
        if self._context is not None:
            return
        self._context = context
        self._sky = NightSky(np.random.default_rng(11), ember=0.2, stars=40)
        self._reader = Reader.load(context.models_dir / "digits")
        if self.chosen not in self._reader.classifiers:
            self.chosen = next(iter(self._reader.classifiers), self.chosen)
        self._form = Form(context, on_back=Pop)
        self._add_words()
        self._look()

    def exit(self) -> None:
        """Lift the pen."""
        self.pad.lift()

    def close(self) -> None:
        """End the process that measures."""
        if self._worker:
            self._worker.close()

    @property
    def canvas_rect(self) -> pygame.Rect:
        """The drawing area, in the window's pixels."""
        assert self._context is not None
        return self._context.in_window(self.pad.rect)

    @property
    def probabilities(self) -> Numbers | None:
        """How probable the chosen network finds each digit, (10,); None while nothing is drawn, or it can't be read."""
        if self._seen != self.pad.revision:
            self._look()
        return None if self.reading.verdict(self.chosen) is Verdict.EMPTY else self.reading.probabilities[self.chosen]

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Draw, or do what a key, a button or a word means."""
        if self.pad.handle_event(event):
            return None
        if event.type == pygame.KEYDOWN and event.key == pygame.K_z:
            self.pad.undo()
        elif event.type == pygame.KEYDOWN and event.key in (pygame.K_c, pygame.K_DELETE):
            self.pad.clear()
        else:
            return self._obey(event)
        return None

    def _obey(self, event: pygame.event.Event) -> Transition | None:
        match translate(event):
            case Command.HANDOVER if event.type != pygame.KEYDOWN:  # Tab moves the focus
                self.pad.undo()
            case Command.RETRY:
                self.pad.clear()
            case Command.NEXT | Command.PREVIOUS:
                self._tabs.choose((self._tabs.index + 1) % len(self._tabs.options))
            case _:
                return self._form.handle_event(event)
        return None

    def update(self) -> Transition | None:
        """Look at what has been drawn since, and hear what was measured."""
        if self._seen != self.pad.revision:
            self._look()
        self._listen()
        return self._form.update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the pad, the answer, and what led to it."""
        self._sky.draw(canvas)
        canvas.text(texts.DIGITS_TITLE, (PAD.left, 45), size=TITLE)
        self.pad.draw(canvas)
        if self.chosen in self.reading.probabilities:
            draw_answer(canvas, self.reading, self.chosen)
        steps = list(asdict(self._switches).values())
        self._sight.draw(canvas, self.reading, self.chosen, self._why, steps)
        self._form.draw(canvas)
        self._draw_words(canvas)

    # Reading

    def _look(self) -> None:
        """Let the networks read what is on the pad."""
        self._seen = self.pad.revision
        self.reading = self._reader.read(self.pad.strokes, self.pad.ink, self._switches)
        self._why = None
        chosen = self.reading.probabilities.get(self.chosen)
        if chosen is not None:
            self._why = self._reader.explain(self.chosen, self.reading.stages.centred)
        self._show_bars()

    def _show_bars(self) -> None:
        drawn = bool(self.reading.stages.centred.any())
        values = [self.reading.probabilities.get(name) for name in (self.chosen, self._other)]
        for row in self._rows:
            one, other = (float(value[row.digit]) if drawn and value is not None else 0.0 for value in values)
            row.values = (one, other)
            row.best = drawn and values[0] is not None and int(values[0].argmax()) == row.digit

    @property
    def _other(self) -> str:
        return next(name for name in NAMES if name != self.chosen)

    # Steps of preprocessing, and what they are worth

    def _switch(self, step: str, on: bool) -> None:
        self._switches = replace(self._switches, **{step: on})
        self._look()
        if self._worker is None:
            assert self._context is not None
            folder = self._context.models_dir / "digits"
            self._worker = Worker(stage_accuracy, {name: folder / name for name in self._reader.classifiers})
            self._worker.pause()  # it works when it is asked
            self._ask(Switches())
        self._ask(self._switches)

    def _ask(self, switches: Switches) -> None:
        if self._worker and switches not in self._accuracy:
            self._worker.send(asdict(switches))

    def _listen(self) -> None:
        if self._worker:
            for told in self._worker.poll():
                self._accuracy[Switches(**dict(told.steps))] = told

    def _accuracy_words(self) -> str:
        if self._worker is None:
            return texts.DIGITS_HINT
        told = self._accuracy.get(self._switches)
        if told is None:
            failed = self._worker.state is State.FAILED
            return texts.DIGITS_NOT_MEASURED.format(problem=self._worker.problem) if failed else texts.DIGITS_MEASURING
        reads = ", ".join(
            texts.DIGITS_READS_AS.format(name=texts.DIGITS_NETWORKS[name], percent=percent(part))
            for name, part in told.read.items()
        )
        return texts.DIGITS_READS.format(count=told.count) + reads + "."

    # Words

    def _add_words(self) -> None:
        manager, add = self._form.manager, self._form.add
        left, top, height = _TABS
        words = [texts.DIGITS_NETWORKS[name] for name in NAMES]
        width = sum(round(typeface.width(word, TEXT, "regular")) + 24 for word in words)
        self._tabs = add(Choice(manager, (left, top, width, height), "", words, NAMES.index(self.chosen), self._choose))
        self._under = [
            add(Word(manager, (PAD.left + 80 * number, _BELOW, 56, 24), word, press, size=SMALL + 1))
            for number, (word, press) in enumerate(((texts.DIGITS_UNDO, self._undo), (texts.DIGITS_CLEAR, self._clear)))
        ]
        self._rows = [add(DigitRow(manager, digit, self._correct)) for digit in range(10)]
        for number, step in enumerate(STEPS):
            add(StageSwitch(manager, number, partial(self._switch, step)))

    def _choose(self, index: int) -> None:
        """Look into another network; one that can't be read is named, and the last stays."""
        if NAMES[index] in self._reader.classifiers:
            self.chosen = NAMES[index]
            self._look()
        else:
            self._tabs.index = NAMES.index(self.chosen)

    def _undo(self) -> None:
        self.pad.undo()

    def _clear(self) -> None:
        self.pad.clear()

    def _correct(self, digit: int) -> Transition | None:
        return None

    def _draw_words(self, canvas: Canvas) -> None:
        assert self._context is not None
        for number, line in enumerate(wrapped(canvas, self._accuracy_words(), LABEL, _RIGHT - SIGHT_LEFT)):
            canvas.text(line, (SIGHT_LEFT, 184 + 15 * number), size=LABEL, colour=MUTE)
        problems = self._reader.problems.items()
        for number, (name, problem) in enumerate(problems):
            words = texts.DIGITS_PROBLEM.format(name=texts.DIGITS_NETWORKS[name], problem=problem)
            for line in wrapped(canvas, words, SMALL, _RIGHT - LEFT)[:2]:
                canvas.text(line, (LEFT, 560 + 34 * number), size=SMALL, colour=canvas.palette.warn)
        controls = self._context.controls
        word = controls.word
        keys = (word(Command.HANDOVER), word(Command.RETRY)) if controls.pad_in_use else ("Z", "C")
        for key, widget in zip(keys, self._under, strict=True):
            left = widget.box.left + canvas.text_width(widget.label, size=SMALL + 1) + 8
            canvas.text(key, (left, widget.baseline), size=SMALL, weight="medium")
        draw_hints(canvas, [
            (word(Command.NEXT), texts.DIGITS_HINT_NETWORK),
            (word(Command.BACK), texts.HINT_BACK),
        ], (PAD.left, VIEW_SIZE[1] - 40))  # fmt: skip
