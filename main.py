"""Open the game, or run one of its commands without a window."""

from __future__ import annotations

import argparse
import os
import sys
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path


def limit_threads() -> None:
    """Let linear algebra use one thread; call it before NumPy is imported, or it has no effect.

    The matrices are small: a second thread only gets in the way, of the window most of all.
    """
    for library in ("OPENBLAS", "OMP", "MKL"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")


def main(argv: list[str] | None = None) -> int:
    """Run `tranquility` with these arguments and return the exit code."""
    limit_threads()
    arguments = _parser().parse_args(argv)
    try:
        if arguments.run is not None:
            return int(arguments.run(arguments))
        return _open_game(arguments)
    except KeyboardInterrupt:
        return 130


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="tranquility", description="Land on the moon by hand, by network, or share the stick."
    )
    parser.set_defaults(run=None)
    parser.add_argument("--version", action="version", version=_version())
    parser.add_argument("--user-dir", type=Path, metavar="DIR", help="where settings and networks are kept")
    screen = parser.add_mutually_exclusive_group()
    screen.add_argument("--windowed", dest="full_screen", action="store_false", default=None)
    screen.add_argument("--fullscreen", dest="full_screen", action="store_true", default=None)
    commands = parser.add_subparsers(title="commands", metavar="COMMAND")
    for module in ("game.cli", "ai.cli", "ai.digits_cli", "ai.copilot_cli"):
        if find_spec(module) is not None:
            import_module(module).add_commands(commands)
    return parser


def _version() -> str:
    try:
        return f"Tranquility {version('tranquility')}"
    except PackageNotFoundError:
        return "Tranquility, from a checkout"


def _open_game(arguments: argparse.Namespace) -> int:
    from game.start import play

    return play(arguments.user_dir, arguments.full_screen)


if __name__ == "__main__":
    if getattr(sys, "frozen", False):  # a packaged program is its own interpreter, also for the processes it starts
        from multiprocessing import freeze_support

        freeze_support()
    sys.exit(main())
