"""Map of the chance to be saved: over the whole sky, where a network could still land at this speed and tilt.

Where it could is the set of states from which the pad can be reached, seen at one speed, tilt and turn (in control
theory the backward reachable set, here by the chances of a safety critic). Its border is the edge of no return.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
import pygame

from ai.common.environment import Doubles, Floats
from ai.lander.environment import LanderEnv
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import INK, NET, NIGHT0, Colour
from game.flight.chances import Critic, chances_to_any_pad
from game.world.camera import GROUND_LINE, View
from game.world.contours import contours, smooth
from game.world.paths import draw_faint
from game.world.policy_map import HALF, TOP, finer, grid_places

EDGE: Final = 0.5  # chance on the edge of no return: as many are lost as are saved
SAFE: Final = 0.97  # chance on the line within which nearly all are saved
GRID: Final = (65, 29)  # places across and up
LINES_GRID: Final = (45, 20)  # enough for the lines alone
_REST: Final = 2  # updates between two maps of a lander that moves
_PIECE: Final = 225  # places and pads asked about in one update: about half a millisecond
_FADE: Final = 2.0  # metres over which it fades out at its top and sides
_LOW: Final = 0.6  # and at the ground
_TICKS: Final = 0.9  # metres from one tick of the edge to the next
_TICK: Final = 0.34  # length of a tick, metres
_STEEPEST: Final = 6.0  # log odds beyond which a chance counts as certain
# From lost to saved: what lies over the sky, and how opaque it is. The edge glows.
_MARKS: Final = (0.0, 0.25, 0.46, 0.54, 0.75, 0.97, 1.0)
_TONES: Final[tuple[Colour, ...]] = (
    (52, 30, 44), (70, 34, 44), (150, 74, 60), (120, 170, 210), (50, 92, 140), (40, 72, 120), (40, 72, 120),
)  # fmt: skip
_COVERS: Final = (0.62, 0.6, 0.52, 0.42, 0.26, 0.12, 0.05)


@dataclass(frozen=True, eq=False)
class ChanceCells:
    """Chances to be saved at a grid of places, for one tilt, turn and speed.

    Attributes:
        places: metres, (rows, columns, 2); the first row is the highest.
        chances: chance to be saved by the best action, (rows, columns), 0 to 1.
        odds: the same as log odds, which change more evenly from place to place.
        edges: lines of the chance `EDGE`, each (k, 2) in metres, with the saved side on one hand throughout.
        safe: lines of the chance `SAFE`.

    """

    places: Doubles
    chances: Doubles
    odds: Doubles
    edges: list[Doubles]
    safe: list[Doubles]

    @classmethod
    def of(cls, places: Doubles, chances: Doubles) -> ChanceCells:
        """Draw the lines through chances at places."""
        sure = np.clip(np.nan_to_num(chances), 1e-9, 1 - 1e-9)
        odds = np.clip(np.log(sure / (1 - sure)), -_STEEPEST, _STEEPEST)
        lines = [
            [_in_metres(places, smooth(line, 1)) for line in contours(odds, float(np.log(level / (1 - level))))]
            for level in (EDGE, SAFE)
        ]
        return cls(places, chances, odds, *lines)

    @cached_property
    def veil(self) -> pygame.Surface:
        """What lies over the sky, four times as fine as the grid: its colours, and in alpha how much it covers."""
        odds = finer(finer(finer(finer(self.odds).T).T).T).T
        up, across = odds.shape
        x, y = np.linspace(-HALF, HALF, across), np.linspace(TOP, GROUND_LINE, up)
        fade = np.minimum((TOP - y) / _FADE, (y - GROUND_LINE) / _LOW).clip(0, 1)[:, None]
        fade = fade * ((HALF - np.abs(x)) / _FADE).clip(0, 1)
        tone = np.round((odds + _STEEPEST) * (len(_VEIL) - 1) / (2 * _STEEPEST)).astype(int).T
        veil = pygame.Surface((across, up), pygame.SRCALPHA)
        pygame.surfarray.pixels3d(veil)[:] = _VEIL[tone, :3].astype(np.uint8)
        cover = _VEIL[tone, 3] * (fade**2 * (3 - 2 * fade)).T
        pygame.surfarray.pixels_alpha(veil)[:] = cover.astype(np.uint8)
        return veil


class ChanceMap:
    """Map of the chance to be saved, computed in pieces; call `follow` once per update.

    Attributes:
        cells: the latest whole map; None before the first.

    """

    def __init__(self, grid: tuple[int, int] = GRID) -> None:
        self._picture = PaintCache()
        self._places: Doubles = grid_places(*grid)
        self._veils = grid != LINES_GRID
        self.forget()

    @property
    def said(self) -> str:
        """What the map shows, in a sentence; empty before the first."""
        if self.cells is None:
            return ""
        if self.cells.edges:
            return texts.EDGE_HERE
        return texts.EDGE_NOWHERE[bool(np.nan_to_num(self.cells.chances).mean() > EDGE)]

    def forget(self) -> None:
        """Forget all that was computed."""
        self.cells: ChanceCells | None = None
        self._edges: list[tuple[Doubles, Doubles]] = []  # lines over the ground, each with its ticks
        self._safe: list[Doubles] = []
        self._state = b""
        self._work: Iterator[None] | None = None
        self._rested = _REST

    def follow(self, env: LanderEnv, slot: int, critic: Critic) -> None:
        """Compute a piece of the map for the tilt, turn and speed of a lander; nothing while it is up to date."""
        self._rested += 1
        if self._work is None and self._rested > _REST:
            state = np.array([*env.velocity[slot], env.angle[slot], env.angular_velocity[slot]]).tobytes()
            if self.cells is None or state != self._state:
                self._state, self._work = state, self._compute(env, slot, critic)
        if self._work is not None and next(self._work, self) is self:
            self._work, self._rested = None, 0

    def _compute(self, env: LanderEnv, slot: int, critic: Critic) -> Iterator[None]:
        """Compute a map of the state that there is when it begins, in pieces of about the same time."""
        moments = self._moments(env, slot)
        pieces, step = [], max(1, _PIECE // moments.shape[1])
        for start in range(0, len(moments), step):
            pieces.append(chances_to_any_pad(critic, moments[start : start + step]).max(axis=1))
            yield
        cells = ChanceCells.of(self._places, np.concatenate(pieces).astype(float).reshape(self._places.shape[:2]))
        yield
        if self._veils:
            _ = cells.veil  # takes as long as a piece, and would else be made while it is drawn
            yield
        safe = [part for line in cells.safe for part in _over_ground(env, line)]
        edges = [(part, _ticks(part)) for line in cells.edges for part in _over_ground(env, line)]
        self.cells, self._safe, self._edges = cells, safe, edges

    def _moments(self, env: LanderEnv, slot: int) -> Floats:
        """Return what there is to be observed at every place on the way to each pad, (places, pads, 9 + k)."""
        places, columns = self._places.reshape(-1, 2), self._places[0]  # the ground beside depends on the column alone
        return np.stack(
            [
                np.concatenate(
                    [
                        env.observe_at(slot, places, pad),
                        np.tile(env.around_at(slot, columns, pad), (len(self._places), 1)),
                    ],
                    axis=1,
                )
                for pad in range(len(env.ground.pads))
            ],
            axis=1,
        )

    # The picture

    def draw_veil(self, canvas: Canvas, view: View) -> None:
        """Draw the chance over the sky: dark where all would be lost, clear where all could be saved."""
        if self.cells is None:
            return
        (left, top), (right, bottom) = view.points(self.cells.places[[0, -1], [0, -1]]).tolist()
        with canvas.unnoted():  # stars shine through it
            self._picture.draw(canvas, (left, top, right - left, bottom - top), self.cells, self._paint)

    def draw_edge(self, canvas: Canvas, view: View, head: float, *, safe: bool = True) -> None:
        """Draw the edge of no return with ticks on its lost side, and the line within which nearly all are `safe`."""
        for line in self._safe if safe else []:
            draw_faint(canvas.surface, view.pixels(line), NET, 0.35, head * canvas.scale)
        for line, ticks in self._edges:
            draw_faint(canvas.surface, view.pixels(line), INK, 0.75, head * canvas.scale)
            _draw_ticks(canvas, view, ticks, head)

    def _paint(self, sheet: Canvas) -> None:
        """Paint the veil on a sheet whose corners are the outermost places; at half resolution, since it is soft."""
        assert self.cells is not None
        half = (max(2, sheet.size[0] // 2), max(2, sheet.size[1] // 2))
        pygame.transform.scale(pygame.transform.smoothscale(self.cells.veil, half), sheet.size, sheet.surface)


def _table() -> Doubles:
    """Return what lies over the sky for even steps of log odds, (n, 4): red, green, blue and alpha, 0 to 255."""
    chances = 1 / (1 + np.exp(-np.linspace(-_STEEPEST, _STEEPEST, 256)))
    channels = [*np.array(_TONES, float).T, 255 * np.array(_COVERS)]
    table: Doubles = np.stack([np.interp(chances, _MARKS, channel) for channel in channels], axis=-1)
    return table


_VEIL: Final = _table()


def veil_colours(chances: Doubles) -> Doubles:
    """Return the colours (..., 3) of chances as they lie over a dark sky, for a legend."""
    tones = np.array([mix(NIGHT0, tone, cover) for tone, cover in zip(_TONES, _COVERS, strict=True)], float)
    colours: Doubles = np.stack([np.interp(chances, _MARKS, tones[:, channel]) for channel in range(3)], axis=-1)
    return colours


def _in_metres(places: Doubles, line: Doubles) -> Doubles:
    """Turn a line in columns and rows of a grid of places into metres."""
    (left, top), (right, bottom) = places[0, 0], places[-1, -1]
    share = line / (np.array(places.shape[1::-1]) - 1)
    metres: Doubles = np.array([left, top]) + share * np.array([right - left, bottom - top])
    return metres


def _over_ground(env: LanderEnv, line: Doubles) -> list[Doubles]:
    """Return the parts of a line (k, 2) that are clear of the ground, each two points at least."""
    clear = line[:, 1] > env.ground.height(line[:, 0]) + _LOW
    breaks = np.flatnonzero(np.diff(clear)) + 1
    parts = np.split(line, breaks)
    return [part for part, up in zip(parts, clear[[0, *breaks]], strict=True) if up and len(part) > 1]


def _ticks(line: Doubles) -> Doubles:
    """Return short strokes on the lost side of an edge, evenly along it: their ends in metres, (n, 2, 2)."""
    steps = np.diff(line, axis=0)
    lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*steps.T))])
    marks = np.arange(0.5 * _TICKS, lengths[-1], _TICKS)
    at = np.stack([np.interp(marks, lengths, line[:, k]) for k in range(2)], axis=1)
    way = steps[np.minimum(np.searchsorted(lengths, marks, "right") - 1, len(steps) - 1)]
    way = way / np.maximum(np.hypot(*way.T), 1e-9)[:, None]
    lost = np.stack([-way[:, 1], way[:, 0]], axis=1)
    return np.stack([at, at + _TICK * lost], axis=1)


def _draw_ticks(canvas: Canvas, view: View, ticks: Doubles, head: float) -> None:
    """Draw the ticks of an edge below the uppermost `head` points, as maps mark the brink of a cliff."""
    surface, least = canvas.surface, head * canvas.scale
    width, height = surface.get_size()
    for start, end in view.pixels(ticks).tolist():
        x, y = int(start[0]), int(start[1])
        if y > least and 0 <= x < width and y < height:
            pygame.draw.aaline(surface, surface.get_at((x, y)).lerp(INK, 0.4), start, end)
