"""A small scene in the player's colours: a pad within reach, a speed within limits and one beyond them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from game.core import texts
from game.drawing.cursor import Cursor
from game.drawing.shapes import Shape
from game.drawing.tokens import CAPTION, FAINT, FIGURE, INK, MUTE, NIGHT1, SMALL
from game.world import lander

if TYPE_CHECKING:
    import pygame

    from game.drawing.canvas import Canvas
    from game.drawing.tokens import Colour

HEIGHT: Final = 190.0
_METRE: Final = 26.0  # points
_SPEEDS: Final[tuple[tuple[str, float, bool], ...]] = (("0.8", 0.32, True), ("2.6", 0.9, False))


def draw_scene(canvas: Canvas, box: pygame.FRect) -> None:
    """Draw it into a box, in points."""
    good, warn = canvas.palette.good, canvas.palette.warn
    canvas.rounded(box, 8, NIGHT1, 0.55)
    ground, middle = box.bottom - 34, box.left + 0.76 * box.width
    canvas.line((box.left + 24, ground), (box.right - 24, ground), FAINT)
    half = 2.6 * _METRE
    canvas.line((middle - half, ground), (middle + half, ground), INK, 3)
    for side in (-half, half):
        canvas.glow((middle + side, ground - 3), 22, good, 0.7)
        canvas.dot((middle + side, ground - 3), 3, good)
    craft, corner = lander.turned(
        lander.LANDER, _METRE * canvas.scale, 0.12, canvas.pixels((middle - 8, ground - 2.6 * _METRE))
    )
    canvas.surface.blit(craft, corner)
    width = 0.19 * box.width
    for number, (figure, share, within) in enumerate(_SPEEDS):
        column = Cursor(box.left + 28 + number * (width + 28), box.top + 26, width + 20, canvas.scale, canvas)
        _write_speed(canvas, column, figure, share, good if within else warn, "check" if within else "triangle")


def _write_speed(canvas: Canvas, column: Cursor, figure: str, share: float, colour: Colour, mark: Shape) -> None:
    within = texts.SWATCH_GOOD if mark == "check" else texts.SWATCH_WARN
    canvas.marker(mark, (column.left + 5, column.y + 9), 10, colour)
    label = Cursor(column.left + 16, column.y, column.width, column.scale, canvas, size=CAPTION, colour=MUTE)
    label.text(within)
    column.y = label.y
    big = column.in_style(FIGURE, colour, "light")
    top = big.y
    big.text(figure)
    unit = Cursor(
        column.left + big.measured(figure) + 6, top + FIGURE - SMALL, 60, column.scale, canvas, size=SMALL, colour=MUTE
    )
    unit.text(texts.SWATCH_UNIT)
    canvas.bar((column.left, big.y + 2, column.width - 20, 3), share, colour)
