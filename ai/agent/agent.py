"""Deep Q-learning agent (Mnih et al. 2015), for any environment with vector observations and discrete actions."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Final

import numpy as np

from ai.agent.config import Config
from ai.agent.n_step import Episodes, NStep
from ai.agent.normalizer import Normalizer
from ai.agent.replay import MemoryCell, PrioritisedReplayBuffer, ReplayBuffer
from ai.agent.schedule import importance, learning_rate
from ai.common.decision import Decision, decide
from ai.common.environment import Bools, Doubles, Floats, Ints, StepResult
from ai.nn import (
    OPTIMIZERS,
    ActivationLayer,
    DuelingLayer,
    FullyConnectedLayer,
    LayerNormalisation,
    ModelFormatError,
    NeuralNetwork,
    atomic_folder,
    recover_folder,
)
from ai.nn.activations import ACTIVATIONS
from ai.nn.budget import WIDEST
from ai.nn.costs import COSTS
from ai.nn.files import brief, count_of, inside, read_arrays, read_json
from ai.nn.folder import NETWORK, FolderKind

FORMAT: Final = "tranquility agent"
VERSION: Final = 1
AGENT_FILE: Final = "config.json"
OPTIMIZER_FILE: Final = "optimizer.npz"
LAST: Final = "last"  # folder within a run's: the agent to resume from
_ALONE: Final = FolderKind(FORMAT, (OPTIMIZER_FILE,), {"online": NETWORK, "target": NETWORK})
KIND: Final = FolderKind(FORMAT, (OPTIMIZER_FILE, "training.json", "history.npz"), {**_ALONE.folders, LAST: _ALONE})
_SLACK: Final = 1 << 16  # bytes of an archive beside its numbers


@dataclass(frozen=True)
class Symmetry:
    """Mirror symmetry of an environment: data augmentation by a second transition for each one made."""

    signs: Floats  # (features,) to multiply a state by
    features: Ints  # (features,) which feature stands in each place
    actions: Ints  # (actions,) which action each becomes

    @cached_property
    def matrix(self) -> Floats:
        """Matrix that mirrors a state, (features, features): exact, since all but one term of a sum are 0."""
        size = len(self.features)
        matrix = np.zeros((size, size), dtype=np.float32)
        matrix[self.features, np.arange(size)] = self.signs
        return matrix

    def apply(self, cells: MemoryCell, count: int) -> MemoryCell:
        """Return a batch, or many (batches, n), with the first `count` of each mirrored, in new arrays.

        States are in the units of the environment: scaled by different means for left and right, they have no
        mirror image of this form.
        """
        state, next_state, action = (part.copy() for part in (cells.state, cells.next_state, cells.action))
        for states in (state, next_state):
            states[..., :count, :] = states[..., :count, :] @ self.matrix
        action[..., :count] = self.actions[action[..., :count]]
        return cells._replace(state=state, next_state=next_state, action=action)


class DeepQAgent:
    """Deep Q-learning agent: it learns the value of each action in each state from its own flights.

    The default sizes are the lander's. `action_chances` (actions,) are the chances of random actions, uniform by
    default. All randomness comes from `rng`.
    """

    def __init__(
        self,
        num_features: int = 9,
        num_actions: int = 6,
        config: Config | None = None,
        rng: np.random.Generator | None = None,
        *,
        symmetry: Symmetry | None = None,
        action_chances: Doubles | None = None,
    ) -> None:
        self.num_features, self.num_actions = num_features, num_actions
        self.config = config or Config()
        self.rng = rng or np.random.default_rng(0)
        self.symmetry = symmetry
        self.action_chances = action_chances
        self.scale = Normalizer(num_features) if self.config.normalise_inputs else None
        self.online = build_network(num_features, num_actions, self.config, self.rng)
        self.target = self.online.copy()
        self.optimizer = OPTIMIZERS[self.config.optimizer](self.config.learning_rate)
        self.decisions = 0
        self.train_count = 0
        self.loss = self.mean_q = 0.0
        self._n_step = NStep(self.config.n_step, self.config.discount)
        self._episodes = Episodes()

    @cached_property
    def replay(self) -> ReplayBuffer:
        """Replay buffer of recent transitions; made when first asked for, since an agent that only flies needs none."""
        config = self.config
        buffer = PrioritisedReplayBuffer if config.prioritised else ReplayBuffer
        replay = buffer(config.replay_size, self.num_features, config.replay_prune)
        if isinstance(replay, PrioritisedReplayBuffer):
            replay.exponent = config.priority_exponent
        return replay

    @cached_property
    def successes(self) -> ReplayBuffer:
        """Replay buffer of transitions of flights that ended well."""
        return ReplayBuffer(max(1500, self.config.replay_size // 10), self.num_features)

    @property
    def network(self) -> NeuralNetwork:
        """Network that chooses actions: the target network if `config.fly_target`, else the online one."""
        return self.target if self.config.fly_target else self.online

    def q_values(self, observation: Floats) -> Floats:
        """Return the Q-value of every action, (n, actions), for observations (n, features)."""
        observation = np.atleast_2d(observation)
        values: Floats = self.network.predict(self.scale(observation) if self.scale else observation)
        return values

    def decide(self, observation: Floats, *, held: Ints | None = None) -> Decision:
        """Choose actions for observations (n, features); return them with the values that decided.

        An action `held` (n,) until now is kept while its value is within `config.steadiness` of the best: engines
        that flicker between two actions of nearly equal value are unpleasant to watch.
        """
        observation, config = np.atleast_2d(observation), self.config
        values = self.q_values(observation)
        return decide(observation, values, held, steadiness=config.steadiness, reward_scale=config.reward_scale)

    def act(self, observation: Floats, epsilon: float | Doubles = 0.0, held: Ints | None = None) -> Ints:
        """Return ε-greedy actions (n,) for observations (n, features): random with chance `epsilon`, else by `decide`.

        `epsilon` is one number, or (n,) to let some slots explore more than others.
        """
        actions = self.decide(observation, held=held).action
        if np.any(epsilon):
            actions = actions.copy()
            explore = self.rng.random(len(actions)) < epsilon
            chances = self.action_chances
            actions[explore] = self.rng.choice(self.num_actions, int(explore.sum()), p=chances)
        return actions

    def remember(self, observation: Floats, actions: Ints, result: StepResult, success: Bools | None = None) -> None:
        """Store the result of `actions` (n,) at `observation` (n, features); `success` (n,) marks good endings."""
        cells, slots = self._n_step.add(
            observation, actions, result.reward * np.float32(self.config.reward_scale),
            result.observation, result.terminated, result.ended,
        )  # fmt: skip
        self.decisions += len(actions)
        if self.scale:
            self.scale.watch(observation)
        if not len(slots):
            return
        self.replay.add(cells)
        if self.config.success_pass and success is not None:
            for episode in self._episodes.add(cells, slots, result.ended, success):
                self.successes.add(episode)

    @np.errstate(over="ignore", invalid="ignore")  # what overflows is found by the optimizer
    def learn(self) -> float | None:
        """Take `config.updates` learning steps, and a second pass over successes if asked for; return the mean loss.

        None before the warm-up is over. The targets of all these steps are computed in one go beforehand. Raises
        DivergenceError when a number is no longer finite.
        """
        config = self.config
        if self.replay.added < config.warm_up:
            return None
        self.optimizer.learning_rate = learning_rate(config, self.decisions)
        self.optimizer.clip = config.gradient_clip
        self.loss, self.mean_q = self._learn_from(self.replay, config.batch_size, config.updates)
        if config.success_pass and len(self.successes) >= config.success_batch_size:
            self._learn_from(self.successes, config.success_batch_size, config.updates, follow=False)
        return self.loss

    def _learn_from(
        self, memory: ReplayBuffer, batch_size: int, updates: int, *, follow: bool = True
    ) -> tuple[float, float]:
        """Take steps on minibatches of a memory; return the mean absolute error and the mean value of next states.

        With `follow`, the steps count, and the target network follows.
        """
        if isinstance(memory, PrioritisedReplayBuffer):
            memory.importance = importance(self.config, self.decisions)
        cells, rows, weights = memory.sample(batch_size * updates, self.rng)
        if self.config.mirror and self.symmetry is not None:
            batches = MemoryCell(*(part.reshape(updates, batch_size, *part.shape[1:]) for part in cells))
            mirrored = self.symmetry.apply(batches, batch_size // 2)
            cells = MemoryCell(*(part.reshape(-1, *part.shape[2:]) for part in mirrored))
        if self.scale:
            cells = cells._replace(state=self.scale(cells.state), next_state=self.scale(cells.next_state))
        targets, values = self._targets(cells)
        errors = np.empty_like(targets)
        for first in range(0, len(targets), batch_size):
            batch = slice(first, first + batch_size)
            errors[batch] = self._update(cells.state[batch], cells.action[batch], targets[batch], weights[batch])
            if follow:
                self._count()
        memory.update_priorities(rows, errors)
        return float(np.abs(errors).mean()), float(values.mean())

    def _targets(self, cells: MemoryCell) -> tuple[Floats, Floats]:
        """Bellman targets (n,), reward + γ^steps · value, and the values (n,) by the target network.

        The value is that of the best action in the next state.
        """
        size = self.config.batch_size  # what many layers make of a batch stays in the cache
        parts = (cells.next_state[first : first + size] for first in range(0, len(cells.action), size))
        value = np.concatenate([self._value(part) for part in parts])
        discount = np.float32(self.config.discount) ** cells.steps.astype(np.float32)
        targets: Floats = cells.reward + discount * value * ~cells.terminal
        return targets, value

    def _value(self, states: Floats) -> Floats:
        """Return the value of the best action in each state by the target network, (n,)."""
        values = self.target.predict(states)
        # van Hasselt et al. 2016: the online network picks, the target judges.
        best = (self.online.predict(states) if self.config.double else values).argmax(axis=1)
        value: Floats = values[np.arange(len(best)), best]
        return value

    def _update(self, states: Floats, actions: Ints, targets: Floats, weights: Floats) -> Floats:
        """Take one step of the optimizer; return the temporal-difference errors (n,)."""
        predicted = self.online.forward_propagate(states)
        rows = np.arange(len(actions))
        chosen = predicted[rows, actions]
        errors: Floats = chosen - targets
        slope = np.zeros_like(predicted)
        # Outputs have costs of their own: those of the other actions are 0.
        slope[rows, actions] = self.online.cost.derivative(chosen[:, None], targets[:, None])[:, 0] * weights
        self.online.backward_propagate(slope)
        self.optimizer.step(self.online.values, self.online.gradients, cost=float(np.dot(errors, errors)))
        return errors

    def _count(self) -> None:
        """Count a learning step of the first pass, and update the target network when it is due."""
        self.train_count += 1
        if self.train_count % self.config.target_every == 0:
            self._follow()

    def change(self, config: Config) -> None:
        """Take over the live knobs of another configuration."""
        self.config = config
        self._n_step.discount = config.discount

    def go_back(self, values: Floats, scale: Normalizer | None) -> None:
        """Restore both networks to the parameters `values` (parameters,) with their `scale`; reset the optimizer."""
        self.online.values = self.target.values = values
        self.optimizer = OPTIMIZERS[self.config.optimizer](self.config.learning_rate)
        self.scale = scale

    def _follow(self) -> None:
        """Move the target network towards the online one."""
        rate = self.config.target_rate
        if rate >= 1.0:
            self.target.values = self.online.values
        else:
            self.target.values += rate * (self.online.values - self.target.values)

    def take_over(self, other: DeepQAgent) -> None:
        """Take over the networks, optimizer and counts of `other`, but not its memories."""
        self.online.values, self.target.values = other.online.values, other.target.values
        self.optimizer.load_state(other.optimizer.state(), self.online.values)
        self.decisions, self.train_count, self.scale = other.decisions, other.train_count, other.scale

    def save(self, folder: str | Path) -> None:
        """Write the agent to a folder, whole or not at all. Memories are not kept.

        Raises OSError if it cannot be written, FileExistsError if the folder holds something else.
        """
        with atomic_folder(folder, KIND) as temporary:
            self.write(temporary)

    def write(self, folder: Path) -> None:
        """Write the agent's files into a new folder; `save` does so safely."""
        described = {
            "format": FORMAT, "version": VERSION, "features": self.num_features, "actions": self.num_actions,
            "decisions": self.decisions, "train_count": self.train_count, "config": self.config.to_json(),
        }  # fmt: skip
        if self.scale:
            described["scale"] = self.scale.to_json()
        folder.mkdir(parents=True, exist_ok=True)
        self.online.save(folder / "online")
        self.target.save(folder / "target")
        np.savez(folder / OPTIMIZER_FILE, allow_pickle=False, **self.optimizer.state())
        (folder / AGENT_FILE).write_text(json.dumps(described, indent=2) + "\n", encoding="utf-8")

    @classmethod
    def load(cls, folder: str | Path, rng: np.random.Generator | None = None, *, env: str | None = None) -> DeepQAgent:
        """Read what `save` wrote. Raises ModelFormatError, which names everything that is wrong.

        Loading imports no code that a file names: an agent for an environment "module:Name" is refused, unless the
        caller names that same `env`.
        """
        folder = Path(folder)
        recover_folder(folder)
        described = _read_description(folder)
        try:
            config = Config.from_json(described["config"])
            _check_env(config.env, env)
            agent = cls(
                count_of(described["features"], 1, WIDEST), count_of(described["actions"], 1, WIDEST), config, rng
            )
            agent.decisions, agent.train_count = count_of(described["decisions"]), count_of(described["train_count"])
            if agent.scale:
                agent.scale.load(described["scale"])
        except (KeyError, TypeError, ValueError, ArithmeticError) as error:
            said = f"{error.args[0]} is missing" if isinstance(error, KeyError) else brief(error)
            raise ModelFormatError(folder, [f"{AGENT_FILE}: {said}"]) from error
        problems = []
        for name in ("online", "target"):
            try:
                network = NeuralNetwork.load(inside(folder, name))
                if _sizes(network) != _sizes(agent.online):
                    raise ModelFormatError(folder / name, ["its sizes are not those of the agent's settings"])
                setattr(agent, name, network)
            except ModelFormatError as error:
                problems += [f"{name}: {problem}" for problem in error.problems]
            except OSError as error:
                problems.append(f"{name}: {error.strerror or error}")
        try:
            agent.optimizer.load_state(_read_state(inside(folder, OPTIMIZER_FILE), agent), agent.online.values)
        except OSError as error:
            problems.append(f"{OPTIMIZER_FILE}: {error.strerror or error}")
        except (ValueError, KeyError) as error:
            problems.append(f"{OPTIMIZER_FILE}: {error}")
        if problems:
            raise ModelFormatError(folder, problems)
        return agent


