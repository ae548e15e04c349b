"""Open the game, or run one of its commands without a window: `tranquility`, `python -m tranquility`.

Modules are imported as `engine`, `ai` and `game`. In a checkout these folders lie beside this one. In an installed
wheel they lie within it, so the wheel owns one top-level name; `find_own_folders` makes the imports work there.

Nothing is imported here that Python has not loaded by itself: until `main` runs, Ctrl-C would end in a traceback.
"""

from __future__ import annotations

import os
import sys

TYPE_CHECKING = False  # typing's own is late, too
if TYPE_CHECKING:
    import argparse


def limit_threads() -> None:
    """Let linear algebra use one thread; call it before NumPy is imported, or it has no effect.

    The matrices are small: a second thread only takes time from the window. And the sums of a
    matrix product divided between threads are rounded differently, so the same seed would give another network.
    """
    for library in ("OPENBLAS", "OMP", "MKL"):
        os.environ[f"{library}_NUM_THREADS"] = "1"


def find_own_folders() -> None:
    """Put the folders of this copy first on the path, before anything else that is called `ai` or `game`.

    This holds only for this process and its children, to which multiprocessing's `spawn` passes the path.
    """
    from pathlib import Path

    own = Path(__file__).resolve().parent
    folder = str(own if (own / "engine").is_dir() else own.parent)
    if sys.path[:1] != [folder]:
        sys.path.insert(0, folder)


def main(argv: list[str] | None = None) -> int:
    """Run `tranquility` with these arguments and return the exit code."""
    try:
        limit_threads()
        find_own_folders()
        _open_streams()
        arguments = _parser().parse_args(argv)
        code = _open_game(arguments) if arguments.run is None else int(arguments.run(arguments))
        sys.stdout.flush()  # here, where a failure can still be reported
        return code
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:  # the reader has closed the pipe, as `head` does
        _discard_output()
        return 141
    except OSError as error:
        if error.filename is not None:
            raise  # another file's error, not the output's
        _discard_output()
        print(f"tranquility: cannot write: {error.strerror or error}", file=sys.stderr)
        return 1
    except RuntimeError as error:  # what Python makes of Ctrl-C while a class of a module is made
        if isinstance(error.__cause__, KeyboardInterrupt):
            return 130
        raise


def _open_streams() -> None:
    """Open closed standard streams to nowhere, or the next file would take their place, and what is printed with it.

    Characters outside a terminal's encoding are printed as question marks, instead of raising an error.
    """
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, os.fdopen(os.open(os.devnull, os.O_RDWR), mode, encoding="utf-8", closefd=False))
        elif mode == "w" and hasattr(getattr(sys, name), "reconfigure"):
            getattr(sys, name).reconfigure(errors="replace")


def _discard_output() -> None:
    """Redirect remaining output to nowhere, so that the interpreter's final flush does not fail."""
    void = os.open(os.devnull, os.O_WRONLY)
    os.dup2(void, sys.stdout.fileno())
    os.close(void)


def _parser() -> argparse.ArgumentParser:
    from importlib import import_module
    from importlib.util import find_spec

    from ai.cli.command_line import Parser, folder  # imported after `find_own_folders`

    parser = Parser(prog="tranquility", description="Land on the moon by hand, by network, or share the stick.")
    parser.set_defaults(run=None)
    parser.add_argument("--version", action="version", version=_version())
    parser.add_argument("--user-dir", type=folder, metavar="DIR", help="where settings and networks are kept")
    screen = parser.add_mutually_exclusive_group()
    screen.add_argument("--windowed", dest="full_screen", action="store_false", default=None)
    screen.add_argument("--fullscreen", dest="full_screen", action="store_true", default=None)
    commands = parser.add_subparsers(title="commands", metavar="COMMAND")
    for module in ("game.cli", "ai.cli.train", "ai.cli.evaluate", "ai.cli.sweep"):
        if find_spec(module) is not None:
            import_module(module).add_commands(commands)
    return parser


def _version() -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return f"Tranquility {version('tranquility-lander')}"
    except PackageNotFoundError:
        return "Tranquility, from a checkout"


def _open_game(arguments: argparse.Namespace) -> int:
    from game.start import play

    return play(arguments.user_dir, arguments.full_screen)


if __name__ == "__main__":
    sys.exit(main())
