"""Focus navigation with the arrow keys."""

from __future__ import annotations

from collections.abc import Sequence

import pygame

Direction = tuple[int, int]
UP: Direction = (0, -1)
DOWN: Direction = (0, 1)
LEFT: Direction = (-1, 0)
RIGHT: Direction = (1, 0)


def neighbour(boxes: Sequence[pygame.Rect], current: int, direction: Direction, *, in_order: bool = False) -> int:
    """Return the index of the nearest box in a direction; up and down wrap around.

    With `in_order`, distances up and down are between edges, so that of two columns side by side the first one comes
    first, and the lower end of a column leads to the next box in order, which is the first one of the next column.

    A sideways distance counts double, so that a column is followed to its end before another is entered; left and right
    leave a row only at its end.
    """
    here = boxes[current]

    def ahead(box: pygame.Rect) -> float:
        if direction[1] and in_order:
            return box.top - here.bottom + 1 if direction[1] > 0 else here.top - box.bottom + 1
        return direction[0] * (box.centerx - here.centerx) + direction[1] * (box.centery - here.centery)

    def aside(box: pygame.Rect) -> float:
        if direction[0]:
            return max(box.top - here.bottom, here.top - box.bottom, 0)
        return max(box.left - here.right, here.left - box.right, 0)

    def level(box: pygame.Rect) -> bool:  # rows that only touch are two
        return box.top < here.bottom and here.top < box.bottom

    def beyond(box: pygame.Rect) -> bool:
        return box.left >= here.right if direction[0] > 0 else box.right <= here.left

    others = [index for index in range(len(boxes)) if index != current]
    forward = [index for index in others if ahead(boxes[index]) > 0]
    if direction[0]:
        row = [index for index in forward if level(boxes[index])]
        forward = row or [index for index in forward if beyond(boxes[index])]
    if forward:
        return min(forward, key=lambda index: ahead(boxes[index]) + 2 * aside(boxes[index]))
    if direction[1] and in_order:
        return (current + direction[1]) % len(boxes)
    if direction[1] and others:
        return min([current, *others], key=lambda index: ahead(boxes[index]) + 2 * aside(boxes[index]))
    return current