def build_network(num_features: int, num_actions: int, config: Config, rng: np.random.Generator) -> NeuralNetwork:
    """Build the Q-network of a configuration: one value per action, no activation at the end."""
    network = NeuralNetwork(*COSTS[config.cost](), rng=rng)
    inputs = num_features
    for units in config.hidden:
        network.add_layer(FullyConnectedLayer(inputs, units))
        if config.layer_normalisation:
            network.add_layer(LayerNormalisation(units))
        network.add_layer(ActivationLayer(*ACTIVATIONS[config.activation]()))
        inputs = units
    head = DuelingLayer if config.dueling else FullyConnectedLayer
    return network.add_layer(head(inputs, num_actions, scale=config.output_scale))


def _check_env(env: str, named: str | None) -> None:
    """Raise ValueError for an environment whose name would import code, unless the user has named it."""
    if not isinstance(env, str) or (":" in env and env != named):
        raise ValueError(
            f"it is for the environment {brief(repr(env), 100)}, which is code that a file may not start; "
            "if you trust it, name it yourself with --env"
        )


def _sizes(network: NeuralNetwork) -> list[Any]:
    """Return the dtype, layer types and shapes, which two networks must share to take each other's parameters."""
    return [network.dtype, *((type(layer), dict(layer.shapes)) for layer in network.layers)]


