"""Command-line commands of the game: to open it on a screen other than the menu, and to verify flights."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, Final

from game.core import texts

_FIRST: Final = "stack"


def add_commands(commands: Any) -> None:
    """Add the commands `physics` and `verify` to a parser's sub-commands."""
    physics = commands.add_parser("physics", help="open the gallery of physics")
    names = sorted(texts.EXHIBITS)
    physics.add_argument("--exhibit", choices=names, default=_FIRST, help=f"what to begin with (default: {_FIRST})")
    physics.set_defaults(run=open_physics)
    verify = commands.add_parser("verify", help="fly recorded flights again, and print what each really earned")
    files = "a flight's file, a text with codes of flights, a folder of such files, or - for standard input"
    verify.add_argument("files", nargs="+", type=Path, metavar="FILE", help=files)
    verify.add_argument("--json", action="store_true", help="print one JSON object")
    verify.set_defaults(run=_verify)


def open_physics(arguments: argparse.Namespace) -> int:
    """Open the window on the physics gallery, with the menu below it."""
    from game.core.scene import Route
    from game.start import play

    return play(arguments.user_dir, arguments.full_screen, begin=Route("physics", (arguments.exhibit,)))


def _verify(arguments: argparse.Namespace) -> int:
    from game.verify import verify

    return verify(arguments)
