"""Letters that most screens use are loaded while nothing waits for them: the first text of a font takes long."""

from __future__ import annotations

from functools import lru_cache, partial
from itertools import product
from typing import Final

from game.drawing import typeface
from game.drawing.paint_cache import InPieces, Steps
from game.drawing.typeface import Weight

# Sizes in points that most screens use, and the letters of most words, a few at a time.
_FONTS: Final[dict[Weight, tuple[float, ...]]] = {
    "regular": (12.5, 15.0, 12.0, 13.5, 22.0, 14.0, 18.0),
    "medium": (12.5, 12.0, 15.0),
    "light": (34.0, 30.0),
    "code": (12.0,),
}
_LETTERS: Final = ("eatoinsrhldcumfpgwybvkxjqz", "0123456789 .,:;-–'%()[]/=+*_·°", "TASDPCIWRMLNFEHBGOVUKYQJXZ")
_FEW: Final = 25_000  # pixels of a picture that could be painted in the time that a few letters take


def begin(scale: float) -> None:
    """Load letters in pieces from now on, for text of so many pixels a point."""
    _loading(scale)


@lru_cache(maxsize=1)  # which keeps it until it is done
def _loading(scale: float) -> InPieces[None]:
    return InPieces(partial(_load, scale))


def _load(scale: float, share: float) -> Steps[None]:  # noqa: ARG001 - there are no rough letters
    for weight, sizes in _FONTS.items():
        for size, letters in product(sizes, _LETTERS):
            typeface.open_letters(letters, size, weight, scale)
            yield _FEW
