"""Settings that a Q-learning agent learns and decides by."""

from __future__ import annotations

from dataclasses import dataclass

from ai.files.knobs import Knobs, knob
from ai.nn import OPTIMIZERS
from ai.nn.activations import ACTIVATIONS


@dataclass(frozen=True)
class AgentConfig(Knobs):
    """Settings of an agent, whatever it learns; `ai.training.config` adds those of the run around it.

    The defaults are the preset *modern*.
    """

    # fmt: off
    learning_rate: float = knob(3e-3, "Learning rate: how far each step moves the weights.",
                                "learning", low=1e-5, high=1.0, log=True, live=True)
    final_learning_rate: float = knob(3e-4, "Final learning rate, reached in a straight line over the schedule.",
                                      "learning", low=1e-6, high=1.0, log=True, live=True)
    discount: float = knob(0.985, "Discount γ: how much a reward one decision later is worth.",
                           "learning", low=0.8, high=0.9999, live=True)
    n_step: int = knob(8, "n-step return: rewards summed before the network's own estimate takes over.",
                       "learning", low=1, high=20)
    batch_size: int = knob(128, "Batch size: memories in each learning step.", "learning", low=8, high=1024, live=True)
    gradient_steps: int = knob(16, "Gradient steps after each decision of all landers.",
                               "learning", low=1, high=32, live=True)
    optimizer: str = knob("adam", "Optimizer: how a gradient becomes a step.", "learning", choices=tuple(OPTIMIZERS))
    cost: str = knob("huber", "Cost function: how an error is measured.", "learning", choices=("mse", "huber"))
    gradient_clip: float = knob(10.0, "Gradient clipping: the longest gradient allowed.",
                                "learning", low=0.1, high=100.0, log=True, live=True)
    schedule_decisions: int = knob(100_000, "Decisions in which learning rate and τ fall and touchdown limits tighten.",
                                   "learning", low=1_000, high=10_000_000, log=True)

    hidden: tuple[int, ...] = knob((64, 64), "Units in each hidden layer.", "network", low=1, high=1024,
                                   offers=((16, 16), (32, 32), (64, 64), (128, 128), (256, 256), (64, 64, 64)))
    activation: str = knob("leaky_relu", "Activation function of the hidden layers.", "network",
                           choices=tuple(ACTIVATIONS))
    layer_normalisation: bool = knob(True, "Normalise each layer's inputs: steadier learning.", "network")
    dueling: bool = knob(False, "Dueling network: state value and advantages estimated apart.", "network")
    normalise_inputs: bool = knob(False, "Scale observations to running mean 0 and standard deviation 1.",
                                  "network")
    output_scale: float = knob(0.1, "Factor on the last layer's initial weights: early estimates are near 0.",
                               "network", low=0.01, high=1.0, log=True)

    replay_size: int = knob(1_000_000, "Replay buffer size, in memories.", "memory", low=100, high=1_000_000, log=True)
    replay_prune: int = knob(1, "Oldest memories dropped when the buffer is full.", "memory", low=1, high=100_000)
    learning_starts: int = knob(5_000, "Memories collected before learning.",
                                "memory", low=1, high=50_000)
    prioritised: bool = knob(False, "Prioritised replay: by size of error.", "memory")
    priority_exponent: float = knob(0.6, "Priority exponent: 0 is uniform, 1 in proportion to error.",
                                    "memory", low=0.0, high=1.0, needs="prioritised")
    importance_exponent: float = knob(0.4, "Importance sampling: correction of replay's bias, rising to 1.",
                                      "memory", low=0.0, high=1.0, needs="prioritised")
    mirror: bool = knob(True, "Mirror half of each batch left to right: free experience.", "memory", live=True)
    success_pass: bool = knob(False, "Second learning pass over successful landings.", "memory", live=True)
    success_batch_size: int = knob(32, "Batch size of the second pass, in memories.",
                                   "memory", low=4, high=512, live=True, needs="success_pass")

    target_judges: bool = knob(False, "The target network judges next states: steadier. Off, the newest does: faster.",
                               "target", live=True)
    double: bool = knob(False, "Double Q-learning: one network chooses, the other judges.",
                        "target", live=True, needs="target_judges")
    target_update_interval: int = knob(1, "Gradient steps between two updates of the target network.",
                                       "target", low=1, high=10_000, log=True, live=True)
    tau: float = knob(0.005, "Target update rate τ: 1 copies the network, less follows softly.",
                      "target", low=0.0001, high=1.0, log=True, live=True)
    final_tau: float = knob(0.05, "Target update rate after the schedule, as a share of τ.",
                            "target", low=0.01, high=1.0, log=True, live=True)
    fly_target: bool = knob(True, "Fly with the target network, which is steadier.", "target", live=True)

    epsilon_start: float = knob(1.0, "Initial ε: share of random actions.", "exploration", low=0.0, high=1.0)
    epsilon_end: float = knob(0.05, "Share of random actions once ε has fallen.",
                              "exploration", low=0.0, high=1.0, live=True)
    epsilon_decay: float = knob(1.0, "Factor on ε after each episode; 1 leaves it to the next knob.",
                                "exploration", low=0.9, high=1.0, live=True)
    epsilon_decisions: int = knob(15_000, "Decisions over which ε falls in a straight line; 0 for none.",
                                  "exploration", low=0, high=10_000_000, live=True)
    epsilon_spread: float = knob(0.7, "Spread ε over the landers: at 1, from ε for the first up to 1 for the last.",
                                 "exploration", low=0.0, high=1.0, live=True)

    steadiness: float = knob(0.01, "Value by which the action held may fall short of the best.",
                             "lander", low=0.0, high=1.0, live=True)
    reward_scale: float = knob(0.01, "Factor on rewards before the network sees them.",
                               "lander", low=0.0001, high=1.0, log=True)
    # fmt: on

    def problems(self) -> list[str]:
        """Return what is wrong with the values, a sentence each."""
        problems = super().problems()
        if not problems and self.replay_prune > self.replay_size:
            problems.append(f"replay_prune is at most replay_size, {self.replay_size}, not {self.replay_prune}")
        return problems
