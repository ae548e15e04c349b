"""Safety critic: how likely a network still lands if it takes the stick after one more action of the pilot's."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any, Final, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ai.agent.agent import DeepQAgent
from ai.agent.storage import CRITIC_KIND, GUARDIAN
from ai.common.decision import Real
from ai.common.environment import Floats
from ai.lander.environment import LanderEnv
from ai.lander.rules import MIRROR_ACTIONS, MIRROR_FEATURES, MIRROR_SIGNS, NUM_ACTIONS, NUM_FEATURES
from ai.lander.sensing import AROUND, AROUND_ORDER, AROUND_SIGNS, SURROUNDINGS, plain
from ai.nn import ModelFormatError, NeuralNetwork, atomic_folder, recover_folder
from ai.nn.files import brief, inside, read_json
from ai.nn.folder import CONFIG
from ai.nn.schema import check_header, read_as

VERSION: Final = 1
NETWORK: Final = "network"


class Reliability(NamedTuple):
    """Row of a reliability table: of so many moments never learned from, what was said and what came of them."""

    said: float  # mean chance that the critic gave
    saved: float  # share that the network landed
    moments: int


@dataclass(frozen=True)
class CriticFacts:
    """What is known of a safety critic beside its network.

    Attributes:
        agent: fingerprint of the agent whose landings it foretells, from `fingerprint`.
        inputs: names of `ai.lander.sensing.AROUND` that its network takes after an observation.
        slope, offset: chance = logistic(slope · output + offset), fitted on moments it did not learn from.
        moments: how many it learned from.
        reliability: rows of moments that neither it nor slope and offset were fitted to.

    """

    agent: str
    inputs: tuple[str, ...] = ()
    slope: float = 1.0
    offset: float = 0.0
    moments: int = 0
    reliability: tuple[Reliability, ...] = field(default=())


class SafetyCritic:
    """Safety critic: a network with one output for each action, and what turns those into chances.

    A person flies until the chance to be saved is too small; so it is asked about what they want to do next, not
    about what the agent would do (compare Srinivasan et al. 2020, Learning to be safe, whose critic also outlives
    the policy that it was learnt with).
    """

    def __init__(self, network: NeuralNetwork, facts: CriticFacts) -> None:
        self.network, self.facts = network, facts
        self._columns = columns(facts.inputs)
        self._order = [facts.inputs.index(AROUND[AROUND_ORDER[column]]) for column in self._columns]

    @property
    def anywhere(self) -> bool:
        """Whether it was made for a network that lands anywhere, from flights in worlds of many kinds."""
        return "gravity" in self.facts.inputs

    def chances(self, observation: Floats, surroundings: Floats | None = None) -> Floats:
        """Return the chance, 0 to 1, to land for each action, (n, 6), for observations (n, 9).

        It is the chance that the agent lands if that action is flown for one decision of 1/15 s and the agent has the
        stick from then on. `surroundings` (n, k) are those of `LanderEnv.around` or, over a plain, of
        `LanderEnv.surroundings`; by default, those of a flight that has just begun on the moon. NaN where the
        observation is not finite.
        """
        observation = np.atleast_2d(observation)
        if surroundings is None:
            surroundings = np.broadcast_to(usual_surroundings(), (len(observation), len(SURROUNDINGS)))
        if surroundings.shape[1] == len(SURROUNDINGS):
            surroundings = np.concatenate([surroundings, plain(observation, surroundings)], axis=1)
        output = self.outputs(joined_inputs(observation, surroundings, self._columns))
        return logistic(np.float32(self.facts.slope) * output + np.float32(self.facts.offset))

    def outputs(self, inputs: Floats) -> Floats:
        """Return the network's outputs (n, 6) for inputs (n, 9 + k): means of each moment and its mirror image.

        Left and right are alike; two opinions are steadier than one.
        """
        both = self.network.predict(np.concatenate([inputs, self.mirror(inputs)]))
        return np.asarray((both[: len(inputs)] + both[len(inputs) :, MIRROR_ACTIONS]) / 2, np.float32)

    def mirror(self, inputs: Floats) -> Floats:
        """Return inputs (n, 9 + k) with left and right swapped."""
        nine = inputs[:, MIRROR_FEATURES] * MIRROR_SIGNS
        return np.concatenate([nine, (inputs[:, NUM_FEATURES:] * AROUND_SIGNS[self._columns])[:, self._order]], axis=1)

    def save(self, folder: str | Path) -> None:
        """Write the critic to a folder, whole or not at all; raises as `DeepQAgent.save` does."""
        with atomic_folder(folder, CRITIC_KIND) as temporary:
            self.network.save(temporary / NETWORK)
            described = {"format": CRITIC_KIND.format, "version": VERSION, **asdict(self.facts)}
            (temporary / CONFIG).write_text(json.dumps(described, indent=2) + "\n", encoding="utf-8")

    @classmethod
    def load(cls, folder: str | Path) -> SafetyCritic:
        """Read what `save` wrote; raises ModelFormatError, which names what is wrong."""
        folder = Path(folder)
        recover_folder(folder)
        try:
            file = read_as(_CriticFile, check_header(read_json(inside(folder, CONFIG)), CRITIC_KIND.format, (VERSION,)))
            network = NeuralNetwork.load(inside(folder, NETWORK))
            if unknown := set(file.inputs) - set(AROUND):
                raise ValueError(f"it takes {brief(sorted(unknown)[0])}, which nothing measures")
            rows = tuple(Reliability(*row) for row in file.reliability)
            critic = cls(network, CriticFacts(file.agent, file.inputs, file.slope, file.offset, file.moments, rows))
            if critic.chances(np.zeros((1, 9), np.float32)).shape != (1, NUM_ACTIONS):
                raise ValueError(f"the network has not {NUM_ACTIONS} outputs")
        except OSError as error:
            raise ModelFormatError(folder, [error.strerror or str(error)]) from error
        except ModelFormatError:
            raise
        except ValueError as error:
            raise ModelFormatError(folder, [str(error)]) from error
        return critic


@dataclass(frozen=True)
class _CriticFile:
    format: str
    version: int
    agent: str
    inputs: tuple[str, ...]
    slope: float
    offset: float
    moments: int
    reliability: tuple[tuple[float, float, int], ...]


def columns(names: Sequence[str]) -> list[int]:
    """Return the columns of what `LanderEnv.around` returns that have these names."""
    return [AROUND.index(name) for name in names]


def joined_inputs(observation: Floats, around: Floats, chosen: list[int]) -> Floats:
    """Return inputs (n, 9 + k) of a critic's network: observations (n, 9) and the chosen columns of what is around."""
    return np.concatenate([observation, around[:, chosen]], axis=1)


