"""Digit training scene: a network learns in a process of its own; charts and confusion matrix show its progress."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.digits.config import DIGIT_PRESETS, DigitConfig
from ai.training.config import InForce
from game.core import texts
from game.core.scene import Push, Transition, push
from game.digits.filter_film import FilterFilm
from game.digits.matrix import ConfusionMatrix
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.sky import NightSky
from game.drawing.tokens import LABEL, LINE, MUTE, SMALL, TEXT
from game.lesson.door import ImageDoor
from game.panels.digit_charts import DigitCharts, draw_accuracy_legend
from game.panels.knobs import KnobsPanel
from game.panels.run_status import draw_run_status
from game.panels.training_status import digit_status
from game.panels.way_back import WayBack
from game.scenes.menus.dialogs import QuestionDialog
from game.scenes.training_scene import DISPLAY_WIDTH, LEFT, PANEL_LEFT, TrainingScene
from game.training.digit_models import DigitModels, figures_of, runs_dir
from game.training.knob_descriptions import knob_descriptions
from game.training.run import TrainingRun
from game.training.run_settings import RunKind
from game.training.workers import DIGITS
from game.ui.context import Context
from game.ui.hints import HintRow
from game.ui.scrubber import Scrubber
from game.ui.virtual_pointer import VirtualPointer
from game.ui.widget import OnPress, Widget
from game.ui.widgets import Choice, TextButton

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier

_OFFERED: Final = {name: preset for name, preset in DIGIT_PRESETS.items() if name in texts.DIGIT_RUN_PRESETS}
KNOBS: Final = RunKind(tuple(knob_descriptions(DigitConfig)), _OFFERED, texts.DIGIT_RUN_PRESETS, "images")
_KNOBS: Final = pygame.Rect(868, 20, 384, 436)
_MATRIX: Final = pygame.Rect(70, 372, 320, 320)
_CELL: Final = pygame.Rect(440, 346, 372, 346)
_VIEWS: Final = pygame.Rect(440, 690, 372, 24)  # what is misread, or the filters
_SAID: Final = 500.0  # baseline of a problem's message
_HINT: Final = pygame.Rect(868, 548, 384, 60)
_EVERY: Final = 12  # frames between two drawings of the charts


class DigitTrainingScene(TrainingScene):
    """Digit training scene: charts, knobs, and the confusion matrix or the filters as they form.

    Attributes:
        film: the filters of the moment that is chosen on the charts.
        views: the choice between the matrix, 0, and the filters, 1.

    """

    def __init__(self, context: Context) -> None:
        self._frame = 0
        self._asked = False
        self.stop_button: TextButton | None = None
        self._in_force_told: tuple[float, DigitConfig, InForce] | None = None
        self.digit_run = TrainingRun(DIGITS, DigitModels(runs_dir(context.user_dir)))
        super().__init__(context, self.digit_run, ((PANEL_LEFT, _SAID), 4))

    def _build(self) -> None:
        self.digit_run.collection.hold()
        self._sky = NightSky(np.random.default_rng(12), ember=0.2, stars=40)
        self.charts = DigitCharts()
        self.lessons = ImageDoor(self.digit_run, self.context.note)
        self._add_words()
        self.form.add(VirtualPointer(self.form.manager, self.charts.box, self.charts.follow))
        self.knobs = KnobsPanel(
            self.form, _KNOBS, DIGIT_PRESETS["classic"], 0, self.digit_run.change, self._begin, KNOBS
        )
        self.film = FilterFilm(self.charts)
        self.matrix = self.form.add(ConfusionMatrix(self.form.manager, _MATRIX))
        self._shown: Widget = self.matrix
        self.views = self.form.add(
            Choice(self.form.manager, _VIEWS, "", texts.DIGIT_RUN_VIEWS, 0, self._change_view, size=SMALL)
        )
        self._way_back = WayBack(self.form, _HINT, self.digit_run)
        self.form.focus(self.start_button)

    def enter(self) -> None:
        """Resume the run."""
        super().enter()
        if self._asked and self.digit_run.alive:  # and the player chose not to replace it
            self.knobs.set_config(self.digit_run.config, self.digit_run.seed)
        self._asked = False

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Handle start, pause, stop, knobs and the matrix."""
        self.charts.follow(event)
        return super().handle_event(event)

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        """Return the hints above the charts."""
        return [HintRow(self.hints, (DISPLAY_WIDTH - 24, 46), from_right=True)]

    def update(self) -> Transition | None:
        """Receive the worker's messages, and animate the screen."""
        for note in self.digit_run.poll():
            self.context.note(note)
        self._follow_run()
        if self.matrix.confusion is not self.digit_run.confusion:
            self.matrix.set(self.digit_run.confusion)
        self.film.follow(self.digit_run)
        if self.digit_run.alive:
            self.knobs.show_in_force(self._in_force())
        self._way_back.follow()
        self._frame += 1
        if self._frame % _EVERY == 0:
            self.charts.look(self.digit_run.history, self.digit_run.earlier)
            self._name_words()
        self.charts.update(at_once=self._settings.reduced_motion)
        return self._ask_or(self.form.update()) or self.lessons.update()

    # The run

    @property
    def _learnt(self) -> bool:
        return self.digit_run.steps > 0

    def _in_force(self) -> InForce | None:
        """Values in force, as last reported by the run."""
        history, config = self.digit_run.history, self.digit_run.config
        if not len(history):
            return None
        rate = float(history["learning_rate"][-1])
        if self._in_force_told is None or self._in_force_told[:2] != (rate, config):
            self._in_force_told = rate, config, InForce({"learning_rate": rate}, config.unused())
        return self._in_force_told[2]

    def _toggle(self) -> None:
        if not self.digit_run.stopping:
            super()._toggle()
            self._name_words()

    def _begin(self, config: DigitConfig, seed: int) -> None:
        """Start a run; first ask whether to keep an unnamed earlier one."""
        run = self.digit_run
        if not (run.kept or (run.alive and run.steps)):
            self._start(config, seed)
            return
        preset, seconds, part = figures_of(run)
        named = (preset, "") if preset in _OFFERED else KNOBS.nearest(run.config)
        name = run.collection.free_name(texts.DIGIT_RUN_NAME.format(preset=KNOBS.word(named)))

        def keep() -> None:
            if problem := self._save_as(name):
                self.context.note(problem)
            else:
                self._start(config, seed)

        self._asked = True
        words = texts.DIGIT_RUN_LEFT_YOUNG if part is None else texts.DIGIT_RUN_LEFT_FIGURES
        self._question = Push(QuestionDialog(self, texts.TRAIN_LEFT, words.format(part=part, seconds=seconds), [
            (texts.DIGIT_RUN_LEFT_KEEP.format(name=name), keep),
            (texts.TRAIN_LEFT_DISCARD, lambda: self._start(config, seed)),
        ]))  # fmt: skip

    def _clear(self) -> None:
        self.matrix.set(None)

    def _stop_or_go_on(self) -> None:
        """Stop the run, or resume the unfinished one."""
        if self.digit_run.alive:
            self.digit_run.stop()
        elif self.digit_run.unfinished:
            self._start(self.knobs.config, self.knobs.seed, resume=self.digit_run.collection.unsaved)
        self._name_words()

    def _save(self) -> Transition | None:
        if not (self.digit_run.kept or self.digit_run.alive):
            self.context.note(texts.DIGIT_RUN_NOTHING)
            return None
        return self._ask_name(texts.DIGIT_RUN_NAME.format(preset=self.knobs.name))

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
            self.context.note(texts.DIGIT_RUN_NOTHING)
            return None
        try:
            return DigitClassifier.load(self.digit_run.collection.unsaved)
        except (OSError, ValueError) as error:
            self.context.note(str(error))
            return None

    # Matrix or filters

    def _change_view(self, index: int) -> None:
        """Show what is misread, or the filters with a scrubber over the charts."""
        self.film.release()
        manager, old = self.form.manager, self._shown
        if index:
            self._shown = Scrubber(manager, self.charts, self.film.choose, lambda: None, self.charts.zoom_by)
        else:
            cell = self.matrix.cell
            self._shown = self.matrix = ConfusionMatrix(manager, _MATRIX)
            self.matrix.set(self.digit_run.confusion)
            self.matrix.cell = cell
        self.form.replace([old], [self._shown])

    # The picture

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the display and the panel; what is read from the charts is above all."""
        super().draw(canvas, alpha)
        self.charts.draw(canvas)

    def _draw_display(self, canvas: Canvas, alpha: float) -> None:
        """Draw the figures, and what is misread or the filters."""
        self._sky.draw(canvas)
        self._draw_title(canvas)
        canvas.line((LEFT, 318), (DISPLAY_WIDTH - 24, 318), LINE)
        if self.views.index:
            self.film.draw(canvas)
        else:
            self._draw_misread(canvas)

    def _draw_misread(self, canvas: Canvas) -> None:
        """Draw the headings of the matrix, and the chosen cell's digits."""
        heading = canvas.text(texts.MATRIX_TITLE, (LEFT, 340), size=LABEL, colour=MUTE, weight="medium")
        shown = canvas.text(texts.MATRIX_AXES, (heading.right + 12, 340), size=LABEL, colour=MUTE)
        if self.digit_run.test is not None and self.digit_run.kept_epoch is not None:
            of_best = texts.MATRIX_OF_BEST.format(epoch=self.digit_run.kept_epoch)
            canvas.text(of_best, (shown.right + 12, 340), size=LABEL, colour=MUTE)
        if self.matrix.confusion is None:
            canvas.text(texts.MATRIX_EMPTY, (_CELL.left, _CELL.top + 14), size=SMALL, colour=MUTE)
        self.matrix.draw_cell(canvas, _CELL)

    def _draw_advice(self, canvas: Canvas) -> None:
        self._way_back.draw(canvas)

    def _add_words(self) -> None:
        def add(x: float, y: float, label: str, press: OnPress) -> TextButton:
            width = typeface.width(label, TEXT, "regular")
            return self.form.add(TextButton(self.form.manager, (x, y, width, 28), label, press))

        self.start_button = add(PANEL_LEFT, 664, texts.TRAIN_START, self._toggle)
        self.save_button = add(PANEL_LEFT + 316, 664, texts.TRAIN_SAVE, self._save)
        self.dream_button = add(PANEL_LEFT, 624, texts.DIGIT_RUN_DREAM, self._dream)
        self.quiz_button = add(
            max(PANEL_LEFT + 120, self.dream_button.box.right + 18), 624, texts.DIGIT_RUN_QUIZ, self._quiz
        )
        self.why_button = add(
            max(PANEL_LEFT + 214, self.quiz_button.box.right + 18), 624, texts.LESSON_WHY, self.lessons.open
        )
        self._name_words()

    def _name_words(self) -> None:
        digit_run = self.digit_run
        stop = texts.DIGIT_RUN_GO_ON if digit_run.unfinished else ""
        if digit_run.alive:
            stop = texts.DIGIT_RUN_STOPPING if digit_run.stopping else texts.DIGIT_RUN_STOP
        old = self.stop_button
        if stop != (old.label if old else ""):
            box = (PANEL_LEFT + 80, 664, typeface.width(stop, TEXT, "regular"), 28)
            self.stop_button = TextButton(self.form.manager, box, stop, self._stop_or_go_on) if stop else None
            before = [self.start_button, *([old] if old else [])]
            self.form.replace(before, [self.start_button, *([self.stop_button] if self.stop_button else [])])

    def _draw_title(self, canvas: Canvas) -> None:
        if len(self.digit_run.history):
            draw_accuracy_legend(canvas, self.digit_run.history)
        status = digit_status(self.digit_run)
        draw_run_status(canvas, (LEFT, 46), texts.DIGIT_RUN_TITLE, *status, drop=72, room=DISPLAY_WIDTH - 2 * LEFT)
        self.draw_hints(canvas)
