"""Code of a flight, short enough for a message: `tranq4-`, base64, `-over`.

It stands for deflated bytes and their checksum. The bytes are start and claim as one line of JSON, a byte for each run
of equal steps, and for a flight by sticks the moves of both. docs/codes.md describes them.
"""

from __future__ import annotations

import base64
import json
import re
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby
from typing import Annotated, Final

import numpy as np

from ai.files.reading import parse_json
from ai.files.schema import OneOf, Sized, Within, read_as
from ai.flights.recording import LONGEST, Claim, ClaimedFlight, LegAsList, Recording, Start, StickHolder
from ai.flights.verification import COURSES
from ai.lander.environment import Outcome
from ai.lander.push import KEYS, STEPS, Push

VERSION: Final = 4
BEGIN, END = f"tranq{VERSION}-", "-over"
_LONGEST_TEXT: Final = 1_000_000  # characters of a text in which codes are looked for
_LARGEST: Final = 4 * LONGEST  # bytes that a code may unfold to: several for each step
_SIGNS: Final = b"+."  # base64's last two: unlike others, no messenger takes them for formatting
_ALIEN: Final = re.compile(r"[^0-9A-Za-z+.-]+")
_CODE: Final = re.compile(r"tranq(\d{0,3})-((?:(?!tranq\d{0,3}-)[0-9A-Za-z+.])*)(-over)?")
_FAR: Final = 10**6  # metres
_GRID: Final = 10_000  # parts of a metre and a radian in which the last pose is given
_LONGEST_NAME: Final = 40  # characters
_HELD: Final = 6 * len(StickHolder)  # an action, and who holds the stick
_RUN: Final = 21  # steps of a run, at most: a run fits a byte below _MOVES
_MOVES: Final = b"\xff"  # comes before the moves of the sticks
# What deflating takes to have been said before: words of some codes, and how most of them begin.
_USUAL: Final = (
    b'"daily","wind","rung_"pads":3,"wider_pads":true,"untimed":true},"leg":[2,12.5,false]'
    b'"outcome":"CRASHED","points":0,"end":[-{"seed":1,"spawn":"random","pads":1,"mission":"",'
    b'"easing":{"wider_pads":false,"untimed":false},"leg":null,"course":"","barred":"","outcome":"LANDED",'
    b'"points":9'
)

_Tenth = Annotated[int, Within(-_FAR * _GRID, _FAR * _GRID)]


class CodeError(ValueError):
    """A code is refused; `kind` says why, a key of `texts.CODE_REFUSED`."""

    def __init__(self, kind: str) -> None:
        self.kind = kind
        super().__init__(f"a code is refused: {kind}")


@dataclass(kw_only=True)
class _Content(Start):
    """What a code says besides the inputs."""

    leg: LegAsList
    outcome: Annotated[str, OneOf(Outcome.__members__)]
    points: Annotated[int, Within(0, 10**6)]
    end: tuple[_Tenth, _Tenth, _Tenth]
    course: Annotated[str, OneOf(COURSES)]
    barred: Annotated[str, Sized(_LONGEST_NAME)]


def code_of(flight: ClaimedFlight) -> str:
    """Return the code of a flight."""
    recording, claim = flight.recording, flight.claim
    end = [round(_GRID * min(max(number, -_FAR), _FAR)) for number in claim.end]
    values = recording.start() | {"course": flight.course, "barred": flight.barred[:_LONGEST_NAME]}
    values |= {"outcome": claim.outcome.name, "points": claim.points, "end": end}
    packer = zlib.compressobj(9, wbits=-zlib.MAX_WBITS, memLevel=9, zdict=_USUAL)
    data = packer.compress(json.dumps(values, separators=(",", ":")).encode() + b"\n" + _packed(recording))
    data += packer.flush()
    return f"{BEGIN}{_spelt(data + zlib.crc32(data).to_bytes(4, 'big'))}{END}"


def _spelt(data: bytes) -> str:
    return base64.b64encode(data, _SIGNS).decode().rstrip("=")