@cache
def usual_surroundings() -> Floats:
    """Return the surroundings (k,) of a flight that has just begun on the moon."""
    env = LanderEnv(1, 0)
    env.reset()
    surroundings: Floats = env.surroundings()[0]
    return surroundings


def logistic(output: NDArray[Real]) -> NDArray[Real]:
    """Return 1 / (1 + e^-output), without overflow."""
    chance: NDArray[Real] = 0.5 * (1.0 + np.tanh(0.5 * output))
    return chance


def fingerprint(agent: DeepQAgent) -> str:
    """Return a text that is different for agents that would fly differently."""
    return sha256(np.ascontiguousarray(agent.network.values).tobytes()).hexdigest()[:16]


_found: WeakKeyDictionary[DeepQAgent, tuple[SafetyCritic | None, str]] = WeakKeyDictionary()


def critic_beside(agent: Any) -> tuple[SafetyCritic | None, str]:
    """Return the critic in the agent's own folder, and why there is none; empty if there is one. Read once."""
    if not isinstance(agent, DeepQAgent) or agent.folder is None:
        return None, "it has no folder"
    if agent not in _found:
        _found[agent] = _read_beside(agent, agent.folder / GUARDIAN)
    return _found[agent]


def _read_beside(agent: DeepQAgent, folder: Path) -> tuple[SafetyCritic | None, str]:
    if not folder.is_dir():
        return None, "none was made"
    try:
        critic = SafetyCritic.load(folder)
    except ModelFormatError as error:
        return None, error.problems[0] if error.problems else str(error)
    if critic.facts.agent != fingerprint(agent):
        return None, "it was made for another network"
    return critic, ""
