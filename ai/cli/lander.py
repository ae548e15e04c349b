"""The commands that need no window: train a network, evaluate one.

Nothing heavy is imported until a command runs, because the game reads this table too before it opens.
"""

from __future__ import annotations

import argparse
import json
import sys
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ai.cli.command_line import (
    EPISODES,
    REFUSED,
    SECONDS,
    SEEDS,
    configured,
    exit_code,
    fail,
    fail_diverged,
    folder,
    keep,
    keep_checkpoint,
    out_of_range,
    reason,
    refuse_fixed,
    stoppable,
)

if TYPE_CHECKING:
    from ai.agent.config import Config
    from ai.training.checkpoints import TrainingClock
    from ai.training.loop import Training
    from ai.training.task import Score

DECISIONS: Final = (1, 10**12)


def add_commands(commands: Any) -> None:
    """Add `train` and `evaluate` to a parser's sub-commands."""
    train = commands.add_parser("train", help="teach a network to land, or to master another environment")
    train.add_argument("--env", metavar="NAME",
                       help="an environment of Gymnasium, such as CartPole-v1 (default: our own lander)")  # fmt: skip
    train.add_argument("--preset", help="modern or classic (default: modern; for --env, settings of its own)")
    train.add_argument("--seed", type=int, help="what all chance follows from (default: 0)")
    train.add_argument("--seconds", type=float,
                       help="stop when the whole run, resumed or not, has trained for so many seconds")  # fmt: skip
    train.add_argument("--decisions", type=int,
                       help="stop when the whole run, resumed or not, has taken so many decisions; begun anew with"
                            " the same seed, it gives the same network")  # fmt: skip
    train.add_argument("--output", type=folder, metavar="DIR", help="where to keep the network")
    train.add_argument("--resume", type=folder, metavar="DIR",
                       help="go on with what an earlier run kept there, by its settings; --set and --preset may"
                            " change those that can change while a run goes on")  # fmt: skip
    train.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", dest="changes",
                       help="change a setting of the preset, such as --set n_step=5")  # fmt: skip
    train.add_argument("--validation", type=int, metavar="N", help="episodes that choose the best network")
    train.set_defaults(run=_train)

    evaluate = commands.add_parser("evaluate", help="measure how well a network does")
    evaluate.add_argument("--model", type=folder, required=True, metavar="DIR")
    evaluate.add_argument("--env", metavar="NAME", help="the environment, where its name is module:Name")
    evaluate.add_argument("--episodes", type=int, help="default: 1000 flights, or 100 episodes of another environment")
    evaluate.add_argument("--seed", type=int, default=0)
    evaluate.add_argument("--spawn", help="random or hard (default: random)")
    evaluate.add_argument("--json", action="store_true", help="print one JSON object")
    evaluate.set_defaults(run=_evaluate)


def _train(arguments: argparse.Namespace) -> int:
    from ai.agent.storage import KIND
    from ai.nn.folder import claimed_folder
    from ai.training.checkpoints import TrainingClock

    if arguments.resume is None and arguments.output is None:
        return fail("say where to keep the network: --output DIR, or --resume DIR")
    if arguments.seconds is None and arguments.decisions is None:
        return fail("say when to stop: --seconds S or --decisions N")
    problem = out_of_range(arguments, seed=SEEDS, seconds=SECONDS, decisions=DECISIONS, validation=EPISODES)
    if problem:
        return fail(problem)
    output = arguments.output or arguments.resume
    clock = TrainingClock(arguments.seconds, arguments.decisions)
    with ExitStack() as claims:
        try:
            training = _begun(arguments) if arguments.resume is None else _resumed(arguments)
            if clock.share(training) >= 1.0:
                raise ValueError(
                    f"this run has taken {training.agent.decisions:,} decisions in {training.seconds:,.1f} seconds"
                    " already; --decisions and --seconds are of the whole run: ask for more"
                )
            claims.enter_context(claimed_folder(output, KIND))
        except REFUSED as error:
            return fail(reason(error))
        return _keep_training(training, clock, output)


def _begun(arguments: argparse.Namespace) -> Training:
    """Return a new run; raises what `task_of` raises, and ValueError for settings that make no sense."""
    from ai.training.loop import Training

    return Training(_config(arguments), arguments.seed or 0, validation_episodes=arguments.validation)


def _resumed(arguments: argparse.Namespace) -> Training:
    """Return the run to go on with, its live settings changed as asked; raises ValueError where they are not live."""
    from ai.training.checkpoints import resume_run

    training = resume_run(arguments.resume, env=arguments.env)
    wanted = _config(arguments, training.config)
    refuse_fixed(training.config, wanted, training.seed, arguments.seed)
    training.apply_live(wanted)
    if arguments.validation is not None:
        training.validation_episodes = arguments.validation
    return training


