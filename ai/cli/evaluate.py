"""The commands that measure a network: `evaluate` and `evaluate-digits`. Nothing heavy is imported until one runs."""

from __future__ import annotations

import argparse
import json
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ai.cli import command_line as cli

if TYPE_CHECKING:
    from ai.training.tasks import Score, Trial

_SHARES: Final = ("success", "crash", "out_of_bounds", "time_out")


def add_commands(commands: Any) -> None:
    """Add `evaluate` and `evaluate-digits` to a parser's sub-commands."""
    land = commands.add_parser("evaluate", help="measure how well a network does")
    read = commands.add_parser("evaluate-digits", help="measure how well a network reads MNIST's test images")
    land.add_argument("--env", metavar="NAME", help="the environment, where its name is module:Name")
    land.add_argument("--episodes", type=int, help="default: 1000 flights, or 100 episodes of another environment")
    land.add_argument("--seed", type=int, default=0)
    land.add_argument("--frame-skip", type=int, metavar="N", help="steps that a decision is held (default: as trained)")
    land.add_argument("--spawn", help="random or hard (default: random)")
    flown = land.add_mutually_exclusive_group(required=True)
    flown.add_argument("--pilot", type=Path, metavar="FILE", help="a pilot of your own in place of a network")
    for command, run in ((land, _evaluate), (read, _evaluate_digits)):
        model = flown if command is land else command
        model.add_argument("--model", type=cli.folder, required=command is read, metavar="DIR")
        command.add_argument("--json", action="store_true", help="print one JSON object")
        command.set_defaults(run=run)


@cli.refusing
def _evaluate(arguments: argparse.Namespace) -> int:
    from ai.lander.spawns import SPAWNS
    from ai.training.statistics import wilson

    cli.check_ranges(arguments, episodes=cli.EPISODES, seed=cli.SEEDS, frame_skip=(1, 100))
    if arguments.spawn not in (None, *SPAWNS):
        raise ValueError(f"--spawn is one of {', '.join(SPAWNS)}, not {arguments.spawn}")
    score = _own(arguments) if arguments.pilot else _score(arguments)
    values: dict[str, Any] = score.to_json()
    if score.success is not None:
        values["success_interval"] = wilson(score.success, score.episodes)
    if arguments.json:
        print(json.dumps(values, indent=2))
        return 0
    low, high = values.pop("success_interval", (0.0, 0.0))
    for name, value in values.items():
        if value is None or isinstance(value, int):
            figure = "–" if value is None else str(value)
        else:
            figure = f"{value:.2%}" if name in _SHARES else f"{value:.2f}"
        interval = f" (95%: {low:.2%} to {high:.2%})" if name == "success" and value is not None else ""
        print(f"{name.replace('_', ' '):14} {figure}{interval}")
    return 0


def _score(arguments: argparse.Namespace) -> Score:
    """Measure a network; raises ValueError for options that do not fit its environment."""
    from ai.training.config import LANDER, load_agent
    from ai.training.loop import task_of
    from ai.training.tasks import flights

    agent, config = load_agent(arguments.model, env=arguments.env)
    if arguments.env not in (None, config.env):
        raise ValueError(f"the network in {arguments.model} is for {config.env}, not for {arguments.env}")
    task = task_of(config)
    if (agent.num_features, agent.num_actions) != (task.num_features, task.num_actions):
        raise ValueError(f"the network in {arguments.model} is not made for {config.env}")
    episodes = arguments.episodes or task.test_episodes
    if config.env == LANDER:
        skip = arguments.frame_skip or config.frame_skip
        return _finished(flights(agent, episodes, arguments.seed, arguments.spawn or "random", skip))
    if arguments.spawn is not None:
        raise ValueError(f"--spawn is for the lander on the moon; this network is for {config.env}")
    return _finished(task.trial(agent, episodes, arguments.seed, arguments.frame_skip))


def _finished(trial: Trial[Score]) -> Score:
    """Take a measurement to its end; a signal that asks the program to end is heard between two decisions."""
    with cli.stoppable() as stop:
        try:
            while not stop:
                next(trial)
        except StopIteration as done:
            score: Score = done.value
            return score
        except ValueError:
            if not stop:  # else it only ends what is to end
                raise
        finally:
            trial.close()
    raise SystemExit(128 + stop[0])


def _own(arguments: argparse.Namespace) -> Score:
    """Fly the flights with a player's file, all at once; raises ValueError for what is wrong with it."""
    from ai.pilots.own import MeasuredPilot
    from ai.training.tasks import LanderTask, flights

    if arguments.env is not None:
        raise ValueError("--env is for networks")
    with closing(MeasuredPilot(arguments.pilot)) as pilot:
        episodes = arguments.episodes or LanderTask.test_episodes
        return _finished(
            flights(pilot, episodes, arguments.seed, arguments.spawn or "random", arguments.frame_skip or 4)
        )


@cli.refusing
def _evaluate_digits(arguments: argparse.Namespace) -> int:
    from ai.digits.classifier import DigitClassifier
    from ai.digits.mnist import TEST, load_part
    from ai.digits.training import confusion

    classifier = DigitClassifier.load(arguments.model)
    images, labels = load_part(TEST)
    table = confusion(labels, classifier.predict(images).argmax(axis=1))
    right, shown = table.diagonal(), table.sum(axis=1)
    accuracy = int(right.sum()) / len(labels)
    if arguments.json:
        by_digit = (right / shown).tolist()
        measured = {"accuracy": accuracy, "images": len(labels), "by_digit": by_digit, "confusion": table.tolist()}
        print(json.dumps(measured))
        return 0
    print(f"read right  {accuracy:.2%} of {len(labels):,}")
    print("drawn       read as" + "".join(f"{digit:>5}" for digit in range(len(table))))
    for digit, row in enumerate(table):
        print(f"{digit:>5} {right[digit] / shown[digit]:>11.2%} " + "".join(f"{count:>5}" for count in row))
    return 0
