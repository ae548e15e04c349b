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
    from ai.agent.agent import DeepQAgent
    from ai.copilot.measurement import AssistedFlights, Help

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
    table.add_argument("--anywhere", type=cli.folder, default=ANYWHERE_MODEL, metavar="DIR",
                       help="the co-pilot of the table in other worlds (default: anywhere)")  # fmt: skip
    table.add_argument("--episodes", type=int, default=ROW, help=f"flights for each row (default: {ROW})")
    table.add_argument("--assist", type=float, nargs="*", default=[], metavar="DIAL",
                       help="more settings of the guardian's dial, 0 to 1")  # fmt: skip
    table.add_argument("--seed", type=int, default=0)
    table.add_argument(
        "--good",
        choices=("network", "scripted"),
        default="network",
        help="whom the imperfect pilots are made of (default: the same network)",
    )
    table.add_argument("--pilot", type=Path, metavar="FILE", help="only a pilot of your own, over one pad and three")
    table.add_argument("--json", action="store_true", help="print one JSON object")
    table.add_argument("--workers", type=int, default=1, metavar="N", help="processes at once (default: 1)")
    table.set_defaults(run=_table)


def _lander(model: Path, envs: tuple[str, ...]) -> DeepQAgent:
    """Read the agent of a folder; raises ValueError for one of other environments, and as `load_agent`."""
    from ai.training.config import load_agent

    agent, config = load_agent(model)
    if config.env not in envs:
        raise ValueError(f"the co-pilot flies the lander; this network is for {config.env}")
    return agent


@cli.refusing
def _table(arguments: argparse.Namespace) -> int:
    from ai.copilot.copilot import Mode
    from ai.copilot.measurement import GUARD, HELPS, TABLES, seconds
    from ai.lander.pilots import ScriptedPilot
    from ai.sweep.shards import parts_of, results
    from ai.training.config import ANYWHERE, LANDER

    cli.check_ranges(arguments, episodes=cli.EPISODES, seed=cli.SEEDS, workers=cli.WORKERS)
    if not all(0 <= assist <= 1 for assist in arguments.assist):
        raise ValueError("the dial goes from 0 to 1")
    more = [(Mode.GUARDIAN, assist) for assist in arguments.assist]
    agent = _lander(arguments.model, (LANDER,))
    if arguments.pilot:
        return _told(arguments, _own(arguments, agent, [*HELPS, *more]))
    agents = {"one_pad": agent, "three_pads": agent, "other_worlds": _lander(arguments.anywhere, (ANYWHERE,))}
    flown, scripted = (arguments.episodes, arguments.seed), arguments.good == "scripted"
    models = {table: arguments.anywhere if table == "other_worlds" else arguments.model for table in agents}
    asked = parts_of(models, scripted, [*HELPS, *more], *flown)
    took = (
        sum(
            seconds(agent, ScriptedPilot() if scripted else agent, table, TABLES[table][1], help_, *flown)
            for table, agent in agents.items()
            for help_ in (GUARD, *more)
        )
        / arguments.workers
    )
    print(f"this takes about {max(took / 60, 0.1):.1f} minutes", file=sys.stderr)
    with cli.progress_bar(len(asked), "flying", unit="part") as bar:
        parts = results([part for _, part in asked], arguments.workers, bar.update)
    tables: dict[str, list[AssistedFlights]] = {}
    for (name, _), rows in zip(asked, parts, strict=True):
        tables.setdefault(name, []).extend(rows)
    return _told(arguments, tables)


def _own(arguments: argparse.Namespace, agent: DeepQAgent, helps: list[Help]) -> dict[str, list[AssistedFlights]]:
    """Return the tables of a player's file as the hands that are helped; raises ValueError if it fails."""
    from ai.copilot.measurement import rows
    from ai.pilots.own import MeasuredPilot

    with closing(MeasuredPilot(arguments.pilot)) as pilot:
        return {
            table: [
                replace(row, pilot=arguments.pilot.stem[:20])
                for row in rows(agent, pilot, table, ("good",), helps, arguments.episodes, arguments.seed)
            ]
            for table in ("one_pad", "three_pads")
        }


def _told(arguments: argparse.Namespace, tables: dict[str, list[AssistedFlights]]) -> int:
    if arguments.json:
        told = {name: [row.to_json() for row in table] for name, table in tables.items()}
        settings = {"good": arguments.good, "seed": arguments.seed, "episodes": arguments.episodes}
        print(json.dumps(settings | told, indent=2))
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
