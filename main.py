"""Open the game, or run one of its commands without a window."""

from __future__ import annotations

import argparse
import os
import sys
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from typing import NoReturn

from ai.command_line import folder, readable


def limit_threads() -> None:
    """Let linear algebra use one thread; call it before NumPy is imported, or it has no effect.

    The matrices are small: a second thread only gets in the way, of the window most of all. And the sums of a
    product that two threads share are rounded differently, so the same seed would give another network.
    """
    for library in ("OPENBLAS", "OMP", "MKL"):
        os.environ[f"{library}_NUM_THREADS"] = "1"


def main(argv: list[str] | None = None) -> int:
    """Run `tranquility` with these arguments and return the exit code."""
    limit_threads()
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


class _Parser(argparse.ArgumentParser):
    """A parser that complains in one line, and not in a page."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {readable(' '.join(message.split()))} (see {self.prog} --help)\n")


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="tranquility", description="Land on the moon by hand, by network, or share the stick.")
    parser.set_defaults(run=None)
    parser.add_argument("--version", action="version", version=_version())
    parser.add_argument("--user-dir", type=folder, metavar="DIR", help="where settings and networks are kept")
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
