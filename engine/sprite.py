"""A body and how it is to be shown; no picture is held here."""

from __future__ import annotations

from dataclasses import dataclass

from engine.body import Body


@dataclass(frozen=True)
class Sprite:
    """What is to be drawn where a body is, turned as the body is.

    Attributes:
        image: key of a picture in a table of whoever draws; the engine has none.
        size: width and height of the picture in metres, its middle at the body's position.
        layer: higher ones lie on top.

    """

    body: Body
    image: str
    size: tuple[float, float]
    layer: int = 0
