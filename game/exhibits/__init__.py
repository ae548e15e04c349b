"""Exhibits of the physics gallery: small worlds, each showing one law of the engine.

May be imported by `digits`, `play`, `export`, `shell` and `scenes`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from game.exhibits.exhibit import Exhibit, Label
from game.exhibits.falls import Bounce, DragRace, Slopes
from game.exhibits.momentum import Impacts, Spin
from game.exhibits.piles import Heap, Stack

# Exhibits by their name in `texts.EXHIBITS`; each is built for a gravity in m/s².
EXHIBITS: Final[dict[str, Callable[[float], Exhibit]]] = {
    "stack": Stack,
    "heap": Heap,
    "slopes": Slopes,
    "bounce": Bounce,
    "impacts": Impacts,
    "drag": DragRace,
    "spin": Spin,
}

__all__ = ["EXHIBITS", "Exhibit", "Label"]
