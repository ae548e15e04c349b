"""Command-line commands that open the game on a screen other than the menu."""

from __future__ import annotations

import argparse
from typing import Any, Final

from game.core import texts

_FIRST: Final = "stack"


def add_commands(commands: Any) -> None:
    """Add the command `physics` to a parser's sub-commands."""
    physics = commands.add_parser("physics", help=texts.CLI_PHYSICS)
    names = sorted(texts.EXHIBITS)
    physics.add_argument("--exhibit", choices=names, default=_FIRST, help=texts.CLI_EXHIBIT.format(name=_FIRST))
    physics.set_defaults(run=open_physics)


def open_physics(arguments: argparse.Namespace) -> int:
    """Open the window on the physics gallery, with the menu below it."""
    from game.core.scene import Route
    from game.start import play

    return play(arguments.user_dir, arguments.full_screen, begin=Route("physics", (arguments.exhibit,)))
