"""Moments of flights by clumsy hands, and whether a network that takes the stick there still lands."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from ai.agent.agent import DeepQAgent
from ai.common.environment import Bools, Doubles, Floats, Ints
from ai.lander.anywhere import AnywhereEnv, Site
from ai.lander.environment import LIMITS, PARAMS, LanderEnv, Outcome
from ai.lander.ground import Ground, Pad, hilly
from ai.lander.pilots import Pilot
from engine import DT

SPAWN: Final = "wide"  # starts a little beyond those that are flown
_SLOTS: Final = 2048  # landers that the network flies at once
_TIME: Final = Site._fields.index("time")
_STANDS: Final = 8  # steps of standing still that tell of a landing

Share = Callable[[LanderEnv, Ints], Ints]  # actions to fly, given what the hands ask for


@dataclass
class Moments:
    """Moments in flight, m of them: where a lander was, what was asked for, and later what came of it."""

    env: LanderEnv  # that they are of
    target: Ints  # (m,) pad
    start: Doubles  # (m, 6) as `LanderEnv.place` takes it
    steps: Ints  # (m,) flown until then
    observation: Floats  # (m, 9)
    surroundings: Floats  # (m, k)
    action: Ints  # (m,) asked for
    burnt: Ints  # (m, 2) steps of main engine and jets until then
    site: Doubles  # (m, k) of `AnywhereEnv`; k is 0 on the moon

    def __len__(self) -> int:
        return len(self.action)

    @property
    def longest(self) -> Any:
        """Seconds that a flight may take, for all of them or each, (m,)."""
        return self.site[:, _TIME] if self.site.size else self.env.limits.time

    @property
    def parts(self) -> tuple[NDArray[Any], ...]:
        """All arrays, in the order in which they are named."""
        return tuple(getattr(self, each.name) for each in fields(self)[1:])

    def take(self, rows: Ints | Bools) -> Moments:
        """Return some of the moments."""
        return Moments(self.env, *(part[rows] for part in self.parts))


def present(env: LanderEnv, asked: Ints, which: Bools) -> Moments:
    """Return the present moment of the slots of `which` (n,) of an environment, where `asked` (n,) is asked for."""
    start = np.column_stack([env.position, env.velocity, env.angle, env.angular_velocity])
    seen = LanderEnv.observe(env), env.around(), asked
    burnt = np.column_stack([env.main_steps, env.side_steps])
    site = env.settled if isinstance(env, AnywhereEnv) else np.zeros((env.num_envs, 0))
    parts: tuple[NDArray[Any], ...] = (env.target, start, env.steps, *seen, burnt, site)
    return Moments(env, *(part[which] for part in parts))


def flown(env: LanderEnv, hands: Pilot, share: Share | None = None) -> Moments:
    """Fly every slot of a fresh `env` with `hands` to its end; return every moment.

    `share` turns what the hands ask for into what is flown; by default, that is the same.
    """
    moments = []
    while (flying := env.outcome == Outcome.FLYING).any():
        asked = hands.act(env.observe(), held=env.actions)
        moments.append(present(env, asked, flying))
        env.fly(asked if share is None else share(env, asked))
    return joined(moments)


def joined(moments: Sequence[Moments]) -> Moments:
    """Return moments of the same environment as one."""
    parts = zip(*(some.parts for some in moments), strict=True)
    return Moments(moments[0].env, *(np.concatenate(part) for part in parts))


def saved(agent: DeepQAgent, moments: Moments, action: Ints, decisions: int = 1) -> Bools:
    """Return whether the agent lands, (m,), after `action` (m,) has been flown for some decisions at each moment.

    Landers that have ended give their slots to the next, so that few fly beside many that lie.
    """
    count = len(moments)
    slots = min(_SLOTS, count)
    landed: Bools = np.zeros(count, dtype=bool)
    env = _like(moments.env, slots)
    row, following = np.arange(slots), slots  # whose moment each slot flies, and the next one
    _begin(env, np.ones(slots, dtype=bool), moments, row)
    live = np.ones(slots, dtype=bool)
    waits = np.full(slots, decisions)  # decisions until the agent takes the stick
    while live.any():
        env.fly(np.where(waits > 0, action[row], agent.act(env.observe(), held=env.actions)))
        waits -= 1
        ended = np.flatnonzero(live & (env.outcome != Outcome.FLYING))
        landed[row[ended]] = env.outcome[ended] == Outcome.LANDED
        begin = ended[: count - following]
        live[ended[len(begin) :]] = False
        row[begin] = np.arange(following, following + len(begin))
        following += len(begin)
        if len(begin):
            _begin(env, np.isin(np.arange(slots), begin), moments, row)
            waits[begin] = decisions
    return landed


def _like(env: LanderEnv, slots: int) -> LanderEnv:
    """Return an environment of so many slots where it is as in another."""
    return AnywhereEnv(slots, 0) if isinstance(env, AnywhereEnv) else LanderEnv(slots, 0, ground=env.ground)


def _begin(env: LanderEnv, mask: Bools, moments: Moments, row: Ints) -> None:
    """Put the landers of `mask` (n,) at the moments of `row` (n,)."""
    rows = row[mask]
    if isinstance(env, AnywhereEnv):
        env.settle(moments.site[rows], mask)
    env.place(mask, moments.start[rows])
    env.steps[mask], env.target[mask] = moments.steps[rows], moments.target[rows]
    env.main_steps[mask], env.side_steps[mask] = moments.burnt[rows].T
    # A lander that stands still on both feet for some steps goes on standing: the rest of the time that a landing
    # takes is not flown, but taken off.
    time = (moments.env.limits if not isinstance(env, AnywhereEnv) else env.limits).time
    env.limits = replace(env.limits, rest_steps=_STANDS, time=time - (LIMITS.rest_steps - _STANDS) * DT)


def moon(slots: int, rng: np.random.Generator) -> LanderEnv:
    """Return landers on the moon, ready to fly: over a plain with a pad of some width, or among hills."""
    kind = rng.random()
    if kind < 0.45:
        ground = hilly(rng)
    else:
        width = PARAMS.pad_width if kind < 0.75 else float(rng.uniform(3.2, 8.0))
        ground = Ground((Pad(0.0, PARAMS.pad_top, width),))
    env = LanderEnv(slots, rng, SPAWN, ground=ground)
    env.target = rng.integers(len(ground.pads), size=slots)
    env.reset()
    return env


def anywhere(slots: int, rng: np.random.Generator) -> LanderEnv:
    """Return landers at random sites, ready to fly."""
    env = AnywhereEnv(slots, rng, SPAWN)
    env.reset()
    return env
