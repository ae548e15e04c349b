"""Chapter 8, learning from yesterday: the replay memory as a wall of moments, and what is drawn from it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import pygame

from ai.training.config import Config
from ai.training.small_run import SMALL_RUN, TESTED, Plan, SmallState
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.tokens import HUMAN, INK, NET, NIGHT0, NIGHT1, SMALL
from game.explain.figures import percent
from game.scenes.learn.runs import RunsChapter, draw_side_by_side
from game.ui.context import Context
from game.ui.panel import Column

KEPT: Final = (None, 200)  # memories that are held after yesterday, to choose from: all, or so many of the latest
YESTERDAY: Final = 600  # decisions from high up; then flights begin low
TODAY: Final = 300
_COLUMNS, _ROWS = 45, 10
_EACH: Final = (YESTERDAY + TODAY) * SMALL_RUN.num_envs // (_COLUMNS * _ROWS)  # memories that a cell stands for
_WALL: Final = 0.52  # share of the picture's height
_FORGOTTEN: Final = 0.25  # share of the tests that landed before and do not now


class MemoryChapter(RunsChapter):
    """One agent with a memory of the chosen kind; yesterday it began high up, today it begins low.

    Attributes:
        results: by choice, the share that landed of the tests from high up: at yesterday's end, and the least today.

    """

    key = "memory"
    LENGTH = YESTERDAY + TODAY
    PLAN = Plan(heights=(5.0, 8.0), change=YESTERDAY, later=(0.3, 1.0), tested=(5.0, 8.0))

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self.results: dict[int, tuple[float, float]] = {}

    def configs(self) -> Sequence[Config]:
        return [SMALL_RUN]

    @property
    def plan(self) -> Plan:
        return self.PLAN._replace(keep=KEPT[self.choice])

    def controls(self, column: Column) -> None:
        self.starter(column, texts.LEARN_MEMORY_NAMES, texts.LEARN_MEMORY_START)

    def start(self) -> None:
        """Start with the choice as it is now; always from the same seed, so that memories can be compared."""
        self.seed = 0
        super().start()

    def finish(self) -> None:
        """Keep the result; once all were tried, say which memory forgot most, or that none did."""
        passed, changed = np.nan_to_num(self.history(0, "passed")), min(YESTERDAY, self.LENGTH)
        self.results[self.flown] = float(passed[changed]), float(passed[changed:].min())
        if len(self.results) == len(KEPT):
            lost = [before - after for before, after in (self.results[choice] for choice in range(len(KEPT)))]
            self.came = int(np.argmax(lost)) if max(lost) >= _FORGOTTEN else len(KEPT)

    def why(self) -> str:
        return " ".join(
            texts.LEARN_MEMORY_WHY.format(
                name=texts.LEARN_MEMORY_NAMES[choice], before=percent(before), after=percent(after)
            )
            for choice, (before, after) in self.results.items()
        )

    def below(self, column: Column) -> None:
        super().below(column)
        column.aside(texts.LEARN_MEMORY_WALL)

    def draw(self, canvas: Canvas, box: pygame.FRect) -> None:
        state, half = self.states[-1][0] if self.states else None, (box.width - 32) / 2
        self._draw_wall(canvas, pygame.FRect(box.left, box.top, box.width, _WALL * box.height), state)
        day = texts.LEARN_MEMORY_DAYS[len(self.states) > YESTERDAY + 1]
        top = box.top + _WALL * box.height + 30
        for side, (name, count) in enumerate(((day, SMALL_RUN.num_envs), (texts.LEARN_MEMORY_TESTS, TESTED))):
            area = pygame.FRect(box.left + side * (half + 32), top, half, box.bottom - top)
            canvas.text(name, (area.left, top - 6), size=SMALL, colour=(NET, INK)[side], room=half)
            flown = None if state is None else state.tested if side else state.flown
            draw_side_by_side(canvas, area, flown, len(self.states), count)
            share = (state.passed if side else state.landed) if state else None
            if share is not None:
                words = texts.LEARN_RUNS_LANDED.format(share=percent(share))
                canvas.text(words, (area.right - 10, area.top + 20), size=SMALL, align="right", tabular=True)

    def _draw_wall(self, canvas: Canvas, box: pygame.FRect, state: SmallState | None) -> None:
        """Draw the cells that are held, light those from which the latest step drew, and mark where today begins."""
        oldest, newest = (state.memory.oldest, state.memory.newest) if state else (0, 0)
        drawn = set((state.memory.drawn[-SMALL_RUN.batch_size :] // _EACH).tolist()) if state else set()
        gone, kept, lit = mix(NIGHT0, NIGHT1, 0.5), mix(NIGHT1, NET, 0.3), mix(NIGHT1, NET, 0.9)
        wide, high = box.width / _COLUMNS, box.height / _ROWS
        for cell in range(_COLUMNS * _ROWS):
            row, column = divmod(cell, _COLUMNS)
            held = oldest < (cell + 1) * _EACH and cell * _EACH < newest
            colour = lit if held and cell in drawn else kept if held else gone
            place = box.left + column * wide, box.top + row * high
            canvas.fill(canvas.rect(*place, wide - 1, high - 1), colour)
            if cell == YESTERDAY * SMALL_RUN.num_envs // _EACH:
                canvas.fill(canvas.rect(*place, 2, high), HUMAN)
