"""Edits of a network by hand, while it flies: weights that are set, units that are silenced, and the way back.

Layers are counted as `ai.explain.inspection.links` has them: layer 0 leads from the inputs to the first hidden units.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Final

from ai.agent.agent import DeepQAgent
from ai.agent.network import make_optimizer
from ai.environment import Floats
from ai.nn import DuelingLayer, FullyConnectedLayer, NeuralNetwork

EDITED: Final = "network"  # the name of the setting change that an edit is
MOST_WEIGHT: Final = 100.0  # largest size of a weight that is set by hand


@dataclass(frozen=True)
class SilenceUnit:
    """Edit that sets all outgoing weights of a unit to 0; `layer` is the one that leads away from it."""

    layer: int
    unit: int


@dataclass(frozen=True)
class SetWeight:
    """Edit that sets the weight from unit `start` to unit `end` of a layer; 0 cuts the link."""

    layer: int
    start: int
    end: int
    value: float


Edit = SilenceUnit | SetWeight
Parameters = tuple[Floats, Floats]  # of the online and the target network


@dataclass(frozen=True)
class EditNetwork:
    """Command to edit the network by hand; `amends` says that the weight of the last edit is still being dragged."""

    edit: Edit
    amends: bool = False


@dataclass(frozen=True)
class UndoEdit:
    """Command to undo the last edit, or with `all` every one since the network was as it had learnt."""

    all: bool = False


@dataclass(frozen=True)
class LearnOn:
    """Command to learn again, from the network as it was edited."""


EditCommand = EditNetwork | UndoEdit | LearnOn


@dataclass(frozen=True)
class NetworkEdits:
    """Edits in force: an empty message says that the network is as it has learnt.

    Attributes:
        silenced: layer and unit of each silenced unit.
        weights: layer, start and end of each weight that was set.
        steps: number of steps that can be undone one by one.
        holds: whether learning is held still.
        way_back: whether all parameters from before the first edit can be restored.

    """

    newest_only: ClassVar = True

    silenced: tuple[tuple[int, int], ...] = ()
    weights: tuple[tuple[int, int, int], ...] = ()
    steps: int = 0
    holds: bool = False
    way_back: bool = False


class NetworkEditor:
    """Editor of an agent's networks. The agent does not learn from the first edit until it is told to.

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
        edits = dict.fromkeys(edit for edit, _ in self._steps)
        silenced = ((each.layer, each.unit) for each in edits if isinstance(each, SilenceUnit))
        weights = ((each.layer, each.start, each.end) for each in edits if isinstance(each, SetWeight))
        return NetworkEdits(
            tuple(silenced), tuple(dict.fromkeys(weights)), len(self._steps), self._agent.paused,
            self._before is not None,
        )  # fmt: skip

    @property
    def count(self) -> int:
        """Number of units and weights that were edited, also those from which it has learnt on."""
        edits = self.edits
        return self._learnt_on + len(edits.silenced) + len(edits.weights)

    def carry_out(self, command: EditCommand) -> None:
        """Carry out a command; raises ValueError, with nothing changed, for an edit that cannot be made."""
        match command:
            case EditNetwork(edit, amends):
                self.apply(edit, amends=amends)
            case UndoEdit(everything):
                self.restore() if everything else self.undo()
            case LearnOn():  # `restore` still leads back
                self._learnt_on = self.count
                self._agent.paused = False
                self._steps.clear()

    def apply(self, edit: Edit, *, amends: bool = False) -> None:
        """Carry out an edit in both networks, and hold learning.

        With `amends`, it takes the place of the step before if that set the same weight, as while it is dragged. Raises
        ValueError, with nothing changed, for an edit that cannot be made.
        """
        agent = self._agent
        check(agent.online, edit)
        values = agent.online.values.copy(), agent.target.values.copy()
        if amends and self._steps and _same_place(self._steps[-1][0], edit):
            values = self._steps.pop()[1]
        self._before = self._before or values
        self._steps.append((edit, values))
        for network in (agent.online, agent.target):
            network.values  # noqa: B018 - packs the parameters, so that the weights are views of them
            weights: Floats = _layers(network)[edit.layer].weights
            if isinstance(edit, SilenceUnit):
                weights[edit.unit] = 0.0
            else:
                weights[edit.start, edit.end] = edit.value
        agent.paused = True

    def undo(self) -> None:
        """Undo the last step; after the last one, the agent learns again."""
        if not self._steps:
            return
        self._agent.online.values, self._agent.target.values = self._steps.pop()[1]
        if not self._steps and not self._learnt_on:
            self.forget()
        self._agent.paused = bool(self._steps)

    def restore(self) -> None:
        """Restore all parameters from before the first edit, bit for bit; the agent learns again.

        If it has learnt since, its optimizer begins anew: what that remembers belongs to other weights.
        """
        if self._before is None:
            return
        self._agent.online.values, self._agent.target.values = self._before
        if self._learnt_on:
            self._agent.optimizer = make_optimizer(self._agent.config)
        self.forget()

    def forget(self) -> None:
        """Let the agent learn, and keep no way back: its networks have been replaced, or are as they were."""
        self._agent.paused = False
        self._before, self._learnt_on = None, 0
        self._steps.clear()


def check(network: NeuralNetwork, edit: Edit) -> None:
    """Raise ValueError, with the reason, for an edit that cannot be made in a network."""
    layers = _layers(network)
    if not 0 <= edit.layer < len(layers):
        if isinstance(edit, SilenceUnit) and edit.layer == len(layers):
            raise ValueError("an action's value has no outgoing weights; silence a unit before it")
        raise ValueError(f"there is no layer {edit.layer} of {len(layers)}")
    layer = layers[edit.layer]
    starts, ends = layer.weights.shape
    if isinstance(edit, SilenceUnit):
        if not 0 <= edit.unit < starts:
            raise ValueError(f"there is no unit {edit.unit} of {starts}")
        return
    if isinstance(layer, DuelingLayer):
        raise ValueError("in a dueling layer no single weight leads to one action; silence a unit before it")
    if not (0 <= edit.start < starts and 0 <= edit.end < ends):
        raise ValueError(f"there is no weight {edit.start}, {edit.end} of {starts} x {ends}")
    if not abs(edit.value) <= MOST_WEIGHT:  # nor is NaN
        raise ValueError(f"a weight is at most {MOST_WEIGHT:g} in size, not {edit.value:g}")


def _layers(network: NeuralNetwork) -> list[FullyConnectedLayer]:
    return [layer for layer in network.layers if isinstance(layer, FullyConnectedLayer)]


def _same_place(one: Edit, other: Edit) -> bool:
    return (
        isinstance(one, SetWeight)
        and isinstance(other, SetWeight)
        and (one.layer, one.start, one.end) == (other.layer, other.start, other.end)
    )
