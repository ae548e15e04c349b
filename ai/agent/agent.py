"""Deep Q-learning agent, for any environment with vector observations and discrete actions.

One decision of training is on one page: `DeepQAgent.train_step` and the methods below it. Where that, as the preset
`modern` has it, is not what the papers do, and why:

Mnih et al. 2015, Human-level control through deep reinforcement learning
- One game, one gradient step on 32 transitions every 4 actions. Here `num_envs` landers decide at once, then come
  `gradient_steps` steps: NumPy pays per call. All their targets are computed before the first of them, in a few large
  passes, and stay as they are.
- The target network is copied every 10,000 steps, and the online one acts. Here it follows softly by `tau` after each
  step (Lillicrap et al. 2016), at last more slowly (`final_tau`), and acts itself (`fly_target`): it is steadier to
  watch. Next states are judged by the online network (`target_judges` is off), as in Gallici et al. 2025, who need no
  target network, thanks to layer normalisation.
- Rewards are clipped to ±1. Here they are only scaled (`reward_scale`): a landing must outweigh what leads to it.
- RMSProp at a fixed rate. Here Adam, at a rate that falls in a straight line; gradients are clipped by length, and the
  cost is Huber's, the paper's clipped error.
- ε falls to 0.1, and random actions are uniform. Here each lander has an ε of its own, as in Horgan et al. 2018, and
  chances of random actions may differ (`action_chances`): a main engine fired half the time is hovering.
- The action of the greatest value is taken. Here the one held goes on while it is nearly as good (`steadiness`), so
  that engines do not flicker. Targets use the greatest value all the same.
- An episode's end has no value beyond. Here the end by the clock has, as time is not observed (Pardo et al. 2018).
Off in both presets: double Q-learning (van Hasselt et al. 2016); prioritised replay (Schaul et al. 2016), here with all
  minibatches of a decision drawn together, priorities set once after the last, and weights relative to the largest of
  all; dueling networks (Wang et al. 2016), here with linear streams and no gradient scaled by 1/√2.
N-step returns (Sutton and Barto 2018, 7.1) are not weighted by importance sampling, as in Hessel et al. 2018.
In no paper: half of each minibatch is mirrored (`mirror`); `classic` has a second pass over flights that ended well.
"""

from __future__ import annotations

from copy import deepcopy
from functools import cached_property, partial
from pathlib import Path
from typing import Any, Final, Self

import numpy as np

from ai.agent.config import AgentConfig
from ai.agent.decision import Decision, decide
from ai.agent.n_step import Episodes, NStep
from ai.agent.network import build_network, make_optimizer
from ai.agent.normalizer import Normalizer
from ai.agent.replay import ReplayBuffer, Transition, make_replay
from ai.agent.schedule import importance, learning_rate, target_rate
from ai.agent.storage import KIND, read_agent, write_agent
from ai.agent.symmetry import Symmetry
from ai.environment import Bools, Doubles, Env, Floats, Ints, StepResult
from ai.files.folder import atomic_folder
from ai.nn import NeuralNetwork

TOGETHER: Final = 1024  # states that are judged at a time: fewer calls, and what layers make of them stays in the cache