def _keep_training(training: Training, clock: TrainingClock, output: Path) -> int:
    """Train, keep what comes of it, and return the exit code."""
    from ai.training.checkpoints import save_run

    stopped = ""
    try:
        with stoppable() as stop:
            try:
                _advance(training, clock, output, stop)
            except FloatingPointError as error:
                stopped = f"training stopped: {error}. "
                training.restore_best()
            # Save before measuring, which takes seconds: the user may stop the program meanwhile.
            output, _ = keep(partial(save_run, training), output)
        if not stopped:
            output, _ = keep(partial(save_run, training, final=True), output)
    except OSError as error:
        return fail(f"{stopped}could not write to {output}: {error.strerror or error}")
    except ValueError as error:
        return fail(f"{stopped}Nothing new is kept in {output}: {error}")
    if stopped:
        return fail_diverged(stopped, output, measured=training.best is not None)
    print(f"kept in {output}: {training.best}")
    return exit_code(stop)


def _advance(training: Training, clock: TrainingClock, output: Path, stop: list[int]) -> None:
    """Train until the clock or the user says stop, with a progress bar, keeping the work now and then."""
    from tqdm import tqdm

    from ai.agent.config import LANDER
    from ai.training.checkpoints import save_run

    lander, trouble = training.config.env == LANDER, ""
    form = "{desc} {percentage:3.0f}%|{bar}| {elapsed}<{remaining} {postfix}"
    with tqdm(total=1000, desc="training", bar_format=form, disable=None) as bar:
        for progress in clock.run(training):
            bar.update(int(clock.share(training) * 1000) - bar.n)
            best = f" best {progress.best.figure}" if progress.best else ""
            recent = f"landed {progress.success_rate:.0%}" if lander else f"return {progress.mean_return:.1f}, mean"
            bar.set_postfix_str(
                f"{recent} of the last 100, ε {progress.epsilon:.2f},"
                f" {progress.decisions:,} decisions{best}", refresh=False,
            )  # fmt: skip
            if stop:
                break
            if clock.checkpoint_due():
                new = keep_checkpoint(partial(save_run, training), output)
                if new and new != trouble:
                    bar.write(new, file=sys.stderr)
                trouble = new


def _evaluate(arguments: argparse.Namespace) -> int:
    from ai.agent.agent import DeepQAgent
    from ai.agent.config import LANDER
    from ai.lander.spawns import SPAWNS
    from ai.training.loop import evaluate
    from ai.training.tasks import task_of

    spawn, episodes = "random" if arguments.spawn is None else arguments.spawn, arguments.episodes
    if problem := out_of_range(arguments, episodes=EPISODES, seed=SEEDS):
        return fail(problem)
    if spawn not in SPAWNS:
        return fail(f"--spawn is one of {', '.join(SPAWNS)}, not {spawn}")
    try:
        agent = DeepQAgent.load(arguments.model, env=arguments.env)
        task = task_of(agent.config)
        if (agent.num_features, agent.num_actions) != (task.num_features, task.num_actions):
            raise ValueError(f"the network in {arguments.model} is not made for {agent.config.env}")
    except REFUSED as error:
        return fail(reason(error))
    episodes = episodes or task.test_episodes
    if agent.config.env == LANDER:
        score: Score = evaluate(agent, episodes, arguments.seed, spawn, agent.config.frame_skip)
    elif arguments.spawn is None:
        score = task.evaluate(agent, episodes, arguments.seed)
    else:
        return fail(f"--spawn is for the lander; this network is for {agent.config.env}")
    if arguments.json:
        print(json.dumps(score.to_json(), indent=2))
        return 0
    for name, value in score.to_json().items():
        print(f"{name.replace('_', ' '):14} {_shown(name, value)}")
    return 0


def _shown(name: str, value: float | None) -> str:
    if value is None:
        return "–"
    if name in ("success", "crash", "out_of_bounds", "time_out"):
        return f"{value:.2%}"
    return str(value) if isinstance(value, int) else f"{value:.2f}"


def _config(arguments: argparse.Namespace, begun: Config | None = None) -> Config:
    """Return the preset, or the settings a run was begun with, with the changes asked for.

    Raises ValueError for a change that makes no sense.
    """
    from ai.agent.config import LANDER, PRESETS

    env: str = arguments.env if arguments.env is not None else begun.env if begun else LANDER
    if arguments.preset is not None and arguments.preset not in PRESETS:
        raise ValueError(f"--preset is one of {', '.join(PRESETS)}, not {arguments.preset}")
    if arguments.preset is not None:
        preset = PRESETS[arguments.preset].changed(env=env)
    elif begun is not None:
        preset = begun.changed(env=env)
    elif env != LANDER:
        from ai.training.gym_task import gym_config

        preset = gym_config(env)
    else:
        preset = PRESETS["modern"]
    return configured(preset, arguments.changes)
