"""Exhibits of the physics gallery: small worlds, each showing one law of the engine."""

from __future__ import annotations

from typing import Final

from game.scenes.physics.exhibit import Exhibit, Label, Quantity
from game.scenes.physics.falls import Bounce, DragRace, Slopes
from game.scenes.physics.momentum import Impacts, Spin
from game.scenes.physics.piles import Heap, Stack

# Exhibits by their name in `texts.EXHIBITS`; each is built for a gravity in m/s² and values of its quantities.
EXHIBITS: Final[dict[str, type[Exhibit]]] = {
    kind.name: kind for kind in (Stack, Heap, Slopes, Bounce, Impacts, DragRace, Spin)
}

__all__ = ["EXHIBITS", "Exhibit", "Label", "Quantity"]
