"""The commands that need no window: train a lander, evaluate one.

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
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ai.config import Config
    from ai.training import Training


def add_commands(commands: Any) -> None:
    """Add `train` and `evaluate` to a parser's sub-commands."""
    train = commands.add_parser("train", help="teach a network to land")
    train.add_argument("--preset", default="modern", help="modern or classic (default: modern)")
    train.add_argument("--seed", type=int, default=0)
    train.add_argument("--seconds", type=float, help="stop after so many seconds")
    train.add_argument("--decisions", type=int, help="stop after so many decisions; the same seed, the same network")
    train.add_argument("--output", type=Path, metavar="DIR", help="where to keep the network")
    train.add_argument("--resume", type=Path, metavar="DIR", help="go on with what an earlier run kept there")
    train.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", dest="changes",
                       help="change a setting of the preset, such as --set n_step=5")  # fmt: skip
    train.set_defaults(run=_train)

    evaluate = commands.add_parser("evaluate", help="measure how well a network lands")
    evaluate.add_argument("--model", type=Path, required=True, metavar="DIR")
    evaluate.add_argument("--episodes", type=int, default=1000)
    evaluate.add_argument("--seed", type=int, default=0)
    evaluate.add_argument("--spawn", default="random", help="random or hard (default: random)")
    evaluate.add_argument("--json", action="store_true", help="print one JSON object")
    evaluate.set_defaults(run=_evaluate)


def _train(arguments: argparse.Namespace) -> int:
    from ai.runs import TrainingClock, resume_run, save_run
    from ai.training import Training

    if arguments.resume is None and arguments.output is None:
        return _fail("say where to keep the network: --output DIR, or --resume DIR")
    if arguments.seconds is None and arguments.decisions is None:
        return _fail("say when to stop: --seconds S or --decisions N")
    output = arguments.output or arguments.resume
    try:
        resumed = resume_run(arguments.resume) if arguments.resume else None
        training = resumed or Training(_config(arguments), arguments.seed)
    except ValueError as error:
        return _fail(str(error))
    clock = TrainingClock(arguments.seconds, arguments.decisions)
    try:
        _advance(training, clock, output)
    except FloatingPointError as error:
        save_run(training, output)
        return _fail(f"training stopped: {error}. What was best until then is kept in {output}.")
    except OSError as error:
        return _fail(f"could not write to {output}: {error.strerror or error}")
    try:
        save_run(training, output, final=True)
    except OSError as error:
        return _fail(f"could not write to {output}: {error.strerror or error}")
    best = training.best
    assert best is not None
    took = "" if best.mean_time is None else f", in {best.mean_time:.1f} s on average"
    print(f"kept in {output}: {best.success:.1%} of {best.episodes} validation flights landed{took}")
    return 0


def _advance(training: Training, clock: Any, output: Path) -> None:
    """Train until the clock or the user says stop, with a progress bar, keeping the work now and then."""
    from tqdm import tqdm

    from ai.runs import save_run

    form = "{desc} {percentage:3.0f}%|{bar}| {elapsed}<{remaining} {postfix}"
    with tqdm(total=1000, desc="training", bar_format=form, disable=None) as bar, _stoppable() as stop:
        for progress in clock.run(training):
            bar.update(int(clock.share * 1000) - bar.n)
            best = f" best {progress.best.success:.1%}" if progress.best else ""
            bar.set_postfix_str(
                f"landed {progress.success_rate:.0%} of the last 100, ε {progress.epsilon:.2f},"
                f" {progress.decisions:,} decisions{best}", refresh=False,
            )  # fmt: skip
            if clock.checkpoint_due():
                save_run(training, output)
            if stop:
                break


@contextmanager
def _stoppable() -> Iterator[list[bool]]:
    """Turn the first Ctrl-C into an entry of the list, so that a step and its save are never cut short."""
    stop: list[bool] = []
    before = signal.signal(signal.SIGINT, lambda *_: stop.append(True))
    try:
        yield stop
    finally:
        signal.signal(signal.SIGINT, before)


def _evaluate(arguments: argparse.Namespace) -> int:
    from ai.agent import DeepQAgent
    from ai.nn import ModelFormatError
    from ai.spawns import SPAWNS
    from ai.training import evaluate

    if arguments.episodes < 1:
        return _fail("--episodes starts from 1")
    if arguments.spawn not in SPAWNS:
        return _fail(f"--spawn is one of {', '.join(SPAWNS)}, not {arguments.spawn}")
    try:
        agent = DeepQAgent.load(arguments.model)
    except ModelFormatError as error:
        return _fail(str(error))
    result = evaluate(agent, arguments.episodes, arguments.seed, arguments.spawn, agent.config.frame_skip)
    if arguments.json:
        print(json.dumps(result.to_json(), indent=2))
        return 0
    for name, value in result.to_json().items():
        shown = (
            "–"
            if value is None
            else f"{value:.2%}"
            if name in ("success", "crash", "out_of_bounds", "time_out")
            else f"{value:.2f}"
        )
        print(f"{name.replace('_', ' '):14} {shown if name != 'episodes' else int(value)}")
    return 0


def _config(arguments: argparse.Namespace) -> Config:
    """Return the preset with the changes asked for; raises ValueError for one that makes no sense."""
    from ai.config import PRESETS

    if arguments.preset not in PRESETS:
        raise ValueError(f"--preset is one of {', '.join(PRESETS)}, not {arguments.preset}")
    changes = {}
    for change in arguments.changes:
        name, equals, text = change.partition("=")
        if not equals or name not in PRESETS["modern"].to_json():
            raise ValueError(f"--set takes NAME=VALUE with the name of a setting, not {change!r}")
        try:
            changes[name] = json.loads(text)
        except ValueError:
            changes[name] = text
    return PRESETS[arguments.preset].from_json(PRESETS[arguments.preset].to_json() | changes)


def _fail(message: str) -> int:
    print(message, file=sys.stderr)
    return 1
