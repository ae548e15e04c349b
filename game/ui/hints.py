"""Which key does what, in one quiet line."""

from __future__ import annotations

from collections.abc import Iterable

from game.ui.canvas import Canvas
from game.ui.tokens import INK, MUTE, SMALL


def draw_hints(
    canvas: Canvas,
    hints: Iterable[tuple[str, str]],
    position: tuple[float, float],
    *,
    from_right: bool = False,
) -> None:
    """Write pairs of a key and its meaning on one baseline, starting (or ending) at the position."""
    pairs = list(hints)
    gaps = 8.0, 24.0
    if from_right:
        widths = [canvas.text_width(text, size=SMALL) for pair in pairs for text in pair]
        position = (position[0] - sum(widths) - len(pairs) * sum(gaps) + gaps[1], position[1])
    x, y = position
    for key, meaning in pairs:
        x += canvas.text(key, (x, y), size=SMALL, colour=INK, weight="medium").width + gaps[0]
        x += canvas.text(meaning, (x, y), size=SMALL, colour=MUTE).width + gaps[1]