def _packed(recording: Recording) -> bytes:
    """Return the inputs of all steps: runs of equal ones, and how far the sticks moved in each step."""
    pushes, moves = recording.pushes, b""
    by_keys = all(push in KEYS for push in pushes)
    if not by_keys:
        moves = _MOVES + np.diff(np.array(pushes, np.int8), axis=0, prepend=np.int8(0)).T.tobytes()
    held = [
        push.action * by_keys + 6 * (hand is StickHolder.NETWORK)
        for push, hand in zip(pushes, recording.hands, strict=True)
    ]
    runs = ((each, range(len(list(same)), 0, -_RUN)) for each, same in groupby(held))
    return bytes(each + _HELD * (min(_RUN, left) - 1) for each, steps in runs for left in steps) + moves


def flight_of(code: str) -> ClaimedFlight:
    """Return the flight of a code, in time and memory that its length bounds; raises CodeError for any other text.

    Whatever a messenger has put into it is passed over: line breaks, blanks, quotation marks.
    """
    match = _CODE.fullmatch(next(codes_in(code), ""))
    if match is None:
        raise CodeError("none")
    version, signs, end = match.groups()
    if int(version or 1) != VERSION:
        raise CodeError("older" if int(version or 1) < VERSION else "newer")
    if not end:
        raise CodeError("cut")
    try:
        data = base64.b64decode(signs + "=" * (-len(signs) % 4), _SIGNS, validate=True)
    except ValueError as error:
        raise CodeError("damaged") from error
    if zlib.crc32(data[:-4]).to_bytes(4, "big") != data[-4:] or _spelt(data) != signs:
        raise CodeError("damaged")
    try:
        return _read(data[:-4])
    except (ValueError, zlib.error) as error:
        raise CodeError("nonsense") from error


def codes_in(text: str) -> Iterator[str]:
    """Yield every code in a text, without what a messenger put between its signs; one that is cut has no end."""
    return (match[0] for match in _CODE.finditer(_ALIEN.sub("", text[:_LONGEST_TEXT])))


def _read(data: bytes) -> ClaimedFlight:
    """Return the flight of a code's bytes; raises ValueError or zlib.error for what is none."""
    unpacker = zlib.decompressobj(-zlib.MAX_WBITS, zdict=_USUAL)
    line, _, inputs = unpacker.decompress(data, _LARGEST).partition(b"\n")
    if not unpacker.eof or unpacker.unused_data:
        raise ValueError("it is longer than any flight, or has no end")
    content = read_as(_Content, parse_json(line.decode()))
    if content.leg and (content.mission or content.pads != 1):
        raise ValueError("a leg of a descent has a start and rules of its own")
    x, y, angle = (number / _GRID for number in content.end)
    claim = Claim(Outcome[content.outcome], content.points, (x, y, angle))
    return ClaimedFlight(
        Recording.begun(content, content.leg, *_unpacked(inputs)), claim, content.course, content.barred
    )


def _unpacked(inputs: bytes) -> tuple[list[Push], list[StickHolder]]:
    """Return the pushes and the hands of `_packed`; raises ValueError."""
    runs, marked, moves = inputs.partition(_MOVES)
    if sum(run // _HELD + 1 for run in runs) > LONGEST:
        raise ValueError("no flight is so long")
    held = [run % _HELD for run in runs for _ in range(run // _HELD + 1)]
    holders = list(StickHolder)
    hands = [holders[each // 6] for each in held]
    if not marked:
        return [KEYS[each % 6] for each in held], hands
    if len(moves) != 2 * len(held) or any(each % 6 for each in held):
        raise ValueError("sticks have a place in every step, and no keys beside it")
    main, side = np.frombuffer(moves, np.int8).reshape(2, -1).cumsum(axis=1, dtype=int)
    if not (((main >= 0) & (main <= STEPS)).all() and (abs(side) <= STEPS).all()):
        raise ValueError("there is no more thrust than all of it")
    return list(map(Push, main.tolist(), side.tolist())), hands
