"""What the co-pilot is worth to good, bad and hostile hands: alone, and with each kind of help.

    python -m benchmarks.copilot [--flights 2] [--dials 0.04 [0.27 1]] [--hands NAME ...] [--pilot FILE]

All hands fly from the same starts, which no network was trained with, over one pad, over three of which one is meant,
and in other worlds; a pilot of your own (`docs/pilots.md`) over one and three. The dials are the guardian's: with 0.04,
0.27 and 1 there must be a landing after 1, 4 and 12 decisions of an action.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any, NamedTuple

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.copilot.copilot import CoPilot, Mode
from ai.copilot.futures import Futures
from ai.environment import Bools, Doubles, Floats, Ints
from ai.lander.anywhere import AnywhereEnv
from ai.lander.environment import NUM_ACTIONS, LanderEnv, Outcome
from ai.lander.ground import hilly
from ai.lander.pilots import COAST, LaggyPilot, NoisyPilot, Pilot, ScriptedPilot
from ai.lander.push import Push
from ai.lander.rules import ACTION_SHARES
from ai.pilots.own import MeasuredPilot
from ai.training.statistics import wilson

MODELS = Path(__file__).parents[1] / "models" / "lander"
STARTS = 0x5AFE7AB1E  # beside the seed, so that no start is one that anything was trained with
SECOND = 15  # decisions
HOLDS_RIGHT = 2


class HeldKeys:
    """Pilot who holds the same keys all the time, or, without an action, others from each second to the next."""

    def __init__(self, action: int | None, slots: int, rng: np.random.Generator) -> None:
        self.action, self.slots, self.rng = action, slots, rng
        self._asked = 0
        self._last: Ints = np.full(slots, action or COAST, dtype=np.intp)

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:  # noqa: ARG002
        """Actions (n,) for observations (n, 9)."""
        if self.action is None and self._asked % SECOND == 0:
            self._last = self.rng.integers(NUM_ACTIONS, size=self.slots)
        self._asked += 1
        return self._last


class PartThrust:
    """Pilot whose main engine never gives more than a share of its thrust, 0 to 1."""

    def __init__(self, pilot: Pilot, most: float) -> None:
        self.act, self.most = pilot.act, most

    def shares(self, action: Ints) -> Doubles:
        """Return the shares of thrust of main engine and jets, (n, 2), that are pushed with actions (n,)."""
        return ACTION_SHARES[action] * (self.most, 1.0)


class Adversary:
    """Pilot who wants to crash: of the actions that pass, one at random."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng = rng

    def act(self, observation: Floats, *, held: Ints | None = None, passes: Any = True) -> Ints:  # noqa: ARG002
        """Actions (n,) for observations (n, features), where those that `passes` (n, 6) are flown; all by default."""
        rank = self.rng.random((len(observation), NUM_ACTIONS))
        passes = np.broadcast_to(passes, rank.shape)
        action: Ints = np.where(passes | ~passes.any(axis=1, keepdims=True), rank, np.inf).argmin(axis=1)
        return action


# Hands by name, made of slots, randomness and a good pilot.
HANDS: dict[str, Callable[[int, np.random.Generator, Pilot], Pilot]] = {
    "good": lambda _slots, _rng, good: good,
    "laggy": lambda _, rng, good: LaggyPilot(good, rng),
    "noisy": lambda _, rng, good: NoisyPilot(good, rng),
    "holds right": lambda slots, rng, _: HeldKeys(HOLDS_RIGHT, slots, rng),
    "a key each second": lambda slots, rng, _: HeldKeys(None, slots, rng),
    "thrust 0.3": lambda *_: PartThrust(ScriptedPilot(), 0.3),
    "adversary": lambda _, rng, __: Adversary(rng),
}


class Help(NamedTuple):
    """One kind of help."""

    name: str
    mode: Mode | None  # None: alone
    assist: float = 0.0
    by_values: bool = False

    @property
    def foresees(self) -> bool:
        """Whether it goes by futures."""
        return self.mode is Mode.GUARDIAN and not self.by_values


def helps(dials: Sequence[float]) -> list[Help]:
    """Return the kinds of help that are compared."""
    guardians = [Help(f"guardian {dial:.2f}", Mode.GUARDIAN, dial) for dial in dials]
    by_values = Help("guardian by values 0.40", Mode.GUARDIAN, 0.4, by_values=True)
    return [Help("alone", None), Help("tolerance 0.40", Mode.TOLERANCE, 0.4), by_values, *guardians]


def _hills(slots: int, rng: np.random.Generator) -> LanderEnv:
    return LanderEnv(slots, rng, ground=hilly(rng))


TABLES: dict[str, tuple[str, Callable[[int, np.random.Generator], LanderEnv]]] = {  # title: network, world
    "One pad": ("modern", LanderEnv),
    "Three pads, one of them meant": ("modern", _hills),
    "In other worlds": ("anywhere", AnywhereEnv),
}


