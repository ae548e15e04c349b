"""Exhibits of stacked bodies: contact forces in a stack, and energy loss in a heap."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from engine import Body, Circle, Polygon
from game.scenes.physics.exhibit import Exhibit, Quantity

_SEED: Final = 3
_SETTLED: Final = 60  # steps until contact impulses, which start at zero, carry ten boxes
_TIMED: Final = 60  # steps over which a push is averaged
_SQUARE: Final = 0.1  # tolerance of a box in a column: radians, and shares of a box's side


class Stack(Exhibit):
    """Three columns and a pyramid: the lowest contact carries every box above it. A ball to throw at them."""

    name = "stack"
    quantities = (Quantity("boxes", (2.0, 12.0), 10.0, 1.0), Quantity("iterations", (1.0, 20.0), 10.0, 1.0))
    patience = _SETTLED + _TIMED
    tolerance = 0.07  # with a single iteration and a high column; 0.001 with 6 or more
    box = 0.8
    base = 8

    @classmethod
    def law(cls, gravity: float, values: Mapping[str, float]) -> float:
        """Return the push of the ground under a column, in newtons: the weight n m g of its boxes of 1 kg."""
        return values["boxes"] * gravity

    def build(self) -> None:
        """Add the columns and the pyramid, of boxes of one kilogram."""
        self.high = round(self.values["boxes"])
        self.world.iterations = round(self.values["iterations"])
        places = (-5.4, -2.7, 0.0)[: 1 if self.lean else 3]
        self.columns = [[self._box(x, (level + 0.5) * self.box) for level in range(self.high)] for x in places]
        self._pushes = 0.0
        if self.lean:
            return
        for level in range(self.base):
            count = self.base - level
            for number in range(count):
                self._box(6.4 + 1.05 * self.box * (number - (count - 1) / 2), (level + 0.5) * self.box)
        self.ball = self.add(Circle(0.7), (-10.5, 0.7), "ember-disc", mass=4.0, friction=0.6, restitution=0.2)

    def observe(self) -> None:
        """Take the mean push of the ground under the first column, for as long as it stands."""
        first = self.columns[0]
        if self.result is not None or self.touched[[box.index for box in first]].any() or self.steps <= _SETTLED:
            return
        self._pushes += self.push(self.floor, first[0])
        if self.steps == _SETTLED + _TIMED:
            self.result = self._pushes / _TIMED

    @property
    def state(self) -> str:
        """State of the columns: "begun", "standing" (two boxes or more, settled) or "fallen"."""
        if self.steps < _SETTLED and not self.touched.any():
            return "begun"
        return "standing" if len(self.standing()) > 1 else "fallen"

    def figures(self) -> dict[str, float]:
        """Return the weight of the highest column and its ground force; with none standing, those of all bodies."""
        standing = self.standing()
        if len(standing) > 1:
            weighed, push = standing, self.push(self.floor, standing[0])
        else:
            weighed, push = self.bodies, self.push(self.floor)
        weight = self.gravity * sum(body.mass for body in weighed)
        return {"count": len(weighed), "weight": weight, "push": push}

    def standing(self) -> list[Body]:
        """Return the boxes of the highest column whose boxes lie squarely on each other."""
        return max((column[: self._height(column)] for column in self.columns), key=len)

    def _height(self, column: list[Body]) -> int:
        """Return the number of boxes, from the ground up, that are in place or have moved as one."""
        x, y, angle = self.world.state.pose[0, [box.index for box in column]].T
        lean = np.abs((angle + np.pi / 4) % (np.pi / 2) - np.pi / 4)
        level = np.abs(y - self.box * (np.arange(len(column)) + 0.5))
        aside = np.abs(np.diff(x, prepend=x[0]))
        moved = (lean > _SQUARE) | (np.maximum(level, aside) > _SQUARE * self.box)
        return int(moved.argmax()) if moved.any() else len(column)

    def _box(self, x: float, y: float) -> Body:
        return self.add(Polygon.box(self.box, self.box), (x, y), "box", friction=0.6)


class Heap(Exhibit):
    """A hundred boxes and discs fall: impacts and friction turn their energy into heat."""

    name = "heap"
    quantities = (Quantity("count", (10.0, 100.0), 100.0, 5.0), Quantity("rubbing", (0.1, 1.0), 0.5, 0.1))
    patience = 480
    points = 5
    columns = 14

    @classmethod
    def law(cls, gravity: float, values: Mapping[str, float]) -> float:
        """Return the mean push of the ground, in newtons, from the start until the heap lies: the weight n m g.

        Bodies of 1 kg are at rest at first and in the end, so all impulses of the ground undo all those of gravity.
        """
        return values["count"] * gravity

    def build(self) -> None:
        """Place the bodies in rows above the floor, each a little askew."""
        self.world.iterations = 6  # enough to come to rest: no load passes through more than a few bodies
        self.count, friction = round(self.values["count"]), self.values["rubbing"]
        self._pushes = 0.0
        rng = np.random.default_rng(_SEED)
        for number in range(self.count):
            row, column = divmod(number, self.columns)
            x = 1.28 * (column - (self.columns - 1) / 2) + rng.uniform(-0.12, 0.12)
            y = 1.0 + 1.26 * row
            angle = rng.uniform(0, 2 * np.pi)
            if rng.random() < 0.4:
                self.add(Circle(rng.choice((0.34, 0.44, 0.54))), (x, y), "ember-disc", angle=angle, friction=friction)
            else:
                wide, tall = rng.uniform(0.55, 0.95, 2)
                image = "bright-box" if rng.random() < 0.15 else "box"
                self.add(Polygon.box(wide, tall), (x, y), image, angle=angle, friction=friction)
        self.at_first = self.energy

    def observe(self) -> None:
        """Add up the pushes of the ground from the first step on, unless a hand has come in."""
        if self.steps <= self.patience and not self.touched.any():
            self._pushes += self.push(self.floor)
            if self.steps == self.patience:
                self.result = self._pushes / self.patience

    @property
    def state(self) -> str:
        """State of the energy: "untouched" while all lost energy has become heat, else "touched"."""
        return "touched" if self.touched.any() else "untouched"

    def figures(self) -> dict[str, float]:
        """Return the mechanical energy at the start and now."""
        return {"first": self.at_first, "left": self.energy}
