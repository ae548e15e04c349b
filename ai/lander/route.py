"""Route: how a pilot that knows only pads is led around rock, to a pad that it cannot fly straight to.

A network has learnt one thing: to come down to a pad from above. So on the way it is shown a pad that flies: a little
below it, and moving along the route. Keeping its descent over such a pad, it climbs, crosses and comes down with it.
Over the goal it is shown the goal.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Final

import numpy as np
import numpy.typing as npt

from ai.environment import Bools, Doubles, Floats
from ai.lander.environment import LanderEnv
from ai.lander.pilots import Pilot
from ai.lander.sensing import sensed

_AHEAD: Final = 2.0  # metres along the route from the nearest point of it to the one flown to
_CRUISE: Final = 2.2  # m/s along the route
_SLOW: Final = (0.55, 0.7)  # m/s at the route's end, and more for every metre before it
_BELOW: Final = 3.0  # metres that the flying pad is below the craft
_MEASURED: Final = (40, 40)  # decisions until a pilot's descent is steady, and over which it is measured
_OVER_GOAL: Final = 1.0  # metres before the route's end at which the goal is shown


@lru_cache(maxsize=4)
def sink_of(pilot: Pilot) -> float:
    """Return how fast a pilot comes down, in m/s, over a pad that stays just below it: measured by letting it fly."""
    env = LanderEnv(1, 0, frame_skip=4)
    env.place(np.ones(1, dtype=bool), np.array([[0.0, 20.0, 0.0, 0.0, 0.0, 0.0]]))
    warm_up, measured = _MEASURED
    speeds = []
    for _ in range(warm_up + measured):
        env.glide(pilot.act(_over_flying_pad(env, np.zeros(2)), held=env.actions))
        speeds.append(-float(env.velocity[0, 1]))
    return float(np.mean(speeds[warm_up:]))


def _over_flying_pad(env: LanderEnv, pad_velocity: Doubles) -> Floats:
    """Return the observations (n, 9) of a pad in the air just below each lander, moving at (2,) or (n, 2) m/s."""
    below, nothing = np.tile([0.0, _BELOW], (env.num_envs, 1)), np.zeros((env.num_envs, 2), dtype=bool)
    return sensed(below, env.velocity - pad_velocity, *env.turned, nothing)


class Route:
    """A way through the air, as points (k, 2) in metres, that ends over a pad."""

    def __init__(self, points: npt.ArrayLike) -> None:
        points = np.asarray(points, dtype=float)
        self._from, self._way = points[:-1], np.diff(points, axis=0)
        self._long = np.hypot(*self._way.T)
        self._start = np.concatenate([[0.0], np.cumsum(self._long)])  # metres along the route, of each point

    @property
    def length(self) -> float:
        """Metres from the first point to the last."""
        return float(self._start[-1])

    def point(self, along: npt.ArrayLike) -> Doubles:
        """Return the places (..., 2) so many metres (...) along the route; beyond its ends, the end."""
        along = np.clip(along, 0.0, self.length)
        part = np.minimum(self._start.searchsorted(along, side="right") - 1, len(self._long) - 1)
        share = (along - self._start[part]) / self._long[part]
        place: Doubles = self._from[part] + share[..., None] * self._way[part]
        return place

    def nearest(self, place: Doubles) -> Doubles:
        """Return how many metres along the route its nearest points to places (..., 2) are, (...)."""
        offset = place[..., None, :] - self._from
        share = ((offset * self._way).sum(axis=-1) / self._long**2).clip(0.0, 1.0)
        away = self._from + share[..., None] * self._way - place[..., None, :]
        part = np.hypot(away[..., 0], away[..., 1]).argmin(axis=-1)
        along: Doubles = (
            self._start[part] + np.take_along_axis(share, part[..., None], axis=-1)[..., 0] * self._long[part]
        )
        return along

    def lead(self, place: Doubles) -> tuple[Doubles, Bools]:
        """Return the velocity (..., 2) in m/s that leads from places (..., 2) along the route, and where to the goal.

        There, over the goal, (...), it means nothing.
        """
        along = self.nearest(place)
        left = self.length - along
        over = (left < _OVER_GOAL) & (np.abs(place[..., 0] - self.point(self.length)[0]) < 2 * _OVER_GOAL)
        way = self.point(along + _AHEAD) - place
        slowest, more = _SLOW
        speed = np.minimum(_CRUISE, slowest + more * left)
        wanted: Doubles = (speed / np.maximum(np.hypot(way[..., 0], way[..., 1]), 1e-6))[..., None] * way
        return wanted, over

    def observe(self, env: LanderEnv, pilot: Pilot) -> Floats:
        """Return the observations (n, 9) that a pilot needs: of the goal, or on the way to it of the flying pad."""
        wanted, over = self.lead(env.position)
        goal = env.observe(0)
        if over.all():
            return goal
        sink = sink_of(pilot)  # type: ignore[arg-type]  # one network is one object, whatever it compares equal to
        return np.where(over[:, None], goal, _over_flying_pad(env, wanted + np.array([0.0, sink])))