def begun(
    world: Callable[[int, np.random.Generator], LanderEnv], pilots: int, flights: int, seed: int
) -> LanderEnv:  # fmt: skip
    """Return landers at the starts of so many flights for each pilot, all from the same."""
    env = world(pilots * flights, np.random.default_rng([STARTS, seed]))
    for first in range(0, env.num_envs, flights):
        for slot, rng in enumerate(np.random.default_rng([STARTS, seed, 1]).spawn(flights), first):
            env.streams[slot] = rng
    env.reset()
    if env.ground.at_once > 1:
        intended = np.random.default_rng([STARTS, seed, 2]).integers(env.ground.at_once, size=flights)
        env.target = np.tile(intended, pilots)
    return env


def fly(env: LanderEnv, agent: DeepQAgent, pilots: Sequence[Pilot], given: Help) -> tuple[Doubles, Doubles, Bools]:
    """Fly until all have ended, with as many slots for every pilot.

    Returns each flight's overridden decisions, its decisions, and whether a plan was ever held, (n,) each.
    """
    copilot = CoPilot(agent, given.assist, given.mode) if given.mode else None
    overridden, decisions = np.zeros((2, env.num_envs))
    held = np.zeros(env.num_envs, dtype=bool)
    each = env.num_envs // len(pilots)
    hands = [(pilot, slice(number * each, (number + 1) * each)) for number, pilot in enumerate(pilots)]
    while (flying := env.outcome == Outcome.FLYING).any():
        wished, action, shares = env.observe(), env.actions.copy(), env.shares.copy()
        asked: list[Push | None] = [None] * env.num_envs
        for pilot, mine in hands:
            if not flying[mine].any():
                continue
            action[mine] = pilot.act(wished[mine], held=env.actions[mine])
            shares[mine] = getattr(pilot, "shares", ACTION_SHARES.__getitem__)(action[mine])
            if not isinstance(pilot, Adversary):
                asked[mine] = [Push.of(*row) for row in shares[mine].tolist()]
        known = copilot.foresee(env, asked) if copilot and given.foresees else None
        for pilot, mine in hands:
            if known and isinstance(pilot, Adversary):
                action[mine] = pilot.act(wished[mine], passes=Futures(known[mine]).lasts)
                shares[mine] = ACTION_SHARES[action[mine]]
        if copilot:
            seen = env.observe_pads(agent) if env.ground.at_once > 1 else env.observe_for(agent)
            decision = copilot.decide(seen, action, None, shares, env if given.foresees else None, known)
            action, shares = decision.action, decision.shares
            overridden += flying & decision.overridden
            held |= flying & (decision.held if decision.held is not None else False)
        decisions += flying
        env.fly(action, shares)
    return overridden, decisions, held


def table(title: str, hands: dict[str, Pilot | None], given: Sequence[Help], flights: int, seed: int) -> None:
    """Fly all hands with each kind of help, and print what came of it; a pilot of None is made of its name."""
    model, world = TABLES[title]
    agent = DeepQAgent.load(MODELS / model)
    print(f"\n{title}\n")
    print("| hands | help | landed | 95% interval | own pad | crashed | overridden | plan held | held and lost |")
    print("|---|---|---|---|---|---|---|---|---|")
    for help_ in given:
        env = begun(world, len(hands), flights, seed)
        made = [
            pilot or HANDS[name](flights, np.random.default_rng([STARTS, seed, 3]), agent)
            for name, pilot in hands.items()
        ]
        overridden, decisions, held = fly(env, agent, made, help_)
        landed, own = env.outcome == Outcome.LANDED, env.landed_on == env.target
        for number, name in enumerate(hands):
            mine = slice(number * flights, (number + 1) * flights)
            success = float(landed[mine].mean())
            low, high = wilson(success, flights)
            crashed = (env.outcome[mine] == Outcome.CRASHED).mean()
            shares = own[mine].mean(), crashed, overridden[mine].sum() / decisions[mine].sum(), held[mine].mean()
            cells = [
                name,
                help_.name,
                f"{success:.1%}",
                f"{low:.1%} to {high:.1%}",
                *(f"{each:.1%}" for each in shares),
            ]
            print(f"| {' | '.join(cells)} | {int((held & ~landed)[mine].sum())} |", flush=True)


def main() -> None:
    """Measure what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--flights", type=int, default=2, help="of each hands with each help (default: 2)")
    parser.add_argument("--dials", type=float, nargs="*", default=[0.04], help="of the guardian, 0 to 1")
    parser.add_argument("--hands", nargs="*", default=list(HANDS), choices=list(HANDS), metavar="NAME")
    parser.add_argument("--pilot", type=Path, metavar="FILE", help="a pilot of your own in place of these")
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    asked = helps(arguments.dials), arguments.flights, arguments.seed
    if arguments.pilot:
        with closing(MeasuredPilot(arguments.pilot)) as pilot:
            for title in list(TABLES)[:2]:
                table(title, {arguments.pilot.stem[:20]: pilot}, *asked)
    else:
        for title in TABLES:
            table(title, dict.fromkeys(arguments.hands), *asked)


if __name__ == "__main__":
    main()
