"""Training runs on disk: the best network, the last one to go on from, and how they were made; checkpoints to fly."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from ai.agent.agent import DeepQAgent
from ai.agent.normalizer import Normalizer
from ai.agent.storage import KIND, LAST, write_agent
from ai.common.knobs import nearest_preset
from ai.files import count_of, inside, number_of, problem_in, read_json
from ai.lander.environment import NUM_ACTIONS, NUM_FEATURES
from ai.nn import ModelFormatError, atomic_folder
from ai.training.config import ANYWHERE, LANDER, LANDS_ANYWHERE, PRESETS, Config, load_agent
from ai.training.gym_task import gym_config
from ai.training.history import Checkpoint, History
from ai.training.keeping import save
from ai.training.loop import Training
from ai.training.run import RunKind
from ai.training.state import read_state
from ai.training.statistics import EpisodeStatistics
from ai.training.task import TEST_SEED, Score

TRAINING_FILE: Final = "training.json"


@dataclass(frozen=True)
class Snapshot:
    """Copy of all that is kept of a run, at one moment: it may be saved while training goes on."""

    described: dict[str, Any]
    best: DeepQAgent
    last: DeepQAgent
    history: History | None

    def save(self, folder: str | Path) -> None:
        """Write it, whole or not at all; raises OSError if it cannot be written."""
        with atomic_folder(folder, KIND) as temporary:
            write_agent(self.best, temporary)
            write_agent(self.last, temporary / LAST)
            if self.history is not None:
                self.history.write(temporary)
            (temporary / TRAINING_FILE).write_text(json.dumps(self.described, indent=2) + "\n", encoding="utf-8")


def snapshot(training: Training, history: History | None = None, final: bool = False) -> Snapshot:
    """Copy what is to be kept of a run. One that has not been evaluated yet has its latest network for its best.

    This measures nothing: the clock may decide when it is called, but never which network is best. But a `final` one
    considers the latest network for the best too, and measures the best one on test spawns, which neither trained nor
    chose it.
    """
    if final:
        training.conclude()
    agent, config = training.agent, training.config
    if config.env == LANDER:
        presets = PRESETS
    elif config.env == ANYWHERE:
        presets = {"anywhere": LANDS_ANYWHERE}
    else:
        presets = {"gym": gym_config(config.env)}
    described = {
        "env": config.env,
        **nearest_preset(config.to_json(), {name: preset.to_json() for name, preset in presets.items()}),
        "seed": training.seed,
        "decisions": agent.decisions,
        "updates": agent.gradient_steps,
        "episodes": training.episodes,
        "landings": training.env.landings,
        "seconds": round(training.seconds, 3),
        "best": training.best.to_json() if training.best else None,
        "flights": training.statistics.to_json(),
    }
    best = training.best_agent()
    if final:
        described["evaluation"] = training.task.evaluate(best, training.task.test_episodes, TEST_SEED).to_json()
    return Snapshot(described, best, training.last_agent(), None if history is None else history.copy())


AGENTS: Final = RunKind(KIND, snapshot)


def save_run(training: Training, folder: str | Path, final: bool = False, *, state: bool = False) -> dict[str, Any]:
    """Save a run of an agent as `ai.training.keeping.save` does, by default its networks alone."""
    return save(training, AGENTS, folder, final=final, state=state)


def resume_run(folder: str | Path, *, env: str | None = None) -> Training:
    """Resume a run of an agent: the very same, if its state lies beside its folder, else with an empty memory.

    `Training.lost` says what is missing. Raises ModelFormatError for anything else. `env` is the environment as the
    user names it, without which "module:Name" is refused: see `load_agent`.
    """
    folder = Path(folder)
    best, _ = load_agent(folder, env=env)
    try:
        last, config = load_agent(inside(folder, LAST), env=env)
        described = read_json(inside(folder, TRAINING_FILE))
    except OSError as error:
        raise ModelFormatError(folder, [f"{Path(error.filename or LAST).name}: {error.strerror or error}"]) from error
    except ModelFormatError:
        raise
    except ValueError as error:
        raise ModelFormatError(folder, [f"{TRAINING_FILE}: {error}"]) from error
    try:
        training = Training(config, count_of(described["seed"], most=10**40))
        for agent in (best, last):
            if (agent.num_features, agent.num_actions) != (training.task.num_features, training.task.num_actions):
                raise ValueError(f"its network is not made for {config.env}")
        if described["best"] is not None:
            if best.network.values.shape != training.agent.network.values.shape:
                raise ValueError("the best network and the last one are of different sizes")
            training.best = _read_score(training, described["best"])
            training.best_values, training.best_normalizer = best.network.values.copy(), best.normalizer
        training.episodes, training.env.landings = count_of(described["episodes"]), count_of(described["landings"])
        training.seconds = float(number_of(described["seconds"], 0))
        training.statistics.load(
            described.get("flights", EpisodeStatistics(0).to_json())
        )  # older runs do not have them
    except (KeyError, TypeError, ValueError, ArithmeticError) as error:
        raise ModelFormatError(folder, [f"{TRAINING_FILE}: {problem_in(error)}"]) from error
    training.agent.copy_from(last)
    state = read_state(folder, last.decisions)
    if state is None or not training.load_state(state, folder):
        training.lost = "its state is not there, so it goes on with an empty memory"
    return training


def _read_score(training: Training, described: Any) -> Score:
    """Read a score, and make sure that it can be compared and shown; raises ValueError or TypeError if not."""
    score = training.task.read_score(described)
    for value in score.to_json().values():
        if value is not None:
            number_of(value)
    score.better_than(score)
    str(score)
    return score


def agent_of(config: Config, checkpoint: Checkpoint) -> DeepQAgent:
    """Return an agent that flies as the run did at that checkpoint; raises ValueError if it does not fit."""
    agent = DeepQAgent(NUM_FEATURES, NUM_ACTIONS, config)
    if agent.online.values.shape != checkpoint.values.shape:
        raise ValueError(
            f"the checkpoint has {len(checkpoint.values)} parameters, the network {len(agent.online.values)}"
        )
    restore_checkpoint(agent, checkpoint)
    agent.decisions = checkpoint.decisions
    return agent


def restore_checkpoint(agent: DeepQAgent, checkpoint: Checkpoint) -> None:
    """Restore an agent's networks from a checkpoint of its size; raises ValueError if its normalizer makes no sense."""
    normalizer = None
    if checkpoint.normalizer is not None:
        normalizer = Normalizer(agent.num_features)
        try:
            normalizer.load(checkpoint.normalizer)
        except (KeyError, TypeError) as error:
            raise ValueError(f"the checkpoint's scale of observations: {problem_in(error)}") from error
    agent.restore(checkpoint.values, normalizer)
