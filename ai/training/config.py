"""Settings of a training run as one dataclass, the presets, what is in force of them, and agents saved with theirs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Final, Self

from ai.agent.agent import DeepQAgent
from ai.agent.config import AgentConfig
from ai.agent.storage import AGENT_FILE
from ai.files.knobs import knob
from ai.files.reading import brief, shown
from ai.lander.rewards import RewardWeights
from ai.lander.spawns import CURRICULA, RUNGS, SPAWNS
from ai.nn.storage import reading

LANDER: Final = "lander"
ANYWHERE: Final = "lander-anywhere"  # our lander at random sites, with what is around it as further inputs
_STARTS: Final = (*CURRICULA, *(name for name in SPAWNS if name not in RUNGS))  # a person's ladder is no choice here
_HASTE: Final = RewardWeights(time=-0.4, switch=-0.05)  # quick, and without flickering jets


@dataclass(frozen=True)
class Config(AgentConfig):
    """Settings of one training run: its agent's, then those of what it flies in. The defaults are preset *modern*."""

    # fmt: off
    random_main: float = knob(0.3, "How often a random action fires the main engine; half the time is hovering.",
                              "exploration", low=0.0, high=1.0, live=True)
    env: str = knob(LANDER, "Environment to learn: our lander, lander-anywhere, or one of Gymnasium by its name.",
                    "task")
    env_arguments: str = knob("", "Arguments that it is made with, as a JSON object.", "task")
    num_envs: int = knob(256, "Landers flown at once.", "lander", low=1, high=1024)
    frame_skip: int = knob(4, "Physics steps per decision.", "lander", low=1, high=12)
    spawn: str = knob("widening", "Where flights begin.", "lander", choices=_STARTS)
    final_touchdown_limits: float = knob(0.8, "Touchdown limits after the schedule, as a share of the real ones.",
                                         "lander", low=0.3, high=1.0)
    reward_weights: RewardWeights = knob(_HASTE, "Weight of each part of the reward.",  # noqa: RUF009
                                         "lander", live=True)
    # fmt: on

    def problems(self) -> list[str]:
        """Return what is wrong with the values, a sentence each."""
        problems = super().problems()
        if self.env == "":
            problems.append("env is the name of an environment, and was empty")
        return problems

    @classmethod
    def value_from_json(cls, name: str, value: Any) -> Any:
        """Return the value of a field from what a file holds of it; raises ValueError for what cannot be one."""
        if name != "reward_weights" or not isinstance(value, Mapping):
            return super().value_from_json(name, value)
        parts = [item.name for item in fields(RewardWeights)]
        if unknown := [part for part in value if part not in parts]:
            raise ValueError(f"reward_weights has no {shown(unknown[0])}, only {', '.join(parts)}")
        return RewardWeights(**value)

    @classmethod
    def of(cls, agent: DeepQAgent) -> Self:
        """Return the configuration of the run that an agent is from; raises ValueError where its file has no such."""
        if isinstance(agent.config, cls):
            return agent.config
        return cls.from_json({**agent.config.to_json(), **agent.run_settings})


def load_agent(folder: str | Path, *, env: str | None = None) -> tuple[DeepQAgent, Config]:
    """Read an agent and the configuration of its run. Raises ModelFormatError, which names what is wrong.

    Reading imports no code that a file names: an agent for an environment "module:Name" is refused, unless the
    caller names that same `env`.
    """
    agent = DeepQAgent.load(folder)
    with reading(folder, AGENT_FILE):
        config = Config.of(agent)
        check_env(config.env, env)
    agent.config, agent.run_settings = config, {}
    return agent, config


def check_env(env: object, named: str | None) -> None:
    """Raise ValueError for a file's environment whose name would import code, unless the user has named it."""
    if not isinstance(env, str) or (":" in env and env != named):
        raise ValueError(
            f"it is for the environment {brief(repr(env), 100)}, which is code that a file may not start; "
            "if you trust it, name it yourself with --env"
        )


