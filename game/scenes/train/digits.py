"""Digit training scene: a network learns in a process of its own; charts and confusion matrix show its progress."""

from __future__ import annotations

from collections.abc import Hashable
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.digits.config import DIGIT_PRESETS, DigitConfig
from ai.training.config import InForce
from ai.training.history import REVERTED, History
from game.core import texts
from game.core.scene import Push, Transition, push
from game.digits.filter_film import FilterFilm
from game.digits.matrix import ConfusionMatrix
from game.drawing.canvas import Canvas
from game.drawing.sky import NightSky
from game.drawing.tokens import HUMAN, LABEL, MUTE, SMALL
from game.panels.lesson_door import ImageDoor
from game.scenes.menus.dialogs import QuestionDialog
from game.scenes.train.base import KNOBS as ALL_KNOBS
from game.scenes.train.base import MORE, TrainingScene
from game.scenes.train.digit_charts import DigitCharts
from game.scenes.train.knobs import KnobsPanel
from game.scenes.train.layout import Layout
from game.scenes.train.status import digit_status
from game.training.digit_models import DigitModels, figures_of, runs_dir
from game.training.run import TrainingRun
from game.training.run_settings import RunKind
from game.training.workers import DIGITS
from game.ui.context import Context
from game.ui.panel import Column
from game.ui.scrubber import Scrubber
from game.ui.virtual_pointer import VirtualPointer
from game.ui.widget import Widget

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier

_OFFERED: Final = {name: preset for name, preset in DIGIT_PRESETS.items() if name in ("classic", "modern")}
KNOBS: Final = RunKind(
    DigitConfig, _OFFERED, lambda: texts.DIGIT_RUN_PRESETS, "images",
    first=("learning_rate", "batch_size", "dropout"),
)  # fmt: skip
FALLEN: Final = 0.15  # drop of the accuracy below its best at which a return to the best is offered
_HEAD: Final = 172.0  # of the display, for the title and a heading
_LEFT: Final = 28.0
_NUMBERS: Final = 24.0  # beside and above the matrix, for its digits
_LARGEST: Final = 330.0  # matrix
_SMALLEST: Final = 135.0  # matrix: in a smaller one, its digits would touch
_LEAST: Final = 180.0  # points beside it for the digits of a cell
_EVERY: Final = 12  # frames between two drawings of the charts


def fallen(history: History) -> tuple[float, float] | None:
    """Return the best and the present accuracy, if the present one is far lower; None otherwise, or after a return."""
    back = max((turn.seconds for turn in history.setting_changes if turn.name == REVERTED), default=-1.0)
    read = [score.success for score in history.validations if score.seconds > back]
    best = max((score.success for score in history.validations), default=0.0)
    return (best, read[-1]) if read and best - read[-1] > FALLEN else None


