"""Sprite: a body and how to draw it; no picture is held here."""

from __future__ import annotations

from dataclasses import dataclass

from engine.body import Body


@dataclass(frozen=True)
class Sprite:
    """Description of the picture to draw at a body's position and angle.

    Attributes:
        image: key of a picture in the renderer's table; the engine has none.
        size: width and height of the picture in metres, its middle at the body's position.
        layer: higher ones lie on top.

    """

    body: Body
    image: str
    size: tuple[float, float]
    layer: int = 0
