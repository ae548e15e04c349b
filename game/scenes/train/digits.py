"""Digits as Train shows them: what is misread, with the digits of one cell."""

from __future__ import annotations

from collections.abc import Hashable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

import pygame

from ai.training.history import REVERTED
from game.core import texts
from game.core.scene import Transition
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, LABEL, MUTE, SMALL
from game.scenes.train.charts import DIGIT_CHARTS
from game.scenes.train.digit_views import ConfusionMatrix
from game.scenes.train.layout import Layout, Status
from game.scenes.train.scene import TrainScene
from game.scenes.train.view import Pointer, View
from game.training.library import DigitModels
from game.training.run_kind import DIGITS
from game.ui.panel import Column
from game.ui.virtual_pointer import VirtualPointer

if TYPE_CHECKING:
    from game.ui.context import Context

FALLEN: Final = 0.15  # drop of the accuracy below its best at which a return to the best is offered
_HEAD: Final = 172.0  # of the display, for the title and a heading
_LEFT: Final = 28.0
_NUMBERS: Final = 24.0  # beside and above the matrix, for its digits
_LARGEST: Final = 330.0  # matrix
_SMALLEST: Final = 135.0  # matrix: in a smaller one, its digits would touch
_LEAST: Final = 180.0  # points beside it for the digits of a cell


def digit_training(context: Context) -> TrainScene:
    """Return the scene of a run of digits."""
    return TrainScene(context, DigitView)


class DigitView(View):
    """View of a run of digits.

    Attributes:
        matrix: what is misread.

    """

    kind, charts, preset = DIGITS, DIGIT_CHARTS, "classic"

    def __init__(self, scene: TrainScene) -> None:
        super().__init__(scene)
        self.matrix = ConfusionMatrix((0, 0, 100, 100))

    @staticmethod
    def collection(user_dir: Path) -> DigitModels:
        return DigitModels(user_dir)

    # What it has come to

    def status(self) -> Status:
        run = self.run
        history, scores = run.history, run.history.validations
        line = texts.DIGIT_RUN_LOADING if run.alive else texts.DIGIT_RUN_LINE
        if len(history):
            epoch, seconds, rate = (history[name][-1] for name in ("epoch", "seconds", "images_per_second"))
            figures = {"epoch": epoch, "epochs": run.config.epochs, "seconds": seconds, "rate": rate}
            line = texts.DIGIT_RUN_FIGURES.format(**figures)
        part, words = scores[-1].success if scores else None, texts.DIGIT_RUN_READ
        if run.test is not None:
            if run.kept_epoch is not None:
                read = f"{100 * scores[-1].success:.2f} %" if scores else "–"
                line = texts.DIGIT_RUN_KEPT_BEST.format(epoch=run.kept_epoch, last=read)
            part, words = run.test, texts.DIGIT_RUN_TESTED
        return Status(texts.DIGIT_RUN_TITLE, line, "" if part is None else f"{100 * part:.2f}", words)

    @property
    def unfinished(self) -> str:  # type: ignore[override]
        return texts.TRAIN_LEFT if self.run.unfinished else ""

    @property
    def worth_keeping(self) -> bool:  # type: ignore[override]
        return self.run.steps > 0 if self.run.alive else self.run.kept

    @property
    def _fallen(self) -> tuple[float, float] | None:
        """The best accuracy and the present one, where that is far lower, and not since a return to the best."""
        run, scores = self.run, self.run.history.validations
        back = max((turn.seconds for turn in run.history.setting_changes if turn.name == REVERTED), default=-1.0)
        if not scores or scores[-1].seconds <= back or not run.alive or run.stopping:
            return None
        best, now = max(score.success for score in scores), scores[-1].success
        return (best, now) if best - now > FALLEN else None

    @property
    def _shows_misread(self) -> bool:
        """Whether something was read already, and there is room to read what."""
        return self.matrix.confusion is not None and self.matrix.box.width >= _SMALLEST

    # Rows

    @property
    def key(self) -> Hashable:  # type: ignore[override]
        return self._fallen is not None, self._shows_misread

    def describe_foot(self, column: Column) -> None:
        if self.run.alive:
            column.button(texts.DIGIT_RUN_STOPPING if self.run.stopping else texts.DIGIT_RUN_STOP, self.run.stop)

    def describe_hint(self, column: Column) -> bool:
        if (parts := self._fallen) is None:
            return False
        best, now = (f"{100 * part:.1f} %" for part in parts)
        column.caption(texts.HINT_TITLE)
        column.text(texts.DIGIT_RUN_FALLEN.format(best=best, now=now), size=SMALL, colour=HUMAN)
        column.button(texts.DIGIT_RUN_GO_BACK, partial(self.run.ask, "restore_best"))
        return True

    def pointers(self) -> list[Pointer]:
        charts = self.scene.charts
        pointers: list[Pointer] = [(VirtualPointer((0, 0, 1, 1), charts.follow), lambda: charts.box)]
        if self._shows_misread:
            before, self.matrix = self.matrix, ConfusionMatrix(self.matrix.box)
            self.matrix.take_over(before)
            pointers.append((self.matrix, lambda: self._matrix))
        return pointers

    # Time

    def update(self) -> Transition | None:
        if self.matrix.confusion is not self.run.confusion:
            self.matrix.set(self.run.confusion)
        return None

    def clear(self) -> None:
        self.matrix.set(None)

    # The picture

    def place(self, place: Layout) -> None:
        area = place.swarm
        self._area = pygame.FRect(_LEFT, area.top + _HEAD, area.width - 2 * _LEFT, max(area.height - _HEAD - 8, 60))
        side = min(self._area.height - _NUMBERS, _LARGEST, self._area.width - _NUMBERS)
        matrix = pygame.Rect(round(_LEFT + _NUMBERS), round(self._area.top + _NUMBERS), round(side), round(side))
        self.matrix.rect = self.matrix.relative_rect = self._matrix = matrix
        self._cell = pygame.FRect(matrix.right + 36, matrix.top, self._area.right - matrix.right - 36, side)

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the headings of the matrix, and the chosen cell's digits."""
        if not self._shows_misread:
            return
        box, run = self.matrix.box, self.run
        place = (box.left - _NUMBERS, box.top - _NUMBERS - 4)
        heading = canvas.text(texts.MATRIX_TITLE, place, size=LABEL, colour=MUTE, weight="medium")
        if run.test is not None and run.kept_epoch is not None:
            of_best = texts.MATRIX_OF_BEST.format(epoch=run.kept_epoch)
            canvas.text(of_best, (heading.right + 12, place[1]), size=LABEL, colour=MUTE)
        if self._cell.width >= _LEAST:
            canvas.text(texts.MATRIX_AXES, (self._cell.left, place[1]), size=LABEL, colour=MUTE, room=self._cell.width)
            self.matrix.draw_cell(canvas, self._cell)
