"""Moments of flights by clumsy hands, and whether a network that takes the stick there still lands."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.common.environment import Bools, Doubles, Floats, Ints
from ai.copilot.hands import any_hands
from ai.lander.environment import LIMITS, NUM_ACTIONS, PARAMS, LanderEnv, Outcome
from ai.lander.ground import Ground, Pad, hilly
from ai.lander.pilots import Pilot

SPAWN: Final = "wide"  # starts a little beyond those that are flown
_SLOTS: Final = 2048  # landers that the network flies at once
# A lander that stands still on both feet for so many steps would stand for half a second, too.
_RESTED: Final = replace(LIMITS, rest_steps=8)
_DECISION: Final = 4  # physics steps

Share = Callable[[LanderEnv, Ints], Ints]  # actions to fly, given what the hands ask for


@dataclass
class Moments:
    """Moments in flight, m of them: where a lander was, what was asked for, and later what came of it."""

    ground: Ground
    target: Ints  # (m,) pad
    start: Doubles  # (m, 6) as `LanderEnv.place` takes it
    steps: Ints  # (m,) flown until then
    observation: Floats  # (m, 9)
    surroundings: Floats  # (m, k)
    action: Ints  # (m,) asked for
    flight: Ints  # (m,) number of the flight

    def __len__(self) -> int:
        return len(self.action)

    def take(self, rows: Ints | Bools) -> Moments:
        """Return some of the moments."""
        return Moments(self.ground, *(part[rows] for part in list(vars(self).values())[1:]))


def flown(env: LanderEnv, hands: Pilot, share: Share | None = None) -> Moments:
    """Fly every slot of a fresh `env` with `hands` to its end; return every moment before the first touch.

    `share` turns what the hands ask for into what is flown; by default, that is the same.
    """
    parts: list[tuple[Doubles, ...]] = []
    whole = np.arange(env.num_envs)
    while (flying := env.outcome == Outcome.FLYING).any():
        observation, surroundings, steps = env.observe(), env.surroundings(), env.steps.copy()
        start = np.column_stack([env.position, env.velocity, env.angle, env.angular_velocity])
        asked = hands.act(observation, held=env.actions)
        env.fly(asked if share is None else share(env, asked))
        kept = flying & (env.impact[:, 0] == 0)
        parts.append(
            tuple(part[kept] for part in (env.target, start, steps, observation, surroundings, asked, whole))
        )
    return Moments(env.ground, *(np.concatenate(part) for part in zip(*parts, strict=True)))


def saved(agent: DeepQAgent, moments: Moments, action: Ints) -> Bools:
    """Return whether the agent lands, (m,), after `action` (m,) has been flown for one decision at each moment.

    Landers that have ended give their slots to the next, so that few fly beside many that lie.
    """
    count = len(moments)
    slots = min(_SLOTS, count)
    landed: Bools = np.zeros(count, dtype=bool)
    env = LanderEnv(slots, 0, ground=moments.ground, limits=_RESTED)
    row, following = np.arange(slots), slots  # whose moment each slot flies, and the next one
    _begin(env, np.ones(slots, dtype=bool), moments, row)
    actions, live = action[row], np.ones(slots, dtype=bool)
    while live.any():
        env.fly(actions)
        ended = np.flatnonzero(live & (env.outcome != Outcome.FLYING))
        landed[row[ended]] = env.outcome[ended] == Outcome.LANDED
        begin = ended[: count - following]
        live[ended[len(begin) :]] = False
        row[begin] = np.arange(following, following + len(begin))
        following += len(begin)
        if len(begin):
            _begin(env, np.isin(np.arange(slots), begin), moments, row)
        actions = agent.act(env.observe(), held=env.actions)
        actions[begin] = action[row[begin]]
    return landed


def _begin(env: LanderEnv, mask: Bools, moments: Moments, row: Ints) -> None:
    """Put the landers of `mask` (n,) at the moments of `row` (n,)."""
    env.place(mask, moments.start[row[mask]])
    env.steps[mask] = moments.steps[row[mask]]
    env.target[mask] = moments.target[row[mask]]


def moon(slots: int, rng: np.random.Generator) -> LanderEnv:
    """Return landers on the moon, ready to fly: over a plain with a pad of some width, or among hills."""
    kind = rng.random()
    if kind < 0.3:
        ground = hilly(rng)
    else:
        width = PARAMS.pad_width if kind < 0.7 else float(rng.uniform(3.2, 8.0))
        ground = Ground((Pad(0.0, PARAMS.pad_top, width),))
    env = LanderEnv(slots, rng, SPAWN, ground=ground)
    env.target = rng.integers(len(ground.pads), size=slots)
    env.reset()
    return env
