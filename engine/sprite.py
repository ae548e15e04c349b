"""A body and how it is to be shown; no picture is held here."""

from __future__ import annotations

from dataclasses import dataclass

from engine.body import Body


@dataclass(frozen=True)
class Sprite:
    """`image` is a key for whoever draws, `size` its width and height in metres, higher layers lie on top."""

    body: Body
    image: str
    size: tuple[float, float]
    layer: int = 0
