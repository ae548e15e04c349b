"""Code of a flight, short enough for a message: `tranq-`, letters and digits, `-over`.

The letters stand for bytes: the format's version, sections, and a checksum. A section is a tag, its length and its
content, which one function packs and one reads; what is as usual is left out. A reader refuses a section that it does
not know, because without it the flight would be another, but not one with a tag from `OPTIONAL` on.
docs/files.md describes the sections.
"""

from __future__ import annotations

import re
import struct
import zlib
from collections.abc import Callable, Iterator
from itertools import groupby
from typing import Any, Final

from ai.flights import key_presses, letters, stick_positions
from ai.flights.easing import AS_IT_IS, Easing
from ai.flights.places import COURSES
from ai.flights.recording import LONGEST, Recording, StickHolder
from ai.flights.shared import Claim, SharedFlight
from ai.flights.stick import STEPS, Shares
from ai.lander.descent import MOST_LEGS, TANK, LegStart
from ai.lander.environment import Outcome
from ai.lander.missions import MISSIONS
from ai.lander.rules import AREAS
from ai.lander.spawns import SPAWNS

VERSION: Final = 1
BEGIN, END = "tranq-", "-over"
OPTIONAL: Final = 64  # tags from which a reader may pass over a section that it does not know
LARGEST: Final = 8_192  # bytes of a code: several times those of the longest flight with a change in every step
_LONGEST_TEXT: Final = 1_000_000  # characters of a text in which codes are looked for
_MOST: Final = 10**6
_LARGEST_SEED: Final = 10**40
_LONGEST_NAME: Final = 40  # bytes
_MOST_CHANGES: Final = 1_000  # of gravity
_GRAVITY: Final = (0.01, 10.0)  # share of normal gravity
_FAR: Final = 10**6  # metres
_GRID: Final = 10_000  # parts of a metre and a radian in which the last pose is told
_SIDES: Final = 2 * STEPS + 1  # shares of the jets that there are
_STICK: Final = 1  # how the shares of thrust are told; so their section is never empty
_TANK: Final = 1_000  # parts of a second of fuel in which a tank is told, as it is rounded in a descent
_ALIEN: Final = re.compile(r"[^0-9A-Za-z-]+")


class CodeError(ValueError):
    """A code is refused. `kind` says why in one word, for those who say it in the player's language."""

    def __init__(self, kind: str) -> None:
        self.kind = kind
        super().__init__(REFUSALS[kind])


REFUSALS: Final = {
    "none": "there is no code of a flight in it",
    "cut": "the end of the code is missing",
    "damaged": "the code is damaged: a sign is wrong or missing",
    "newer": "the code was made by a newer version of the game",
    "nonsense": "the code stands for no flight that there can be",
}


def code_of(flight: SharedFlight) -> str:
    """Return the code of a flight."""
    data = bytearray([VERSION])
    for tag, (pack, _) in _SECTIONS.items():
        if content := pack(flight):
            data += _varint(tag) + _varint(len(content)) + content
    data += zlib.crc32(data).to_bytes(4, "big")
    return f"{BEGIN}{letters.spelt(bytes(data))}{END}"


def flight_of(code: str) -> SharedFlight:
    """Return the flight of a code, in time and memory that its length bounds; raises CodeError for any other text.

    Whatever a messenger has put into it is passed over: line breaks, blanks, quotation marks.
    """
    found = next(codes_in(code), "")
    if not found:
        raise CodeError("none")
    if not found.endswith(END):
        raise CodeError("cut")
    signs = found[len(BEGIN) : -len(END)]
    if len(signs) > 2 * LARGEST:
        raise CodeError("nonsense")
    try:
        data = letters.read(signs)
    except ValueError as error:
        raise CodeError("damaged") from error
    if len(data) < 5 or zlib.crc32(data[:-4]) != int.from_bytes(data[-4:], "big"):
        raise CodeError("damaged")
    return _unpacked(data[:-4])


def codes_in(text: str) -> Iterator[str]:
    """Yield every code in a text, without what a messenger put between its signs; one that is cut has no end."""
    plain = _ALIEN.sub("", text[:_LONGEST_TEXT])
    for part in plain.split(BEGIN)[1:]:
        signs, dash, rest = part.partition("-")
        yield f"{BEGIN}{signs}{END if rest.startswith(END[1:]) else dash}"


