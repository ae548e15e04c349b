"""Particles: dust, sparks, fragments and exhaust glow. Decoration only; the simulation never depends on them."""

from __future__ import annotations

import math
from enum import IntEnum
from functools import lru_cache
from typing import Final

import numpy as np
import pygame

from ai.environment import Bools, Doubles, Ints
from ai.lander.environment import LanderEnv
from game.core.clock import STEP
from game.drawing.paint import light
from game.drawing.tokens import Colour
from game.flight.foresight import HEIGHT_STEP, REACH, heights
from game.world.camera import View

_LEVELS: Final = 8
_Range = tuple[float, float]


class ParticleKind(IntEnum):
    """Kind of a particle, which decides how it moves, fades, grows and is drawn."""

    DUST = 0  # in clouds that grow
    SHARD = 1
    SPARK = 2  # this and those that follow shine
    AMBER = 3  # exhaust of a person's engine
    BLUE = 4  # of a network's


DUST: Final[Colour] = (150, 140, 150)  # of the moon
_GLOWS: Final[dict[int, Colour]] = {
    ParticleKind.SPARK: (255, 176, 90),
    ParticleKind.AMBER: (255, 150, 70),
    ParticleKind.BLUE: (96, 160, 255),
}
_SHARDS: Final[tuple[Colour, ...]] = ((214, 158, 74), (190, 198, 214), (92, 98, 118), (168, 112, 48))
# By kind:
_GROWTH: Final = np.array([0.34, 0.0, 0.0, 0.30, 0.30])  # metres a second
_WEIGHT: Final = np.array([0.35, 1.0, 1.0, 0.0, 0.0])  # share of gravity that pulls
_SAIL: Final = np.array([0.7, 0.0, 0.3, 3.0, 3.0])  # share of the wind's speed that is taken on in a second
_BOUNCE: Final = np.array([0.0, 0.42, 0.45, 0.0, 0.0])
_GRIP: Final = np.array([0.9, 0.7, 0.75, 1.0, 1.0])  # share of the way along the ground that goes on
_SPREAD: Final = np.array([1.0, 1.0, 3.0, 3.0, 3.0])  # radius of the sprite, in radii of the particle
_LEAST, _MOST = 2, 64  # pixels
# By radius, how far apart the radii that have a picture are: a view that zooms would need all of them.
_STEP: Final = np.repeat([1, 2, 4, 8], [5, 12, 16, _MOST - 32])


