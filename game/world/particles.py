"""Dust, sparks and fragments. Decoration only: they touch nothing, and nothing depends on them."""

from __future__ import annotations

import math
from enum import IntEnum
from functools import lru_cache
from typing import Final

import numpy as np
import numpy.typing as npt
import pygame

from ai.lander import PARAMS
from game.render import View
from game.ui.tokens import Colour

_STEP: Final = 1 / 60
_LEVELS: Final = 8


class Kind(IntEnum):
    """What a particle is: how it fades, grows and is drawn."""

    DUST = 0
    SPARK = 1
    SHARD = 2


_DUST: Final[Colour] = (150, 140, 150)
_SPARK: Final[Colour] = (255, 176, 90)
_SHARDS: Final[tuple[Colour, ...]] = ((214, 158, 74), (190, 198, 214), (92, 98, 118), (168, 112, 48))
_GROWTH: Final = np.array([0.55, 0.0, 0.0])  # metres a second


class Particles:
    """A fixed number of slots; the oldest are taken over when all are in use."""

    def __init__(self, rng: np.random.Generator, slots: int = 420) -> None:
        self._rng = rng
        self._position = np.zeros((slots, 2))
        self._before = np.zeros((slots, 2))
        self._velocity = np.zeros((slots, 2))
        self._age = np.full(slots, np.inf)
        self._life = np.ones(slots)
        self._size = np.zeros(slots)
        self._kind = np.zeros(slots, np.intp)
        self._look = np.zeros(slots, np.intp)
        self._next = 0

    def clear(self) -> None:
        """Take every particle away."""
        self._age[:] = np.inf

    def update(self) -> None:
        """Let a step of 1/60 s pass."""
        self._before[:] = self._position
        self._velocity[:, 1] -= PARAMS.gravity * _STEP
        self._position += self._velocity * _STEP
        self._age += _STEP
        self._size += _GROWTH[self._kind] * _STEP
        low = self._position[:, 1] < PARAMS.ground
        self._position[low, 1] = PARAMS.ground
        self._velocity[low] *= (0.5, -0.35)

    def blow(self, x: float, ground: float, strength: float) -> None:
        """Blow dust outwards along the ground from where a jet meets it; `strength` 0 to 1."""
        count = int(self._rng.poisson(3.2 * strength))
        if count:
            side = self._rng.choice((-1.0, 1.0), count)
            start = np.stack([x + side * self._rng.uniform(0.1, 0.7, count), np.full(count, ground + 0.06)], 1)
            speed = side * self._rng.uniform(2.2, 7.5, count) * (0.5 + 0.5 * strength)
            rise = self._rng.uniform(0.05, 1.1, count) * strength
            life = self._rng.uniform(0.5, 1.3, count)
            self._add(Kind.DUST, start, np.stack([speed, rise], 1), life, self._rng.uniform(0.10, 0.26, count))

    def settle(self, x: float, ground: float, strength: float) -> None:
        """Raise the little dust that two feet raise."""
        count = int(8 + 14 * min(strength, 1.0))
        side = self._rng.choice((-1.0, 1.0), count)
        start = np.stack([x + side * self._rng.uniform(0.7, 1.1, count), np.full(count, ground + 0.04)], 1)
        speed = np.stack([side * self._rng.uniform(0.3, 1.8, count), self._rng.uniform(0.1, 0.8, count)], 1)
        self._add(Kind.DUST, start, speed, self._rng.uniform(0.5, 1.2, count), self._rng.uniform(0.06, 0.14, count))

    def burst(self, position: npt.NDArray[np.float64], velocity: npt.NDArray[np.float64], share: float = 1.0) -> None:
        """Break something: sparks, fragments and a ring of dust, or a share of them."""
        for kind, most, speed, life, size in (
            (Kind.SPARK, 46, 6.5, (0.4, 1.6), (0.03, 0.07)),
            (Kind.SHARD, 20, 4.2, (1.6, 3.4), (0.10, 0.26)),
            (Kind.DUST, 46, 3.4, (0.7, 1.8), (0.14, 0.40)),
        ):
            count = math.ceil(share * most)
            turn = self._rng.uniform(0.05 * np.pi, 0.95 * np.pi, count)
            fast = speed * self._rng.uniform(0.15, 1.0, count)
            push = np.stack([np.cos(turn), np.sin(turn)], 1) * fast[:, None] + 0.35 * velocity * (1, -0.4)
            start = position + self._rng.uniform(-0.5, 0.5, (count, 2)) * (1.0, 0.7)
            self._add(kind, start, push, self._rng.uniform(*life, count), self._rng.uniform(*size, count))

    def draw(self, surface: pygame.Surface, view: View, alpha: float) -> None:
        """Draw what lives, between the last two steps."""
        live = np.flatnonzero(self._age < self._life)
        if not len(live):
            return
        place = view.pixels(self._before[live] + alpha * (self._position[live] - self._before[live]))
        left = np.clip(1 - self._age[live] / self._life[live], 0, 1)
        radius = self._size[live] * view.pixels_per_metre
        plain: list[tuple[pygame.Surface, tuple[int, int]]] = []
        added: list[tuple[pygame.Surface, tuple[int, int]]] = []
        for (x, y), kind, share, r, look, age in zip(
            place.tolist(), self._kind[live].tolist(), left.tolist(), radius.tolist(),
            self._look[live].tolist(), self._age[live].tolist(), strict=True,
        ):  # fmt: skip
            if kind == Kind.SPARK:
                sprite = _spark(max(2, round(r * 3)), math.ceil(share * _LEVELS))
            elif kind == Kind.SHARD:
                sprite = _shard(
                    max(2, round(r)), look, int(age * (3 + look % 5) * 4) % 16, min(4, math.ceil(share * 8))
                )
            else:
                sprite = _puff(max(2, round(r)), math.ceil(share * _LEVELS))
            corner = (round(x) - sprite.get_width() // 2, round(y) - sprite.get_height() // 2)
            (added if kind == Kind.SPARK else plain).append((sprite, corner))
        surface.fblits(plain)
        surface.fblits(added, pygame.BLEND_RGB_ADD)

    def _add(
        self,
        kind: Kind,
        position: npt.NDArray[np.float64],
        velocity: npt.NDArray[np.float64],
        life: npt.NDArray[np.float64],
        size: npt.NDArray[np.float64],
    ) -> None:
        slots = (self._next + np.arange(len(position))) % len(self._age)
        self._next = int(slots[-1] + 1) % len(self._age)
        self._position[slots] = self._before[slots] = position
        self._velocity[slots], self._life[slots], self._size[slots] = velocity, life, size
        self._age[slots], self._kind[slots] = 0.0, kind
        self._look[slots] = self._rng.integers(0, 1000, len(slots))


@lru_cache(maxsize=512)
def _puff(radius: int, level: int) -> pygame.Surface:
    axis = np.arange(-radius, radius + 1) / radius
    away = np.hypot(axis[:, None], axis[None, :])
    cover = np.clip(1 - away, 0, 1) ** 1.5 * 82 * (level / _LEVELS) ** 1.4
    surface = pygame.Surface((2 * radius + 1, 2 * radius + 1), pygame.SRCALPHA)
    surface.fill((*_DUST, 0))
    pygame.surfarray.pixels_alpha(surface)[:] = cover.astype(np.uint8)
    return surface


@lru_cache(maxsize=256)
def _spark(radius: int, level: int) -> pygame.Surface:
    axis = np.arange(-radius, radius + 1) / radius
    away = np.hypot(axis[:, None], axis[None, :])[..., None]
    strength = level / _LEVELS
    glow = np.exp(-((away / 0.24) ** 2)) * 255 * strength
    halo = np.clip(1 - away, 0, 1) ** 2 * 0.6 * strength * np.array(_SPARK)
    return pygame.surfarray.make_surface(np.minimum(glow * np.array((1.0, 0.86, 0.62)) + halo, 255).astype(np.uint8))


@lru_cache(maxsize=512)
def _shard(radius: int, look: int, turn: int, level: int) -> pygame.Surface:
    """Return one of a few bits of foil and frame, tumbling in sixteenths of a turn."""
    shape = look % 7
    side = 2 * radius + 3
    sheet = pygame.Surface((side * 4, side * 4), pygame.SRCALPHA)
    colour = _SHARDS[shape % len(_SHARDS)]
    sheet.fill((*colour, 0))
    corners = []
    for corner in range(3 + shape % 2):
        angle = math.tau * (corner / (3 + shape % 2) + turn / 16) + 0.5 * math.sin(shape * 3.1 + corner)
        reach = 4 * radius * (0.45 + 0.5 * abs(math.sin(shape * 1.7 + 2.3 * corner)))
        corners.append((side * 2 + reach * math.cos(angle), side * 2 + reach * math.sin(angle) * 0.8))
    pygame.draw.polygon(sheet, colour, corners)
    surface = pygame.transform.smoothscale(sheet, (side, side))
    surface.set_alpha(round(255 * level / 4))
    return surface
