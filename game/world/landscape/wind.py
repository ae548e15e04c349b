"""Visible wind: drifting dust whose speed follows the wind's push."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

import numpy as np
import pygame

from ai.environment import Doubles
from ai.lander.environment import LanderEnv, Outcome
from game.core.clock import STEP
from game.drawing.tokens import Colour
from game.world.camera import View

_COUNT: Final = 130
_WIDTH, _LOW, _HIGH = 92.0, 1.3, 24.0  # metres: width, more than any view's, and the heights between which dust drifts
_CARRY: Final = 16.0  # m/s of the air for every m/s² that it pushes a craft
_TRAIL: Final = 0.2  # seconds of movement that a grain's trail covers
_STEPS: Final = 4  # points: lengths of trails are multiples of it, so that few pictures are made


class Wind:
    """Drifting dust in the wind of a flight; a function of time alone, so any moment can be shown."""

    def __init__(self, env: LanderEnv, dust: Colour) -> None:
        self._env, self._dust = env, dust
        chance = np.random.default_rng(0)
        self._start = chance.uniform((0.0, _LOW), (_WIDTH, _HIGH), (_COUNT, 2))
        self._near = chance.uniform(0.35, 1.0, _COUNT)  # what is nearer passes faster
        self.forget()

    def forget(self) -> None:
        """Jump to the flight's current moment."""
        self._time = float(self._env.time[0])

    def follow(self) -> None:
        """Advance by one step; after the end of the flight, the wind goes on."""
        flying = self._env.outcome[0] == Outcome.FLYING
        self._time = float(self._env.time[0]) if flying else self._time + STEP

    @property
    def speed(self) -> float:
        """Speed of the air to the right, in m/s, which is also that of the nearest dust."""
        return self._of_air(self._env.conditions.push(np.array([self._time])))

    def _of_air(self, given: Doubles) -> float:
        """Convert the wind's force (1,) in N to the air's speed in m/s, or its impulse in N s to the air's way in m."""
        return _CARRY / self._env.params.mass * float(given[0])

    def draw(self, surface: pygame.Surface, view: View, alpha: float) -> None:
        """Draw the dust, `alpha` of the way from the last step to this one."""
        conditions, time = self._env.conditions, np.array([self._time + (alpha - 1) * STEP])
        gone, speed = (self._near * self._of_air(given) for given in (conditions.impulse(time), conditions.push(time)))
        place = self._start.copy()
        place[:, 0] = (place[:, 0] + gone) % _WIDTH - _WIDTH / 2
        length = np.abs(speed) * _TRAIL * view.pixels_per_metre / view.scale
        trails = []
        for (x, y), points, near in zip(view.pixels(place).tolist(), length.tolist(), self._near.tolist(), strict=True):
            trail = _trail(max(1, round(points / _STEPS)), view.scale, self._dust, round(3 * near))
            trails.append((trail, (round(x - trail.get_width() / 2), round(y))))
        surface.fblits(trails)


@lru_cache(maxsize=256)
def _trail(length: int, scale: float, colour: Colour, near: int) -> pygame.Surface:
    """Return a grain's trail, `length` in steps of points, faint at both ends."""
    across, thick = max(2, round(length * _STEPS * scale)), max(1, round(scale))
    cover = 38 * (1 + near) * np.sin(np.linspace(0, np.pi, across + 2)[1:-1])
    surface = pygame.Surface((across, thick), pygame.SRCALPHA)
    surface.fill((*colour, 0))
    pygame.surfarray.pixels_alpha(surface)[:] = cover.astype(np.uint8)[:, None]
    return surface
