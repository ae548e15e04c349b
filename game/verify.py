"""The command `verify`: flights of files and codes are flown again, many at once, and what each earned is printed.

It opens no window and loads no pygame.
"""

from __future__ import annotations

import argparse
import errno
import json
import sys
from collections.abc import Callable, Iterator
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any, Final

from ai.cli.command_line import readable
from ai.files.reading import brief, read_text
from ai.flights.code import codes_in
from ai.flights.recording import ClaimedFlight
from ai.flights.verification import Earned, is_true, verified
from game.core import texts
from game.flight import codes

_LARGEST: Final = 64_000_000  # bytes of a file
_STDIN: Final = Path("-")
_PORTION: Final = 4_096  # flights that are held at a time, whatever the number of all
_SUFFIXES: Final = (".json", ".txt")  # of what is read in a folder


def verify(arguments: argparse.Namespace) -> int:
    """Print what every flight really earned; return 0 if all claims are true, 1 if one is wrong or refused."""
    counts = {"true": 0, "wrong": 0, "refused": 0}
    listed: list[dict[str, Any]] = []
    flights = _flights(arguments.files)
    while portion := list(islice(flights, _PORTION)):
        sound = [flight for _, flight in portion if isinstance(flight, ClaimedFlight)]
        real = dict(verified(sound))
        number = 0
        for place, flight in portion:
            if isinstance(flight, ClaimedFlight):
                row, line = _judged(place, flight, real[number])
                number += 1
            else:
                row, line = _refused(place, flight)
            counts[row["verdict"]] += 1
            if arguments.json:
                listed.append(row)
            else:
                print(readable(line))
    if arguments.json:
        print(json.dumps({"flights": listed, **counts}, indent=1))
    else:
        print(texts.VERIFY_SUM.format(**counts), file=sys.stderr if counts["true"] == 0 else sys.stdout)
    return int(counts["true"] == 0 or counts["wrong"] + counts["refused"] > 0)


def _judged(place: str, flight: ClaimedFlight, real: Earned) -> tuple[dict[str, Any], str]:
    """Return a flight's row and its line."""
    claim, true = flight.claim, is_true(flight, real)
    row = {
        "place": place, "verdict": "true" if true else "wrong", "where": codes.where(flight),
        "outcome": real.outcome.name, "points": real.points, "medal": real.medal, "seconds": round(real.seconds, 3),
        "fuel": round(real.fuel, 3), "claimed": {"outcome": claim.outcome.name, "points": claim.points},
    }  # fmt: skip
    if not true:
        row["why"] = codes.why_wrong(flight, real)
    verdict = texts.VERIFY_TRUE if true else texts.VERIFY_WRONG.format(why=row["why"])
    words = codes.words(real)
    return row, texts.VERIFY_LINE.format(place=place, where=row["where"], earned=words, verdict=verdict)


def _refused(place: str, why: str) -> tuple[dict[str, Any], str]:
    why = brief(why)
    return {"place": place, "verdict": "refused", "reason": why}, texts.VERIFY_REFUSED.format(place=place, reason=why)


def _flights(paths: list[Path]) -> Iterator[tuple[str, ClaimedFlight | str]]:
    """Yield every flight, or why it is refused, and its place: the file, and the number of its code there."""
    for path in paths:
        if path == _STDIN:
            yield from _flights_in(_STDIN, _piped_in)
            continue
        try:
            files = _files(path)
        except OSError as error:
            yield str(path), error.strerror or str(error)
            continue
        for file in files:
            yield from _flights_in(file, partial(read_text, file, _LARGEST))


def _piped_in() -> str:
    held = sys.stdin.buffer.read(_LARGEST + 1)
    if len(held) > _LARGEST:
        raise OSError(errno.EFBIG, f"is larger than the {_LARGEST:,} bytes that there can be")
    return held.decode("utf-8")


def _files(path: Path) -> list[Path]:
    """Return the files that a path names: itself, or all in a folder that may hold flights."""
    if not path.is_dir():
        return [path]
    return sorted(file for file in path.iterdir() if file.suffix in _SUFFIXES and file.is_file())


def _flights_in(file: Path, read: Callable[[], str]) -> Iterator[tuple[str, ClaimedFlight | str]]:
    try:
        text = read()
    except OSError as error:
        yield str(file), error.strerror or str(error)
        return
    except UnicodeDecodeError:
        yield str(file), texts.CODE_REFUSED["none"]
        return
    alone = len(list(islice(codes_in(text), 2))) < 2
    for number, flight in enumerate(codes.flights_in(text), 1):
        yield str(file) if alone else f"{file}:{number}", flight
