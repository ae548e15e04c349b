"""Command-line commands that open the game on a screen other than the menu."""

from __future__ import annotations

import argparse
from typing import Any

from game.core import texts


def add_commands(commands: Any) -> None:
    """Add the command `physics` to a parser's sub-commands."""
    physics = commands.add_parser("physics", help=texts.CLI_PHYSICS)
    names = list(texts.EXHIBITS)
    physics.add_argument("--exhibit", choices=names, default=names[0], help=texts.CLI_EXHIBIT.format(name=names[0]))
    physics.set_defaults(run=open_physics)


def open_physics(arguments: argparse.Namespace) -> int:
    """Open the window on the physics gallery, with the menu below it."""
    from game.core.scene import Route
    from game.start import play

    return play(arguments.user_dir, arguments.full_screen, begin=Route("physics", (arguments.exhibit,)))
