"""Edits of a network by hand, while it flies: weights that are set, units that are silenced, and the way back.

Layers are counted as `ai.explain.inspection.links` has them: layer 0 leads from the inputs to the first hidden units.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Final

from ai.agent.agent import DeepQAgent
from ai.agent.network import make_optimizer
from ai.common.environment import Floats
from ai.nn import DuelingLayer, FullyConnectedLayer, NeuralNetwork

EDITED: Final = "network"  # the name of the setting change that an edit is
MOST_WEIGHT: Final = 100.0  # largest size of a weight that is set by hand
MOST_STEPS: Final = 1000  # that can be undone one by one; all of them are undone together in any case


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


@dataclass(frozen=True, eq=False)
class _Step:
    """One edit, with the weights that it replaced in the online and the target network."""

    edit: Edit
    before: tuple[Floats, Floats]


class NetworkEditor:
    """Editor of an agent's networks. The agent does not learn from the first edit until it is told to.

    While it is held, nothing but the editor changes the parameters, so that undoing restores them bit for bit.
    """

    def __init__(self, agent: DeepQAgent) -> None:
        self._agent = agent
        self._steps: list[_Step] = []
        self._before: tuple[Floats, Floats] | None = None  # all parameters, before the first edit
        self._edits: list[Edit] = []  # in force, also those that can no longer be undone one by one
        self._learnt_on = 0  # edits from which it has learnt on

    @property
    def edits(self) -> NetworkEdits:
        """What is in force."""
        silenced = ((each.layer, each.unit) for each in self._edits if isinstance(each, SilenceUnit))
        weights = ((each.layer, each.start, each.end) for each in self._edits if isinstance(each, SetWeight))
        return NetworkEdits(
            tuple(dict.fromkeys(silenced)),
            tuple(dict.fromkeys(weights)),
            len(self._steps),
            self._agent.paused,
            self._before is not None,
        )

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
            case LearnOn():
                self.learn_on()

    def apply(self, edit: Edit, *, amends: bool = False) -> None:
        """Carry out an edit in both networks, and hold learning.

        With `amends`, it belongs to the step before if that set the same weight, as while it is dragged. Raises
        ValueError, with nothing changed, for an edit that cannot be made.
        """
        check(self._agent.online, edit)
        if self._before is None:
            self._before = self._agent.online.values.copy(), self._agent.target.values.copy()
        networks = self._agent.online, self._agent.target
        last = self._steps[-1] if self._steps else None
        if amends and last is not None and _same_place(last.edit, edit):
            self._steps[-1] = _Step(edit, last.before)
            self._edits[-1] = edit
        else:
            self._steps = [*self._steps, _Step(edit, _both(networks, edit))][-MOST_STEPS:]
            self._edits.append(edit)
        for network in networks:
            _place(network, edit)[...] = edit.value if isinstance(edit, SetWeight) else 0.0
        self._agent.paused = True

    def undo(self) -> None:
        """Undo the last step; after the last one, the agent learns again."""
        if not self._steps:
            return
        step = self._steps.pop()
        self._edits.pop()
        for network, values in zip((self._agent.online, self._agent.target), step.before, strict=True):
            _place(network, step.edit)[...] = values
        if not self._edits and not self._learnt_on:
            self.forget()
        elif not self._edits:
            self._agent.paused = False

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

    def learn_on(self) -> None:
        """Let the agent learn again, from the network as it is; `restore` still leads back."""
        self._learnt_on = self.count
        self._agent.paused = False
        self._steps.clear()
        self._edits.clear()

    def forget(self) -> None:
        """Let the agent learn, and keep no way back: its networks have been replaced, or are as they were."""
        self._agent.paused = False
        self._before, self._learnt_on = None, 0
        self._steps.clear()
        self._edits.clear()


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


def _place(network: NeuralNetwork, edit: Edit) -> Floats:
    """Return the view of the weights that an edit sets."""
    network.values  # noqa: B018 - packs the parameters, so that the weights are views of them
    weights: Floats = _layers(network)[edit.layer].weights
    return weights[edit.unit] if isinstance(edit, SilenceUnit) else weights[edit.start, edit.end : edit.end + 1]


def _both(networks: tuple[NeuralNetwork, NeuralNetwork], edit: Edit) -> tuple[Floats, Floats]:
    online, target = networks
    return _place(online, edit).copy(), _place(target, edit).copy()


def _same_place(one: Edit, other: Edit) -> bool:
    return (
        isinstance(one, SetWeight)
        and isinstance(other, SetWeight)
        and (one.layer, one.start, one.end) == (other.layer, other.start, other.end)
    )