class DeepQAgent:
    """Deep Q-learning agent: it learns the value of each action in each state from its own flights.

    The default sizes are the lander's. `action_chances` (actions,) are the chances of random actions, uniform by
    default. `replay` is that of the configuration unless another is handed over. All randomness comes from `rng`.

    Attributes:
        online: the network that learns.
        target: a copy that follows it. It judges next states if `config.target_judges`, flies if `config.fly_target`.
        decisions: decisions taken so far, of single landers.
        gradient_steps: gradient steps taken so far.
        loss: mean absolute temporal-difference error of the last `learn`, in scaled reward.
        mean_q: mean value of the next states it learned from, in the same unit.
        folder: where it was read from; None for an agent that was not.
        run_settings: what its file says of the run it is from, and `config` does not; saved with it again.

    """

    def __init__(
        self,
        num_features: int = 9,
        num_actions: int = 6,
        config: AgentConfig | None = None,
        rng: np.random.Generator | None = None,
        *,
        symmetry: Symmetry | None = None,
        action_chances: Doubles | None = None,
        replay: ReplayBuffer | None = None,
    ) -> None:
        self.num_features, self.num_actions = num_features, num_actions
        self.config = config or AgentConfig()
        self.rng = rng or np.random.default_rng(0)
        self.symmetry, self.action_chances = symmetry, action_chances
        self.normalizer = Normalizer(num_features) if self.config.normalise_inputs else None
        self.online = build_network(num_features, num_actions, self.config, self.rng)
        self.target = self.online.copy()
        self.optimizer = make_optimizer(self.config)
        if replay is not None:
            self.replay = replay
        self.decisions = self.gradient_steps = 0
        self.loss = self.mean_q = 0.0
        self.folder: Path | None = None
        self.run_settings: dict[str, Any] = {}
        self.n_step = NStep(self.config.n_step, self.config.discount)
        self.episodes = Episodes(num_features)

    # One decision of training, in the order in which it happens

    def train_step(
        self, env: Env, observation: Floats, epsilon: float | Doubles, held: Ints
    ) -> tuple[Ints, StepResult]:
        """Take one decision in all n slots of an environment, and learn; return the actions (n,) and their result.

        `observation` (n, features) is the environment's latest, `held` (n,) are the actions before. Raises
        DivergenceError when a number is no longer finite.
        """
        actions = self.act(observation, epsilon, held)
        result = env.step(actions)
        self.store(observation, actions, result, result.succeeded)
        self.learn()
        return actions, result

    def act(self, observation: Floats, epsilon: float | Doubles = 0.0, held: Ints | None = None) -> Ints:
        """Return ε-greedy actions (n,) for observations (n, features): random with chance `epsilon`, else by `decide`.

        `epsilon` is one number, or (n,) to let some slots explore more than others.
        """
        actions = self.decide(observation, held=held).action
        if epsilon.any() if isinstance(epsilon, np.ndarray) else epsilon:
            actions = actions.copy()
            explore = self.rng.random(len(actions)) < epsilon
            actions[explore] = self.rng.choice(self.num_actions, int(explore.sum()), p=self.action_chances)
        return actions

    def store(self, observation: Floats, actions: Ints, result: StepResult, success: Bools | None = None) -> None:
        """Store the result of `actions` (n,) at `observation` (n, features); `success` (n,) marks good endings."""
        before, after = observation, result.observation
        if self.normalizer:
            self.normalizer.begin(before)
            before, after = self.normalizer.measured(before), self.normalizer.measured(after)
            self.normalizer.update(before)
        reward = result.reward * np.float32(self.config.reward_scale)
        transitions, slots = self.n_step.add(before, actions, reward, after, result.terminated, result.ended)
        self.decisions += len(actions)
        if not len(slots):
            return
        self.replay.add(transitions)
        if self.config.success_pass and success is not None:
            for episode in self.episodes.add(transitions, slots, result.ended, success):
                self.successes.add(episode)

    @np.errstate(over="ignore", invalid="ignore")  # what overflows is found by the optimizer
    def learn(self) -> float | None:
        """Take `config.gradient_steps` steps, and a second pass over successes if asked for; return `loss`.

        None until it is `ready`. Raises DivergenceError when a number is no longer finite.
        """
        config = self.config
        if not self.ready:
            return None
        self.optimizer.learning_rate = learning_rate(config, self.decisions)
        self.optimizer.clip = config.gradient_clip
        self.loss, self.mean_q = self._learn_from(self.replay, config.batch_size)
        if config.success_pass and len(self.successes) >= config.success_batch_size:
            self._learn_from(self.successes, config.success_batch_size, first_pass=False)
        return self.loss

    def _learn_from(self, replay: ReplayBuffer, batch_size: int, *, first_pass: bool = True) -> tuple[float, float]:
        """Take steps on minibatches of a replay buffer; return the mean absolute error and mean value of next states.

        All targets are computed before the first step. Only steps of the first pass count, and only after those is the
        target network updated.
        """
        replay.importance = importance(self.config, self.decisions)
        transitions, rows, weights = replay.sample(batch_size * self.config.gradient_steps, self.rng)
        if self.config.mirror and self.symmetry is not None:
            transitions = self.symmetry.apply(transitions, batch_size, batch_size // 2)
        if self.normalizer:
            state, next_state = map(self.normalizer.scaled, (transitions.state, transitions.next_state))
            transitions = transitions._replace(state=state, next_state=next_state)
        targets, values = self.targets(transitions)
        errors = np.empty_like(targets)
        for first in range(0, len(targets), batch_size):
            batch = slice(first, first + batch_size)
            errors[batch] = self.gradient_step(
                transitions.state[batch], transitions.action[batch], targets[batch], weights[batch]
            )
            if first_pass:
                self.gradient_steps += 1
                self._update_target()
        replay.update_priorities(rows, errors)
        return float(np.abs(errors).mean()), float(values.mean())

    def targets(self, transitions: Transition) -> tuple[Floats, Floats]:
        """Return Bellman targets (n,), reward + γ^steps · value, and the values (n,) of the next states.

        A value is max Q(s', a) over the actions a, of the network that judges; after a terminal decision the target is
        the reward alone. Both are in scaled reward.
        """
        firsts = range(0, len(transitions.action), TOGETHER)
        parts = (transitions.next_state[first : first + TOGETHER] for first in firsts)
        value = np.concatenate([self._next_value(part) for part in parts])
        discount = np.float32(self.config.discount) ** transitions.steps.astype(np.float32)
        targets: Floats = transitions.reward + discount * value * ~transitions.terminal
        return targets, value

    def _next_value(self, states: Floats) -> Floats:
        """Return the value of the best action in each state by the network that judges, (n,).

        With double Q-learning it is Q_target(s, argmax Q_online(s, a)).
        """
        values = self.target.predict(states) if self.config.target_judges else self.online.predict(states)
        # van Hasselt et al. 2016: the online network picks, the target judges.
        best = (self.online.predict(states) if self.double else values).argmax(axis=1)
        value: Floats = values[np.arange(len(best)), best]
        return value

    def gradient_step(self, states: Floats, actions: Ints, targets: Floats, weights: Floats) -> Floats:
        """Take one step of the optimizer on a minibatch; return the temporal-difference errors (n,).

        `states` (n, features) are normalised; `weights` (n,) are those of importance sampling. The optimizer only asks
        whether the cost is finite: a sum of squares shows that of either cost.
        """
        predicted = self.online.forward_propagate(states)
        rows = np.arange(len(actions))
        chosen = predicted[rows, actions]
        errors: Floats = chosen - targets
        derivative = np.zeros(predicted.shape, predicted.dtype)
        # Outputs have costs of their own: those of the other actions are 0.
        derivative[rows, actions] = self.online.cost.derivative(chosen[:, None], targets[:, None])[:, 0] * weights
        self.online.backward_propagate(derivative)
        self.optimizer.step(self.online.values, self.online.gradients, cost=float(np.dot(errors, errors)))
        return errors

    def _update_target(self) -> None:
        """Move the target network towards the online one by τ, where that is due."""
        if self.gradient_steps % self.config.target_update_interval == 0:
            tau = target_rate(self.config, self.decisions)
            if tau >= 1.0:
                self.target.values = self.online.values
            else:
                values = self.target.values
                values += tau * (self.online.values - values)  # in place: the property's setter would copy them again

    # Values and decisions

    @property
    def ready(self) -> bool:
        """Whether `config.learning_starts` transitions have been stored, and some are there."""
        return self.replay.added >= self.config.learning_starts and self.replay.size > 0

    @property
    def network(self) -> NeuralNetwork:
        """Network that chooses actions: the target network if `config.fly_target`, else the online one."""
        return self.target if self.config.fly_target else self.online

    @property
    def double(self) -> bool:
        """Whether one network picks the next action and the other judges it."""
        return self.config.double and self.config.target_judges

    def q_values(self, observation: Floats) -> Floats:
        """Return the Q-value of every action, (n, actions), for observations (n, features)."""
        observation = np.atleast_2d(observation)
        values: Floats = self.network.predict(self.normalizer(observation) if self.normalizer else observation)
        return values

    def decide(self, observation: Floats, *, held: Ints | None = None) -> Decision:
        """Choose actions for observations (n, features); return them with the values that decided.

        An action `held` (n,) until now is kept while its value is within `config.steadiness` of the best: engines
        that flicker between two actions of nearly equal value are unpleasant to watch.
        """
        observation, config = np.atleast_2d(observation), self.config
        values = self.q_values(observation)
        return decide(observation, values, held, steadiness=config.steadiness, reward_scale=config.reward_scale)

    # Parts

    @cached_property
    def replay(self) -> ReplayBuffer:
        """Replay buffer of recent transitions; made when first asked for, since an agent that only flies needs none."""
        return make_replay(self.config, self.num_features)

    @cached_property
    def successes(self) -> ReplayBuffer:
        """Replay buffer of transitions of flights that ended well."""
        return ReplayBuffer(max(1500, self.config.replay_size // 10), self.num_features)

    def apply_live(self, config: AgentConfig) -> None:
        """Use the live knobs of another configuration, which must not differ in others."""
        self.config = config
        self.n_step.discount = config.discount

    def restore(self, values: Floats, normalizer: Normalizer | None) -> None:
        """Restore both networks to the parameters `values` (parameters,) and their normalizer; reset the optimizer."""
        self.online.values = self.target.values = values
        self.optimizer = make_optimizer(self.config)
        self.normalizer = normalizer

    def copy_from(self, other: DeepQAgent) -> None:
        """Copy the networks, optimizer state, normalizer and counts of `other`, but not its replay buffers."""
        self.online.values, self.target.values = other.online.values, other.target.values
        self.optimizer.load_state(other.optimizer.state(), self.online.values)
        self.decisions, self.gradient_steps = other.decisions, other.gradient_steps
        self.normalizer = deepcopy(other.normalizer)

    # Files: ai.agent.storage has their format

    def save(self, folder: str | Path) -> None:
        """Write the agent to a folder, whole or not at all; its replay buffers are not saved.

        Raises OSError if it cannot be written, FileExistsError if the folder holds something else.
        """
        with atomic_folder(folder, KIND) as temporary:
            write_agent(self, temporary)

    @classmethod
    def load(cls, folder: str | Path, rng: np.random.Generator | None = None) -> Self:
        """Read what `save` wrote; raises ModelFormatError, which names what is wrong."""
        return read_agent(folder, partial(cls, rng=rng))
