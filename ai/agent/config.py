"""Settings of a training run, as one dataclass, and the presets."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, Final

from ai.common.knobs import Knobs, is_number, knob
from ai.files import shown
from ai.lander.rewards import RewardWeights
from ai.lander.spawns import CURRICULA, RUNGS, SPAWNS
from ai.nn import OPTIMIZERS
from ai.nn.activations import ACTIVATIONS

LANDER: Final = "lander"
ANYWHERE: Final = "lander-anywhere"  # our lander at random sites, with what is around it as further inputs
_STARTS: Final = (*CURRICULA, *(name for name in SPAWNS if name not in RUNGS))  # a person's ladder is no choice here
_HASTE: Final = RewardWeights(time=-0.4, switch=-0.05)  # quick, and without flickering jets


@dataclass(frozen=True)
class Config(Knobs):
    """Settings of one training run.

    The defaults are what a file means that does not name a setting, as it was saved before there was that choice.
    `PRESETS` has what is offered today.
    """

    # fmt: off
    learning_rate: float = knob(2e-3, "Learning rate: how far each step moves the weights.",
                                "learning", low=1e-5, high=1.0, log=True, live=True)
    final_learning_rate: float = knob(3e-4, "Final learning rate, reached in a straight line over the schedule.",
                                      "learning", low=1e-6, high=1.0, log=True, live=True)
    discount: float = knob(0.985, "Discount γ: how much a reward one decision later is worth.",
                           "learning", low=0.8, high=0.9999, live=True)
    n_step: int = knob(10, "n-step return: rewards summed before the network's own estimate takes over.",
                       "learning", low=1, high=20)
    batch_size: int = knob(256, "Batch size: memories in each learning step.", "learning", low=8, high=1024, live=True)
    gradient_steps: int = knob(12, "Gradient steps after each decision of all landers.",
                               "learning", low=1, high=32, live=True, formerly="updates")
    optimizer: str = knob("adam", "Optimizer: how a gradient becomes a step.", "learning", choices=tuple(OPTIMIZERS))
    cost: str = knob("huber", "Cost function: how an error is measured.", "learning", choices=("mse", "huber"))
    gradient_clip: float = knob(10.0, "Gradient clipping: the longest gradient allowed.",
                                "learning", low=0.1, high=100.0, log=True, live=True)
    schedule_decisions: int = knob(600_000, "Decisions in which learning rate and τ fall and touchdown limits tighten.",
                                   "learning", low=1_000, high=10_000_000, log=True, formerly="horizon")

    hidden: tuple[int, ...] = knob((64, 64), "Units in each hidden layer.", "network", low=1, high=1024,
                                   offers=((16, 16), (32, 32), (64, 64), (128, 128), (256, 256), (64, 64, 64)))
    activation: str = knob("relu", "Activation function of the hidden layers.", "network", choices=tuple(ACTIVATIONS))
    layer_normalisation: bool = knob(True, "Normalise each layer's inputs: steadier learning.", "network")
    dueling: bool = knob(False, "Dueling network: state value and advantages estimated apart.", "network")
    normalise_inputs: bool = knob(False, "Scale observations to running mean 0 and standard deviation 1.",
                                  "network")
    output_scale: float = knob(0.1, "Factor on the last layer's initial weights: early estimates are near 0.",
                               "network", low=0.01, high=1.0, log=True)

    replay_size: int = knob(1_000_000, "Replay buffer size, in memories.", "memory", low=100, high=1_000_000, log=True)
    replay_prune: int = knob(1, "Oldest memories dropped when the buffer is full.", "memory", low=1, high=100_000)
    learning_starts: int = knob(5_000, "Memories collected before learning.",
                                "memory", low=1, high=50_000, formerly="warm_up")
    prioritised: bool = knob(False, "Prioritised replay: by size of error.", "memory")
    priority_exponent: float = knob(0.6, "Priority exponent: 0 is uniform, 1 in proportion to error.",
                                    "memory", low=0.0, high=1.0, needs="prioritised")
    importance_exponent: float = knob(0.4, "Importance sampling: correction of replay's bias, rising to 1.",
                                      "memory", low=0.0, high=1.0, needs="prioritised")
    mirror: bool = knob(True, "Mirror half of each batch left to right: free experience.", "memory", live=True)
    success_pass: bool = knob(False, "Second learning pass over successful landings.", "memory", live=True)
    success_batch_size: int = knob(32, "Batch size of the second pass, in memories.",
                                   "memory", low=4, high=512, live=True, needs="success_pass")

    target_judges: bool = knob(True, "The target network judges next states: steadier. Off, the newest does: faster.",
                               "target", live=True)
    double: bool = knob(True, "Double Q-learning: one network chooses, the other judges.",
                        "target", live=True, needs="target_judges")
    target_update_interval: int = knob(1, "Gradient steps between two updates of the target network.",
                                       "target", low=1, high=10_000, log=True, live=True, formerly="target_every")
    tau: float = knob(0.005, "Target update rate τ: 1 copies the network, less follows softly.",
                      "target", low=0.0001, high=1.0, log=True, live=True, formerly="target_rate")
    final_tau: float = knob(1.0, "Target update rate after the schedule, as a share of τ.",
                            "target", low=0.01, high=1.0, log=True, live=True)
    fly_target: bool = knob(True, "Fly with the target network, which is steadier.", "target", live=True)

    epsilon_start: float = knob(1.0, "Initial ε: share of random actions.", "exploration", low=0.0, high=1.0)
    epsilon_end: float = knob(0.05, "Share of random actions once ε has fallen.",
                              "exploration", low=0.0, high=1.0, live=True)
    epsilon_decay: float = knob(1.0, "Factor on ε after each episode; 1 leaves it to the next knob.",
                                "exploration", low=0.9, high=1.0, live=True)
    epsilon_decisions: int = knob(40_000, "Decisions over which ε falls in a straight line; 0 for none.",
                                  "exploration", low=0, high=10_000_000, live=True)
    epsilon_spread: float = knob(0.7, "Spread ε over the landers: at 1, from ε for the first up to 1 for the last.",
                                 "exploration", low=0.0, high=1.0, live=True)
    random_main: float = knob(0.3, "How often a random action fires the main engine; half the time is hovering.",
                              "exploration", low=0.0, high=1.0, live=True)

    env: str = knob(LANDER, "Environment to learn: our lander, lander-anywhere, or one of Gymnasium by its name.",
                    "task")
    steadiness: float = knob(0.01, "Value by which the action held may fall short of the best.",
                             "lander", low=0.0, high=1.0, live=True)
    num_envs: int = knob(256, "Landers flown at once.", "lander", low=1, high=1024)
    frame_skip: int = knob(4, "Physics steps per decision.", "lander", low=1, high=12)
    spawn: str = knob("thorough", "Where flights begin.", "lander", choices=_STARTS)
    final_touchdown_limits: float = knob(0.8, "Touchdown limits after the schedule, as a share of the real ones.",
                                         "lander", low=0.3, high=1.0, formerly="care")
    reward_scale: float = knob(0.01, "Factor on rewards before the network sees them.",
                               "lander", low=0.0001, high=1.0, log=True)
    reward_weights: RewardWeights = knob(_HASTE, "Weight of each part of the reward.",  # noqa: RUF009
                                         "lander", live=True, formerly="weights")
    # fmt: on

    def problems(self) -> list[str]:
        """Return what is wrong with the values, a sentence each."""
        problems = super().problems()
        problems += _weight_problems(self.reward_weights)
        if self.env == "":
            problems.append("env is the name of an environment, and was empty")
        if not problems and self.replay_prune > self.replay_size:
            problems.append(f"replay_prune is at most replay_size, {self.replay_size}, not {self.replay_prune}")
        return problems

    @classmethod
    def value_from_json(cls, name: str, value: Any) -> Any:
        """Return the value of a field from what a file holds of it; raises ValueError for what cannot be one."""
        if name != "reward_weights":
            return super().value_from_json(name, value)
        parts = [item.name for item in fields(RewardWeights)]
        if not isinstance(value, Mapping):
            raise ValueError(f"reward_weights are numbers by name, of {', '.join(parts)}, not {shown(value)}")
        if unknown := [part for part in value if part not in parts]:
            raise ValueError(f"reward_weights has no {shown(unknown[0])}, only {', '.join(parts)}")
        return RewardWeights(**value)


def _weight_problems(weights: Any) -> list[str]:
    """Return what is wrong with the weights of the parts of the reward, a sentence each."""
    if not isinstance(weights, RewardWeights):
        return [f"reward_weights are finite numbers by name, not {shown(weights)}"]
    wrong = {name: value for name, value in vars(weights).items() if not is_number(value)}
    return [f"reward_weights.{name} is a finite number, not {shown(value)}" for name, value in wrong.items()]


# What a network is taught with that lands anywhere, by `python main.py train --preset anywhere`; not among the presets
# that are offered on the screen, since what it needs to see is not drawn there.
LANDS_ANYWHERE: Final = Config(
    env=ANYWHERE, hidden=(128, 128), final_learning_rate=1e-4, schedule_decisions=3_000_000, gradient_steps=8,
    replay_size=400_000, epsilon_decisions=100_000, steadiness=0.02,
    reward_weights=RewardWeights(time=-0.2, switch=-0.1),
)  # fmt: skip
PRESETS: Final[dict[str, Config]] = {
    "modern": Config(
        learning_rate=3e-3, schedule_decisions=100_000, n_step=8, batch_size=128, gradient_steps=16,
        activation="leaky_relu", target_judges=False, double=False, final_tau=0.05, epsilon_decisions=15_000,
        spawn="widening",
    ),
    "classic": Config(
        learning_rate=1e-3, final_learning_rate=1e-3, schedule_decisions=300_000, discount=0.99, n_step=1,
        batch_size=64, gradient_steps=1, optimizer="sgd", cost="mse", hidden=(128, 128), activation="tanh",
        layer_normalisation=False, output_scale=1.0, replay_size=1500, replay_prune=1000, learning_starts=64,
        mirror=False, success_pass=True, double=False, target_update_interval=50, tau=1.0, fly_target=False,
        epsilon_decay=0.999, epsilon_decisions=0, epsilon_spread=0.0, random_main=0.5, num_envs=1, steadiness=0.0,
        final_touchdown_limits=1.0, spawn="curriculum", reward_scale=0.1, reward_weights=RewardWeights(time=-0.1),
    ),
}  # fmt: skip
