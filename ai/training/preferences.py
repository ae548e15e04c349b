"""A person's taste, learned from choices between two flights, and a memory that is paid anew by it.

Christiano et al. 2017 (Deep reinforcement learning from human preferences) fit a deep network to choices between clips
of two seconds, and need hundreds. Here the model is linear in a few sums of a whole flight: some thirty choices are
enough, and the model can be shown whole. `ai.training.upbringing` has what asks and what learns.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from ai.agent.replay import ReplayBuffer, Transition
from ai.environment import Doubles, Floats, Ints
from ai.lander.rewards import Situation
from ai.lander.rules import CRASHED, FLYING, LANDED, OUT
from ai.training.tasks import LANDER_SYMMETRY

# What a flight is judged by: sums over its decisions, scaled so that two flights differ by about one in each.
SUMS: Final[dict[str, Callable[[Situation, Situation], Any]]] = {
    "nearer": lambda before, after: (before.distance - after.distance) / 10,
    "slower": lambda before, after: (before.speed - after.speed) / 4,
    "upright": lambda before, after: after.aligned - before.aligned,
    "time": lambda before, after: (after.steps - before.steps) / 600,
    "left": lambda before, after: (np.clip(before.across, -3, 3) - np.clip(after.across, -3, 3)) / 3,
    "turned": lambda before, after: np.abs(after.tilt - before.tilt) / np.pi,
    "landed": lambda before, after: (before.outcome == FLYING) & (after.outcome == LANDED),
    "crashed": lambda before, after: (before.outcome == FLYING) & (after.outcome == CRASHED),
    "out": lambda before, after: (before.outcome == FLYING) & (after.outcome == OUT),
}
ENDS: Final = ("landed", "crashed", "out")
FIRST, SECOND, NEITHER = range(3)  # answers: which of two flights is liked better; or one cannot tell
_MIRRORED: Final = np.array([1.0 - 2.0 * (name == "left") for name in SUMS], dtype=np.float32)
_POINTS: Final = 200.0  # length of what is paid: a little more than what a landing brings as a rule
_SAMPLES, _BURNT, _APART = 250, 150, 4  # of the taste, left out before them, and steps from one to the next
_LIKING: Final = (2.0, 4.0)  # standard deviation of a weight before anything is known; of those of an end
# Means and standard deviations of what the shares of slips and of ties follow from.
_OTHER: Final = np.array([[-0.8, -2.0], [1.0, 1.5]])
_SLIPS: Final = 0.4  # share of slips at most


class Taste:
    """What a person is believed to like: samples from the posterior of a linear model, given all answers.

    A flight of sums s is worth w·s. Of two that differ by z = w·(s - s'), the first is chosen with the chance
    e^(z/2) / (e^(z/2) + e^(-z/2) + ν), and for ν in the place of the numerator nobody can tell: the model of Bradley
    and Terry 1952 with the ties of Davidson 1970. In a share of the answers, either was meant: with such slips in the
    likelihood one wrong answer cannot outweigh many right ones. Weights, slips and ties all have a Gaussian prior, so
    elliptical slice sampling (Murray, Adams and MacKay 2010) draws from the posterior, without a step size to tune.

    Attributes:
        differences: of the sums of both flights, for each answer, (m, sums).
        answers: FIRST, SECOND or NEITHER, (m,).
        samples: (samples, sums + 2): weights, then what slips and ties follow from.

    """

    def __init__(self, rng: np.random.Generator) -> None:
        self._rng = rng
        self.differences: Doubles = np.zeros((0, len(SUMS)))
        self.answers: Ints = np.zeros(0, dtype=np.intp)
        self.samples = self._sampled()

    def answer(self, difference: Doubles, answer: int) -> None:
        """Learn from one more answer."""
        self.restore(np.concatenate([self.differences, difference[None]]), np.append(self.answers, answer))

    def restore(self, differences: Doubles, answers: Ints) -> None:
        """Learn from these answers alone."""
        self.differences, self.answers = differences, answers
        self.samples = self._sampled()

    @property
    def weights(self) -> Doubles:
        """Samples of the weight of each sum, (samples, sums)."""
        return self.samples[:, : len(SUMS)]

    @property
    def pay(self) -> Doubles:
        """Points for one of each sum, (sums,): mean weights, the longer the more all samples agree."""
        weights = self.weights
        points: Doubles = _POINTS * weights.mean(axis=0) / np.sqrt((weights**2).sum(axis=1).mean())
        return points

    def worth_asking(self, differences: Doubles) -> Doubles:
        """Return how much the answers to pairs (m, sums) would tell of the taste, (m,), in natural units.

        That is how much the samples disagree on them: the entropy of their mean less their mean entropy (Houlsby et
        al. 2011, Bayesian active learning). What all are sure of, or none can tell, is not asked.
        """
        chances = _chances(self.samples, differences)
        told: Doubles = _entropy(chances.mean(axis=0)) - _entropy(chances).mean(axis=0)
        return told

    def _sampled(self) -> Doubles:
        count, rng = len(SUMS), self._rng
        middle = np.concatenate([np.zeros(count), _OTHER[0]])
        spread = np.concatenate([[_LIKING[name in ENDS] for name in SUMS], _OTHER[1]])
        each = np.arange(len(self.answers))

        def likelihood(place: Doubles) -> float:
            chances = _chances((middle + place)[None], self.differences)[0]
            return float(np.log(chances[each, self.answers] + 1e-12).sum())

        place, samples = np.zeros(count + 2), []
        reached = likelihood(place)
        for number in range(_BURNT + _SAMPLES * _APART):
            other, least = spread * rng.normal(size=count + 2), reached + np.log(rng.random())
            angle = 2 * np.pi * rng.random()
            low, high = angle - 2 * np.pi, angle
            while True:
                there = np.cos(angle) * place + np.sin(angle) * other
                reached = likelihood(there)
                if reached > least:
                    break
                low, high = (angle, high) if angle < 0 else (low, angle)
                angle = low + (high - low) * rng.random()
            place = there
            if number >= _BURNT and number % _APART == 0:
                samples.append(middle + place)
        return np.array(samples)


def _chances(samples: Doubles, differences: Doubles) -> Doubles:
    """Return the chance of each answer, (samples, m, 3)."""
    worth = np.clip(samples[:, :-2] @ differences.T / 2, -30, 30)
    slips = _SLIPS / 2 / (1 + np.exp(-1.7 * samples[:, -2, None]))
    ties = np.exp(samples[:, -1, None])
    first, second = np.exp(worth), np.exp(-worth)
    tie = ties / (first + second + ties)
    right = (1 - 2 * slips) / (first + second + ties)
    return np.stack([right * first + slips * (1 - tie), right * second + slips * (1 - tie), tie], axis=-1)


def _entropy(chances: Doubles) -> Doubles:
    entropy: Doubles = -(chances * np.log(chances + 1e-12)).sum(axis=-1)
    return entropy


class Paying:
    """Pays landers by a taste, and keeps what they are paid for: the latest decision's sums, (n, sums)."""

    def __init__(self) -> None:
        self.points: Doubles = np.zeros(len(SUMS))
        self.latest: Floats = np.zeros((0, len(SUMS)), dtype=np.float32)

    def __call__(self, before: Situation, after: Situation) -> Floats:
        self.latest = np.array([part(before, after) for part in SUMS.values()], dtype=np.float32).T
        paid: Floats = self.latest @ self.points.astype(np.float32)
        return paid


class PaidMemory(ReplayBuffer):
    """Replay buffer that keeps sums beside rewards, so that it can be paid anew whenever a taste is known better.

    As pay is linear in the sums, that is exact for n-step returns, too. Christiano et al. 2017 use an algorithm
    without a memory; Lee et al. 2021 (PEBBLE) relabel theirs, as here.
    """

    def __init__(self, capacity: int, num_features: int) -> None:
        super().__init__(capacity, num_features)
        self._sums = np.zeros((capacity, len(SUMS)), dtype=np.float32)
        self._points = np.zeros(len(SUMS), dtype=np.float32)

    def add(self, transitions: Transition) -> Ints:
        """Keep transitions, and their mirror images, whose sums differ in what is to the left."""
        mirror, mirrored = LANDER_SYMMETRY, LANDER_SYMMETRY.mirrored
        image = transitions._replace(
            state=mirrored(transitions.state), next_state=mirrored(transitions.next_state),
            action=mirror.actions[transitions.action], reward=transitions.reward * _MIRRORED,
        )  # fmt: skip
        both = Transition(*map(np.concatenate, zip(transitions, image, strict=True)))
        rows = super().add(both._replace(reward=both.reward @ self._points))
        self._sums[rows] = both.reward
        return rows

    def pay(self, points: Doubles) -> None:
        """Pay everything anew."""
        self._points, rows = points.astype(np.float32), slice(min(self.added, self.capacity))
        self.transitions.reward[rows] = self._sums[rows] @ self._points
