"""Training of a safety critic: rounds of moments near the edge of what can be saved, and a calibration."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.common.environment import Bools, Doubles, Floats, Ints
from ai.copilot.copilot import CoPilot, Mode
from ai.copilot.critic import (
    CriticFacts,
    Reliability,
    SafetyCritic,
    columns,
    fingerprint,
    joined_inputs,
    logistic,
)
from ai.copilot.hands import any_hands
from ai.copilot.moments import Moments, anywhere, flown, moon, saved
from ai.lander.environment import MIRROR_ACTIONS, NUM_ACTIONS, NUM_FEATURES, LanderEnv
from ai.lander.sensing import LONG, SURROUNDINGS, SURROUNDINGS_SCALE, TERRAIN
from ai.nn import OPTIMIZERS, ActivationFunctions, ActivationLayer, CostFunctions, FullyConnectedLayer, NeuralNetwork
from engine import DT

MOON: Final = ("time left", "pad width", *TERRAIN)  # of what is around a lander on the moon
_HIDDEN: Final = (128, 128, 128)
_FLIGHTS: Final = 192  # of clumsy hands in a round
_PER_ROUND: Final = 4000  # moments that are kept of those
_FIRST: Final = 6  # rounds of any moments, before there is a critic to say which are in doubt
_FITS: Final = 8  # rounds from one critic to the next
_STEPS: Final = 7500  # of a fit; with twice as many, a critic is surer of itself than it may be, and saves fewer
_BATCH: Final = 512
_RATE: Final = 2e-3
_ASKED: Final = 0.6  # share of moments in which the action asked for is flown, and not a random one
_ALONE: Final = 0.15  # share of flights without help
_HURRIED: Final = 0.2  # share of moments that are moved to the last seconds of a flight
_TIME: Final = SURROUNDINGS.index("time left")
_LEAST_SAVED: Final = 0.3  # share of any moments that the agent must still save, to be worth a critic
_PLAIN: Final = 1500  # moments of a round that takes them as they come
_CALIBRATED, _TESTED = 12, 12  # such rounds: for slope and offset, and for the table
_EDGES: Final = (0.0, 0.01, 0.1, 0.5, 0.9, 0.97, 0.99, 0.998, 1.0)  # of the reliability table

MakeEnv = Callable[[int, np.random.Generator], LanderEnv]


@dataclass
class Lessons:
    """What a critic learns from: inputs (m, k), the action flown (m,), and whether the flight was saved (m,)."""

    inputs: Floats
    action: Ints
    saved: Bools

    def __len__(self) -> int:
        return len(self.action)


@dataclass(frozen=True)
class Progress:
    """Progress of training a critic; `critic` is the latest."""

    round: int
    rounds: int
    moments: int
    right: float  # share of right guesses among the moments of the round, most of them in doubt
    critic: SafetyCritic


@dataclass
class CriticTraining:
    """Training of a safety critic for `agent`; iterate over `run` to its end, then take `critic`.

    The critic flies beside clumsy hands as it will later, at all settings of the dial, so that it learns from the
    moments that it will be asked about (Ross, Gordon and Bagnell 2011, DAgger).
    """

    agent: DeepQAgent
    rng: np.random.Generator
    rounds: int = 80
    lessons: list[Lessons] = field(default_factory=list)
    critic: SafetyCritic = field(init=False)

    def __post_init__(self) -> None:
        far = self.agent.num_features > NUM_FEATURES  # it lands anywhere
        self._make_env: MakeEnv = anywhere if far else moon
        self.inputs = SURROUNDINGS if far else MOON

    def run(self) -> Iterator[Progress]:
        """Train round by round; the last round's critic is calibrated.

        Raises ValueError for an agent that hardly ever lands, as nobody can be handed over to it.
        """
        for number in range(1, self.rounds + 1):
            critic = None if number <= _FIRST else self.critic
            lessons = self.gather(critic)
            right = 0.5 if critic is None else self._right(critic, lessons)
            self.lessons.append(lessons)
            if number == _FIRST and np.mean([some.saved.mean() for some in self.lessons]) < _LEAST_SAVED:
                raise ValueError("this network lands too seldom to be anybody's guardian; train it for longer first")
            if number >= _FIRST and (number % _FITS == _FIRST % _FITS or number == self.rounds):
                self.critic = self.fit(_STEPS)
            elif number < _FIRST:
                continue
            yield Progress(number, self.rounds, sum(map(len, self.lessons)), right, self.critic)
        self.critic = self.calibrated(self.critic)

    def gather(self, critic: SafetyCritic | None, *, plain: bool = False) -> Lessons:
        """Fly a round of clumsy hands, and find out of which moments the agent would have saved them.

        With a `critic`, it guards most of the flights, and moments in doubt come more often; `plain` takes them as
        they come.
        """
        env = self._make_env(_FLIGHTS, self.rng)
        share = None if critic is None else self._guarded(critic)
        moments = flown(env, any_hands(env.num_envs, self.rng, self.agent), share)
        weight = np.ones(len(moments))
        if critic is not None and not plain:
            chance = critic.chances(moments.observation, moments.surroundings)
            asked = chance[np.arange(len(moments)), moments.action]
            weight = np.sqrt(asked * (1.0 - asked)) + 0.01
        size = min(_PER_ROUND if not plain else _PLAIN, len(moments))
        moments = moments.take(self.rng.choice(len(moments), size, replace=False, p=weight / weight.sum()))
        if not plain:
            self._hurry(moments)
        action = np.where(
            self.rng.random(size) < (1.0 if plain else _ASKED),
            moments.action,
            self.rng.integers(0, NUM_ACTIONS, size),
        )
        inputs = joined_inputs(moments.observation, moments.surroundings, columns(self.inputs))
        return Lessons(inputs, action, saved(self.agent, moments, action))

    def _guarded(self, critic: SafetyCritic) -> Callable[[LanderEnv, Ints], Ints]:
        """Return a guardian with its dial somewhere, and some flights without it."""
        copilot = CoPilot(self.agent, self.rng.uniform(0.15, 0.75), Mode.GUARDIAN, critic=critic)
        alone = self.rng.random(_FLIGHTS) < _ALONE

        def share(env: LanderEnv, asked: Ints) -> Ints:
            return np.where(alone, asked, copilot.share(env.observe(), asked, env.around())[0])

        return share

    def _hurry(self, moments: Moments) -> None:
        """Move some moments to the last seconds of their flights."""
        hurried = self.rng.random(len(moments)) < _HURRIED
        left = self.rng.uniform(0.5, 15.0, len(moments))
        steps = np.maximum(moments.steps, ((moments.longest - left) / DT).astype(np.intp))
        moments.steps = np.where(hurried, steps, moments.steps)
        seconds = np.minimum(moments.longest - moments.steps * DT, LONG)
        moments.surroundings[:, _TIME] = seconds * SURROUNDINGS_SCALE[_TIME]

    def fit(self, steps: int) -> SafetyCritic:
        """Return a critic learnt from all lessons so far by logistic regression on the action flown; half mirrored."""
        inputs = np.concatenate([some.inputs for some in self.lessons])
        action = np.concatenate([some.action for some in self.lessons])
        landed = np.concatenate([some.saved for some in self.lessons]).astype(np.float32)
        network, optimizer = self._network(), OPTIMIZERS["adam"](_RATE)
        critic = SafetyCritic(network, CriticFacts(fingerprint(self.agent), self.inputs, moments=len(action)))
        rows = np.arange(_BATCH)
        for step in range(steps):
            some = self.rng.integers(0, len(action), _BATCH)
            seen, flown_, mirrored = inputs[some], action[some], _BATCH // 2
            seen[:mirrored], flown_[:mirrored] = critic.mirror(seen[:mirrored]), MIRROR_ACTIONS[flown_[:mirrored]]
            optimizer.learning_rate = _RATE * (1.0 - step / steps) + 1e-5
            output = network.forward_propagate(seen)
            error = np.zeros_like(output)
            error[rows, flown_] = (logistic(output[rows, flown_]) - landed[some]) / _BATCH
            network.backward_propagate(error)
            optimizer.step(network.values, network.gradients, cost=0.0)
        return critic

    def _network(self) -> NeuralNetwork:
        network = NeuralNetwork(*CostFunctions.use_mse(), rng=self.rng)
        width = 9 + len(self.inputs)
        for hidden in _HIDDEN:
            network.add_layer(FullyConnectedLayer(width, hidden)).add_layer(
                ActivationLayer(*ActivationFunctions.use_relu())
            )
            width = hidden
        return network.add_layer(FullyConnectedLayer(width, NUM_ACTIONS))

    def calibrated(self, critic: SafetyCritic) -> SafetyCritic:
        """Return the critic with slope and offset fitted to moments as they come, and a table of others."""
        fitted, tested = (self._plain(critic, rounds) for rounds in (_CALIBRATED, _TESTED))
        slope, offset = _platt(*fitted)
        output, landed = tested
        chance = logistic(slope * output + offset)
        bins = np.digitize(chance, _EDGES[1:-1])
        rows = (
            Reliability(float(chance[bins == k].mean()), float(landed[bins == k].mean()), int((bins == k).sum()))
            for k in np.unique(bins)
        )
        facts = replace(critic.facts, slope=slope, offset=offset, reliability=tuple(rows))
        return SafetyCritic(critic.network, facts)

    def _plain(self, critic: SafetyCritic, rounds: int) -> tuple[Doubles, Bools]:
        """Return the critic's outputs for actions asked for at moments as they come, and whether each was saved."""
        parts = [self.gather(critic, plain=True) for _ in range(rounds)]
        outputs = [critic.outputs(part.inputs)[np.arange(len(part)), part.action] for part in parts]
        return np.concatenate(outputs).astype(float), np.concatenate([part.saved for part in parts])

    @staticmethod
    def _right(critic: SafetyCritic, lessons: Lessons) -> float:
        output = critic.outputs(lessons.inputs)[np.arange(len(lessons)), lessons.action]
        return float(((output > 0) == lessons.saved).mean())


def _platt(output: Doubles, landed: Bools) -> tuple[float, float]:
    """Return slope and offset by which outputs (m,) best foretell landings (m,) (Platt 1999), by Newton's method."""
    inputs = np.column_stack([output, np.ones(len(output))])
    weights = np.array([1.0, 0.0])
    for _ in range(25):
        chance = logistic(inputs @ weights)
        slope = inputs.T @ (chance - landed) + 1e-3 * (weights - (1.0, 0.0))
        curve = (inputs * (chance * (1 - chance))[:, None]).T @ inputs + 1e-3 * np.eye(2)
        weights -= np.clip(np.linalg.solve(curve, slope), -0.5, 0.5)
    return float(weights[0]), float(weights[1])
