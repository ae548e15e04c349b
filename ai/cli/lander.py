"""The commands that need no window: train a network, evaluate one.

Nothing heavy is imported until a command runs, because the game reads this table too before it opens.
"""

from __future__ import annotations

import argparse
import json
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ai.cli.command_line import (
    EPISODES,
    REFUSED,
    SECONDS,
    SEEDS,
    WORKERS,
    add_where,
    configured,
    fail,
    folder,
    out_of_range,
    progress_bar,
    reason,
)
from ai.cli.training_run import RunCommand, add_run_options, train

if TYPE_CHECKING:
    from ai.agent.agent import DeepQAgent
    from ai.training.config import Config
    from ai.training.loop import Progress
    from ai.training.tasks import Score, Task

DECISIONS: Final = (1, 10**12)
FLIGHTS: Final = (1, 10**8)


def add_commands(commands: Any) -> None:
    """Add `train` and `evaluate` to a parser's sub-commands."""
    teach = commands.add_parser("train", help="teach a network to land, or to master another environment")
    teach.add_argument(
        "--env", metavar="NAME", help="an environment of Gymnasium, such as CartPole-v1 (default: our own lander)"
    )
    teach.add_argument(
        "--preset",
        help="modern, classic or anywhere, which lands on any world (default: modern; for --env, settings of its own)",
    )
    teach.add_argument(
        "--seconds", type=float, help="stop when the whole run, resumed or not, has trained for so many seconds"
    )
    teach.add_argument(
        "--decisions",
        type=int,
        help="stop when the whole run, resumed or not, has taken so many decisions; begun anew with"
        " the same seed, it gives the same network",
    )
    add_run_options(teach, "n_step=5")
    teach.add_argument("--validation", type=int, metavar="N", help="episodes that choose the best network")
    teach.set_defaults(run=_train)

    evaluate = commands.add_parser("evaluate", help="measure how well a network does")
    evaluate.add_argument("--model", type=folder, required=True, metavar="DIR")
    evaluate.add_argument("--env", metavar="NAME", help="the environment, where its name is module:Name")
    evaluate.add_argument("--episodes", type=int, help="default: 1000 flights, or 100 episodes of another environment")
    evaluate.add_argument("--seed", type=int, default=0)
    evaluate.add_argument("--spawn", help="random or hard (default: random)")
    evaluate.add_argument("--json", action="store_true", help="print one JSON object")
    add_where(evaluate, "processes at once (default: this one alone)")
    evaluate.set_defaults(run=_evaluate)


def _train(arguments: argparse.Namespace) -> int:
    from ai.training.checkpoints import AGENTS, resume_run
    from ai.training.config import ANYWHERE, LANDER
    from ai.training.loop import Training
    from ai.training.run import Limit

    if arguments.resume is None and arguments.output is None:
        return fail("say where to keep the network: --output DIR, or --resume DIR")
    if arguments.seconds is None and arguments.decisions is None:
        return fail("say when to stop: --seconds S or --decisions N")
    problem = out_of_range(arguments, seed=SEEDS, seconds=SECONDS, decisions=DECISIONS, validation=EPISODES)
    if problem:
        return fail(problem)

    def begin(config: Config, seed: int) -> Training:
        return Training(config, seed, validation_episodes=arguments.validation)

    def resume(folder: Path) -> Training:
        training = resume_run(folder, env=arguments.env)
        if arguments.validation is not None:
            training.validation_episodes = arguments.validation
        return training

    def used_up(training: Training) -> str:
        return (
            f"this run has taken {training.moment:,} decisions in {training.seconds:,.1f} seconds"
            " already; --decisions and --seconds are of the whole run: ask for more"
        )

    def shown(progress: Progress) -> str:
        best = f" best {progress.best.figure}" if progress.best else ""
        lander = progress.env in (LANDER, ANYWHERE)
        recent = f"landed {progress.success_rate:.0%}" if lander else f"return {progress.mean_return:.1f}, mean"
        return f"{recent} of the last 100, ε {progress.epsilon:.2f}, {progress.decisions:,} decisions{best}"

    return train(arguments, RunCommand(
        AGENTS, partial(config_of, arguments), begin, resume, Limit(arguments.seconds, arguments.decisions), used_up,
        shown, lambda training, _: str(training.best),
    ))  # fmt: skip


