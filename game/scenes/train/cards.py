"""Sabotage cards: the parts that can be taken away, and what `python -m benchmarks.sabotages` measured of each."""

from __future__ import annotations

from functools import cache
from typing import Final

from ai.files import read_json
from ai.training.experiments import MEASURED
from game.core import texts
from game.core.assets import ASSETS_DIR

FILE: Final = ASSETS_DIR / "sabotages.json"


@cache
def measurements() -> dict[str, object]:
    """Return the file: decisions and seeds, and for each run its mean share that landed, and its interval's ends."""
    found = read_json(FILE)
    assert isinstance(found, dict)
    return found


def measured(name: str) -> str:
    """Say what was measured of a card, beside the preset that nothing was taken from."""
    found = measurements()
    shares = found["shares"]
    assert isinstance(shares, dict)
    (other, low, high), (healthy, least, most) = (
        tuple(100 * each for each in shares[each]) for each in (name, MEASURED)
    )
    return texts.LAB_MEASURED.format(
        decisions=found["decisions"], seeds=found["seeds"], other=other, low=low, high=high,
        healthy=healthy, least=least, most=most,
    )  # fmt: skip
