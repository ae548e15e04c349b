"""Word wrap: sentences on as many lines as they need, or as there is room for."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import lru_cache
from typing import Final

from game.drawing import typeface
from game.drawing.typeface import Weight

_LONGEST: Final = 4000  # characters: more than fit on a screen
_TOGETHER: Final = "\u00a0"  # where no line is broken: as a text says, and between a number and its unit
_UNIT: Final = re.compile(r"(?<=\d) (?=(?:%|°|[kcm]?m/s²?|[km]?[smgN]|kg|min|h|rad|M|k)(?:[^\w]|$))")
_BREAKS: Final = re.compile(r"[ \t\n]+")


def _broken(text: str, width: float, measure: Callable[[str], float]) -> list[str]:
    lines = [""]
    for word in _BREAKS.split(_UNIT.sub(_TOGETHER, text[:_LONGEST]).strip()):
        longer = f"{lines[-1]} {word}".strip()
        if lines[-1] and measure(longer.replace(_TOGETHER, " ")) > width:
            lines.append(word)
        else:
            lines[-1] = longer
    return [line.replace(_TOGETHER, " ") for line in lines]


@lru_cache(maxsize=1024)
def lines(text: str, size: float, weight: Weight, width: float, scale: float) -> tuple[str, ...]:
    """Break a text that flows into lines no wider than `width`, as they are written at `scale` pixels a point.

    A word that is wider than a line is broken as well: nothing leaves its column.
    """

    def measure(line: str) -> float:
        return typeface.reach(line, round(size * scale, 2), weight) / scale

    broken = (line for part in text.split("\n") for line in _broken(part, width, measure))
    return tuple(piece for line in broken for piece in _pieces(line, width, measure))


def _pieces(word: str, width: float, measure: Callable[[str], float]) -> Iterator[str]:
    """Yield the parts of a word that fit into a line."""
    while len(word) > 1 and measure(word) > width:
        most = next(length for length in range(len(word) - 1, 0, -1) if length == 1 or measure(word[:length]) <= width)
        yield word[:most]
        word = word[most:]
    yield word