class Particles:
    """Pool of a fixed number of particles over the ground of a flight; when all slots are in use, the oldest go.

    Attributes:
        wind: speed of the air to the right, m/s.
        position: (slots, 2), metres.
        velocity: (slots, 2), m/s.
        kind: (slots,), each a `ParticleKind`; all three only hold where `alive`.

    """

    def __init__(self, rng: np.random.Generator, env: LanderEnv, dust: Colour = DUST, slots: int = 640) -> None:
        self._rng, self._env, self._dust = rng, env, dust
        self._heights = np.array(heights(env.ground))
        self.wind = 0.0
        self.position = np.zeros((slots, 2))
        self._before = np.zeros((slots, 2))
        self.velocity = np.zeros((slots, 2))
        self._age = np.full(slots, np.inf)
        self._life = np.ones(slots)
        self._size = np.zeros(slots)
        self.kind = np.zeros(slots, np.intp)
        self._look = np.zeros(slots, np.intp)
        self._next = 0

    @property
    def alive(self) -> Bools:
        """Mask (slots,) of the slots in use."""
        alive: Bools = self._age < self._life
        return alive

    def clear(self) -> None:
        """Remove every particle."""
        self._age[:] = np.inf

    def floor(self, x: Doubles) -> Doubles:
        """Return the height in metres of the ground or pad under x (k,); x is rounded to 2 cm."""
        if self._env.conditions.moves:  # such a world has one pad on a plain, and nothing else
            x = x - float(self._env.pad_shift[0])
        places = np.rint((x + REACH) / HEIGHT_STEP).astype(np.intp)
        floor: Doubles = self._heights[places.clip(0, len(self._heights) - 1)]
        return floor

    def update(self) -> None:
        """Advance by one step of 1/60 s."""
        live = np.flatnonzero(self.alive)
        kind, before, velocity = self.kind[live], self.position[live], self.velocity[live]
        velocity[:, 0] += _SAIL[kind] * self.wind * STEP
        velocity[:, 1] -= _WEIGHT[kind] * self._env.gravity * STEP
        position = before + velocity * STEP
        self._bounce(position, velocity, kind)
        self._before[live], self.position[live], self.velocity[live] = before, position, velocity
        self._age[live] += STEP
        self._size[live] += _GROWTH[kind] * STEP

    def _bounce(self, position: Doubles, velocity: Doubles, kind: Ints) -> None:
        """Bounce particles that have entered the ground; exhaust spreads along it instead."""
        floor = self.floor(position[:, 0])
        low = np.flatnonzero(position[:, 1] < floor)
        kind, into = kind[low], np.minimum(velocity[low, 1], 0.0)
        spread = 0.75 * into * self._rng.choice((-1.0, 1.0), len(low)) * (kind >= ParticleKind.AMBER)
        velocity[low] = np.stack([_GRIP[kind] * velocity[low, 0] + spread, -_BOUNCE[kind] * into], 1)
        position[low, 1] = floor[low]

    def burn(self, nozzle: Doubles, direction: Doubles, carried: Doubles, thrust: float, blue: float) -> None:
        """Emit glowing exhaust from a nozzle along a unit vector; `carried` is the velocity of the craft."""
        count = int(self._rng.poisson(2.4 * thrust))
        if count:
            kind = ParticleKind.BLUE if blue > 0.5 else ParticleKind.AMBER
            aside = np.array([-direction[1], direction[0]])
            speed = self._rng.uniform(6.5, 11.0, (count, 1))
            push = carried + direction * speed + aside * self._rng.normal(0.0, 0.55, (count, 1))
            start = nozzle + direction * self._rng.uniform(0.2, 0.9, (count, 1))
            self.add(kind, start, push, (0.14, 0.34), (0.03, 0.07))

    def blow(self, x: float, strength: float) -> None:
        """Blow dust outwards along the ground from where a jet meets it; `strength` 0 to 1."""
        count = int(self._rng.poisson(4.4 * strength))
        side = self._rng.choice((-1.0, 1.0), count)
        start = x + side * self._rng.uniform(0.1, 0.8, count)
        speed = self._rng.uniform(1.6, 6.5, count) * (0.4 + 0.6 * strength)
        rise = 0.14 * speed * self._rng.uniform(0.2, 1.0, count)
        place = np.stack([start, self.floor(start) + 0.05], 1)
        self.add(ParticleKind.DUST, place, np.stack([side * speed, rise], 1), (0.5, 1.4), (0.08, 0.24))

    def raise_dust(self, foot: tuple[float, float], strength: float) -> None:
        """Raise a foot's dust, and sparks where it comes down hard; `strength` 0 to 1."""
        sparks = int(22 * max(0.0, strength - 0.35))
        for kind, count, fast, rise, life, size in (
            (ParticleKind.DUST, int(4 + 9 * strength), (0.3, 1.8), (0.1, 0.8), (0.5, 1.2), (0.06, 0.14)),
            (ParticleKind.SPARK, sparks, (0.5, 4.5), (0.3, 2.4), (0.25, 0.8), (0.02, 0.045)),
        ):
            side = self._rng.choice((-1.0, 1.0), count)
            start = np.stack([foot[0] + side * self._rng.uniform(0.0, 0.25, count), np.full(count, foot[1] + 0.04)], 1)
            speed = np.stack([side * self._rng.uniform(*fast, count), self._rng.uniform(*rise, count)], 1)
            self.add(kind, start, speed, life, size)

    def burst(self, position: Doubles, velocity: Doubles, share: float = 1.0) -> None:
        """Emit the debris of a crash: sparks, fragments and a ring of dust, or a share of them."""
        for kind, most, speed, life, size in (
            (ParticleKind.SPARK, 52, 6.5, (0.4, 1.6), (0.02, 0.06)),
            (ParticleKind.SHARD, 22, 4.2, (2.2, 4.5), (0.06, 0.20)),
            (ParticleKind.DUST, 46, 3.4, (0.7, 1.8), (0.14, 0.40)),
        ):
            count = math.ceil(share * most)
            turn = self._rng.uniform(0.05 * np.pi, 0.95 * np.pi, count)
            fast = speed * self._rng.uniform(0.15, 1.0, count)
            push = np.stack([np.cos(turn), np.sin(turn)], 1) * fast[:, None] + 0.35 * velocity * (1, -0.4)
            start = position + self._rng.uniform(-0.5, 0.5, (count, 2)) * (1.0, 0.7)
            self.add(kind, start, push, life, size)

    def draw(self, surface: pygame.Surface, view: View, alpha: float) -> None:
        """Draw the particles, `alpha` of the way from the last step to this one."""
        live = np.flatnonzero(self.alive)
        kind, look, age = self.kind[live], self._look[live], self._age[live]
        place = view.pixels(self._before[live] + alpha * (self.position[live] - self._before[live]))
        left = 1 - age / self._life[live]
        radius = np.rint(self._size[live] * view.pixels_per_metre * _SPREAD[kind]).astype(np.intp)
        radius = radius.clip(_LEAST, _MOST)
        step = _STEP[radius]
        radius = (radius + step // 2) // step * step
        level = np.ceil(_LEVELS * left).astype(np.intp)
        corner = np.rint(place).astype(np.intp) - radius[:, None]
        rows = list(zip(kind.tolist(), radius.tolist(), level.tolist(), corner.tolist(), strict=True))
        surface.fblits([(_puff(*row[1:3], self._dust), row[3]) for row in rows if row[0] == ParticleKind.DUST])
        for number in np.flatnonzero(kind == ParticleKind.SHARD).tolist():
            size = float(radius[number]) * min(1.0, 2 * float(left[number]))
            x, y = place[number].tolist()
            _draw_shard(surface, x, y, size, int(look[number]), float(age[number]))
        shining = [(_glow(*row[:3]), row[3]) for row in rows if row[0] >= ParticleKind.SPARK]
        surface.fblits(shining, pygame.BLEND_RGB_ADD)

    def add(self, kind: ParticleKind, position: Doubles, velocity: Doubles, life: _Range, size: _Range) -> None:
        """Add particles (count, 2) that live for `life` seconds, with radii of `size` metres, each from and to."""
        count = len(position)
        slots = (self._next + np.arange(count)) % len(self._age)
        self._next += count
        self.position[slots] = self._before[slots] = position
        self.velocity[slots], self._life[slots] = velocity, self._rng.uniform(*life, count)
        self._size[slots], self._age[slots], self.kind[slots] = self._rng.uniform(*size, count), 0.0, kind
        self._look[slots] = self._rng.integers(0, 1000, count)


@lru_cache(maxsize=512)
def _puff(radius: int, level: int, colour: Colour) -> pygame.Surface:
    """Return a cloud of dust, `radius` pixels to every side of its middle pixel; `level` is in 1/8."""
    axis = np.arange(-radius, radius + 1) / radius
    away = np.hypot(axis[:, None], axis[None, :])
    cover = np.clip(1 - away, 0, 1) ** 1.5 * 82 * (level / _LEVELS) ** 1.4
    surface = pygame.Surface(cover.shape, pygame.SRCALPHA)
    surface.fill((*colour, 0))
    pygame.surfarray.pixels_alpha(surface)[:] = cover.astype(np.uint8)
    return surface


@lru_cache(maxsize=2048)
def _glow(kind: int, radius: int, level: int) -> pygame.Surface:
    """Return a spark, small and hot, or a whiff of glowing gas, large and faint; to be added."""
    axis = np.arange(-radius, radius + 1) / radius
    away = np.hypot(axis[:, None], axis[None, :])[..., None]
    strength, colour = level / _LEVELS, np.array(_GLOWS[kind])
    heart, halo = (1.0, 0.6) if kind == ParticleKind.SPARK else (0.10, 0.24)
    hot = 0.35 * colour + 0.65 * 255
    return light(
        strength * (heart * np.exp(-((away / 0.24) ** 2)) * hot + halo * np.clip(1 - away, 0, 1) ** 2 * colour)
    )


def _draw_shard(surface: pygame.Surface, x: float, y: float, size: float, look: int, age: float) -> None:
    """Draw a tumbling three-cornered fragment of foil or frame."""
    corners = []
    for number, turn in enumerate((0.0, 0.3, 0.65)):
        angle = math.tau * (look / 7 + age * (3 + look % 5) / 4 + turn)
        reach = size * (0.5 + 0.5 * abs(math.sin(look + number)))
        corners.append((x + reach * math.cos(angle), y + 0.8 * reach * math.sin(angle)))
    pygame.draw.polygon(surface, _SHARDS[look % len(_SHARDS)], corners)