# What a network is taught with that lands anywhere, by `python main.py train --preset anywhere`; not among the presets
# that are offered on the screen, since what it needs to see is not drawn there.
LANDS_ANYWHERE: Final = Config(
    preset="anywhere", env=ANYWHERE, learning_rate=2e-3, final_learning_rate=1e-4, schedule_decisions=3_000_000,
    n_step=10, batch_size=256, gradient_steps=8, hidden=(128, 128), activation="relu", target_judges=True, double=True,
    final_tau=1.0, replay_size=400_000, epsilon_decisions=100_000, spawn="thorough", steadiness=0.02,
    reward_weights=RewardWeights(time=-0.2, switch=-0.1),
)  # fmt: skip
PRESETS: Final[dict[str, Config]] = {
    "modern": Config(),
    "classic": Config(
        preset="classic", learning_rate=1e-3, final_learning_rate=1e-3, schedule_decisions=300_000, discount=0.99,
        n_step=1, batch_size=64, gradient_steps=1, optimizer="sgd", cost="mse", hidden=(128, 128), activation="tanh",
        layer_normalisation=False, output_scale=1.0, replay_size=1500, replay_prune=1000, learning_starts=64,
        mirror=False, success_pass=True, target_judges=True, target_update_interval=50, tau=1.0, final_tau=1.0,
        fly_target=False, epsilon_decay=0.999, epsilon_decisions=0, epsilon_spread=0.0, random_main=0.5, num_envs=1,
        steadiness=0.0, final_touchdown_limits=1.0, spawn="curriculum", reward_scale=0.1,
        reward_weights=RewardWeights(time=-0.1),
    ),
}  # fmt: skip
# Found by trial on CartPole-v1 and LunarLander-v3, before that got its own; docs/environments.md has measurements.
# These and the next are written out where they are those of our lander, too: a change there is none here.
GYM: Final = Config(
    preset="gym", env="CartPole-v1", num_envs=16, frame_skip=1, normalise_inputs=True, mirror=False, steadiness=0.0,
    learning_rate=2e-3, final_learning_rate=3e-4, schedule_decisions=700_000, discount=0.995, n_step=3,
    batch_size=128, gradient_steps=4, replay_size=1_000_000, learning_starts=5_000, epsilon_decisions=40_000,
    epsilon_end=0.05, epsilon_spread=0.7, hidden=(64, 64), activation="relu", target_judges=True, double=True,
    tau=0.005, final_tau=1.0, reward_scale=0.01, spawn="thorough",
)  # fmt: skip

# Found by trial on LunarLander-v3 alone: docs/environments.md says what each did. A slow descent burns fuel, so a small
# discount pays.
LUNAR_LANDER: Final = Config(
    preset="gym", env="LunarLander-v3", num_envs=16, frame_skip=3, normalise_inputs=True, mirror=True, steadiness=0.0,
    learning_rate=2e-3, final_learning_rate=1e-5, schedule_decisions=300_000, discount=0.975, n_step=3,
    batch_size=128, gradient_steps=4, replay_size=1_000_000, learning_starts=5_000, epsilon_decisions=40_000,
    epsilon_end=0.02, epsilon_spread=0.6, hidden=(64, 64), dueling=True, tau=0.005, final_tau=1.0, reward_scale=0.01,
    optimizer="adam", cost="huber", gradient_clip=10.0, activation="relu", layer_normalisation=True, output_scale=0.1,
    target_judges=True, double=True, target_update_interval=1, fly_target=True, epsilon_start=1.0, epsilon_decay=1.0,
    prioritised=False, success_pass=False, replay_prune=1,
)  # fmt: skip


def gym_config(env: str) -> Config:
    """Return the settings to learn an environment of Gymnasium with."""
    return LUNAR_LANDER if env == LUNAR_LANDER.env else GYM.changed(env=env)


def presets_of(env: str) -> Mapping[str, Config]:
    """Return what is offered to learn an environment with, by name."""
    if env == ANYWHERE:
        return {"anywhere": LANDS_ANYWHERE}
    return PRESETS if env == LANDER else {"gym": gym_config(env)}
