"""Landing anywhere: random sites, and landers that each fly at one of their own.

A site is what `LanderEnv.around` describes: gravity, engine, air, wind, fuel, time, and a pad that may be narrow
or move. Sites are drawn from named distributions, as starts are from `ai.lander.spawns`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Final, NamedTuple

import numpy as np

from ai.environment import Bools, Doubles, Floats, Ints
from ai.lander.conditions import Conditions
from ai.lander.environment import LIMITS, NUM_FEATURES, PARAMS, LanderEnv
from ai.lander.ground import Ground, Pad
from ai.lander.rewards import RewardWeights
from ai.lander.sensing import SURROUNDINGS
from ai.lander.spawns import Curriculum

# Width and top of the pads that sites have, metres.
_PADS: Final = ((6.0, 1.6), (4.6, 2.4), (3.6, 1.8), (3.1, 2.1))
_NARROW: Final = (2, 3)
GROUND: Final = Ground(tuple(Pad(0.0, top, width) for width, top in _PADS), in_turn=True)


class Site(NamedTuple):
    """Site of one flight, in SI units; the defaults are the calm moon."""

    gravity: float = PARAMS.gravity
    thrust: float = PARAMS.main_thrust
    air: float = PARAMS.quadratic_drag
    touch_speed: float = LIMITS.touch_speed
    slide_speed: float = LIMITS.slide_speed
    time: float = LIMITS.time
    wind: float = 0.0
    gust: float = 0.0
    gust_period: float = 5.0
    tank: float = math.inf
    dead: float = math.inf
    back: float = math.inf
    swing: float = 0.0
    swing_period: float = 14.0
    pad: int = 0  # of `GROUND`


def _side(rng: np.random.Generator) -> float:
    return 1.0 if rng.random() < 0.5 else -1.0


def _any(rng: np.random.Generator) -> Site:
    """Draw a site of any gravity, and each of the other conditions for some of them."""
    gravity = PARAMS.gravity if rng.random() < 0.25 else math.exp(rng.uniform(math.log(0.8), math.log(11.0)))
    spare = rng.uniform(1.45, 3.4)  # thrust as a multiple of weight
    light = min(1.0, gravity / PARAMS.gravity)
    changes: dict[str, Any] = {}
    if rng.random() < 0.5:
        changes["air"] = math.exp(rng.uniform(math.log(0.005), math.log(0.25)))
    if rng.random() < 0.5:
        changes["touch_speed"] = changes["slide_speed"] = rng.uniform(1.7, 3.2)
    if rng.random() < 0.25:
        changes["time"] = rng.uniform(10.0, 22.0)
    if rng.random() < 0.5:
        wind, gust, period = light * rng.uniform(-0.4, 0.4), light * rng.uniform(0.0, 0.4), rng.uniform(3.0, 8.0)
        changes |= {"wind": wind, "gust": gust, "gust_period": period}
    if rng.random() < 0.25:
        changes["tank"] = rng.uniform(1.0, 2.2) * 7.0 / spare
    if rng.random() < 0.2:
        dead = rng.uniform(0.0, 5.0)
        changes |= {"dead": dead, "back": dead + rng.uniform(0.3, 2.5) / math.sqrt(max(1.0, gravity / 1.62))}
    if rng.random() < 0.4:
        changes |= {"swing": _side(rng) * rng.uniform(0.5, 4.5), "swing_period": rng.uniform(12.0, 20.0)}
    pad = int(rng.integers(len(_PADS)))
    return Site(gravity, spare * gravity, pad=pad)._replace(**changes)


def _earth(rng: np.random.Generator) -> Site:
    air, speed = rng.uniform(0.04, 0.08), rng.uniform(2.8, 3.0)
    return Site(9.81, rng.uniform(15.6, 16.4), air, speed, speed)


def _outage(rng: np.random.Generator) -> Site:
    dead = rng.uniform(0.5, 4.0)
    return Site(dead=dead, back=dead + rng.uniform(0.5, 2.6))


SITES: Final[dict[str, Callable[[np.random.Generator], Site]]] = {
    "moon": lambda rng: Site(),  # noqa: ARG005
    "mars": lambda rng: Site(3.71, 8.0, wind=rng.uniform(-0.15, 0.15), gust=rng.uniform(0.0, 0.25)),
    "earth": _earth,
    "wind": lambda rng: Site(
        wind=rng.uniform(-0.4, 0.4), gust=rng.uniform(0.0, 0.4), gust_period=rng.uniform(4.0, 7.0)
    ),
    "narrow": lambda rng: Site(pad=int(rng.choice(_NARROW))),
    "moving": lambda rng: Site(swing=_side(rng) * rng.uniform(1.0, 4.2), swing_period=rng.uniform(13.0, 20.0)),
    "tank": lambda rng: Site(tank=rng.uniform(2.8, 4.5)),
    "outage": _outage,
    "any": _any,
}
# As often as named: what asks for foresight, fuel and a dead engine, is the hardest to learn.
TRAINED: Final = (*SITES, "tank", "tank", "outage", "outage", *["any"] * 5)


class AnywhereEnv(LanderEnv):
    """LanderEnv in which every flight is at a site of its own, and observations, (n, 9 + k), tell of it.

    `reset` draws sites from distributions with names in `sites`, as often as they are named; `set_sites` sets them.

    Attributes:
        kind: the number in `sites` of the distribution that each slot's site was drawn from, (n,).
        settled: numbers of every slot's Site, (n, k).

    """

    num_features = NUM_FEATURES + len(SURROUNDINGS)
    wide = True
    kept = (*LanderEnv.kept, "kind", "settled")

    def __init__(
        self,
        num_envs: int = 1,
        seed: int | np.random.Generator | None = None,
        spawn: str | Curriculum = "random",
        frame_skip: int = 4,
        *,
        sites: Sequence[str] = TRAINED,
        weights: RewardWeights | None = None,
    ) -> None:
        unknown = [name for name in sites if name not in SITES]
        if unknown or not sites:
            raise ValueError(f"sites are some of {', '.join(SITES)}, not {', '.join(unknown) or 'none'}")
        super().__init__(num_envs, seed, spawn, frame_skip, ground=GROUND, weights=weights)
        self.sites = tuple(sites)
        self.kind: Ints = np.zeros(num_envs, dtype=np.intp)
        self.settled: Doubles = np.tile(np.array(Site()), (num_envs, 1))
        drag = np.tile(self.world.params.quadratic_drag, (num_envs, 1, 1))
        self.world.params = replace(self.world.params, quadratic_drag=drag)
        self._air: Doubles = self.world.params.quadratic_drag[:, self.lander.index]  # (n, 3), a view
        self.set_sites(self.settled)

    def reset(self, mask: Bools | None = None) -> Floats:
        """Begin a new flight at a new site in the slots of `mask` (n,), or in all; return every slot's observation."""
        begun = np.ones(self.num_envs, dtype=bool) if mask is None else np.asarray(mask, dtype=bool)
        for slot in np.flatnonzero(begun):
            rng = self.streams[slot]
            self.kind[slot] = rng.integers(len(self.sites))
            self.settled[slot] = SITES[self.sites[self.kind[slot]]](rng)
        self.set_sites(self.settled)
        return super().reset(mask)

    def set_sites(self, sites: Sequence[Site] | Doubles) -> None:
        """Let every slot be at a given site from now on, until the next reset."""
        self.settled[:] = sites
        site = Site(*self.settled.T.copy())
        self.world.gravity = np.stack([np.zeros(self.num_envs), -site.gravity], axis=1)
        self._air[:, :2] = np.array(site.air)[:, None]
        self.params = replace(PARAMS, main_thrust=site.thrust, quadratic_drag=site.air)
        self.limits = replace(LIMITS, touch_speed=site.touch_speed, slide_speed=site.slide_speed, time=site.time)
        wind, outage = (site.wind, site.gust, site.gust_period), (site.dead, site.back)
        self.conditions = Conditions(*wind, site.tank, outage, site.swing, site.swing_period)
        self.target = np.array(site.pad, dtype=np.intp)
        self.world.state.active[:, self.pad_bodies] = self.target[:, None] == np.arange(len(_PADS))
