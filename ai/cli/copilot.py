"""The command that measures the co-pilot. Nothing heavy is imported until it runs."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ai.cli.command_line import EPISODES, REFUSED, SEEDS, fail, folder, out_of_range, reason

if TYPE_CHECKING:
    from ai.copilot.measurement import AssistedFlights

MODEL: Final = Path(__file__).parents[2] / "models" / "lander" / "modern"


def add_commands(commands: Any) -> None:
    """Add `copilot-table` to a parser's sub-commands."""
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
    table.set_defaults(run=_table)


def _table(arguments: argparse.Namespace) -> int:
    from tqdm import tqdm

    from ai.agent.agent import DeepQAgent
    from ai.agent.config import LANDER
    from ai.copilot.measurement import INTENT_PILOTS, ONE_PAD, PILOTS, THREE_PADS, one_pad, three_pads
    from ai.lander.pilots import Pilot, ScriptedPilot

    if problem := out_of_range(arguments, episodes=EPISODES, seed=SEEDS):
        return fail(problem)
    try:
        agent = DeepQAgent.load(arguments.model)
    except REFUSED as error:
        return fail(reason(error))
    if agent.config.env != LANDER:
        return fail(f"the co-pilot flies the lander; this network is for {agent.config.env}")
    good: Pilot = ScriptedPilot() if arguments.good == "scripted" else agent
    tables: dict[str, list[AssistedFlights]] = {"one_pad": [], "three_pads": []}
    rows = len(PILOTS) * len(ONE_PAD) + 1 + len(INTENT_PILOTS) * len(THREE_PADS)
    with tqdm(total=rows, desc="flying", unit="row", disable=None) as bar:
        for name, fly in (("one_pad", one_pad), ("three_pads", three_pads)):
            for row in fly(agent, good, arguments.episodes, arguments.seed):
                tables[name].append(row)
                bar.update()
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
        f"\n{title}\n{'pilot':10}{'help':25}{'success':>8}{'crash':>8}{'gone':>8}{'time out':>9}{'return':>8}"
        f"{'overridden':>12}{'own pad':>9}"[: None if own else -9]
    )
    for row in rows:
        help_ = row.mode if row.assist == 0.0 else f"{row.mode} {row.assist:.1f}"
        line = (
            f"{row.pilot:10}{help_:25}{row.success:8.1%}{row.crash:8.1%}{row.out_of_bounds:8.1%}"
            f"{row.time_out:9.1%}{row.mean_return:8.1f}{row.overridden:12.1%}"
        )
        print(line + (f"{row.own_pad:9.1%}" if own else ""))
    sys.stdout.flush()
