"""Frames of a lesson of a network that reads digits: the image, and what it answers, should answer, and sends back."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import pygame

from ai.digits.training import DigitTraining
from ai.environment import Floats
from ai.explain.digit_lesson import DigitLesson
from ai.explain.recorder import Function
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import TITLE
from game.explain.figures import number, signed
from game.explain.tables import Line, table, told
from game.scenes.lesson.frame import Frame
from game.ui.panel import Column

SIDE: Final = 28  # pixels of an image
OUTPUT, PROBABILITY, TARGET, BACK = 1, 2, 3, 4  # columns, by their texts
_HIGHEST, _LEAST = 400.0, 260.0  # height of the image, width of a column


def pixel_name(unit: int) -> str:
    """Return the name of an input by its number."""
    return texts.LESSON_PIXEL.format(row=unit // SIDE + 1, column=unit % SIDE + 1)


class ImageFrame(Frame):
    """Frame of the image: its pixels, each with its number."""

    def __init__(self, lesson: DigitLesson) -> None:
        self._image, self._said = lesson.image, texts.LESSON_LABEL.format(digit=lesson.labels[lesson.step.row])
        super().__init__(texts.LESSON_DIGIT_FRAMES["image"], self._said, (DigitTraining.advance,), "images")

    def describe(self, column: Column) -> None:
        left, right = column.beside((1, 1), _LEAST)
        left.add(self._write_image)
        right.text(self._said, size=TITLE)
        right.aside(texts.LESSON_IMAGE_NOTE)

    def _write_image(self, cursor: Cursor) -> None:
        side = min(cursor.width, _HIGHEST)
        box = cursor.take(side)
        if canvas := cursor.canvas:
            self._draw(canvas, pygame.FRect(box.left, box.top, side, side))
            if canvas.pointer:
                pixel = side / SIDE
                column, row = (
                    int((at - start) // pixel) for at, start in zip(canvas.pointer, box.topleft, strict=True)
                )
                if 0 <= row < SIDE and 0 <= column < SIDE:
                    area = (box.left + column * pixel, box.top + row * pixel, pixel, pixel)
                    ink = told((texts.LESSON_INK, f"{float(self._image[row, column]):.3f}"))
                    canvas.explain(area, pixel_name(row * SIDE + column), lambda: ink)

    def _draw(self, canvas: Canvas, box: pygame.FRect) -> None:
        levels = np.clip(255 * self._image, 0, 255).astype(np.uint8)
        picture = pygame.surfarray.make_surface(np.repeat(levels.T[:, :, None], 3, axis=2))
        area = canvas.rect(*box)
        canvas.surface.blit(pygame.transform.scale(picture, area.size), area)


class DigitFrame(Frame):
    """Frame with a line for each digit, and columns of numbers with bars: some of `OUTPUT` to `BACK`, (10,) each."""

    def __init__(
        self,
        words: Sequence[str],
        figure: str,
        functions: Sequence[Function],
        digit: int,
        columns: Sequence[tuple[int, Floats]],
    ) -> None:
        super().__init__(words, figure, functions, "targets")
        heads, helps = texts.LESSON_DIGIT_COLUMNS, texts.LESSON_DIGIT_HELP
        shares = [np.abs(values) / max(float(np.abs(values).max()), 1e-9) for _, values in columns]
        self._head = [heads[0], *(heads[kind] for kind, _ in columns)]
        self._last, self._digit, what = shares[-1].tolist(), digit, helps[columns[-1][0]]
        self._lines = []
        for each in range(10):
            figures = [(signed if kind == BACK else number)(float(values[each])) for kind, values in columns]
            rows = told(*((helps[kind], written) for (kind, _), written in zip(columns, figures, strict=True)))
            bars = [float(share[each]) for share in shares]
            self._lines.append(Line((str(each), *figures), what, rows, each == digit, bars))

    def describe(self, column: Column) -> None:
        left, _ = column.beside((3, 2), _LEAST)
        left.add(table(self._head, lambda: self._lines))
