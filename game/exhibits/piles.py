"""Many bodies at rest on each other: what carries what, and where the energy goes."""

from __future__ import annotations

from typing import Final

import numpy as np

from engine import Body, Circle, Polygon
from game.exhibits.exhibit import Exhibit
from game.ui.tokens import EMBER, INK, MUTE

_SEED: Final = 3


class Stack(Exhibit):
    """Three columns and a pyramid: the lowest contact carries every box above it. A ball to throw at them."""

    box = 0.8
    high = 10
    base = 8

    def build(self) -> None:
        """Stack them; boxes of one kilogram."""
        self.columns = [
            [self._box(x, (level + 0.5) * self.box) for level in range(self.high)] for x in (-5.4, -2.7, 0.0)
        ]
        for level in range(self.base):
            count = self.base - level
            for number in range(count):
                self._box(6.4 + 1.05 * self.box * (number - (count - 1) / 2), (level + 0.5) * self.box)
        self.ball = self.add(Circle(0.7), (-10.5, 0.7), EMBER, mass=4.0, friction=0.6, restitution=0.2)

    def figures(self) -> dict[str, float]:
        """Return the weight of a column, and what its lowest contact carries."""
        lowest = self.columns[0][0]
        weight = self.high * lowest.mass * self.gravity
        return {"count": self.high, "weight": weight, "push": self.push_between(self.floor, lowest)}

    def _box(self, x: float, y: float) -> Body:
        return self.add(Polygon.box(self.box, self.box), (x, y), friction=0.6)


class Heap(Exhibit):
    """A hundred boxes and discs fall: impacts and friction turn their energy into heat."""

    columns = 14
    count = 100

    def build(self) -> None:
        """Hang them up in rows, each a little askew."""
        self.world.iterations = 6  # it rests as well as with ten: no load is carried through more than a few of them
        rng = np.random.default_rng(_SEED)
        for number in range(self.count):
            row, column = divmod(number, self.columns)
            x = 1.28 * (column - (self.columns - 1) / 2) + rng.uniform(-0.12, 0.12)
            y = 1.0 + 1.26 * row
            angle = rng.uniform(0, 2 * np.pi)
            if rng.random() < 0.4:
                self.add(Circle(rng.choice((0.34, 0.44, 0.54))), (x, y), EMBER, angle=angle, friction=0.5)
            else:
                wide, tall = rng.uniform(0.55, 0.95, 2)
                colour = INK if rng.random() < 0.15 else MUTE
                self.add(Polygon.box(wide, tall), (x, y), colour, angle=angle, friction=0.5)
        self.at_first = self.energy

    def figures(self) -> dict[str, float]:
        """Return the energy at first, and what is left of it."""
        return {"first": self.at_first, "left": self.energy}
