"""Chapter 8, learning from yesterday: the replay memory as a wall of moments, and what is drawn from it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import pygame
from numpy.typing import NDArray

from ai.agent.replay import ReplayBuffer
from ai.environment import Doubles
from ai.training.config import Config
from ai.training.small_run import SMALL_RUN, TESTED, Plan, SmallState
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.paint import mix
from game.drawing.tokens import CAPTION, HUMAN, INK, MUTE, NET, NIGHT0, NIGHT1, SMALL
from game.explain.figures import percent
from game.scenes.learn.chapter import Code
from game.scenes.learn.runs import RunsChapter, draw_side_by_side
from game.ui.panel import Column

KINDS: Final = ("even", "surprising", "latest")
YESTERDAY: Final = 600  # decisions from high up; then flights begin low
TODAY: Final = 300
LATEST: Final = 200  # memories that are held of the latest only
_COLUMNS, _ROWS = 45, 10
_EACH: Final = (YESTERDAY + TODAY) * SMALL_RUN.num_envs // (_COLUMNS * _ROWS)  # memories that a cell stands for
_WALL: Final = 0.52  # share of the picture's height
_LARGE: Final = 20.0  # points beyond which a cell is lit as a landing or a crash
_FORGOTTEN: Final = 0.25  # share of the tests that landed before and do not now
_FADE: Final = 0.5  # light of a drawn cell that is left after a decision


class MemoryChapter(RunsChapter):
    """One agent with a memory of the chosen kind; yesterday it began high up, today it begins low.

    Attributes:
        light: how lately something was drawn from each cell of the wall, 1 for the last decision, (cells,).
        results: by kind, the share that landed of the tests from high up: at the end of yesterday, and the least today.

    """

    key = "memory"
    LENGTH = YESTERDAY + TODAY
    PLAN = Plan(heights=(5.0, 8.0), change=YESTERDAY, later=(0.3, 1.0), tested=(5.0, 8.0))

    def restart(self) -> None:
        super().restart()
        self.results: dict[str, tuple[float, float]] = {}

    def _forget(self) -> None:
        super()._forget()
        cells = _COLUMNS * _ROWS
        self.light: Doubles = np.zeros(cells)
        self._oldest = 0
        self._paid: Doubles = np.zeros(cells)  # the pay of each cell's memory that was paid most, or cost most
        self._come = np.zeros(cells, dtype=np.intp)

    def configs(self) -> Sequence[Config]:
        return [SMALL_RUN.changed(prioritised=KINDS[self.choice] == "surprising")]

    @property
    def plan(self) -> Plan:
        return self.PLAN._replace(keep=LATEST if KINDS[self.choice] == "latest" else None)

    def controls(self, column: Column) -> None:
        column.choice("", texts.LEARN_MEMORY_KINDS, self.choice, self.choose)
        self.starter(column, texts.LEARN_MEMORY_START)

    def start(self) -> None:
        """Start with the choice as it is now; always from the same seed, so that memories can be compared."""
        self.seed = 0
        super().start()

    def take(self, states: tuple[SmallState, ...]) -> None:
        super().take(states)
        memory = states[0].memory
        self._oldest = memory.oldest
        for number, pay in enumerate((memory.cells.reward / SMALL_RUN.reward_scale).tolist(), memory.first):
            cell = min(number // _EACH, len(self._come) - 1)
            self._come[cell] += 1
            if abs(pay) > abs(self._paid[cell]):
                self._paid[cell] = pay
        self.light *= _FADE
        drawn = memory.drawn[: SMALL_RUN.batch_size]  # for the first of this decision's learning steps
        self.light[np.minimum(drawn // _EACH, len(self.light) - 1)] = 1.0

    def finish(self) -> None:
        """Keep the result, to compare it with that of other memories."""
        passed, changed = np.nan_to_num(self.history(0, "passed")), min(YESTERDAY, self.LENGTH)
        self.results[KINDS[self.flown]] = float(passed[changed]), float(passed[changed:].min())

    def verdict(self) -> int | None:
        """Return which memory forgot most, or that none did, once all were tried."""
        if len(self.results) < len(KINDS):
            return None
        lost = [before - after for before, after in (self.results[kind] for kind in KINDS)]
        return int(np.argmax(lost)) if max(lost) >= _FORGOTTEN else len(KINDS)

    def why(self) -> str:
        named = dict(zip(KINDS, texts.LEARN_MEMORY_NAMES, strict=True))
        return " ".join(
            texts.LEARN_MEMORY_WHY.format(name=named[kind], before=percent(before), after=percent(after))
            for kind, (before, after) in self.results.items()
        )

    def code(self) -> Code:
        memory = self.states[-1][0].memory if self.states else None
        count = memory.first + len(memory.cells.action) - memory.oldest if memory else 0
        held = texts.LEARN_MEMORY_HELD.format(count=count) if memory else ""
        return Code(ReplayBuffer.sample, np.random.Generator.integers, held)

    def below(self, column: Column) -> None:
        super().below(column)
        column.aside(texts.LEARN_MEMORY_WALL)
        column.add(_write_cells)

    # The picture

    def draw(self, canvas: Canvas, box: pygame.FRect, alpha: float) -> None:
        self._draw_wall(canvas, pygame.FRect(box.left, box.top, box.width, _WALL * box.height))
        state, half = self.states[-1][0] if self.states else None, (box.width - 32) / 2
        day = texts.LEARN_MEMORY_DAYS[bool(state) and self.states[-1][0].decisions > YESTERDAY]
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

    def _draw_wall(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw the cells, the light of what was drawn from them, and where today begins."""
        wide, high = box.width / _COLUMNS, box.height / _ROWS
        colours = _colours(canvas, self._paid)
        gone = (self._come == 0) | ((np.arange(_COLUMNS * _ROWS) + 1) * _EACH <= self._oldest)
        colours[gone] = mix(NIGHT0, NIGHT1, 0.5)
        picture = pygame.surfarray.make_surface(colours.reshape(_ROWS, _COLUMNS, 3).swapaxes(0, 1))
        area = canvas.rect(*box)
        canvas.surface.blit(pygame.transform.scale(picture, area.size), area)
        for column in range(1, _COLUMNS):
            canvas.line((box.left + column * wide, box.top), (box.left + column * wide, box.bottom), NIGHT0)
        for row in range(1, _ROWS):
            canvas.line((box.left, box.top + row * high), (box.right, box.top + row * high), NIGHT0)
        for cell in np.flatnonzero(self.light > 0.25).tolist():
            row, column = divmod(cell, _COLUMNS)
            place = canvas.rect(box.left + column * wide + 1, box.top + (row + 1) * high - 3, wide - 1, 2)
            canvas.fill(place, INK, float(self.light[cell]))
        row, column = divmod(YESTERDAY * SMALL_RUN.num_envs // _EACH, _COLUMNS)
        x, y = box.left + column * wide, box.top + row * high
        canvas.line((x, y), (x, y + high), HUMAN, 2)


def _write_cells(cursor: Cursor) -> None:
    """Write what the colours of the wall mean."""
    small, x = cursor.in_style(CAPTION, MUTE), cursor.left
    for name, pay in (("good", 2 * _LARGE), ("warn", -2 * _LARGE), ("net", 5.0)):
        words = texts.LEARN_MEMORY_CELLS[name]
        if canvas := cursor.canvas:
            red, green, blue = _colours(canvas, np.array([pay]))[0].tolist()
            canvas.fill(canvas.rect(x, small.baseline - 10, 11, 11), (red, green, blue))
            canvas.text(words, (x + 17, small.baseline), size=CAPTION, colour=MUTE)
        x += small.measured(words) + 40
    cursor.gap(20)


def _colours(canvas: Canvas, pay: Doubles) -> NDArray[np.uint8]:
    """Return the colours (n, 3) of cells, by the pay (n,) of their memories."""
    large, pay = np.abs(pay)[:, None] > _LARGE, pay[:, None]
    tint = np.where(large, np.where(pay > 0, canvas.palette.good, canvas.palette.warn), NET)
    share = np.where(large, 0.55, 0.25 + 0.25 * np.clip(pay / 5.0, -1.0, 1.0))
    colours: NDArray[np.uint8] = (NIGHT1 + share * (tint - np.array(NIGHT1))).astype(np.uint8)
    return colours