def _unpacked(data: bytes) -> SharedFlight:
    if data[0] != VERSION:
        raise CodeError("newer")
    reader, found = _Reader(data[1:]), dict[str, Any]()
    last = -1
    try:
        while reader.left:
            tag = reader.number(_MOST)
            content = _Reader(reader.bytes(reader.number(LARGEST)))
            if tag <= last:
                raise ValueError("sections come in the order of their tags")
            last = tag
            if tag in _SECTIONS:
                _SECTIONS[tag][1](content, found)
                if content.left:
                    raise CodeError("newer")  # a section that has grown
            elif tag < OPTIONAL:
                raise CodeError("newer")
        return _made(**found)
    except CodeError:
        raise
    except (ValueError, TypeError, KeyError) as error:  # the last two if a section is missing
        raise CodeError("nonsense") from error


def _made(
    start: tuple[int, str, int, str],
    actions: list[int],
    hands: list[StickHolder],
    claim: Claim,
    gravity: list[tuple[int, float]] | None = None,
    course: str = "",
    barred: str = "",
    **more: Any,
) -> SharedFlight:
    """Return a flight of what the sections hold."""
    seed, spawn, pads, mission = start
    if "leg" in more and (mission or gravity or pads != 1):
        raise ValueError("a leg of a descent has a start and rules of its own")
    recording = Recording(seed, spawn, pads, actions, hands, mission, gravity or [], **more)
    return SharedFlight(recording, claim, course or mission, barred)


class _Reader:
    """Reader of a row of bytes; raises ValueError for numbers out of bounds and for bytes that are missing."""

    def __init__(self, data: bytes) -> None:
        self._data, self._at = data, 0

    @property
    def left(self) -> int:
        """Number of bytes left."""
        return len(self._data) - self._at

    def bytes(self, count: int) -> bytes:
        """Return the next bytes."""
        if count > self.left:
            raise ValueError("bytes are missing")
        self._at += count
        return self._data[self._at - count : self._at]

    def number(self, most: int) -> int:
        """Return a whole number from 0 to `most`, seven bits to a byte, the lowest first."""
        value = shift = 0
        while True:
            byte = self.bytes(1)[0]
            value |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                break
            if shift > most.bit_length() + 7:
                raise ValueError("a number is too long")
        if value > most:
            raise ValueError("a number is too large")
        return value

    def text(self) -> str:
        """Return a text behind its length."""
        return self.bytes(self.number(_LONGEST_NAME)).decode()


def _varint(value: int) -> bytes:
    out = bytearray()
    while value > 127:
        out.append(value & 127 | 128)
        value >>= 7
    return bytes([*out, value])


def _named(text: str) -> bytes:
    data = text.encode()[:_LONGEST_NAME].decode(errors="ignore").encode()  # never half of a letter
    return _varint(len(data)) + data


# Sections: each has one function that packs it, empty if it has nothing to say, and one that reads it.


def _pack_start(flight: SharedFlight) -> bytes:
    recording = flight.recording
    return (
        _varint(recording.seed) + _varint(recording.pads)
        + _named("" if recording.spawn == "random" else recording.spawn) + _named(recording.mission)
    )  # fmt: skip


def _read_start(reader: _Reader, found: dict[str, Any]) -> None:
    seed, pads, spawn, mission = reader.number(_LARGEST_SEED), reader.number(3), reader.text(), reader.text()
    if pads not in (1, 3) or (spawn and spawn not in SPAWNS):
        raise ValueError("there is no such start")
    if mission and mission not in MISSIONS:
        raise CodeError("newer")
    found["start"] = (seed, spawn or "random", pads, mission)


def _pack_actions(flight: SharedFlight) -> bytes:
    actions = flight.recording.actions
    return _varint(len(actions)) + key_presses.packed(actions)


def _read_actions(reader: _Reader, found: dict[str, Any]) -> None:
    count = reader.number(LONGEST)
    found["actions"] = key_presses.unpacked(reader.bytes(reader.left), count)


def _pack_hands(flight: SharedFlight) -> bytes:
    rows = [(hand, len(list(same))) for hand, same in groupby(flight.recording.hands)]
    first = rows[0][0] if rows else StickHolder.HUMAN
    return bytes([first is StickHolder.NETWORK]) + b"".join(_varint(length) for _, length in rows[:-1])


def _read_hands(reader: _Reader, found: dict[str, Any]) -> None:
    total, holders = len(found["actions"]), list(StickHolder)
    turn, hands = reader.number(1), list[StickHolder]()
    while reader.left:
        length = reader.number(total - len(hands))
        hands += [holders[turn]] * length
        turn = 1 - turn
    found["hands"] = hands + [holders[turn]] * (total - len(hands))


def _pack_gravity(flight: SharedFlight) -> bytes:
    return b"".join(_varint(step) + struct.pack(">d", share) for step, share in flight.recording.gravity)


