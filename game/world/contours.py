"""Contours of a field over a grid: the lines on which it has one value (marching squares)."""

from __future__ import annotations

from typing import Final

import numpy as np

from ai.environment import Doubles

# For each cell, by which of its corners are above the level (1 upper left, 2 upper right, 4 lower right, 8 lower
# left): the sides between which a line runs (0 upper, 1 right, 2 lower, 3 left). Above lies to its left-hand side
# as rows run down the screen. A saddle is drawn as two corners cut off.
_LINES: Final[tuple[tuple[tuple[int, int], ...], ...]] = (
    (), ((0, 3),), ((1, 0),), ((1, 3),), ((2, 1),), ((0, 3), (2, 1)), ((2, 0),), ((2, 3),),
    ((3, 2),), ((0, 2),), ((1, 0), (3, 2)), ((1, 2),), ((3, 1),), ((0, 1),), ((3, 0),), (),
)  # fmt: skip


def contours(field: Doubles, level: float) -> list[Doubles]:
    """Return the lines on which a field (rows, columns) has a value, each (k, 2) in columns and rows.

    A line that is closed ends where it begins. Cells of the grid are taken to be straight from corner to corner
    (Lorensen and Cline 1987, in two dimensions).
    """
    above = (np.asarray(field) > level).astype(int)
    cases = above[:-1, :-1] + 2 * above[:-1, 1:] + 4 * above[1:, 1:] + 8 * above[1:, :-1]
    follows: dict[tuple[int, int, int], tuple[int, int, int]] = {}
    for row, column in zip(*(each.tolist() for each in np.nonzero((cases > 0) & (cases < 15))), strict=True):
        for start, end in _LINES[cases[row, column]]:
            follows[_side(row, column, start)] = _side(row, column, end)
    lines = []
    begins = set(follows) - set(follows.values())
    while follows:
        side = begins.pop() if begins else next(iter(follows))
        sides = [side]
        while side in follows:
            side = follows.pop(side)
            sides.append(side)
        lines.append(_crossings(field, level, sides))
    return lines


def _side(row: int, column: int, side: int) -> tuple[int, int, int]:
    """Return a name for a cell's side that its neighbour gives it, too: 0 for a level one, 1 for an upright one."""
    return (side % 2, row + (side == 2), column + (side == 1))


def _crossings(field: Doubles, level: float, sides: list[tuple[int, int, int]]) -> Doubles:
    """Return where a level crosses those sides, (k, 2), in columns and rows."""
    upright, row, column = np.array(sides).T
    first, second = field[row, column], field[row + upright, column + 1 - upright]
    apart = np.where(second == first, 1.0, second - first)
    share = np.clip((level - first) / apart, 0.0, 1.0)
    return np.stack([column + (1 - upright) * share, row + upright * share], axis=1)


def smooth(line: Doubles, times: int = 2) -> Doubles:
    """Return a line (k, 2) with its corners cut, so many times (Chaikin 1974); it keeps its ends."""
    for _ in range(times):
        if len(line) < 3:
            break
        near, far = 0.75 * line[:-1] + 0.25 * line[1:], 0.25 * line[:-1] + 0.75 * line[1:]
        cut = np.stack([near, far], axis=1).reshape(-1, 2)
        line = np.concatenate([line[:1], cut[1:-1], line[-1:]])
    return line
