"""Bytes as letters and digits, which no messenger turns into formatting, and which one double click selects.

32 bytes are written as 43 signs in base 62, since 62^43 is just above 256^32; shorter ends in as few as they need.
"""

from __future__ import annotations

from typing import Final

SIGNS: Final = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
_VALUES: Final = {sign: value for value, sign in enumerate(SIGNS)}
_BLOCK: Final = 32


def _length(size: int) -> int:
    """Return how many signs so many bytes take."""
    length = 0
    while 62**length < 256**size:
        length += 1
    return length


_SIZES: Final = {_length(size): size for size in range(_BLOCK + 1)}
_SIGNS: Final = _length(_BLOCK)


def spelt(data: bytes) -> str:
    """Return bytes as letters and digits."""
    return "".join(_block(data[start : start + _BLOCK]) for start in range(0, len(data), _BLOCK))


def _block(data: bytes) -> str:
    value, signs = int.from_bytes(data, "big"), []
    for _ in range(_length(len(data))):
        value, sign = divmod(value, 62)
        signs.append(SIGNS[sign])
    return "".join(reversed(signs))


def read(text: str) -> bytes:
    """Return the bytes that `spelt` was given; raises ValueError for any text that it does not return."""
    out = bytearray()
    for start in range(0, len(text), _SIGNS):
        signs, value = text[start : start + _SIGNS], 0
        for sign in signs:
            if sign not in _VALUES:
                raise ValueError("it has signs other than letters and digits")
            value = 62 * value + _VALUES[sign]
        size = _SIZES.get(len(signs))
        if size is None or value >= 256**size:
            raise ValueError("signs are missing or wrong")
        out += value.to_bytes(size, "big")
    return bytes(out)