def _read_gravity(reader: _Reader, found: dict[str, Any]) -> None:
    changes = list[tuple[int, float]]()
    while reader.left:
        step, (share,) = reader.number(LONGEST), struct.unpack(">d", reader.bytes(8))
        if not _GRAVITY[0] <= share <= _GRAVITY[1] or len(changes) == _MOST_CHANGES:
            raise ValueError("there is no such gravity")
        if changes and step <= changes[-1][0]:
            raise ValueError("changes of gravity come one after another")
        changes.append((step, share))
    found["gravity"] = changes


def _pack_claim(flight: SharedFlight) -> bytes:
    claim = flight.claim
    pose = (round(min(max(number, -_FAR), _FAR) * _GRID) for number in claim.end)
    zigzag = (2 * number if number >= 0 else -2 * number - 1 for number in pose)
    return b"".join(map(_varint, (claim.outcome, claim.points, *zigzag)))


def _read_claim(reader: _Reader, found: dict[str, Any]) -> None:
    outcome, points = Outcome(reader.number(max(Outcome))), reader.number(_MOST)
    zigzag = [reader.number(2 * _FAR * _GRID) for _ in range(3)]
    x, y, angle = ((-(number + 1) // 2 if number % 2 else number // 2) / _GRID for number in zigzag)
    found["claim"] = Claim(outcome, points, (x, y, angle))


def _pack_no_shares(flight: SharedFlight) -> bytes:  # noqa: ARG001
    """Leave out the older section, which took several times as many letters."""
    return b""


def _read_older_shares(reader: _Reader, found: dict[str, Any]) -> None:
    total, step, shares = len(found["actions"]), 0, dict[int, Shares]()
    while reader.left:
        pair, length = reader.number((STEPS + 1) * _SIDES), reader.number(total - step)
        if pair:
            main, side = divmod(pair - 1, _SIDES)
            shares |= dict.fromkeys(range(step, step + length), (main, side - STEPS))
        step += length
    found["shares"] = shares


def _pack_shares(flight: SharedFlight) -> bytes:
    recording = flight.recording
    return bytes([_STICK]) + stick_positions.packed(recording.actions, recording.shares) if recording.shares else b""


def _read_shares(reader: _Reader, found: dict[str, Any]) -> None:
    if reader.number(_MOST) != _STICK:
        raise CodeError("newer")
    found["shares"] = stick_positions.unpacked(reader.bytes(reader.left), found["actions"])


def _pack_easing(flight: SharedFlight) -> bytes:
    easing = flight.recording.easing
    return b"" if easing == AS_IT_IS else _varint(easing.wider_pads + 2 * easing.untimed)


def _read_easing(reader: _Reader, found: dict[str, Any]) -> None:
    bits = reader.number(3)
    found["easing"] = Easing(bool(bits & 1), bool(bits & 2))


def _pack_area(flight: SharedFlight) -> bytes:
    return _varint(flight.recording.area)


def _read_area(reader: _Reader, found: dict[str, Any]) -> None:
    area = reader.number(_MOST)
    if area >= len(AREAS):
        raise CodeError("newer")
    found["area"] = area


def _pack_leg(flight: SharedFlight) -> bytes:
    leg = flight.recording.leg
    return b"" if leg is None else _varint(leg.number) + _varint(round(_TANK * leg.tank)) + bytes([leg.bare])


def _read_leg(reader: _Reader, found: dict[str, Any]) -> None:
    number, tank, bare = reader.number(MOST_LEGS), reader.number(round(_TANK * TANK)), reader.number(1)
    if number < 1:
        raise ValueError("there is no such leg")
    found["leg"] = LegStart(number, tank / _TANK, bool(bare))


def _pack_course(flight: SharedFlight) -> bytes:
    return _named(flight.course) if flight.course != flight.recording.mission else b""


def _read_course(reader: _Reader, found: dict[str, Any]) -> None:
    course = reader.text()
    if course not in COURSES:
        raise CodeError("newer")
    found["course"] = course


def _pack_barred(flight: SharedFlight) -> bytes:
    return _named(flight.barred) if flight.barred else b""


def _read_barred(reader: _Reader, found: dict[str, Any]) -> None:
    found["barred"] = reader.text()


_SECTIONS: Final[dict[int, tuple[Callable[[SharedFlight], bytes], Callable[[_Reader, dict[str, Any]], None]]]] = {
    1: (_pack_start, _read_start),
    2: (_pack_actions, _read_actions),
    3: (_pack_hands, _read_hands),
    4: (_pack_gravity, _read_gravity),
    5: (_pack_claim, _read_claim),
    6: (_pack_no_shares, _read_older_shares),
    7: (_pack_easing, _read_easing),
    8: (_pack_area, _read_area),
    9: (_pack_leg, _read_leg),
    10: (_pack_shares, _read_shares),
    OPTIONAL: (_pack_course, _read_course),
    OPTIONAL + 1: (_pack_barred, _read_barred),
}
