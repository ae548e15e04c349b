"""The command that measures the co-pilot. Nothing heavy is imported until it runs."""

from __future__ import annotations

import argparse
import json
import sys
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ai.cli import command_line as cli

if TYPE_CHECKING:
    from ai.copilot.measurement import AssistedFlights

ROW: Final = 2  # flights: more of them take longer than five minutes
_MODELS: Final = Path(__file__).parents[2] / "models" / "lander"
MODEL: Final = _MODELS / "modern"
ANYWHERE_MODEL: Final = _MODELS / "anywhere"
_TITLES: Final = {
    "one_pad": "One pad",
    "three_pads": "Three pads, one of them meant",
    "other_worlds": "In other worlds",
}


def add_commands(commands: Any) -> None:
    """Add `copilot-table` to a parser's sub-commands."""
    table = commands.add_parser("copilot-table", help="measure how much the co-pilot helps good and bad pilots")
    table.add_argument("--model", type=cli.folder, default=MODEL, metavar="DIR", help="the co-pilot (default: modern)")
    table.add_argument("--episodes", type=int, default=ROW, help=f"flights for each row (default: {ROW})")
    table.add_argument("--seed", type=int, default=0)
    table.add_argument("--pilot", type=Path, metavar="FILE", help="only a pilot of your own, over one pad and three")
    table.add_argument("--json", action="store_true", help="print one JSON object")
    table.add_argument("--workers", type=int, default=1, metavar="N", help="processes at once (default: 1)")
    table.set_defaults(run=_table)


@cli.refusing
def _table(arguments: argparse.Namespace) -> int:
    from ai.copilot.measurement import HELPS, rows
    from ai.pilots.own import MeasuredPilot
    from ai.sweep.shards import parts_of, results
    from ai.training.config import LANDER, load_agent

    cli.check_ranges(arguments, episodes=cli.EPISODES, seed=cli.SEEDS, workers=cli.WORKERS)
    agent, config = load_agent(arguments.model)
    if config.env != LANDER:
        raise ValueError(f"the co-pilot flies the lander; this network is for {config.env}")
    flown = arguments.episodes, arguments.seed
    tables: dict[str, list[AssistedFlights]] = {}
    if arguments.pilot:
        with closing(MeasuredPilot(arguments.pilot)) as pilot:
            for name in ("one_pad", "three_pads"):
                found = rows(agent, pilot, name, ("good",), HELPS, *flown)
                tables[name] = [replace(row, pilot=arguments.pilot.stem[:20]) for row in found]
    else:
        models = {name: ANYWHERE_MODEL if name == "other_worlds" else arguments.model for name in _TITLES}
        asked = parts_of(models, HELPS, *flown)
        with cli.progress_bar(len(asked), "flying", unit="part") as bar:
            parts = results([part for _, part in asked], arguments.workers, bar.update)
        for (name, _), found in zip(asked, parts, strict=True):
            tables.setdefault(name, []).extend(found)
    if arguments.json:
        listed = {name: [row.to_json() for row in table] for name, table in tables.items()}
        print(json.dumps({"seed": arguments.seed, "episodes": arguments.episodes} | listed, indent=2))
    else:
        for name, table in tables.items():
            _show(_TITLES[name], table, own=name == "three_pads")
    return 0


def _show(title: str, rows: list[AssistedFlights], own: bool = False) -> None:
    head = (
        f"{'pilot':22}{'help':20}{'landed':>8}{'95% interval':>18}{'crash':>8}{'gone':>8}{'time out':>10}"
        f"{'overridden':>12}{'plan held':>11}{'and lost':>10}"
    )
    print(f"\n{title}\n{head}" + (f"{'own pad':>9}" if own else ""))
    for row in rows:
        help_ = row.mode if row.assist == 0.0 else f"{row.mode} {row.assist:.2f}"
        low, high = row.success_interval
        line = (
            f"{row.pilot:22}{help_:20}{row.success:8.1%}{f'{low:.1%} to {high:.1%}':>18}{row.crash:8.1%}"
            f"{row.out_of_bounds:8.1%}{row.time_out:10.1%}{row.overridden:12.1%}{row.held:11.1%}{row.lost_held:10.1%}"
        )
        print(line + (f"{row.own_pad:9.1%}" if own else ""))
    sys.stdout.flush()