def _read_state(path: Path, agent: DeepQAgent) -> dict[str, Any]:
    """Read an optimizer's arrays; raises OSError, or ValueError for others than such an optimizer has."""
    values, remembers = agent.online.values, agent.optimizer.remembers

    def expect(name: str, shape: tuple[int, ...], dtype: np.dtype[Any]) -> None:
        steps = name == "steps" and shape == () and dtype.kind in "iu"
        if not steps and not (
            name in remembers and shape == values.shape and dtype.kind == "f" and dtype.itemsize <= 8
        ):
            raise ValueError(f"{name} is no state of {type(agent.optimizer).__name__} of {len(values):,} parameters")

    return read_arrays(path, len(remembers) * values.size * 8 + _SLACK, expect)


def _read_description(folder: Path) -> dict[str, Any]:
    try:
        described = read_json(inside(folder, AGENT_FILE))
    except OSError as error:
        raise ModelFormatError(folder, [f"{AGENT_FILE}: {error.strerror or error}"]) from error
    except ValueError as error:
        raise ModelFormatError(folder, [f"{AGENT_FILE}: {error}"]) from error
    if not isinstance(described, dict) or described.get("format") != FORMAT:
        raise ModelFormatError(folder, [f"{AGENT_FILE}: this is no {FORMAT}"])
    if described.get("version") != VERSION:
        said = brief(repr(described.get("version")), 40)
        raise ModelFormatError(folder, [f"{AGENT_FILE}: version {said}, not {VERSION}"])
    return described
