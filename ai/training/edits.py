"""Edits of a network by hand, while it flies: links that are cut, units that are silenced, and the way back.

Layer 0 leads from the inputs to the first hidden units, as in `ai.explain.inspection.links`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Final

from ai.agent.agent import DeepQAgent
from ai.agent.network import make_optimizer
from ai.environment import Floats
from ai.nn import DuelingLayer, FullyConnectedLayer, NeuralNetwork

EDITED: Final = "network"  # the name of the setting change that an edit is

Parameters = tuple[Floats, Floats]  # of the online and the target network
Place = tuple[int, int, int | None]


@dataclass(frozen=True)
class Edit:
    """Edit that sets a weight of a layer to 0, from unit `start` to unit `end`; without `end`, all that lead from it.

    The first cuts a link, the second silences a unit.
    """

    layer: int
    start: int
    end: int | None = None

    @property
    def place(self) -> Place:
        """What it sets."""
        return self.layer, self.start, self.end

    def check(self, network: NeuralNetwork) -> None:
        """Raise ValueError, with the reason, where it cannot be made in a network."""
        layers = _layers(network)
        if self.end is None and self.layer == len(layers):
            raise ValueError("an action's value has no outgoing weights; silence a unit before it")
        if not 0 <= self.layer < len(layers):
            raise ValueError(f"there is no layer {self.layer} of {len(layers)}")
        layer = layers[self.layer]
        starts, ends = layer.weights.shape
        if self.end is not None and isinstance(layer, DuelingLayer):
            raise ValueError("in a dueling layer no single weight leads to one action; silence a unit before it")
        if not (0 <= self.start < starts and 0 <= (self.end or 0) < ends):
            raise ValueError(f"there is no weight {self.start}, {self.end} of {starts} x {ends}")


@dataclass(frozen=True)
class NetworkEdits:
    """Edits in force: an empty message says that the network is as it has learnt."""

    newest_only: ClassVar = True

    places: tuple[Place, ...] = ()  # layer, start and end of each link that was cut; no end: of a silenced unit
    steps: int = 0  # that can be undone one by one
    holds: bool = False  # whether learning is held still
    way_back: bool = False  # whether all parameters from before the first edit can be restored

    @property
    def silenced(self) -> list[tuple[int, int]]:
        """Layer and unit of each silenced unit."""
        return [(layer, start) for layer, start, end in self.places if end is None]

    @property
    def weights(self) -> list[tuple[int, int, int]]:
        """Layer, start and end of each link that was cut."""
        return [(layer, start, end) for layer, start, end in self.places if end is not None]


class NetworkEditor:
    """Editor of an agent's networks. The agent does not learn from the first edit until asked to.

    While it is held, nothing but the editor changes the parameters, so that undoing restores them bit for bit.
    """

    def __init__(self, agent: DeepQAgent) -> None:
        self._agent = agent
        self._steps: list[tuple[Edit, Parameters]] = []  # since it has learnt last, with all parameters before each
        self._before: Parameters | None = None  # before the first edit of all
        self._learnt_on = 0  # edits from which it has learnt on

    @property
    def edits(self) -> NetworkEdits:
        """What is in force."""
        places = tuple(dict.fromkeys(edit.place for edit, _ in self._steps))
        return NetworkEdits(places, len(self._steps), self._agent.paused, self._before is not None)

    @property
    def count(self) -> int:
        """Number of units and weights that were edited, also those from which it has learnt on."""
        return self._learnt_on + len(self.edits.places)

    def apply(self, edit: Edit) -> None:
        """Carry out an edit in both networks, and hold learning; raises ValueError for one that cannot be made."""
        agent = self._agent
        edit.check(agent.online)
        values = agent.online.values.copy(), agent.target.values.copy()
        self._before = self._before or values
        self._steps.append((edit, values))
        for network in (agent.online, agent.target):
            network.values  # noqa: B018 - packs the parameters, so that the weights are views of them
            _layers(network)[edit.layer].weights[edit.start, slice(None) if edit.end is None else edit.end] = 0.0
        agent.paused = True

    def learn_on(self) -> None:
        """Let the agent learn again; the way back to before all edits stays."""
        self._learnt_on = self.count
        self._agent.paused = False
        self._steps.clear()

    def undo(self, *, every: bool = False) -> None:
        """Undo the last step, or all edits, bit for bit; when none is left, the agent learns again.

        If it has learnt since the first edit, its optimizer begins anew with it undone: what that remembers belongs to
        other weights.
        """
        agent = self._agent
        if every and self._before is not None:
            agent.online.values, agent.target.values = self._before
            if self._learnt_on:
                agent.optimizer = make_optimizer(agent.config)
            self.forget()
        elif self._steps and not every:
            agent.online.values, agent.target.values = self._steps.pop()[1]
            if not self._steps and not self._learnt_on:
                self.forget()
            agent.paused = bool(self._steps)

    def forget(self) -> None:
        """Let the agent learn, and keep no way back: its networks have been replaced, or are as they were."""
        self._agent.paused = False
        self._before, self._learnt_on = None, 0
        self._steps.clear()


def _layers(network: NeuralNetwork) -> list[FullyConnectedLayer]:
    return [layer for layer in network.layers if isinstance(layer, FullyConnectedLayer)]