def _evaluate(arguments: argparse.Namespace) -> int:
    from ai.common.intervals import wilson
    from ai.lander.spawns import SPAWNS
    from ai.training.config import LANDER

    spawn, episodes = "random" if arguments.spawn is None else arguments.spawn, arguments.episodes
    if problem := out_of_range(arguments, episodes=FLIGHTS, seed=SEEDS, workers=WORKERS):
        return fail(problem)
    if spawn not in SPAWNS:
        return fail(f"--spawn is one of {', '.join(SPAWNS)}, not {spawn}")
    try:
        agent, task, env = _agent_and_task(arguments)
    except REFUSED as error:
        return fail(reason(error))
    episodes = episodes or task.test_episodes
    spread = arguments.address is not None or arguments.workers is not None
    if env == LANDER:
        try:
            score: Score = _flown(arguments, agent, episodes, spawn)
        except REFUSED as error:
            return fail(reason(error))
    elif spread or episodes > EPISODES[1]:
        return fail(f"--address, --workers and more than {EPISODES[1]:,} episodes are for the lander on the moon")
    elif arguments.spawn is None:
        score = task.evaluate(agent, episodes, arguments.seed)
    else:
        return fail(f"--spawn is for the lander on the moon; this network is for {env}")
    told: dict[str, Any] = score.to_json()
    if score.success is not None:
        told["success_interval"] = wilson(score.success, score.episodes)
    if arguments.json:
        print(json.dumps(told, indent=2))
        return 0
    low, high = told.pop("success_interval", (0.0, 0.0))
    for name, value in told.items():
        interval = f" (95%: {low:.2%} to {high:.2%})" if name == "success" and value is not None else ""
        print(f"{name.replace('_', ' '):14} {_shown(name, value)}{interval}")
    return 0


def _agent_and_task(arguments: argparse.Namespace) -> tuple[DeepQAgent, Task[Any], str]:
    """Read the network, what it is measured by, and its environment; raises ValueError where they do not fit."""
    from ai.training.config import load_agent
    from ai.training.loop import task_of

    agent, config = load_agent(arguments.model, env=arguments.env)
    env = config.env
    if arguments.env not in (None, env):
        raise ValueError(f"the network in {arguments.model} is for {env}, not for {arguments.env}")
    task = task_of(config)
    if (agent.num_features, agent.num_actions) != (task.num_features, task.num_actions):
        raise ValueError(f"the network in {arguments.model} is not made for {env}")
    return agent, task, env


def _flown(arguments: argparse.Namespace, agent: DeepQAgent, episodes: int, spawn: str) -> Score:
    """Fly the flights, in shards; on several processes if that is asked for. Raises what `ai.sweep.cluster` raises."""
    from ai.sweep.shards import flown_shards, shards

    parts = shards(agent, episodes, arguments.seed, spawn)
    with progress_bar(episodes, "flying", unit="flight", disable=True if len(parts) == 1 else None) as bar:
        for sums in flown_shards(parts, arguments.address, arguments.workers or 1):
            if sums is not None:
                return sums.evaluation()
            bar.update(episodes / len(parts))
    raise AssertionError("an evaluation has one part or more")


def _shown(name: str, value: float | None) -> str:
    if value is None:
        return "–"
    if name in ("success", "crash", "out_of_bounds", "time_out"):
        return f"{value:.2%}"
    return str(value) if isinstance(value, int) else f"{value:.2f}"


def config_of(arguments: argparse.Namespace, begun: Config | None = None) -> Config:
    """Return the preset, or the settings a run was begun with, with the changes asked for.

    Raises ValueError for a change that makes no sense.
    """
    from ai.training.config import ANYWHERE, LANDER, LANDS_ANYWHERE, PRESETS

    presets = {**PRESETS, "anywhere": LANDS_ANYWHERE}
    if arguments.preset is not None and arguments.preset not in presets:
        raise ValueError(f"--preset is one of {', '.join(presets)}, not {arguments.preset}")
    usual = presets[arguments.preset or "modern"].env
    env: str = arguments.env if arguments.env is not None else begun.env if begun else usual
    if arguments.preset is not None:
        preset = presets[arguments.preset].changed(env=env)
    elif begun is not None:
        preset = begun.changed(env=env)
    elif env == ANYWHERE:
        preset = LANDS_ANYWHERE
    elif env != LANDER:
        from ai.training.config import gym_config

        preset = gym_config(env)
    else:
        preset = PRESETS["modern"]
    return configured(preset, arguments.changes)
