"""Shared parts of the commands without a window: errors in one sentence, ranges of options, an orderly stop."""

from __future__ import annotations

import argparse
import json
import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import wraps
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any, Final, NoReturn, TypeVar

if TYPE_CHECKING:
    from ai.files.knobs import Knobs

    Settings = TypeVar("Settings", bound=Knobs)

Command = Callable[[argparse.Namespace], int]
FAILED: Final = 1
LONGEST: Final = 400  # letters of a printed line: text from a file or an argument may be of any length
SEEDS: Final = (0, 2**63 - 1)
SECONDS: Final = (0.001, 1e9)
EPISODES: Final = (1, 50_000)  # all are flown at once, in 5 KB each
_ASKED: Final = 5  # times that a program is asked to end before it does so in the midst of what it does
_REQUESTS: Final = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")  # signals that ask a program to end

# Errors of reading a path or settings that the user has named. A loop of links and JSON that is nested too deeply
# are RuntimeErrors.
REFUSED: Final = (OSError, ValueError, OverflowError, RuntimeError, ImportError, MemoryError)


class Parser(argparse.ArgumentParser):
    """Argument parser that reports an error in one line, not in a page."""

    def error(self, message: str) -> NoReturn:
        """Say what is wrong with the arguments, and end the program with exit code 2."""
        self.exit(2, f"{self.prog}: {readable(' '.join(message.split()))} (see {self.prog} --help)\n")


def report(message: str) -> None:
    """Print to standard error, if anybody still listens."""
    with suppress(OSError):
        print("\n".join(readable(line) for line in message.splitlines()), file=sys.stderr)


def fail(message: str) -> int:
    """Say what went wrong, and return the exit code of a failure."""
    report(message)
    return FAILED


def say(line: str) -> None:
    """Print a line with a name in it that may be anything."""
    print(readable(line))


def readable(line: str, longest: int = LONGEST) -> str:
    """Return a line without its middle, if it is too long, and with control characters escaped."""
    short = line if len(line) <= longest else f"{line[: LONGEST - 100]} ... {line[-90:]}"
    return "".join(letter if letter.isprintable() else ascii(letter)[1:-1] for letter in short)


def folder(text: str) -> Path:
    """Return the path of a folder that the user named; raises ArgumentTypeError for one that cannot be, or be shown."""
    from ai.files.reading import CONTROLS

    try:
        os.fsencode(text)
        named = not CONTROLS.search(text) and text.strip() != "" and Path(text).resolve().name != ""
    except (ValueError, RuntimeError):  # characters that no file system takes, a loop of links
        named = False
    except OSError:  # opening it will report what is wrong
        named = True
    if not named:
        raise argparse.ArgumentTypeError(f"{text!r} cannot be the path of a folder")
    return Path(text)


def reason(error: BaseException) -> str:
    """Say why something was refused, without the numbers and names that only help a programmer.

    Of somebody else's code that has failed, those go to a log.
    """
    from ai.environment import ForeignEnvError

    if isinstance(error, ForeignEnvError) and error.__cause__ is not None:
        return f"{error}{_logged(error.__cause__)}"
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}" if error.filename else error.strerror
    if isinstance(error, MemoryError):
        return "there is not enough memory for that"
    if isinstance(error, RecursionError):
        return "a file or a setting is nested too deeply"
    return str(error) or type(error).__name__


def _logged(error: BaseException) -> str:
    """Write where an error comes from to the log of environments, if that can be; return words that name the file."""
    import traceback

    from ai.files.folder import user_dir
    from ai.files.writing import write_text

    path = user_dir() / "environment.log"
    try:
        write_text(path, "".join(traceback.format_exception(error)))
    except (OSError, ValueError):
        return ""
    return f" (its traceback is in {path})"


def refusing(command: Command) -> Command:
    """Return a command that says in a sentence why it refused what the user has named, and ends with a failure."""

    @wraps(command)
    def run(arguments: argparse.Namespace) -> int:
        try:
            return command(arguments)
        except REFUSED as error:
            if isinstance(error, OSError) and error.errno is not None and error.filename is None:
                raise  # it could not be written, which is reported for all commands alike
            return fail(reason(error))

    return run


def check_ranges(arguments: argparse.Namespace, **ranges: tuple[float, float]) -> None:
    """Raise ValueError for an option outside its range; both ends are inside, NaN never is."""
    for name, (low, high) in ranges.items():
        value = getattr(arguments, name, None)
        if value is not None and not low <= value <= high:
            raise ValueError(f"--{name.replace('_', '-')} lies between {low:,} and {high:,}, and was {value}")


def configured(preset: Settings, given: list[str]) -> Settings:
    """Return the preset with some settings changed, each as NAME=VALUE; raises ValueError for nonsense."""
    values = preset.to_json()
    for change, (name, value) in zip(given, named_values("--set", given), strict=False):
        if name not in values:
            raise ValueError(f"--set takes NAME=VALUE with the name of a setting, not {change!r}")
        parts = isinstance(value, dict) and isinstance(values[name], dict)  # those not named stay as they are
        values[name] = values[name] | value if parts else value
    return preset.from_json(values)


def named_values(option: str, given: list[str]) -> Iterator[tuple[str, Any]]:
    """Yield names and values of an option that takes NAME=VALUE: a value in JSON, or else a text."""
    for change in given:
        name, equals, text = change.partition("=")
        if not equals or not name:
            raise ValueError(f"{option} takes NAME=VALUE, not {change!r}")
        try:
            value = json.loads(text)
        except RecursionError:
            raise ValueError(f"{option} {name}: that is nested too deeply") from None
        except ValueError:
            value = text
        yield name, value


def env_arguments(before: str, given: list[str]) -> str:
    """Return arguments of an environment as its settings hold them, with those given in place of the ones before."""
    arguments = dict(named_values("--env-set", given))
    return json.dumps(json.loads(before or "{}") | arguments, sort_keys=True, allow_nan=False) if arguments else before


@contextmanager
def stoppable(*names: str) -> Iterator[list[int]]:
    """Collect Ctrl-C and termination signals in the list, so that they never cut short a step or its save.

    An entry is the number of a signal; `names` are of other signals to collect in place of these. A hang-up that is
    ignored (nohup) is none. Meant for the main thread; afterwards, signals do what they did before. Whoever asks again
    and again is heard at once, by a KeyboardInterrupt: somebody else's code may never come back.
    """
    stop: list[int] = []
    terminals, hang_up = [number for number in (1, 2) if os.isatty(number)], getattr(signal, "SIGHUP", None)

    def note(number: int, _: FrameType | None) -> None:
        stop.append(number)
        if len(stop) >= _ASKED:
            raise KeyboardInterrupt
        if number == hang_up:  # writing to terminals that are closed would fail
            void = os.open(os.devnull, os.O_WRONLY)
            for terminal in terminals:
                os.dup2(void, terminal)
            os.close(void)

    numbers = [getattr(signal, name) for name in names or _REQUESTS if hasattr(signal, name)]
    kept = [number for number in numbers if number != hang_up or signal.getsignal(number) is not signal.SIG_IGN]
    before = {number: signal.signal(number, note) for number in kept}
    try:
        yield stop
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def exit_code(stop: list[int]) -> int:
    """Return the exit code of a run that ended well: 0, also by Ctrl-C, or 128 and the signal that ended it."""
    return 128 + stop[0] if stop and stop[0] != signal.SIGINT else 0
