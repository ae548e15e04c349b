"""Runs on disk, of agents and of digits: saved, and gone on with; checkpoints to fly."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from ai.agent.agent import DeepQAgent
from ai.agent.normalizer import Normalizer
from ai.agent.storage import KIND, LAST, write_agent
from ai.digits.checkpoints import read_settings
from ai.digits.checkpoints import snapshot as digit_snapshot
from ai.digits.classifier import KIND as DIGITS_KIND
from ai.digits.training import DigitTraining
from ai.files import count_of, inside, number_of, problem_in, read_json
from ai.files.knobs import nearest_preset
from ai.lander.environment import NUM_ACTIONS, NUM_FEATURES
from ai.nn import ModelFormatError
from ai.training.config import Config, load_agent, presets_of
from ai.training.history import Checkpoint
from ai.training.loop import Training
from ai.training.run import TRAINING_FILE, RunKind
from ai.training.state import StateWriter, going_on, read_state
from ai.training.tasks import TEST_SEED


def snapshot(training: Training, final: bool = False) -> tuple[dict[str, Any], Callable[[Path], None]]:
    """Return what a run's training file says now, and what writes its networks as they are now into a new folder.

    One that has not been evaluated yet has its latest network for its best. This measures nothing: the clock may
    decide when it is called, but never which network is best. But a `final` one considers the latest network for the
    best too, and measures the best one on test spawns, which neither trained nor chose it.
    """
    if final:
        training.conclude()
    agent, config = training.agent, training.config
    presets = {name: preset.to_json() for name, preset in presets_of(config.env).items()}
    described = {
        "env": config.env,
        **nearest_preset(config.to_json(), presets),
        "seed": training.seed,
        "decisions": agent.decisions,
        "updates": agent.gradient_steps,
        "episodes": training.episodes,
        "landings": training.env.landings,
        "seconds": round(training.seconds, 3),
        "best": training.best.to_json() if training.best else None,
    }
    best, last = training.best_agent(), training.last_agent()

    def write(folder: Path) -> None:
        write_agent(best, folder)
        write_agent(last, folder / LAST)

    if final:
        described["evaluation"] = training.task.evaluate(best, training.task.test_episodes, TEST_SEED).to_json()
    return described, write


def resume_run(folder: str | Path, *, env: str | None = None) -> Training:
    """Resume a run of an agent: the very same, if its state lies beside its folder, else with an empty memory.

    `Training.lost` says what is missing. Raises ModelFormatError for anything else. `env` is the environment as the
    user names it, without which "module:Name" is refused: see `load_agent`.
    """
    folder = Path(folder)
    best, _ = load_agent(folder, env=env)
    try:
        last, config = load_agent(inside(folder, LAST), env=env)
        training = _begun(config, best, last, read_json(inside(folder, TRAINING_FILE)))
    except OSError as error:
        raise ModelFormatError(folder, [f"{Path(error.filename or LAST).name}: {error.strerror or error}"]) from error
    except ModelFormatError:
        raise
    except (KeyError, TypeError, ValueError, ArithmeticError) as error:
        raise ModelFormatError(folder, [f"{TRAINING_FILE}: {problem_in(error)}"]) from error
    state = read_state(folder, last.decisions)
    with going_on(folder):
        if state is None or not training.load_state(state, folder):
            training.lost = "its state is not there, so it goes on with an empty memory"
            return training
    training.states = StateWriter(folder, state)
    return training


def _begun(config: Config, best: DeepQAgent, last: DeepQAgent, described: Any) -> Training:
    """Return a run as its folder describes it; raises KeyError, TypeError or ValueError where it makes no sense."""
    training = Training(config, count_of(described["seed"], most=10**40))
    for agent in (best, last):
        if (agent.num_features, agent.num_actions) != (training.task.num_features, training.task.num_actions):
            raise ValueError(f"its network is not made for {config.env}")
    if described["best"] is not None:
        if best.network.values.shape != training.agent.network.values.shape:
            raise ValueError("the best network and the last one are of different sizes")
        training.best = training.task.read_score(described["best"])
        training.best_values, training.best_normalizer = best.network.values.copy(), best.normalizer
    training.episodes, training.env.landings = count_of(described["episodes"]), count_of(described["landings"])
    training.seconds = float(number_of(described["seconds"], 0))
    training.agent.copy_from(last)
    return training


def resume_digit_run(folder: str | Path, *, env: str | None = None, **options: Any) -> DigitTraining:  # noqa: ARG001
    """Resume an unfinished run that was kept, the very same; raises ModelFormatError for anything else."""
    folder = Path(folder)
    config, seed, step = read_settings(folder)
    try:
        training = DigitTraining(config, seed, **options)
    except (ValueError, OverflowError) as error:
        raise ModelFormatError(folder, [str(error)]) from error
    state = read_state(folder, step)
    if state is None:
        raise ModelFormatError(folder, ["there is nothing to go on with: the run is finished, or its state is gone"])
    with going_on(folder):
        training.load_state(state)
        training.around, training.states = state.get("around", {}), StateWriter(folder, state)
    return training


AGENTS: Final = RunKind(Training, resume_run, KIND, snapshot)
DIGITS: Final = RunKind(DigitTraining, resume_digit_run, DIGITS_KIND, digit_snapshot)


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
