"""Command-line commands of the game: to open it on a screen other than the menu, and to verify flights."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from game.core import texts

_FIRST: Final = "stack"


def add_commands(commands: Any) -> None:
    """Add the commands `physics` and `verify` to a parser's sub-commands."""
    physics = commands.add_parser("physics", help=texts.CLI_PHYSICS)
    names = sorted(texts.EXHIBITS)
    physics.add_argument("--exhibit", choices=names, default=_FIRST, help=texts.CLI_EXHIBIT.format(name=_FIRST))
    physics.set_defaults(run=open_physics)
    verify = commands.add_parser("verify", help=texts.CLI_VERIFY)
    verify.add_argument("files", nargs="+", type=Path, metavar="FILE", help=texts.CLI_VERIFY_FILES)
    verify.add_argument("--json", action="store_true", help=texts.CLI_VERIFY_JSON)
    verify.set_defaults(run=_verify)


def speak(parser: argparse.ArgumentParser, said: Callable[[str], str]) -> None:
    """Put what a parser and its sub-commands say of themselves into other words."""
    parser.description = parser.description and said(parser.description)
    for group in parser._action_groups:
        group.title = group.title and said(group.title)
    for action in parser._actions:
        action.help = action.help and said(action.help)
        if isinstance(action, argparse._SubParsersAction):
            for named in action._choices_actions:
                named.help = named.help and said(named.help)
            for each in action.choices.values():
                speak(each, said)


def open_physics(arguments: argparse.Namespace) -> int:
    """Open the window on the physics gallery, with the menu below it."""
    from game.core.scene import Route
    from game.start import play

    return play(arguments.user_dir, arguments.full_screen, begin=Route("physics", (arguments.exhibit,)))


def _verify(arguments: argparse.Namespace) -> int:
    from game.verify import verify

    return verify(arguments)
