"""Chapter 9, learning from yesterday: the replay memory as a wall of moments, and what is drawn from it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Final

import numpy as np
import pygame

from ai.agent.agent import DeepQAgent
from ai.agent.replay import PrioritisedReplayBuffer, ReplayBuffer
from ai.environment import Doubles
from ai.lander.environment import OBSERVATION_SCALE
from ai.training.config import Config
from ai.training.small_run import SMALL_RUN, TESTED, Plan, SmallState
from game.core import texts
from game.core.scene import Route
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import HUMAN, INK, MUTE, NET, NIGHT1, SMALL, TEXT, Colour
from game.learn.chapter import STAGE, Code
from game.learn.runs import RunsChapter, draw_landers
from game.ui.context import Context
from game.ui.widget import PointsManager, Widget
from game.ui.widgets import Choice

KINDS: Final = ("even", "surprising", "latest")
YESTERDAY: Final = 600  # decisions from high up; then flights begin low
TODAY: Final = 300
LATEST: Final = 200  # memories that are held of the latest only
_COLUMNS, _ROWS = 45, 10
_EACH: Final = (YESTERDAY + TODAY) * SMALL_RUN.num_envs // (_COLUMNS * _ROWS)  # memories that a cell stands for
_CELL: Final = (STAGE.width / _COLUMNS, 20.0)
_WALL: Final = pygame.FRect(STAGE.left, STAGE.top + 26, STAGE.width, _ROWS * _CELL[1])
_HALF: Final = (STAGE.width - 40) / 2
_HIGHEST: Final = 9.0  # metres, of a cell's picture
_PAID: Final = 20.0  # points beyond which a cell is lit as a landing or a crash
_FORGOTTEN: Final = 0.25  # share of the tests that landed before and do not now
_FADE: Final = 0.5  # light of a drawn cell that is left after a decision


class MemoryChapter(RunsChapter):
    """One agent with a memory of the chosen kind; yesterday it began high up, today it begins low.

    Attributes:
        choice: index into `KINDS`.
        light: how lately something was drawn from each cell of the wall, 1 for the last decision, (cells,).
        results: by kind, the share that landed of the tests from high up: at the end of yesterday, and the least today.

    """

    key = "memory"
    door = Route("train")
    LENGTH = YESTERDAY + TODAY
    PLAN = Plan(heights=(5.0, 8.0), change=YESTERDAY, later=(0.3, 1.0), tested=(5.0, 8.0))

    def __init__(self, context: Context, manager: PointsManager) -> None:
        self.choice = 0
        self.results: dict[str, tuple[float, float]] = {}
        super().__init__(context, manager)
        self._painted = [PaintCache() for _ in range(_ROWS)]

    def restart(self) -> None:
        """Forget the runs and their results."""
        super().restart()
        self.choice = 0
        self.results.clear()

    def _forget(self) -> None:
        super()._forget()
        cells = _COLUMNS * _ROWS
        self.light: Doubles = np.zeros(cells)
        self._oldest = 0
        # Of each cell: height, speed and pay of the one memory that is pictured, and how many have come.
        self._pictured: Doubles = np.zeros((cells, 3))
        self._come = np.zeros(cells, dtype=np.intp)

    def configs(self) -> Sequence[Config]:
        """Return the configuration with the chosen memory."""
        return [SMALL_RUN.changed(prioritised=KINDS[self.choice] == "surprising")]

    @property
    def plan(self) -> Plan:
        """The two days, with the memory that is chosen."""
        return self.PLAN._replace(keep=LATEST if KINDS[self.choice] == "latest" else None)

    def widgets(self) -> list[Widget]:
        """Return the choice, and the button that starts."""
        choice = Choice(self.manager, self.row(1), "", texts.LEARN_MEMORY_KINDS, self.choice, self._choose, size=SMALL)
        return [choice, self.starter(texts.LEARN_MEMORY_START)]

    def _choose(self, index: int) -> None:
        self.choice = index

    def start(self) -> None:
        """Start with the choice as it is now; always from the same seed, so that memories can be compared."""
        self._flown = KINDS[self.choice]
        self.seed = 0
        super().start()

    def _take(self, states: tuple[SmallState, ...]) -> None:
        super()._take(states)
        memory = states[0].memory
        self._oldest = memory.oldest
        heights = memory.cells.state[:, 0] / OBSERVATION_SCALE[1]
        speeds = memory.cells.state[:, 1] / OBSERVATION_SCALE[3]
        pays = memory.cells.reward / SMALL_RUN.reward_scale
        for number, *moment in zip(memory.first + np.arange(len(pays)), heights, speeds, pays, strict=True):
            cell = min(int(number) // _EACH, len(self._come) - 1)
            if not self._come[cell] or abs(moment[2]) > abs(self._pictured[cell, 2]):
                self._pictured[cell] = moment
            self._come[cell] += 1
        self.light *= _FADE
        drawn = memory.drawn[: SMALL_RUN.batch_size]  # for the first of this decision's learning steps
        self.light[np.minimum(drawn // _EACH, len(self.light) - 1)] = 1.0

    def finished(self) -> None:
        """Keep the result, to compare it with that of other memories."""
        passed, changed = self.history(0, "passed"), min(YESTERDAY, self.LENGTH)
        self.results[self._flown] = (
            float(np.nan_to_num(passed[changed])),
            float(np.nan_to_num(passed[changed:]).min()),
        )

    def verdict(self) -> int | None:
        """Return which memory forgot most, or that none did, once all were tried."""
        if len(self.results) < len(KINDS):
            return None
        lost = [before - after for before, after in (self.results[kind] for kind in KINDS)]
        return int(np.argmax(lost)) if max(lost) >= _FORGOTTEN else len(KINDS)

    def why(self, guess: int | None) -> str:  # noqa: ARG002
        """Return for each memory that was tried how it flew from high up before and after."""
        named = dict(zip(KINDS, texts.LEARN_MEMORY_NAMES, strict=True))
        return " ".join(
            texts.LEARN_MEMORY_WHY.format(name=named[kind], before=before, after=after)
            for kind, (before, after) in self.results.items()
        )

    def code(self) -> Sequence[Code]:
        """Return how memories are drawn, evenly and by priority, and where the agent draws them."""
        memory = self.states[-1][0].memory if self.states else None
        held = (
            texts.LEARN_MEMORY_HELD.format(count=memory.first + len(memory.cells.action) - memory.oldest)
            if memory
            else ""
        )
        return [
            Code(ReplayBuffer.sample, np.random.Generator.integers, {np.random.Generator.integers: held}),
            Code(PrioritisedReplayBuffer.sample, np.ndarray.searchsorted),
            Code(DeepQAgent._learn_from, ReplayBuffer.sample),
        ]

    # The picture

    def draw(self, canvas: Canvas, alpha: float) -> None:  # noqa: ARG002
        """Draw the wall, today's flights, and the tests from high up."""
        state = self.states[-1][0] if self.states else None
        done = state.decisions if state else 0
        day = texts.LEARN_MEMORY_DAYS[done > YESTERDAY]
        self._draw_legends(canvas)
        self._draw_wall(canvas)
        flown, tested = (state.flown, state.tested) if state else (None, None)
        top = _WALL.bottom + 34
        for side, (name, each, count) in enumerate(
            ((day, flown, SMALL_RUN.num_envs), (texts.LEARN_MEMORY_TESTS, tested, TESTED))
        ):
            box = pygame.FRect(STAGE.left + side * (_HALF + 40), top, _HALF, 142)
            canvas.text(name, (box.left, top - 6), size=TEXT, colour=(NET, INK)[side], room=_HALF * 0.72)
            draw_landers(canvas, box, each, self.last[0] if state and not side else None, len(self.states), count)
            share = (state.passed if side else state.landed) if state else None
            if share is not None:
                told = texts.LEARN_RUNS_LANDED.format(share=share)
                canvas.text(told, (box.right, top - 6), size=SMALL, align="right", tabular=True, room=_HALF * 0.26)
        self.draw_status(canvas)

    @staticmethod
    def _draw_legends(canvas: Canvas) -> None:
        """Say above the wall what its marks and colours mean."""
        y = STAGE.top + 14
        canvas.text(texts.LEARN_MEMORY_WALL, (STAGE.left, y), size=SMALL, colour=MUTE, room=STAGE.width * 0.58)
        x = STAGE.right
        for name, pay in (("net", 5.0), ("warn", -2 * _PAID), ("good", 2 * _PAID)):
            told = texts.LEARN_MEMORY_CELLS[name]
            x -= canvas.text_width(told, size=SMALL)
            canvas.text(told, (x, y), size=SMALL, colour=MUTE)
            canvas.fill(canvas.rect(x - 17, y - 10, 11, 11), _colour(canvas, pay))
            x -= 34

    def _draw_wall(self, canvas: Canvas) -> None:
        """Draw the wall; rows are painted anew as memories come or go, and the light of what is drawn over them."""
        for row, painted in enumerate(self._painted):
            cells = slice(row * _COLUMNS, (row + 1) * _COLUMNS)
            held = min(max(self._oldest // _EACH, cells.start), cells.stop)
            box = (_WALL.left, _WALL.top + row * _CELL[1], _WALL.width, _CELL[1])
            painted.draw(canvas, box, (int(self._come[cells].sum()), held), partial(self._paint_row, row))
        for cell in np.flatnonzero(self.light > 0.25).tolist():
            x, y = _place(cell)
            canvas.fill(canvas.rect(_WALL.left + x, _WALL.top + y + _CELL[1] - 3, _CELL[0] - 1, 2), INK,
                        round(4 * float(self.light[cell])) / 4)  # fmt: skip
        x, y = _place(YESTERDAY * SMALL_RUN.num_envs // _EACH)
        place = (_WALL.left + x, _WALL.top + y)
        canvas.line(place, (place[0], place[1] + _CELL[1]), HUMAN, 2)

    def _paint_row(self, row: int, sheet: Canvas) -> None:
        for cell in range(row * _COLUMNS, (row + 1) * _COLUMNS):
            x, y = _place(cell)[0], 0.0
            area = sheet.rect(x, y, _CELL[0] - 1, _CELL[1] - 1)
            held = self._come[cell] and (cell + 1) * _EACH > self._oldest
            if not held:
                sheet.fill(area, NIGHT1, 0.5)
                continue
            height, speed, pay = self._pictured[cell].tolist()
            sheet.fill(area, _colour(sheet, pay))
            lander = (x + _CELL[0] / 2, y + 16 - 12 * min(max(height / _HIGHEST, 0.0), 1.0))
            sheet.line(lander, (lander[0], lander[1] - speed), INK, 1, 0.99)
            sheet.dot(lander, 1.6, INK)


def _place(cell: int) -> tuple[float, float]:
    """Return the corner of a cell of the wall, in points from that of the wall."""
    row, column = divmod(cell, _COLUMNS)
    return column * _CELL[0], row * _CELL[1]


def _colour(canvas: Canvas, pay: float) -> Colour:
    """Return the colour of a cell, by the pay of its memory."""
    if abs(pay) > _PAID:
        return mix(NIGHT1, canvas.palette.good if pay > 0 else canvas.palette.warn, 0.55)
    return mix(NIGHT1, NET, 0.25 + 0.25 * min(max(pay / 5.0, -1.0), 1.0))
