"""Digit training scene: a network learns in a process of its own; charts and confusion matrix show its progress."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.agent.schedule import InForce
from ai.digits.config import DIGIT_PRESETS, DigitConfig
from game.core import texts
from game.core.scene import Pop, Push, Transition, push
from game.core.worker import WorkerState
from game.digits.matrix import ConfusionMatrix
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.prose import wrapped
from game.drawing.sky import NightSky
from game.drawing.tokens import HUMAN, LABEL, LINE, MUTE, PANEL, SMALL, TEXT, VIEW_SIZE
from game.input.controls import Command
from game.panels.digit_charts import DigitCharts, draw_accuracy_legend
from game.panels.knobs import KnobsPanel
from game.panels.run_status import draw_problem, draw_run_status, start_word
from game.panels.training_status import digit_status
from game.scenes.dialog import NameDialog, QuestionDialog
from game.training.digit_models import runs_dir
from game.training.digit_run import DigitRun
from game.training.knob_descriptions import knob_descriptions
from game.training.run_settings import RunKind
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.form_scene import FormScene
from game.ui.hints import HintRow
from game.ui.virtual_pointer import VirtualPointer
from game.ui.widget import OnPress
from game.ui.widgets import TextButton

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier

_OFFERED: Final = {name: preset for name, preset in DIGIT_PRESETS.items() if name in texts.PUPIL_PRESETS}
DIGITS: Final = RunKind(tuple(knob_descriptions(DigitConfig)), _OFFERED, texts.PUPIL_PRESETS, "images")
_WIDTH: Final = 836.0  # of charts and matrix; the panel has the rest
_LEFT: Final = 40.0
_PANEL: Final = 868.0
_KNOBS: Final = pygame.Rect(868, 20, 384, 436)
_MATRIX: Final = pygame.Rect(70, 372, 320, 320)
_CELL: Final = pygame.Rect(440, 346, 372, 346)
_SAID: Final = 500.0  # baseline of a problem's message
_HINT: Final = pygame.Rect(868, 548, 384, 60)
_EVERY: Final = 12  # frames between two drawings of the charts


class DigitTrainingScene(FormScene):
    """Digit training scene: charts, confusion matrix and knobs."""

    def __init__(self, context: Context) -> None:
        super().__init__(context, self._leave)
        self._was_running = self._alive = False
        self._frame = 0
        self._question: Transition | None = None
        self._asked = False
        self.stop_word: TextButton | None = None
        self._back_word: TextButton | None = None
        self._in_force_told: tuple[float, DigitConfig, InForce] | None = None
        self._settings = context.settings
        self.digit_run = DigitRun(runs_dir(context.user_dir))
        self.digit_run.collection.hold()
        self._sky = NightSky(np.random.default_rng(12), ember=0.2, stars=40)
        self.charts = DigitCharts()
        self._add_words()
        self.form.add(VirtualPointer(self.form.manager, self.charts.box, self.charts.follow))
        self.knobs = KnobsPanel(
            self.form, _KNOBS, DIGIT_PRESETS["classic"], 0, self._turned, self._begin, DIGITS
        )  # fmt: skip
        self.matrix = self.form.add(ConfusionMatrix(self.form.manager, _MATRIX))
        self.form.focus(self.start_word)

    def enter(self) -> None:
        """Resume the run."""
        if self._was_running:
            self.digit_run.resume()
        if self._asked and self.digit_run.alive:  # and the player chose not to replace it
            self.knobs.set_config(self.digit_run.config, self.digit_run.seed)
        self._asked = False

    def exit(self) -> None:
        """Pause the run while another scene has the window."""
        self._was_running = self.digit_run.state in (WorkerState.RUNNING, WorkerState.STARTING)
        self.digit_run.pause()

    def close(self) -> None:
        """End the run's process; its latest network is kept."""
        self.digit_run.close()
        self.digit_run.collection.release()

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Handle start, pause, stop, knobs and the matrix."""
        self.charts.follow(event)
        return super().handle_event(event)

    def actions(self) -> Table:
        """Go back; step, start or pause, as the buttons say."""
        return [
            self.form.goes_back(texts.HINT_BACK),
            Action(Command.STEP, self.digit_run.step),
            Action(Command.HANDOVER, self._toggle),
        ]

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        """Return the hints above the charts."""
        return [HintRow(self.hints, (_WIDTH - 24, 46), from_right=True)]

    def update(self) -> Transition | None:
        """Receive the worker's messages, and animate the screen."""
        for note in self.digit_run.poll():
            self.context.note(note)
        if self.digit_run.begun:
            self.digit_run.begun = False
            self.knobs.set_config(self.digit_run.config, self.digit_run.seed)
            self.digit_run.call(self.knobs.name)  # the name of a resumed run is known only now
        if self.digit_run.alive != self._alive:
            self._alive = self.digit_run.alive
            self.knobs.set_running(self._alive)
        if self.matrix.confusion is not self.digit_run.confusion:
            self.matrix.set(self.digit_run.confusion)
        if self.digit_run.alive:
            self.knobs.show_in_force(self._in_force())
        self._offer_the_way_back()
        self._frame += 1
        if self._frame % _EVERY == 0:
            self.charts.look(self.digit_run.curves, self.digit_run.earlier)
            self._name_words()
        self.charts.update(at_once=self._settings.reduced_motion)
        question, self._question = self._question, None
        return self.form.update() or question

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the figures, the charts, the matrix and the panel."""
        self._sky.draw(canvas)
        canvas.fill(canvas.rect(_WIDTH, 0, VIEW_SIZE[0] - _WIDTH, VIEW_SIZE[1]), PANEL)
        self._draw_title(canvas)
        canvas.line((_LEFT, 318), (_WIDTH - 24, 318), LINE)
        heading = canvas.text(texts.MATRIX_TITLE, (_LEFT, 340), size=LABEL, colour=MUTE, weight="medium")
        shown = canvas.text(texts.MATRIX_AXES, (heading.right + 12, 340), size=LABEL, colour=MUTE)
        if self.digit_run.test is not None and self.digit_run.kept_epoch is not None:
            of_best = texts.MATRIX_OF_BEST.format(epoch=self.digit_run.kept_epoch)
            canvas.text(of_best, (shown.right + 12, 340), size=LABEL, colour=MUTE)
        if self.matrix.confusion is None:
            canvas.text(texts.MATRIX_EMPTY, (_CELL.left, _CELL.top + 14), size=SMALL, colour=MUTE)
        self.matrix.draw_cell(canvas, _CELL)
        self.knobs.draw(canvas)
        self._draw_said(canvas)
        self.form.draw(canvas)
        self.charts.draw(canvas)

    # The run

    def _in_force(self) -> InForce | None:
        """Values in force, as last reported by the run."""
        points, config = self.digit_run.curves.points, self.digit_run.config
        if not points:
            return None
        if self._in_force_told is None or self._in_force_told[:2] != (points[-1].learning_rate, config):
            rate = points[-1].learning_rate
            self._in_force_told = rate, config, InForce({"learning_rate": rate}, config.unused())
        return self._in_force_told[2]

    def _offer_the_way_back(self) -> None:
        wanted = self.digit_run.alive and not self.digit_run.stopping and self.digit_run.curves.fallen is not None
        if wanted == (self._back_word is not None):
            return
        old = self._back_word
        width = typeface.width(texts.PUPIL_GO_BACK, SMALL, "regular")
        self._back_word = TextButton(
            self.form.manager, (_HINT.right - 14 - width, _HINT.top + 2, width, 22), texts.PUPIL_GO_BACK,
            self.digit_run.go_back, size=SMALL,
        ) if wanted else None  # fmt: skip
        self.form.replace([old] if old else [], [self._back_word] if self._back_word else [])

    def _toggle(self) -> None:
        if self.digit_run.stopping:
            return
        if self.digit_run.state is WorkerState.PAUSED:
            self.digit_run.resume()
        elif self.digit_run.alive:
            self.digit_run.pause()
        else:
            self._begin(self.knobs.config, self.knobs.seed)
        self._name_words()

    def _begin(self, config: DigitConfig, seed: int) -> None:
        """Start a run; first ask whether to keep an unnamed earlier one."""
        if not self.digit_run.nameless:
            self._run(config, seed)
            return
        preset, seconds, part = self.digit_run.described()
        named = (preset, "") if preset in _OFFERED else DIGITS.nearest(self.digit_run.config)
        name = self.digit_run.collection.free_name(texts.PUPIL_NAME.format(preset=DIGITS.word(named)))

        def keep() -> None:
            if problem := self.digit_run.save(name):
                self._say(problem)
            else:
                self._run(config, seed)

        self._asked = True
        words = texts.PUPIL_LEFT_YOUNG if part is None else texts.PUPIL_LEFT_FIGURES
        self._question = Push(QuestionDialog(self, texts.TRAIN_LEFT, words.format(part=part, seconds=seconds), [
            (texts.PUPIL_LEFT_KEEP.format(name=name), keep),
            (texts.TRAIN_LEFT_DISCARD, lambda: self._run(config, seed)),
        ]))  # fmt: skip

    def _run(self, config: DigitConfig, seed: int, resume: bool = False) -> None:
        self._was_running = False
        if note := self.digit_run.begin(config, seed, resume=resume, name=self.knobs.name):
            self.context.note(note)
        self.matrix.set(None)
        if not resume:
            self.knobs.set_config(config, seed)

    def _stop_or_go_on(self) -> None:
        """Stop the run, or resume the unfinished one."""
        if self.digit_run.alive:
            self.digit_run.stop()
        elif self.digit_run.unfinished:
            self._run(self.knobs.config, self.knobs.seed, resume=True)
        self._name_words()

    def _turned(self, name: str, value: object) -> None:
        self.digit_run.change(name, value)

    def _leave(self) -> Transition:
        if self.digit_run.alive and self.digit_run.steps:
            self.context.note(texts.TRAIN_KEPT)
        self.digit_run.close()
        return Pop()

    def _save(self) -> Transition | None:
        if not (self.digit_run.kept or self.digit_run.alive):
            self._say(texts.PUPIL_NOTHING)
            return None
        suggestion = self.digit_run.collection.free_name(texts.PUPIL_NAME.format(preset=self.knobs.name))
        return Push(NameDialog(self, texts.NAMING, suggestion, self._save_as))

    def _save_as(self, name: str) -> str:
        problem, alive = self.digit_run.save(name), self.digit_run.alive
        if not problem and not alive:
            self._say(texts.PUPIL_SAVED.format(name=name))
        return problem

    def _dream(self) -> Transition | None:
        classifier = self._classifier()
        return push("dream", classifier, self.matrix.cell[0]) if classifier else None

    def _quiz(self) -> Transition | None:
        classifier = self._classifier()
        return push("quiz", classifier) if classifier else None

    def _classifier(self) -> DigitClassifier | None:
        """Return the network last saved by the run; if there is none, tell the player and return None."""
        from ai.digits.classifier import DigitClassifier

        if not self.digit_run.kept:
            self._say(texts.PUPIL_NOTHING)
            return None
        try:
            return DigitClassifier.load(self.digit_run.unsaved)
        except (OSError, ValueError) as error:
            self._say(str(error))
            return None

    def _say(self, words: str) -> None:
        self.context.note(words)

    # The picture

    def _add_words(self) -> None:
        def add(x: float, y: float, label: str, press: OnPress) -> TextButton:
            width = typeface.width(label, TEXT, "regular")
            return self.form.add(TextButton(self.form.manager, (x, y, width, 28), label, press))

        self.start_word = add(_PANEL, 664, texts.TRAIN_START, self._toggle)
        self.save_word = add(_PANEL + 316, 664, texts.TRAIN_SAVE, self._save)
        self.dream_word = add(_PANEL, 624, texts.PUPIL_DREAM, self._dream)
        self.quiz_word = add(max(_PANEL + 120, self.dream_word.box.right + 18), 624, texts.PUPIL_QUIZ, self._quiz)
        self._name_words()

    def _name_words(self) -> None:
        digit_run = self.digit_run
        self.start_word.label = start_word(digit_run.state)
        stop = texts.PUPIL_GO_ON if digit_run.unfinished else ""
        if digit_run.alive:
            stop = texts.PUPIL_STOPPING if digit_run.stopping else texts.PUPIL_STOP
        old = self.stop_word
        if stop != (old.label if old else ""):
            box = (_PANEL + 80, 664, typeface.width(stop, TEXT, "regular"), 28)
            self.stop_word = TextButton(self.form.manager, box, stop, self._stop_or_go_on) if stop else None
            before = [self.start_word, *([old] if old else [])]
            self.form.replace(before, [self.start_word, *([self.stop_word] if self.stop_word else [])])

    def _draw_title(self, canvas: Canvas) -> None:
        if self.digit_run.curves.points:
            draw_accuracy_legend(canvas, self.digit_run.curves)
        status = digit_status(self.digit_run)
        draw_run_status(canvas, (_LEFT, 46), texts.PUPIL_TITLE, *status, drop=72, room=_WIDTH - 2 * _LEFT)
        self.draw_hints(canvas)

    def _draw_said(self, canvas: Canvas) -> None:
        if problem := self.digit_run.problem:
            draw_problem(canvas, problem, (_PANEL, _SAID), 380, 4)
        elif self._back_word is not None and (fallen := self.digit_run.curves.fallen):
            best, now = (f"{100 * part:.1f}%" for part in fallen)
            canvas.outline(_HINT, 8, HUMAN, 1, 0.35)
            canvas.text(texts.HINT_TITLE, (_HINT.left + 14, _HINT.top + 17), size=LABEL, colour=HUMAN)
            said = texts.PUPIL_FALLEN.format(best=best, now=now)
            for number, text in enumerate(wrapped(canvas, said, SMALL, _HINT.width - 28)[:2]):
                canvas.text(text, (_HINT.left + 14, _HINT.top + 34 + 16 * number), size=SMALL)
