"""Actions of a flight in few bytes: when each of the two keys, thrust and steering, was pressed or let go.

A step costs bits only for a surprise: whether a key changes is coded by how long it has been as it is, and whether the
step is one on which a network decides. A flight by hand and one by a network are so told by the same few rules.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

from ai.flights.range_coder import Bit, Decoder, Encoder

_AGES: Final = (
    0,
    2,
    3,
    4,
    5,
    7,
    9,
    13,
    17,
    25,
    41,
)  # steps since a key's change that begin another context
_LONG: Final = _AGES[-1]
_AGE_OF: Final = tuple(sum(steps >= age for age in _AGES) - 1 for steps in range(_LONG + 1))
_GRIDS: Final = (1, 4)  # steps from one decision to the next: a person's, and a network's
_RARE: Final = 12  # steps for one change of a key, as expected beforehand

_Code = Callable[[bool, Bit], int]


def packed(actions: Sequence[int]) -> bytes:
    """Return actions, 0 to 5, in few bytes; `unpacked` needs to know how many they are."""
    return min((bytes([grid]) + _packed(actions, grid) for grid in _GRIDS), key=len)


def _packed(actions: Sequence[int], grid: int) -> bytes:
    encoder = Encoder()
    _told(encoder.code, len(actions), grid, actions)
    return encoder.finish()


def unpacked(coded: bytes, count: int) -> list[int]:
    """Return the `count` actions of `packed`, or some others for other bytes; raises ValueError for none."""
    if not coded or coded[0] not in _GRIDS:
        raise ValueError("its actions make no sense")
    return _told(Decoder(coded[1:]).code, count, coded[0])


def _told(code: _Code, count: int, grid: int, actions: Sequence[int] | None = None) -> list[int]:
    """Pass every change of a key through `code`, which writes or reads it; return the actions."""
    # Contexts of a change: which key, whether the step is one of decisions, how it is held, and for how long already.
    changed = [[[[Bit(_RARE) for _ in _AGES] for _ in range(3)] for _ in range(2)] for _ in range(2)]
    other = [[Bit(), Bit()] for _ in range(3)]
    main = steer = main_for = steer_for = wanted_main = wanted_steer = 0
    told: list[int] = []
    for step in range(count):
        if actions:
            wanted_main, wanted_steer = divmod(actions[step], 3)
        decides = step % grid == 0
        if code(wanted_main != main, changed[0][decides][main][_AGE_OF[main_for]]):
            main, main_for = 1 - main, 0
        if code(wanted_steer != steer, changed[1][decides][steer][_AGE_OF[steer_for]]):
            steer = (steer + 1 + code((wanted_steer - steer) % 3 == 2, other[steer][main])) % 3
            steer_for = 0
        main_for, steer_for = min(main_for + 1, _LONG), min(steer_for + 1, _LONG)
        told.append(3 * main + steer)
    return told
