"""Adaptive binary range coder: bits in about as many bytes as their probabilities ask for.

Range coding after Martin, "Range encoding" (1979), with the carry handling of LZMA (Pavlov). A probability is that of
the bits seen so far in the same context (Krichevsky and Trofimov, 1981), in whole numbers only, so that every machine
decodes the same.
"""

from __future__ import annotations

from typing import Final

_TOP: Final = 1 << 24
_MASK: Final = (1 << 32) - 1
_BITS: Final = 12  # of a probability
_MOST: Final = 255  # bits seen in one context, after which old ones count half


class Bit:
    """Context of a bit: how often it was 0 and 1 there; `zeros` and `ones` are what is expected beforehand.

    Attributes:
        share: part of a range that stands for a 0, of 4096.

    """

    __slots__ = ("_ones", "_seen", "share")

    def __init__(self, zeros: int = 1, ones: int = 1) -> None:
        self._seen, self._ones = zeros + ones, ones
        self._weigh()

    def _weigh(self) -> None:
        """Work out the share of a range that stands for a 0."""
        self.share = ((2 * (self._seen - self._ones) + 1) << _BITS) // (2 * self._seen + 2)

    def learn(self, bit: bool) -> None:
        """Count a bit."""
        self._seen += 1
        self._ones += bit
        if self._seen > _MOST:
            self._seen, self._ones = self._seen >> 1, self._ones >> 1
        self._weigh()


class Encoder:
    """Encoder: `code` takes bits one after another, `finish` returns the bytes."""

    def __init__(self) -> None:
        self._low, self._width = 0, _MASK
        self._out = bytearray()

    def code(self, bit: bool, context: Bit) -> int:
        """Append a bit, and return it."""
        bound = (self._width >> _BITS) * context.share
        if bit:
            self._low += bound
            self._width -= bound
        else:
            self._width = bound
        context.learn(bit)
        while self._width < _TOP:
            self._shift()
        return bit

    def _shift(self) -> None:
        self._carry()
        self._out.append(self._low >> 24 & 0xFF)
        self._low = (self._low & (_TOP - 1)) << 8
        self._width <<= 8

    def _carry(self) -> None:
        """Add a carry to the bytes that are written."""
        if self._low > _MASK:
            self._low &= _MASK
            place = len(self._out) - 1
            while self._out[place] == 0xFF:
                self._out[place] = 0
                place -= 1
            self._out[place] += 1

    def finish(self) -> bytes:
        """Return the bytes; zeros at their end are left out, because a decoder reads on as if they were there."""
        high = self._low + self._width - 1
        for kept in range(32, -1, -8):  # the number within the range that ends in the most zero bytes
            end = high >> kept << kept
            if end >= self._low:
                self._low = end
                break
        self._carry()
        self._out += self._low.to_bytes(4, "big")
        return bytes(self._out).rstrip(b"\0")


class Decoder:
    """Decoder of an encoder's bytes; of any others, it makes some bits or other, for as long as it is asked."""

    def __init__(self, coded: bytes) -> None:
        self._coded, self._at = coded, 4
        self._width = _MASK
        self._code = int.from_bytes(coded[:4].ljust(4, b"\0"), "big")

    def code(self, bit: bool, context: Bit) -> int:  # noqa: ARG002
        """Return the next bit; its argument is not used."""
        bound = (self._width >> _BITS) * context.share
        if self._code < bound:
            self._width, found = bound, False
        else:
            self._code, self._width, found = self._code - bound, self._width - bound, True
        context.learn(found)
        while self._width < _TOP:
            self._width <<= 8
            coded = self._coded[self._at] if self._at < len(self._coded) else 0
            self._code, self._at = (self._code << 8 | coded) & _MASK, self._at + 1
        return found
