"""Open the game, or run one of its commands without a window: `tranquility`, `python -m tranquility`.

Modules are imported as `engine`, `ai` and `game`. In a checkout these folders lie beside this one. In an installed
wheel they lie within it, so the wheel owns one top-level name; `find_own_folders` makes the imports work there.
"""

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

    The matrices are small: a second thread only gets in the way, of the window most of all. And the sums of a
    product that two threads share are rounded differently, so the same seed would give another network.
    """
    for library in ("OPENBLAS", "OMP", "MKL"):
        os.environ[f"{library}_NUM_THREADS"] = "1"


def find_own_folders() -> None:
    """Put the folders of this copy first on the path, before anything else that is called `ai` or `game`.

    Only for this process and those it starts: multiprocessing's `spawn` hands the path on.
    """
    own = Path(__file__).resolve().parent
    folder = str(own if (own / "engine").is_dir() else own.parent)
    if sys.path[:1] != [folder]:
        sys.path.insert(0, folder)


def main(argv: list[str] | None = None) -> int:
    """Run `tranquility` with these arguments and return the exit code."""
    limit_threads()
    find_own_folders()
    _forgive_terminals()
    try:
        arguments = _parser().parse_args(argv)
        code = _open_game(arguments) if arguments.run is None else int(arguments.run(arguments))
        if sys.stdout is not None:
            sys.stdout.flush()  # here, where it can still be said that it failed
        return code
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:  # whoever read has read enough, as `head` does
        _discard_output()
        return 141
    except OSError as error:
        if error.filename is not None:
            raise  # the matter of whoever opened that file
        _discard_output()
        print(f"tranquility: cannot write: {error.strerror or error}", file=sys.stderr)
        return 1


def _forgive_terminals() -> None:
    """Let letters that a terminal does not know come out as question marks, instead of ending the program."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")


def _discard_output() -> None:
    """Let what is still to be printed go nowhere, so that the interpreter does not stumble over it at its end."""
    void = os.open(os.devnull, os.O_WRONLY)
    os.dup2(void, sys.stdout.fileno())
    os.close(void)


def _parser() -> argparse.ArgumentParser:
    from ai.cli.command_line import Parser, folder  # once its folder has been found

    parser = Parser(prog="tranquility", description="Land on the moon by hand, by network, or share the stick.")
    parser.set_defaults(run=None)
    parser.add_argument("--version", action="version", version=_version())
    parser.add_argument("--user-dir", type=folder, metavar="DIR", help="where settings and networks are kept")
    screen = parser.add_mutually_exclusive_group()
    screen.add_argument("--windowed", dest="full_screen", action="store_false", default=None)
    screen.add_argument("--fullscreen", dest="full_screen", action="store_true", default=None)
    commands = parser.add_subparsers(title="commands", metavar="COMMAND")
    for module in ("game.cli", "ai.cli.lander", "ai.cli.digits", "ai.cli.copilot"):
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
    sys.exit(main())
