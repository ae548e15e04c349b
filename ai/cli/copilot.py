"""The commands of the co-pilot: train a guardian, measure it. Nothing heavy is imported until one runs."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ai.cli.command_line import (
    EPISODES,
    REFUSED,
    SEEDS,
    WORKERS,
    add_where,
    exit_code,
    fail,
    folder,
    out_of_range,
    progress_bar,
    reason,
    say,
    stoppable,
)

if TYPE_CHECKING:
    from ai.agent.agent import DeepQAgent
    from ai.copilot.measurement import AssistedFlights

ROUNDS: Final = 80
ROUNDS_ALLOWED: Final = (7, 1000)
MODEL: Final = Path(__file__).parents[2] / "models" / "lander" / "modern"


def add_commands(commands: Any) -> None:
    """Add `train-guardian` and `copilot-table` to a parser's sub-commands."""
    guardian = commands.add_parser("train-guardian", help="train the safety critic of a lander's network")
    guardian.add_argument("--model", type=folder, default=MODEL, metavar="DIR",
                          help="the network, which gets its guardian in a folder within (default: modern)")  # fmt: skip
    guardian.add_argument("--rounds", type=int, default=ROUNDS, help=f"rounds of flights (default: {ROUNDS})")
    guardian.add_argument("--replace", action="store_true", help="put it in the place of the guardian it has")
    guardian.add_argument("--seed", type=int, default=0)
    guardian.set_defaults(run=_train_guardian)
    table = commands.add_parser("copilot-table", help="measure how much the co-pilot helps good and bad pilots")
    table.add_argument("--model", type=folder, default=MODEL, metavar="DIR", help="the co-pilot (default: modern)")
    table.add_argument("--episodes", type=int, default=1000, help="flights for each row (default: 1000)")
    table.add_argument("--seed", type=int, default=0)
    table.add_argument(
        "--good",
        choices=("network", "scripted"),
        default="network",
        help="whom the imperfect pilots are made of (default: the same network)",
    )
    table.add_argument("--json", action="store_true", help="print one JSON object")
    add_where(table, "processes at once (default: this one alone)")
    table.set_defaults(run=_table)


def _train_guardian(arguments: argparse.Namespace) -> int:
    import numpy as np

    from ai.agent.config import ANYWHERE, LANDER
    from ai.agent.storage import GUARDIAN
    from ai.copilot.critic_training import CriticTraining

    if problem := out_of_range(arguments, rounds=ROUNDS_ALLOWED, seed=SEEDS):
        return fail(problem)
    if not arguments.replace and (arguments.model / GUARDIAN).exists():
        return fail(f"{arguments.model} has a guardian already; --replace puts the new one in its place")
    try:
        training = CriticTraining(
            _lander(arguments.model, (LANDER, ANYWHERE)), np.random.default_rng(arguments.seed), arguments.rounds
        )
        with (
            stoppable() as stop,
            progress_bar(arguments.rounds, "training", unit="round") as bar,
        ):
            for progress in training.run():
                bar.update(progress.round - bar.n)
                bar.set_postfix_str(f"{progress.moments:,} moments, {progress.right:.1%} right", refresh=False)
                if stop:
                    return exit_code(stop)
        training.critic.save(arguments.model / GUARDIAN)
    except REFUSED as error:
        return fail(reason(error))
    facts = training.critic.facts
    say(f"kept in {arguments.model / GUARDIAN}, learnt from {facts.moments:,} moments; of moments not learnt from")
    print(f"{'chance it gave':>16}{'saved':>9}{'moments':>10}")
    for row in facts.reliability:
        print(f"{row.said:16.1%}{row.saved:9.1%}{row.moments:10,}")
    return 0


def _lander(model: Path, envs: tuple[str, ...]) -> DeepQAgent:
    """Read the agent of a folder; raises ValueError for one of other environments, and as `DeepQAgent.load`."""
    from ai.agent.agent import DeepQAgent

    agent = DeepQAgent.load(model)
    if agent.config.env not in envs:
        raise ValueError(f"the co-pilot flies the lander; this network is for {agent.config.env}")
    return agent


def _table(arguments: argparse.Namespace) -> int:
    from ai.agent.config import LANDER
    from ai.sweep.cluster import each
    from ai.sweep.copilot_table import fly, parts, tables_of

    if problem := out_of_range(arguments, episodes=EPISODES, seed=SEEDS, workers=WORKERS):
        return fail(problem)
    done: dict[int, list[AssistedFlights]] = {}
    try:
        agent = _lander(arguments.model, (LANDER,))
        asked = parts(agent, arguments.good == "scripted", arguments.episodes, arguments.seed)
        with progress_bar(len(asked), "flying", unit="part") as bar:
            for index, rows in each(fly, asked, arguments.address, arguments.workers or 1):
                done[index] = rows
                bar.update()
    except REFUSED as error:
        return fail(reason(error))
    tables = tables_of(asked, done)
    if arguments.json:
        told = {name: [row.to_json() for row in table] for name, table in tables.items()}
        settings = {"good": arguments.good, "seed": arguments.seed, "episodes": arguments.episodes}
        print(json.dumps(settings | told, indent=2))
    else:
        _show("One pad", tables["one_pad"])
        _show("Three pads, one of them meant", tables["three_pads"], own=True)
    return 0


def _show(title: str, rows: list[AssistedFlights], own: bool = False) -> None:
    print(
        f"\n{title}\n{'pilot':18}{'help':25}{'success':>8}{'95% interval':>16}{'crash':>8}{'gone':>8}{'time out':>9}"
        f"{'return':>8}{'overridden':>12}{'own pad':>9}"[: None if own else -9]
    )
    for row in rows:
        help_ = row.mode if row.assist == 0.0 else f"{row.mode} {row.assist:.1f}"
        low, high = row.success_interval
        line = (
            f"{row.pilot:18}{help_:25}{row.success:8.1%}{f'{low:.1%} to {high:.1%}':>16}{row.crash:8.1%}"
            f"{row.out_of_bounds:8.1%}{row.time_out:9.1%}{row.mean_return:8.1f}{row.overridden:12.1%}"
        )
        print(line + (f"{row.own_pad:9.1%}" if own else ""))
    sys.stdout.flush()
