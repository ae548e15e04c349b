"""People of simple tastes bring up networks: what share of 500 random starts their networks then fly as they like.

    python -m benchmarks.taste [NAME ...] [--seeds 5] [--choices 40]

They answer as the game asks: which of two flights from one start they like better, or that they cannot tell, where both
are worth the same to them. `guesses` and `errs` answer nothing of the kind and choose at random then, and `errs` and
`slips` name the wrong one of two in one answer of ten. All see nothing but the flights. No clock decides anything: the
same seed gives the same figures. Seconds are processor time on one thread.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect
os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from ai.environment import Doubles, Ints
from ai.lander.environment import LanderEnv, Outcome
from ai.training.preferences import FIRST, NEITHER, SECOND, SUMS, Paying
from ai.training.tasks import VALIDATION_SEED
from ai.training.upbringing import Flight, Upbringing

TESTED: Final = 500


@dataclass(frozen=True)
class Flown:
    """What a person sees of flights, all (n,)."""

    outcome: Ints
    seconds: Doubles
    x: Doubles  # where they ended, metres to the right of the pad's middle
    turns: Doubles  # the farthest that they turned from how they began
    sums: Doubles  # (n, sums)

    @classmethod
    def of(cls, *flights: Flight) -> "Flown":
        """Return what is seen of flights."""
        outcome = np.array([each.outcome for each in flights])
        seconds = np.array([len(each.actions) / 15 for each in flights])
        x = np.array([float(each.poses[-1, 0]) for each in flights])
        turns = np.array([np.abs(each.poses[:, 2] - each.poses[0, 2]).max() / (2 * np.pi) for each in flights])
        return cls(outcome, seconds, x, turns, np.array([each.sums for each in flights]))

    @property
    def landed(self) -> Any:
        """Whether they landed."""
        return self.outcome == Outcome.LANDED


@dataclass(frozen=True)
class Person:
    """Somebody who brings up a network."""

    worth: Callable[[Flown], Doubles]  # of flights, to them
    liked: Callable[[Flown], Any]  # whether flights are as they like them
    wrong: float = 0.0  # share of their answers
    guesses: bool = False  # rather than say that they cannot tell
    nearly: float = 1e-6  # worth by which they cannot tell two apart

    def answer(self, question: tuple[Flight, Flight], rng: np.random.Generator) -> int:
        """Say which of two is liked better."""
        first, second = self.worth(Flown.of(*question)).tolist()
        if abs(first - second) <= self.nearly:
            return int(rng.integers(2)) if self.guesses else NEITHER
        return FIRST if (first > second) != (rng.random() < self.wrong) else SECOND


def _landed(flown: Flown) -> Any:
    return 1.0 * flown.landed


def _usual(flown: Flown) -> Any:
    """Return about what the usual pay would bring, in hundreds of points."""
    usual = {"nearer": 0.5, "slower": 0.02, "upright": 0.3, "time": -2.4, "landed": 1.2, "crashed": -1.2, "out": -1.2}
    return flown.sums @ [usual.get(name, 0.0) for name in SUMS]


PEOPLE: Final = {
    "lands": Person(_landed, _landed),
    "guesses": Person(_landed, _landed, guesses=True),
    "pay": Person(_usual, _landed, guesses=True),
    "nearly": Person(_usual, _landed, nearly=0.2),
    "slips": Person(_landed, _landed, wrong=0.1),
    "errs": Person(_landed, _landed, wrong=0.1, guesses=True),
    "left": Person(lambda flown: flown.landed * (1 + (flown.x < 0)), lambda flown: flown.landed & (flown.x < 0)),
    "aloft": Person(lambda flown: flown.seconds, lambda flown: flown.outcome == Outcome.TIMED_OUT, nearly=0.3),
    "turns": Person(
        lambda flown: np.minimum(flown.turns, 1.0), lambda flown: flown.turns >= 1.0, nearly=0.02,
    ),
}  # fmt: skip


def tested(upbringing: Upbringing) -> Flown:
    """Return how its network flies without random actions."""
    paying = Paying()
    env = LanderEnv(TESTED, VALIDATION_SEED, "random", upbringing.config.frame_skip, pay=paying)
    observation, held, began = env.reset(), env.actions, env.angle.copy()
    sums, turns = np.zeros((TESTED, len(SUMS))), np.zeros(TESTED)
    pilot = upbringing.best_agent()
    while (env.outcome == Outcome.FLYING).any():
        held = pilot.act(observation, held=held)
        observation = env.step(held).observation
        sums += paying.latest
        turns = np.maximum(turns, np.abs(env.angle - began) / (2 * np.pi))
    return Flown(env.outcome, env.time, env.position[:, 0] - env.pad[:, 0], turns, sums)


def bring_up(person: Person, seed: int, choices: int) -> list[Flown]:
    """Return how a network flies after every tenth choice."""
    upbringing, rng, flown = Upbringing(seed=seed), np.random.default_rng([seed, 2]), []
    for choice in range(1, choices + 1):
        upbringing.answer(person.answer(upbringing.ready(), rng))
        if choice % 10 == 0:
            upbringing.ready()
            flown.append(tested(upbringing))
    return flown


def main() -> None:
    """Print a line for each person and seed, and their means."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("people", nargs="*", metavar="NAME", help=f"of {', '.join(PEOPLE)}")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--choices", type=int, default=40)
    options = parser.parse_args()
    for name in options.people or PEOPLE:
        person, rows = PEOPLE[name], []
        for seed in range(options.seeds):
            began = time.process_time()
            shares = [float(np.mean(person.liked(flown))) for flown in bring_up(person, seed, options.choices)]
            rows.append(shares)
            spent = time.process_time() - began
            print(f"{name:8} seed {seed}: {'  '.join(f'{share:.2f}' for share in shares)}  {spent:.0f} s", flush=True)
        mean, worst = np.mean(rows, axis=0), np.min(rows, axis=0)
        print(f"{name:8} mean:   {'  '.join(f'{share:.2f}' for share in mean)}  worst {worst[-1]:.2f}", flush=True)


if __name__ == "__main__":
    main()
