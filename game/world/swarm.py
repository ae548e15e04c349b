"""Swarm of a training run in another process: interpolated between snapshots, with trails of recent flights."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

import numpy as np
import pygame

from ai.environment import Bools, Doubles
from ai.lander.environment import PARAMS, Outcome
from ai.training.lander_session import CAREFUL
from ai.training.messages import SwarmState
from game.core import texts
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import HUMAN, LABEL, NET, NIGHT0, VIEW_SIZE, Colour
from game.world.camera import HOME, POINTS_PER_METRE, View
from game.world.craft import draw_craft, draw_crowd, draw_fires
from game.world.lander import LANDER
from game.world.landscape.backdrop import Backdrop
from game.world.landscape.pad import draw_pad
from game.world.paths import Trails

_SIZES: Final = ((1, 1.0), (16, 0.8), (64, 0.6), (256, 0.46), (1024, 0.3))  # (landers at most, drawn size)
_KEEP: Final = 16  # flights whose trail stays visible
_LONGEST_GAP: Final = 20.0  # frames between two snapshots, up to which landers are interpolated
_JUMP: Final = 4.0  # metres: farther than any lander flies between two snapshots
_REACH: Final = 16.0  # points from a lander within which a click is meant for it
_MOON: Final = 5
_SMALLEST: Final = 64  # pixels of its picture, each way
_BELOW: Final = 0.077  # share of the world's height that lies below its box: nothing but ground
_EARTH: Final = (880.0, 150.0)  # points of the small picture: clear of the figures


class LearningSwarm:
    """The landers of one training run in a box of the view.

    Attributes:
        box: where they fly, in points; all of their world is seen, and more land or sky beside it.
        head: points of it, from above, under a title: no lander there gets a word.
        chosen: slot of the lander that the player has chosen; None without one.

    """

    head = 0.0

    def __init__(self, box: pygame.typing.RectLike = (0, 0, 836, 434)) -> None:
        self.chosen: int | None = None
        self.place(pygame.FRect(box))
        self.clear()

    def place(self, box: pygame.FRect) -> None:
        """Move to another box."""
        self.box = box
        width, height = VIEW_SIZE
        self._zoom = min(box.width / width, box.height / ((1 - _BELOW) * height))
        middle = box.centerx, box.bottom + (_BELOW - 0.5) * height * self._zoom
        metre = POINTS_PER_METRE * self._zoom
        self._centre = (HOME[0] - (middle[0] - width / 2) / metre, HOME[1] + (middle[1] - height / 2) / metre)

    def clear(self) -> None:
        """Forget the run shown so far."""
        self.swarm_state: SwarmState | None = None
        self.chosen = None
        self._trails = Trails(0)
        self._before: Doubles = np.empty((0, 3))
        self._now: Doubles = self._before
        self._since = self._gap = 1.0
        self._frame = 0

    def take(self, swarm_state: SwarmState) -> None:
        """Take a new snapshot of the landers."""
        poses = np.column_stack([swarm_state.position, swarm_state.angle]).astype(float)
        last = self.swarm_state
        if last is None or len(last.outcome) != len(swarm_state.outcome):
            count = len(swarm_state.outcome)
            self._trails = Trails(count, _KEEP, stride=2)
            fresh = np.ones(count, bool)
        else:
            moved = np.hypot(*(poses[:, :2] - self._now[:, :2]).T)
            fresh = (last.outcome != Outcome.FLYING) | (moved > _JUMP)
        self._before = np.where(fresh[:, None], poses, self._now) if len(self._now) == len(poses) else poses
        self._now = poses
        self._gap += 0.3 * (min(max(self._since, 1.0), _LONGEST_GAP) - self._gap)
        self._since = 0.0
        self.swarm_state = swarm_state
        self._trails.follow(
            poses[:, :2], swarm_state.outcome.astype(np.intp), fresh, swarm_state.outcome != Outcome.FLYING
        )

    def slot_at(self, point: Point) -> int | None:
        """Return the slot of the lander at a point of the view, or None without one."""
        if not len(self._now) or not self.box.collidepoint(point):
            return None
        away = np.hypot(*(View(1.0, self._centre, self._zoom).points(self._now[:, :2]) - point).T)
        nearest = int(away.argmin())
        return nearest if away[nearest] <= _REACH else None

    def update(self, still: bool = False) -> None:
        """Advance by 1/60 s; while `still`, flames do not flicker."""
        self._since += 1
        self._frame += not still

    def draw(self, canvas: Canvas, alpha: float, paused: bool = False) -> None:
        """Draw the moon, the pad and the landers."""
        view = View(canvas.scale, self._centre, self._zoom)
        area = canvas.rect(*self.box)
        canvas.surface.set_clip(area)
        below = round(_BELOW * VIEW_SIZE[1] * self._zoom * canvas.scale)
        pixels = max(_SMALLEST, area.width), max(_SMALLEST, area.height + below)  # a tiny window shows a part of it
        canvas.surface.blit(_moon(pixels).picture, area)
        draw_pad(canvas, view, (0.0, PARAMS.pad_top), PARAMS.pad_width)
        if self.swarm_state is None:
            canvas.surface.set_clip(None)
            return
        part = 1.0 if paused else min(1.0, (self._since + alpha) / self._gap)
        poses = self._before + part * (self._now - self._before)
        wrecked = np.isin(self.swarm_state.outcome, (Outcome.CRASHED, Outcome.OUT_OF_BOUNDS))
        count = len(poses)
        size = next((size for most, size in _SIZES if count <= most), _SIZES[-1][1])
        marked = np.zeros(count, bool)
        marked[CAREFUL] = True
        chosen = self.chosen if self.chosen is not None and self.chosen < count else None
        if chosen is not None:
            marked[chosen] = True
        self._trails.draw(canvas, view, CAREFUL)
        shown = ~marked & ~wrecked
        draw_fires(canvas, view, poses[shown & self._burning()], self._frame, size)
        draw_crowd(canvas, view, poses[shown], size)
        if not wrecked[CAREFUL] and chosen != CAREFUL:
            self._draw_marked(canvas, view, poses[CAREFUL], CAREFUL, texts.SWARM_BEST if count > 1 else "", NET, size)
        if chosen is not None:
            self._draw_marked(canvas, view, poses[chosen], chosen, texts.LESSON_CHOSEN, HUMAN, size)
        canvas.surface.set_clip(None)

    def _burning(self) -> Bools:
        assert self.swarm_state is not None
        burning: Bools = (self.swarm_state.action >= 3) & (self.swarm_state.outcome == Outcome.FLYING)
        return burning

    def _draw_marked(
        self, canvas: Canvas, view: View, pose: Doubles, slot: int, word: str, colour: Colour, size: float
    ) -> None:
        assert self.swarm_state is not None
        steer = int(self.swarm_state.action[slot]) % 3
        thrust = np.array([self._burning()[slot], steer == 2, steer == 1], dtype=float)
        draw_craft(canvas, view, LANDER, pose, thrust, 1.0, self._frame, min(1.0, 1.5 * size))
        x, y = view.points(pose[:2]).tolist()
        if word and y > self.box.top + self.head:
            width = canvas.text_width(word, size=LABEL)
            edge = width / 2 + 8  # a lander may fly out of the picture, the word may not
            x = min(max(x, self.box.left + edge), self.box.right - edge)
            y = max(y - 30 * min(1.0, 1.5 * size), self.box.top + 24)
            canvas.pill((x - width / 2 - 8, y - 22, width + 16, 17), NIGHT0, 0.72)  # over whatever flies behind
            canvas.text(word, (x, y - 9.5), size=LABEL, colour=colour, align="centre")
            canvas.marker("triangle_down", (x, y - 1), 6, colour)


class _Moon:
    """The landscape behind a swarm, dimmed: rough at once, and painted again until it is whole."""

    def __init__(self, size: tuple[int, int]) -> None:
        self._land = Backdrop(size, np.random.default_rng(_MOON))
        self._picture, self._veil = pygame.Surface(size), pygame.Surface(size)
        self._veil.fill(NIGHT0)
        self._veil.set_alpha(90)
        self._whole = False

    @property
    def picture(self) -> pygame.Surface:
        """The picture as far as it is painted."""
        if not self._whole:
            self._land.paint(self._picture, earth=_EARTH)
            self._picture.blit(self._veil, (0, 0))
            self._whole = self._land.whole
        return self._picture


@lru_cache(maxsize=4)
def _moon(size: tuple[int, int]) -> _Moon:
    return _Moon(size)