class DigitTrainingScene(TrainingScene):
    """Digit training scene: charts, knobs, and the confusion matrix or the filters as they form.

    Attributes:
        film: the filters of the moment that is chosen on the charts.
        view: what is shown: the matrix, 0, or the filters, 1.

    """

    charts_shown = 2

    def __init__(self, context: Context) -> None:
        self._frame = self.view = 0
        self._asked = False
        self._in_force_told: tuple[float, DigitConfig, InForce] | None = None
        self.digit_run = TrainingRun(DIGITS, DigitModels(runs_dir(context.user_dir)))
        super().__init__(context, self.digit_run)

    def _build(self) -> None:
        self.digit_run.collection.hold()
        self._sky = NightSky(np.random.default_rng(12), ember=0.2, stars=40)
        self.charts = DigitCharts()
        self.lessons = ImageDoor(self.digit_run, self.context.note)
        self.knobs = KnobsPanel(self.form, DIGIT_PRESETS["classic"], 0, self.digit_run.change, self._begin, KNOBS)
        self.film = FilterFilm(self.charts)
        self.matrix = ConfusionMatrix(self.form.manager, (0, 0, 100, 100))

    def enter(self) -> None:
        """Resume the run."""
        super().enter()
        if self._asked and self.digit_run.alive:  # and the player chose not to replace it
            self.knobs.set_config(self.digit_run.config, self.digit_run.seed)
        self._asked = False

    # Rows

    @property
    def _key(self) -> Hashable:
        run = self.digit_run
        return self.view, run.alive, run.stopping, run.unfinished, self._fallen is not None, self._shows_misread

    @property
    def _fallen(self) -> tuple[float, float] | None:
        """The best accuracy and the present one, where a way back is offered."""
        run = self.digit_run
        return fallen(run.history) if run.alive and not run.stopping else None

    @property
    def _shows_misread(self) -> bool:
        """Whether something was read already, and there is room to read what."""
        return not self.view and self.matrix.confusion is not None and self.matrix.box.width >= _SMALLEST

    def _pointers(self) -> list[Widget]:
        manager, nowhere = self.form.manager, (0, 0, 1, 1)
        self._pointer = VirtualPointer(manager, nowhere, self.charts.follow)
        if self.view:
            self._shown: Widget = Scrubber(manager, self.charts, self.film.choose, lambda: None, self.charts.zoom_by)
        elif self._shows_misread:
            if self.matrix not in self.form.widgets:
                cell, before = self.matrix.cell, self.matrix
                self._shown = self.matrix = ConfusionMatrix(manager, before.box)
                self.matrix.set(before.confusion)
                self.matrix.cell = cell
            self._shown = self.matrix
        else:
            return [self._pointer]
        return [self._pointer, self._shown]

    def _place(self, place: Layout) -> None:
        for chart, box in zip(self.charts.charts, place.charts, strict=True):
            chart.move(box)
        self._pointer.relative_rect = self._pointer.rect = pygame.Rect(self.charts.box)
        area = place.swarm
        self._area = pygame.FRect(_LEFT, area.top + _HEAD, area.width - 2 * _LEFT, max(area.height - _HEAD - 8, 60))
        side = min(self._area.height - _NUMBERS, _LARGEST, self._area.width - _NUMBERS)
        matrix = pygame.Rect(round(_LEFT + _NUMBERS), round(self._area.top + _NUMBERS), round(side), round(side))
        self.matrix.rect = self.matrix.relative_rect = matrix
        self._cell = pygame.FRect(matrix.right + 36, matrix.top, self._area.right - matrix.right - 36, side)
        if self.view:
            self._shown.relative_rect = self._shown.rect = pygame.Rect(self.charts.box)

    def _describe_more(self, column: Column) -> None:
        column.gap()
        self.switch(column, MORE, texts.TRAIN_MORE)
        if not self.opened(MORE):
            return
        self.switch(column, ALL_KNOBS, texts.TRAIN_MORE_KNOBS)
        column.choice("", texts.DIGIT_RUN_VIEWS, self.view, self._change_view, SMALL)
        column.line()
        column.words([
            (texts.LESSON_WHY, self.lessons.open),
            (texts.DIGIT_RUN_DREAM, self._dream),
            (texts.DIGIT_RUN_QUIZ, self._quiz),
            (texts.TRAIN_SAVE, self._save),
        ])  # fmt: skip

    def _describe_foot(self, column: Column) -> None:
        super()._describe_foot(column)
        if word := self._stop_word:
            column.button(word, self._stop_or_go_on)

    @property
    def _stop_word(self) -> str:
        """What stops the run, or goes on with an unfinished one."""
        if self.digit_run.alive:
            return texts.DIGIT_RUN_STOPPING if self.digit_run.stopping else texts.DIGIT_RUN_STOP
        return texts.DIGIT_RUN_GO_ON if self.digit_run.unfinished else ""

    def _describe_hint(self, column: Column) -> bool:
        if (parts := self._fallen) is None:
            return False
        best, now = (f"{100 * part:.1f}%" for part in parts)
        column.caption(texts.HINT_TITLE)
        column.text(texts.DIGIT_RUN_FALLEN.format(best=best, now=now), size=SMALL, colour=HUMAN)
        column.button(texts.DIGIT_RUN_GO_BACK, self.digit_run.go_back)
        return True

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Handle start, pause, stop, knobs and the matrix."""
        self.charts.follow(event)
        return super().handle_event(event)

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
        self._frame += 1
        if self._frame % _EVERY == 0:
            self.charts.look(self.digit_run.history, self.digit_run.earlier)
        self.charts.update(at_once=self._settings.reduced_motion)
        return self._finish_update() or self.lessons.update()

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

    def _change_view(self, view: int) -> None:
        """Show what is misread, or the filters with a scrubber over the charts."""
        self.film.release()
        self.view = view

    # The picture

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the display and the panel; what is read from the charts is above all."""
        super().draw(canvas, alpha)
        self.charts.draw(canvas)

    def _draw_display(self, canvas: Canvas, alpha: float) -> None:
        """Draw the figures, and what is misread or the filters."""
        self._sky.draw(canvas)
        self.draw_title(canvas, texts.DIGIT_RUN_TITLE, digit_status(self.digit_run))
        if self.view:
            self.film.draw(canvas, self._area)
        elif self._shows_misread:
            self._draw_misread(canvas)

    def _draw_misread(self, canvas: Canvas) -> None:
        """Draw the headings of the matrix, and the chosen cell's digits."""
        box, run = self.matrix.box, self.digit_run
        place = (box.left - _NUMBERS, box.top - _NUMBERS - 4)
        heading = canvas.text(texts.MATRIX_TITLE, place, size=LABEL, colour=MUTE, weight="medium")
        if run.test is not None and run.kept_epoch is not None:
            of_best = texts.MATRIX_OF_BEST.format(epoch=run.kept_epoch)
            canvas.text(of_best, (heading.right + 12, place[1]), size=LABEL, colour=MUTE)
        if self._cell.width >= _LEAST:
            canvas.text(texts.MATRIX_AXES, (self._cell.left, place[1]), size=LABEL, colour=MUTE, room=self._cell.width)
            self.matrix.draw_cell(canvas, self._cell)
