"""The commands that need no window: train a network, evaluate one.

Nothing heavy is imported until a command runs, because the game reads this table too before it opens.
"""

from __future__ import annotations

import argparse
import json
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from ai.config import Config
    from ai.digit_config import DigitConfig
    from ai.task import Score
    from ai.training import Training

    Settings = TypeVar("Settings", Config, DigitConfig)


def add_commands(commands: Any) -> None:
    """Add `train` and `evaluate` to a parser's sub-commands."""
    train = commands.add_parser("train", help="teach a network to land, or to master another environment")
    train.add_argument("--env", default="lander", metavar="NAME",
                       help="an environment of Gymnasium, such as CartPole-v1 (default: our own lander)")  # fmt: skip
    train.add_argument("--preset", help="modern or classic (default: modern; for --env, settings of its own)")
    train.add_argument("--seed", type=int, default=0)
    train.add_argument("--seconds", type=float, help="stop after so many seconds")
    train.add_argument("--decisions", type=int, help="stop after so many decisions; the same seed, the same network")
    train.add_argument("--output", type=Path, metavar="DIR", help="where to keep the network")
    train.add_argument("--resume", type=Path, metavar="DIR", help="go on with what an earlier run kept there")
    train.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", dest="changes",
                       help="change a setting of the preset, such as --set n_step=5")  # fmt: skip
    train.add_argument("--validation", type=int, metavar="N", help="episodes that choose the best network")
    train.set_defaults(run=_train)

    evaluate = commands.add_parser("evaluate", help="measure how well a network does")
    evaluate.add_argument("--model", type=Path, required=True, metavar="DIR")
    evaluate.add_argument("--env", metavar="NAME", help="the environment, where its name is module:Name")
    evaluate.add_argument("--episodes", type=int, help="default: 1000 flights, or 100 episodes of another environment")
    evaluate.add_argument("--seed", type=int, default=0)
    evaluate.add_argument("--spawn", help="random or hard (default: random)")
    evaluate.add_argument("--json", action="store_true", help="print one JSON object")
    evaluate.set_defaults(run=_evaluate)


def _train(arguments: argparse.Namespace) -> int:
    from ai.agent import KIND
    from ai.nn.folder import claimed_folder
    from ai.runs import resume_run
    from ai.training import Training

    if arguments.resume is None and arguments.output is None:
        return fail("say where to keep the network: --output DIR, or --resume DIR")
    if arguments.seconds is None and arguments.decisions is None:
        return fail("say when to stop: --seconds S or --decisions N")
    output = arguments.output or arguments.resume
    try:
        resumed = resume_run(arguments.resume, env=arguments.env) if arguments.resume else None
        training = resumed or Training(_config(arguments), arguments.seed)
        training.validation_episodes = arguments.validation or training.validation_episodes
    except (ValueError, ImportError) as error:
        return fail(str(error))
    try:
        with claimed_folder(output, KIND):
            return _train_into(output, training, arguments)
    except FileExistsError as error:
        return fail(str(error))
    except OSError as error:
        return fail(f"could not write to {output}: {error.strerror or error}")


def _train_into(output: Path, training: Training, arguments: argparse.Namespace) -> int:
    """Train, and keep the network in a folder that nobody else trains into."""
    from ai.nn.folder import free_folder
    from ai.runs import TrainingClock, save_run

    clock = TrainingClock(arguments.seconds, arguments.decisions)
    try:
        _advance(training, clock, output)
    except FloatingPointError as error:
        save_run(training, output)
        return fail(f"training stopped: {error}. What was best until then is kept in {output}.")
    except OSError as error:
        return fail(f"could not write to {output}: {error.strerror or error}")
    try:
        save_run(training, output, final=True)
    except FileExistsError as error:  # something else was put there meanwhile, and neither is to be lost
        print(error, file=sys.stderr)
        output = free_folder(output)
        save_run(training, output, final=True)
    except OSError as error:
        return fail(f"could not write to {output}: {error.strerror or error}")
    print(f"kept in {output}: {training.best}")
    return 0


def _advance(training: Training, clock: Any, output: Path) -> None:
    """Train until the clock or the user says stop, with a progress bar, keeping the work now and then."""
    from tqdm import tqdm

    from ai.config import LANDER
    from ai.runs import save_run

    lander = training.config.env == LANDER
    form = "{desc} {percentage:3.0f}%|{bar}| {elapsed}<{remaining} {postfix}"
    with tqdm(total=1000, desc="training", bar_format=form, disable=None) as bar, stoppable() as stop:
        for progress in clock.run(training):
            bar.update(int(clock.share * 1000) - bar.n)
            best = f" best {progress.best.figure}" if progress.best else ""
            recent = f"landed {progress.success_rate:.0%}" if lander else f"return {progress.mean_return:.1f}, mean"
            bar.set_postfix_str(
                f"{recent} of the last 100, ε {progress.epsilon:.2f},"
                f" {progress.decisions:,} decisions{best}", refresh=False,
            )  # fmt: skip
            if clock.checkpoint_due():
                save_run(training, output)
            if stop:
                break


@contextmanager
def stoppable() -> Iterator[list[bool]]:
    """Turn the first Ctrl-C into an entry of the list, so that a step and its save are never cut short."""
    stop: list[bool] = []
    before = signal.signal(signal.SIGINT, lambda *_: stop.append(True))
    try:
        yield stop
    finally:
        signal.signal(signal.SIGINT, before)


def _evaluate(arguments: argparse.Namespace) -> int:
    from ai.agent import DeepQAgent
    from ai.config import LANDER
    from ai.nn import ModelFormatError
    from ai.spawns import SPAWNS
    from ai.task import task_of
    from ai.training import evaluate

    spawn, episodes = arguments.spawn or "random", arguments.episodes
    if episodes is not None and episodes < 1:
        return fail("--episodes starts from 1")
    if spawn not in SPAWNS:
        return fail(f"--spawn is one of {', '.join(SPAWNS)}, not {spawn}")
    try:
        agent = DeepQAgent.load(arguments.model, env=arguments.env)
        task = task_of(agent.config)
        if (agent.num_features, agent.num_actions) != (task.num_features, task.num_actions):
            raise ValueError(f"the network in {arguments.model} is not made for {agent.config.env}")
    except (ModelFormatError, ValueError, ImportError) as error:
        return fail(str(error))
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


def _config(arguments: argparse.Namespace) -> Config:
    """Return the preset with the changes asked for; raises ValueError for one that makes no sense."""
    from ai.config import LANDER, PRESETS

    if arguments.preset is None and arguments.env != LANDER:
        from ai.gym_task import gym_config

        preset = gym_config(arguments.env)
    elif (arguments.preset or "modern") in PRESETS:
        preset = PRESETS[arguments.preset or "modern"].changed(env=arguments.env)
    else:
        raise ValueError(f"--preset is one of {', '.join(PRESETS)}, not {arguments.preset}")
    return configured(preset, arguments.changes)


def configured(preset: Settings, given: list[str]) -> Settings:
    """Return the preset with some settings changed, each as NAME=VALUE; raises ValueError for nonsense."""
    changes = {}
    for change in given:
        name, equals, text = change.partition("=")
        if not equals or name not in preset.to_json():
            raise ValueError(f"--set takes NAME=VALUE with the name of a setting, not {change!r}")
        try:
            changes[name] = json.loads(text)
        except ValueError:
            changes[name] = text
    return preset.from_json(preset.to_json() | changes)


def fail(message: str) -> int:
    """Say what went wrong, and return the exit code of a failure."""
    print(message, file=sys.stderr)
    return 1
