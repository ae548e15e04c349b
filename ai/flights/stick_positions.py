"""Shares of thrust of a flight in few bytes: how a stick and a throttle moved from step to step.

A step costs bits only for a surprise: whether a share changes is coded by how long it has been as it is and which way
it last moved; how far it moves, by steps of the stick. What the actions tell already is known to the reader.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final

from ai.flights.range_coder import Bit, Decoder, Encoder
from ai.flights.stick import STEPS, Shares, full

_AGES: Final = (0, 1, 2, 3, 5, 8, 13, 25)  # steps since a share's change that begin another context
_LONG: Final = _AGES[-1]
_AGE_OF: Final = tuple(sum(steps >= age for age in _AGES) - 1 for steps in range(_LONG + 1))
_LIMITS: Final = ((0, STEPS), (-STEPS, STEPS))  # of the shares of main engine and jets
_FAR: Final = 8  # steps of the stick at once from which on all are one context

_Code = Callable[[bool, Bit], int]


def packed(actions: Sequence[int], shares: Mapping[int, Shares]) -> bytes:
    """Return the shares of each step that has some in few bytes; `unpacked` needs to know the actions, 0 to 5."""
    encoder = Encoder()
    _told(encoder.code, actions, shares)
    return encoder.finish()


def unpacked(coded: bytes, actions: Sequence[int]) -> dict[int, Shares]:
    """Return the shares of `packed`, or some others for other bytes."""
    return _told(Decoder(coded).code, actions)


def _told(code: _Code, actions: Sequence[int], shares: Mapping[int, Shares] | None = None) -> dict[int, Shares]:
    """Pass every move of the stick through `code`, which writes or reads it; return the shares."""
    partly = [[Bit(), Bit()] for _ in range(2)]  # by whether the action is another, and the last step had shares
    axes = _Axis(code, *_LIMITS[0]), _Axis(code, *_LIMITS[1])
    told: dict[int, Shares] = {}
    before, had = 0, False
    for step, action in enumerate(actions):
        same = action == before
        wanted = None if shares is None else shares.get(step)
        had = bool(code(wanted is not None, partly[same][had]))
        if had:
            main, side = wanted or (0, 0)
            told[step] = axes[0].move(main, same), axes[1].move(side, same)
        else:
            for axis, value in zip(axes, full(action), strict=True):
                axis.jump(value)
        before = action
    return told


class _Axis:
    """One share of thrust, in steps of the stick, as it moves between its limits."""

    def __init__(self, code: _Code, least: int, most: int) -> None:
        self._code, self._limits = code, (least, most)
        self._value, self._age, self._way = 0, _LONG, 1
        self._moves = [[[Bit() for _ in _AGES] for _ in range(2)] for _ in range(2)]
        self._ways = [[Bit() for _ in _AGES] for _ in range(2)]
        self._further = [[Bit() for _ in range(_FAR + 1)] for _ in range(2)]

    def move(self, wanted: int, same: bool) -> int:
        """Write or read the next share, of a step whose action is the `same` as before or not; return it."""
        age, change = _AGE_OF[self._age], wanted - self._value
        if not self._code(change != 0, self._moves[same][self._way][age]):
            self._age = min(self._age + 1, _LONG)
            return self._value
        if self._value not in self._limits:
            self._way = self._code(change > 0, self._ways[self._way][age])
        else:
            self._way = int(self._value == self._limits[0])  # there is only one way
        room = abs(self._limits[self._way] - self._value)
        far = 1
        while far < room and self._code(abs(change) > far, self._further[age < len(_AGES) // 2][min(far, _FAR)]):
            far += 1
        self._value += far if self._way else -far
        self._age = 0
        return self._value

    def jump(self, value: int) -> None:
        """Take a share that the action tells."""
        self._age = self._age if value == self._value else 0
        self._value = value
