"""Frames of a lesson of a network that reads digits: the image, and tables with a line for each digit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from ai.digits.training import DigitTraining
from ai.environment import Floats
from ai.explain.digit_lesson import DigitLesson
from ai.explain.recorder import Function
from game.core import texts
from game.digits.pictures import GREY, picture
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


def image_frame(lesson: DigitLesson) -> Frame:
    """Return the frame of the image."""
    said = texts.LESSON_LABEL.format(digit=lesson.labels[lesson.step.row])

    def write(cursor: Cursor) -> None:
        box = cursor.take(min(cursor.width, _HIGHEST))
        if canvas := cursor.canvas:
            area = canvas.rect(box.left, box.top, box.height, box.height)
            canvas.surface.blit(picture(lesson.image, area.size, GREY), area)

    def describe(column: Column) -> None:
        left, right = column.beside((1, 1), _LEAST)
        left.add(write)
        right.text(said, size=TITLE)
        right.aside(texts.LESSON_IMAGE_NOTE)

    return Frame(texts.LESSON_DIGIT_FRAMES["image"], said, (DigitTraining.advance,), "images", describe)


def digit_frame(
    words: Sequence[str],
    figure: str,
    functions: Sequence[Function],
    digit: int,
    columns: Sequence[tuple[int, Floats]],
) -> Frame:
    """Return a frame with a line for each digit, and columns of figures: some of `OUTPUT` to `BACK`, (10,) each."""
    heads, helps = texts.LESSON_DIGIT_COLUMNS, texts.LESSON_DIGIT_HELP
    shares = [np.abs(values) / max(float(np.abs(values).max()), 1e-9) for _, values in columns]
    lines = []
    for each in range(10):
        figures = [(signed if kind == BACK else number)(float(values[each])) for kind, values in columns]
        rows = told(*((helps[kind], written) for (kind, _), written in zip(columns, figures, strict=True)))
        bars = [float(share[each]) for share in shares]
        lines.append(Line((str(each), *figures), helps[columns[-1][0]], rows, each == digit, bars))
    head = [heads[0], *(heads[kind] for kind, _ in columns)]

    def describe(column: Column) -> None:
        left, _ = column.beside((3, 2), _LEAST)
        left.add(table(head, lambda: lines))

    return Frame(words, figure, functions, "targets", describe)
