"""Particles: dust, sparks, fragments and exhaust glow. Decoration only; the simulation never depends on them."""

from __future__ import annotations

import math
from enum import IntEnum
from functools import lru_cache
from itertools import repeat
from typing import Final

import numpy as np
import pygame

from ai.environment import Bools, Doubles, Ints
from ai.lander.environment import LanderEnv
from game.core.clock import STEP
from game.drawing.paint import mix
from game.drawing.tokens import Colour
from game.flight.foresight import HEIGHT_STEP, REACH, heights
from game.world.camera import View

_LEVELS: Final = 8
_Range = tuple[float, float]


class ParticleKind(IntEnum):
    """Kind of a particle, which decides how it moves, fades, grows and is drawn."""

    DUST = 0  # fine, in clouds that grow
    GRAIN = 1  # coarse, in flat arcs
    SHARD = 2
    SPARK = 3  # this and those that follow shine
    AMBER = 4  # exhaust of a person's engine
    BLUE = 5  # of a network's


DUST: Final[Colour] = (150, 140, 150)  # of the moon
_GLOWS: Final[dict[int, Colour]] = {
    ParticleKind.SPARK: (255, 176, 90),
    ParticleKind.AMBER: (255, 150, 70),
    ParticleKind.BLUE: (96, 160, 255),
}
_SHARDS: Final[tuple[Colour, ...]] = ((214, 158, 74), (190, 198, 214), (92, 98, 118), (168, 112, 48))
# By kind:
_GROWTH: Final = np.array([0.34, 0.0, 0.0, 0.0, 0.30, 0.30])  # metres a second
_WEIGHT: Final = np.array([0.35, 1.0, 1.0, 1.0, 0.0, 0.0])  # share of gravity that pulls
_SAIL: Final = np.array([0.7, 0.3, 0.0, 0.3, 3.0, 3.0])  # share of the wind's speed that is taken on in a second
_BOUNCE: Final = np.array([0.0, 0.1, 0.42, 0.45, 0.0, 0.0])
_GRIP: Final = np.array([0.9, 0.5, 0.7, 0.75, 1.0, 1.0])  # share of the way along the ground that goes on
_SPREAD: Final = np.array([1.0, 1.0, 1.0, 3.0, 3.0, 3.0])  # radius of the sprite, in radii of the particle
_LEAST: Final = np.array([2, 1, 2, 2, 2, 2])  # pixels
_MOST: Final = 64
# By radius, how far apart the radii that have a picture are: a view that zooms would need all of them.
_STEP: Final = np.repeat([1, 2, 4, 8], [5, 12, 16, _MOST - 32])
_FADING: Final = np.array([_LEVELS, _LEVELS, _LEVELS // 2, _LEVELS, _LEVELS, _LEVELS])  # level from which it fades


class Relief:
    """Height map of one environment's ground, with a moving pad at its current place."""

    def __init__(self, env: LanderEnv) -> None:
        self._env = env
        self._heights = np.array(heights(env.ground))

    def height(self, x: Doubles) -> Doubles:
        """Return the height in metres of the ground or pad under x (k,); x is rounded to 2 cm."""
        if self._env.conditions.moves:  # such a world has one pad on a plain, and nothing else
            x = x - float(self._env.pad_shift[0])
        places = np.rint((x + REACH) / HEIGHT_STEP).astype(np.intp)
        heights: Doubles = self._heights[places.clip(0, len(self._heights) - 1)]
        return heights

    def deck(self, x: float) -> tuple[float, float] | None:
        """Return the edges of the pad under x, or None where there is none."""
        shift = float(self._env.pad_shift[0])
        under = [pad for pad in self._env.ground.pads if pad.left <= x - shift <= pad.right]
        return (under[0].left + shift, under[0].right + shift) if under else None


class Particles:
    """Pool of a fixed number of particles; when all slots are in use, the oldest are replaced.

    The ground, `gravity` in m/s² and the colour of its dust are those of the flight; gravity may change, and so may
    `wind`, the speed of the air to the right in m/s.

    Attributes:
        position: (slots, 2), metres.
        velocity: (slots, 2), m/s.
        kind: (slots,), each a `ParticleKind`; all three only hold where `alive`.

    """

    def __init__(
        self, rng: np.random.Generator, relief: Relief, gravity: float, dust: Colour = DUST, slots: int = 640
    ) -> None:
        self._rng, self._relief, self.gravity, self._dust = rng, relief, gravity, dust
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

    def update(self) -> None:
        """Advance by one step of 1/60 s."""
        live = np.flatnonzero(self.alive)
        if not len(live):
            return
        kind = self.kind[live]
        before, velocity = self.position[live], self.velocity[live]
        velocity[:, 0] += _SAIL[kind] * self.wind * STEP
        velocity[:, 1] -= _WEIGHT[kind] * self.gravity * STEP
        position = before + velocity * STEP
        self._bounce(position, velocity, kind)
        self._before[live], self.position[live], self.velocity[live] = before, position, velocity
        self._age[live] += STEP
        self._size[live] += _GROWTH[kind] * STEP

    def _bounce(self, position: Doubles, velocity: Doubles, kind: Ints) -> None:
        """Bounce particles that have entered the ground; exhaust spreads along it instead."""
        x = position[:, 0]
        floor = self._relief.height(x)
        low = np.flatnonzero(position[:, 1] < floor)
        if not len(low):
            return
        slope = (self._relief.height(x[low] + 0.15) - self._relief.height(x[low] - 0.15)) / 0.3
        slope[np.abs(slope) > 1.5] = 0.0  # the edge of a pad
        normal = np.stack([-slope, np.ones(len(low))], 1) / np.sqrt(1 + slope**2)[:, None]
        into = (velocity[low] * normal).sum(axis=1)
        along = velocity[low] - into[:, None] * normal
        gas = kind[low] >= ParticleKind.AMBER
        spread = 0.75 * np.abs(into) * np.where(self._rng.random(len(low)) < 0.5, -1.0, 1.0) * gas
        away = _GRIP[kind[low]][:, None] * along - (_BOUNCE[kind[low]] * np.minimum(into, 0))[:, None] * normal
        velocity[low] = away + spread[:, None] * np.stack([normal[:, 1], -normal[:, 0]], 1)
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
            self._emit(kind, start, push, (0.14, 0.34), (0.03, 0.07))

    def blow(self, x: float, strength: float) -> None:
        """Blow dust outwards along the ground from where a jet meets it; `strength` 0 to 1.

        A pad's deck is swept clean: there the jet raises dust beyond both edges.
        """
        edges = self._relief.deck(x)
        count, grains = self._rng.poisson((3.4 * strength, 2.4 * strength))
        if edges:
            away = min(abs(x - edges[0]), abs(x - edges[1]))
            strength *= max(0.25, 1 - 0.2 * away)
            count, grains = round(0.6 * count), round(0.5 * grains)
        for kind, number, fast, steep, life, size in (
            (ParticleKind.DUST, count, (1.6, 6.5), 0.14, (0.5, 1.4), (0.08, 0.24)),
            (ParticleKind.GRAIN, grains, (4.0, 11.0), 0.20, (0.4, 1.0), (0.010, 0.024)),
        ):
            side = self._rng.choice((-1.0, 1.0), number)
            reach = self._rng.uniform(0.1, 0.8, number)
            start = np.where(side < 0, edges[0] - reach, edges[1] + reach) if edges else x + side * reach
            speed = self._rng.uniform(*fast, number) * (0.4 + 0.6 * strength)
            rise = speed * steep * self._rng.uniform(0.2, 1.0, number)
            place = np.stack([start, self._relief.height(start) + 0.05], 1)
            self._emit(kind, place, np.stack([side * speed, rise], 1), life, size)

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
            self._emit(kind, start, speed, life, size)

    def burst(self, position: Doubles, velocity: Doubles, share: float = 1.0) -> None:
        """Emit the debris of a crash: sparks, fragments and a ring of dust, or a share of them."""
        for kind, most, speed, life, size in (
            (ParticleKind.SPARK, 52, 6.5, (0.4, 1.6), (0.02, 0.06)),
            (ParticleKind.SHARD, 22, 4.2, (2.2, 4.5), (0.06, 0.20)),
            (ParticleKind.DUST, 46, 3.4, (0.7, 1.8), (0.14, 0.40)),
            (ParticleKind.GRAIN, 40, 7.0, (0.6, 1.8), (0.012, 0.03)),
        ):
            count = math.ceil(share * most)
            turn = self._rng.uniform(0.05 * np.pi, 0.95 * np.pi, count)
            fast = speed * self._rng.uniform(0.15, 1.0, count)
            push = np.stack([np.cos(turn), np.sin(turn)], 1) * fast[:, None] + 0.35 * velocity * (1, -0.4)
            start = position + self._rng.uniform(-0.5, 0.5, (count, 2)) * (1.0, 0.7)
            self._emit(kind, start, push, life, size)

    def _emit(self, kind: ParticleKind, position: Doubles, velocity: Doubles, life: _Range, size: _Range) -> None:
        count = len(position)
        self.add(kind, position, velocity, self._rng.uniform(*life, count), self._rng.uniform(*size, count))

    def draw(self, surface: pygame.Surface, view: View, alpha: float) -> None:
        """Draw the particles, `alpha` of the way from the last step to this one."""
        live = np.flatnonzero(self.alive)
        if not len(live):
            return
        kind, look, age = self.kind[live], self._look[live], self._age[live]
        place = view.pixels(self._before[live] + alpha * (self.position[live] - self._before[live]))
        level = np.ceil(_LEVELS * (1 - age / self._life[live])).astype(np.intp)
        radius = np.rint(self._size[live] * view.pixels_per_metre * _SPREAD[kind]).astype(np.intp)
        radius = radius.clip(_LEAST[kind], _MOST)
        step = _STEP[radius]
        radius = (radius + step // 2) // step * step
        level = np.minimum(level, _FADING[kind])
        corner = np.rint(place).astype(np.intp) - radius[:, None]
        turned = (look % 7) * 16 + (age * (3 + look % 5) * 4).astype(np.intp) % 16
        turn = np.where(kind == ParticleKind.SHARD, turned, 0)
        sprites = map(_sprite, kind.tolist(), radius.tolist(), level.tolist(), turn.tolist(), repeat(self._dust))
        drawn = list(zip(sprites, corner.tolist(), strict=True))
        shines = (kind >= ParticleKind.SPARK).tolist()
        surface.fblits([pair for pair, shining in zip(drawn, shines, strict=True) if not shining])
        surface.fblits([pair for pair, shining in zip(drawn, shines, strict=True) if shining], pygame.BLEND_RGB_ADD)

    def add(self, kind: ParticleKind, position: Doubles, velocity: Doubles, life: Doubles, size: Doubles) -> None:
        """Add particles (count, 2) that live for `life` seconds (count,), with radii of `size` metres (count,)."""
        if not len(position):
            return
        slots = (self._next + np.arange(len(position))) % len(self._age)
        self._next = int(slots[-1] + 1) % len(self._age)
        self.position[slots] = self._before[slots] = position
        self.velocity[slots], self._life[slots], self._size[slots] = velocity, life, size
        self._age[slots], self.kind[slots] = 0.0, kind
        self._look[slots] = self._rng.integers(0, 1000, len(slots))


@lru_cache(maxsize=2048)
def _sprite(kind: int, radius: int, level: int, turn: int, dust: Colour) -> pygame.Surface:
    """Return a particle's picture, `radius` pixels to every side of its middle pixel; `level` is in 1/8."""
    if kind == ParticleKind.DUST:
        return _puff(radius, level, dust)
    if kind == ParticleKind.GRAIN:
        return _grain(radius, level, dust)
    if kind == ParticleKind.SHARD:
        return _shard(radius, turn // 16, turn % 16, level)
    return _glow(kind, radius, level)


def _puff(radius: int, level: int, colour: Colour) -> pygame.Surface:
    if level < _LEVELS:
        surface = _sprite(ParticleKind.DUST, radius, _LEVELS, 0, colour).copy()
        surface.fill((255, 255, 255, round(255 * (level / _LEVELS) ** 1.4)), special_flags=pygame.BLEND_RGBA_MULT)
        return surface
    axis = np.arange(-radius, radius + 1) / radius
    away = np.hypot(axis[:, None], axis[None, :])
    cover = np.clip(1 - away, 0, 1) ** 1.5 * 82
    surface = pygame.Surface((2 * radius + 1, 2 * radius + 1), pygame.SRCALPHA)
    surface.fill((*colour, 0))
    pygame.surfarray.pixels_alpha(surface)[:] = cover.astype(np.uint8)
    return surface


def _grain(radius: int, level: int, colour: Colour) -> pygame.Surface:
    axis = np.arange(-radius, radius + 1)
    cover = np.clip(radius + 0.2 - np.hypot(axis[:, None], axis[None, :]), 0, 1) * 170 * level / _LEVELS
    surface = pygame.Surface(cover.shape, pygame.SRCALPHA)
    surface.fill((*mix(colour, (255, 246, 236), 0.34), 0))
    pygame.surfarray.pixels_alpha(surface)[:] = cover.astype(np.uint8)
    return surface


def _glow(kind: int, radius: int, level: int) -> pygame.Surface:
    """Return a spark, small and hot, or a whiff of glowing gas, large and faint; to be added."""
    if kind != ParticleKind.SPARK and level < _LEVELS:
        surface = _sprite(kind, radius, _LEVELS, 0, DUST).copy()
        surface.fill([round(255 * level / _LEVELS)] * 3, special_flags=pygame.BLEND_RGB_MULT)
        return surface
    axis = np.arange(-radius, radius + 1) / radius
    away = np.hypot(axis[:, None], axis[None, :])[..., None]
    strength, colour = level / _LEVELS, np.array(_GLOWS[kind])
    heart, halo = (1.0, 0.6) if kind == ParticleKind.SPARK else (0.10, 0.24)
    hot = 0.35 * colour + 0.65 * 255
    picture = heart * np.exp(-((away / 0.24) ** 2)) * hot + halo * np.clip(1 - away, 0, 1) ** 2 * colour
    return pygame.surfarray.make_surface(np.minimum(strength * picture, 255).astype(np.uint8))


def _shard(radius: int, shape: int, turn: int, level: int) -> pygame.Surface:
    """Return one of seven fragments of foil and frame, turned in sixteenths of a full turn."""
    if 2 * level < _LEVELS:
        surface = _sprite(ParticleKind.SHARD, radius, _LEVELS // 2, 16 * shape + turn, DUST).copy()
        surface.set_alpha(round(2 * 255 * level / _LEVELS))
        return surface
    side = 2 * radius + 1
    sheet = pygame.Surface((side * 4, side * 4), pygame.SRCALPHA)
    colour = _SHARDS[shape % len(_SHARDS)]
    sheet.fill((*colour, 0))
    corners = []
    for corner in range(3 + shape % 2):
        angle = math.tau * (corner / (3 + shape % 2) + turn / 16) + 0.5 * math.sin(shape * 3.1 + corner)
        reach = 4 * radius * (0.45 + 0.5 * abs(math.sin(shape * 1.7 + 2.3 * corner)))
        corners.append((side * 2 + reach * math.cos(angle), side * 2 + reach * math.sin(angle) * 0.8))
    pygame.draw.polygon(sheet, colour, corners)
    return pygame.transform.smoothscale(sheet, (side, side))
