"""Digit training scene: a network learns in a process of its own; charts and confusion matrix show its progress."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.agent.schedule import InForce
from ai.digits.config import DIGIT_PRESETS, DigitConfig
from ai.digits.session import DigitSettingChanged
from ai.training.history import REVERTED
from game.charts.chart import RUN_STYLES, Chart, Series, Tick, draw_legend
from game.charts.charts import Charts
from game.core import texts
from game.core.scene import Pop, Push, Transition, push
from game.core.worker import WorkerState
from game.digits.matrix import ConfusionMatrix
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.prose import wrapped
from game.drawing.sky import NightSky
from game.drawing.tokens import HUMAN, LABEL, LINE, MUTE, PANEL, SMALL, TEXT, VIEW_SIZE
from game.input.controls import Command, translate
from game.panels.knobs import KnobsPanel
from game.panels.run_status import draw_problem, draw_run_status, start_word
from game.scenes.dialog import NameDialog, QuestionDialog
from game.training.digit_models import runs_dir
from game.training.digit_run import DigitCurves, DigitRun
from game.training.knob_descriptions import figure, knob_descriptions, label
from game.training.run_settings import RunKind
from game.training.training_run import EarlierRun
from game.ui.context import Context
from game.ui.form import Form
from game.ui.hints import draw_hints
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
_CHARTS: Final = {"loss": (40, 146, 372, 152), "accuracy": (440, 146, 372, 152)}
_MATRIX: Final = pygame.Rect(70, 372, 320, 320)
_CELL: Final = pygame.Rect(440, 346, 372, 346)
_SAID: Final = 500.0  # baseline of a problem's message
_HINT: Final = pygame.Rect(868, 548, 384, 60)
_EVERY: Final = 12  # frames between two drawings of the charts
_BATCHES: Final = (MUTE, (2.0, 4.0))


class DigitTrainingScene:
    """Digit training scene: charts, confusion matrix and knobs."""

    digit_run: DigitRun

    knobs: KnobsPanel

    def __init__(self) -> None:
        self._context: Context | None = None
        self._was_running = self._alive = False
        self._frame = 0
        self._told: tuple[object, ...] = ()
        self._question: Transition | None = None
        self._asked = False
        self.stop_word: TextButton | None = None
        self._back_word: TextButton | None = None
        self._in_force_told: tuple[float, DigitConfig, InForce] | None = None

    def enter(self, context: Context) -> None:
        """Build the screen; after a scene above has closed, resume the run."""
        if self._context is not None:
            if self._was_running:
                self.digit_run.resume()
            if self._asked and self.digit_run.alive:  # and the player chose not to replace it
                self.knobs.set_config(self.digit_run.config, self.digit_run.seed)
            self._asked = False
            return
        self._context, self._settings = context, context.settings
        self.digit_run = DigitRun(runs_dir(context.user_dir))
        self.digit_run.collection.hold()
        self._sky = NightSky(np.random.default_rng(12), ember=0.2, stars=40)
        self.charts = Charts([
            Chart(_CHARTS[name], texts.PUPIL_CHARTS[name], read=form.format, empty=texts.PUPIL_CHARTS_SHOW[name])
            for name, form in (("loss", "{:.3g}"), ("accuracy", "{:.2f}"))
        ])  # fmt: skip
        self._form = Form(context, on_back=self._leave)
        self._add_words()
        self._form.add(VirtualPointer(self._form.manager, self.charts.box, self.charts.follow))
        self.knobs = KnobsPanel(
            self._form, _KNOBS, DIGIT_PRESETS["classic"], 0, self._turned, self._begin, DIGITS
        )  # fmt: skip
        self.matrix = self._form.add(ConfusionMatrix(self._form.manager, _MATRIX))
        self._form.focus(self.start_word)

    def exit(self) -> None:
        """Pause the run while another scene has the window."""
        self._was_running = self.digit_run.state in (WorkerState.RUNNING, WorkerState.STARTING)
        self.digit_run.pause()

    def close(self) -> None:
        """End the run's process; its latest network is kept."""
        if self._context is not None:
            self.digit_run.close()
            self.digit_run.collection.release()

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Handle start, pause, stop, knobs and the matrix."""
        self.charts.follow(event)
        outcome = self._form.handle_event(event)
        if outcome is None and not self._form.used:
            match translate(event):
                case Command.STEP:
                    self.digit_run.step()
                case Command.HANDOVER:
                    self._toggle()
        return outcome

    def update(self) -> Transition | None:
        """Receive the worker's messages, and animate the screen."""
        assert self._context is not None
        for note in self.digit_run.poll():
            self._context.note(note)
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
            self._set_charts()
            self._name_words()
        self.charts.update(at_once=self._settings.reduced_motion)
        question, self._question = self._question, None
        return self._form.update() or question

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
        self._form.draw(canvas)
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
            self._form.manager, (_HINT.right - 14 - width, _HINT.top + 2, width, 22), texts.PUPIL_GO_BACK,
            self.digit_run.go_back, size=SMALL,
        ) if wanted else None  # fmt: skip
        self._form.replace([old] if old else [], [self._back_word] if self._back_word else [])

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
        assert self._context is not None
        self._was_running = False
        if note := self.digit_run.begin(config, seed, resume=resume, name=self.knobs.name):
            self._context.note(note)
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
        assert self._context is not None
        if self.digit_run.alive and self.digit_run.steps:
            self._context.note(texts.TRAIN_KEPT)
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
        assert self._context is not None
        self._context.note(words)

    # The picture

    def _add_words(self) -> None:
        def add(x: float, y: float, label: str, press: OnPress) -> TextButton:
            width = typeface.width(label, TEXT, "regular")
            return self._form.add(TextButton(self._form.manager, (x, y, width, 28), label, press))

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
            self.stop_word = TextButton(self._form.manager, box, stop, self._stop_or_go_on) if stop else None
            before = [self.start_word, *([old] if old else [])]
            self._form.replace(before, [self.start_word, *([self.stop_word] if self.stop_word else [])])

    def _set_charts(self) -> None:
        curves = self.digit_run.curves
        told = (curves.seconds, len(curves.points), len(curves.scores), len(self.digit_run.earlier), *curves.turns)
        if told == self._told:
            return
        self._told = told
        runs = [EarlierRun(texts.TRAIN_THIS, curves, 0), *self.digit_run.earlier]
        end = max(10.0, *(beside.run.seconds for beside in runs))
        losses, accuracies = [], []
        for beside in runs:
            name, each, (colour, dash) = beside.name, beside.run, RUN_STYLES[beside.style]
            if each.points:
                seconds = [point.seconds for point in each.points]
                losses.append(Series(seconds, [point.loss for point in each.points], name, colour, dash))
                scores = ([score.seconds for score in each.scores], [100 * score.accuracy for score in each.scores])
                accuracies.append(Series(*scores, name, colour, dash, smooth=False))
        if curves.points:
            accuracies.append(_batches(curves))
        ticks = [Tick(turn.seconds, _turn_told(turn), "knob") for turn in curves.turns]
        for chart, series in zip(self.charts.charts, (losses, accuracies), strict=True):
            chart.set(series, (0.0, end), ticks)

    def _draw_title(self, canvas: Canvas) -> None:
        assert self._context is not None
        digit_run, curves = self.digit_run, self.digit_run.curves
        line = texts.PUPIL_LOADING if digit_run.alive else texts.PUPIL_LINE
        if curves.points:
            last = curves.points[-1]
            line = texts.PUPIL_FIGURES.format(epoch=last.epoch, epochs=digit_run.config.epochs, seconds=last.seconds,
                                              rate=last.images_per_second)  # fmt: skip
            draw_legend(canvas, [Series((), (), texts.PUPIL_HELD_OUT), _batches(curves)], (440, 118))
        part = digit_run.test if digit_run.test is not None else curves.scores[-1].accuracy if curves.scores else None
        figure = "" if part is None else f"{100 * part:.2f}"
        words = texts.PUPIL_READ if digit_run.test is None else texts.PUPIL_TESTED
        if digit_run.test is not None and digit_run.kept_epoch is not None:
            read = f"{100 * curves.scores[-1].accuracy:.2f}%" if curves.scores else "–"
            line = texts.PUPIL_KEPT_BEST.format(epoch=digit_run.kept_epoch, last=read)
        draw_run_status(canvas, (_LEFT, 46), texts.PUPIL_TITLE, line, figure, words, drop=72, room=_WIDTH - 2 * _LEFT)
        hints = self._form.hints or [(self._context.controls.word(Command.BACK), texts.HINT_BACK)]
        draw_hints(canvas, hints, (_WIDTH - 24, 46), from_right=True)

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


def _turn_told(turn: DigitSettingChanged) -> str:
    if turn.name == REVERTED:
        return texts.PUPIL_WENT_BACK.format(part=turn.after)
    return f"{label(turn.name)} {figure(turn.after)}"


def _batches(curves: DigitCurves) -> Series:
    """Return the curve of the training batches' accuracy."""
    colour, dash = _BATCHES
    return Series([point.seconds for point in curves.points], [100 * point.accuracy for point in curves.points],
                  texts.PUPIL_BATCHES, colour, dash)  # fmt: skip
