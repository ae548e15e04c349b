"""The exhibits of the physics gallery; here those of many bodies, and of what is conserved."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final

import numpy as np

from engine import DT, Body, Circle, Polygon
from game.core import texts
from game.scenes.physics.exhibit import CLEAR, Exhibit, Label, Quantity, height, speed
from game.scenes.physics.falls import Bounce, DragRace, Slopes

_SEED: Final = 3
_AT_REST: Final = 60  # steps until contact impulses, which start at zero, carry ten boxes
_TIMED: Final = 60  # steps over which a push is averaged
_SQUARE: Final = 0.1  # tolerance of a box in a column: radians, and shares of a box's side
_MOVES: Final = 0.05  # metres per second, from which a disc counts as moving


class Stack(Exhibit):
    """Three columns and a pyramid: the lowest contact carries every box above it. A ball to throw at them."""

    name, patience = "stack", _AT_REST + _TIMED
    quantities = (Quantity("boxes", (2.0, 12.0), 10.0, 1.0), Quantity("iterations", (1.0, 20.0), 10.0, 1.0))
    tolerance = 0.07  # with a single iteration and a high column; 0.001 with 6 or more
    box = 0.8
    base = 8

    @classmethod
    def law(cls, gravity: float, values: Mapping[str, float]) -> float:
        """Return the push of the ground under a column, in newtons: the weight n m g of its boxes of 1 kg."""
        return values["boxes"] * gravity

    def build(self) -> None:
        self.world.iterations = round(self.values["iterations"])
        levels = range(round(self.values["boxes"]))
        self.columns = [[self._box(x, level) for level in levels] for x in (-5.4, -2.7, 0.0)]
        for level in range(self.base):
            count = self.base - level
            for number in range(count):
                self._box(6.4 + 1.05 * self.box * (number - (count - 1) / 2), level)
        self.ball = self.add(Circle(0.7), (-10.5, 0.7), "ember-disc", mass=4.0, friction=0.6, restitution=0.2)
        self._pushes = 0.0

    def _box(self, x: float, level: int) -> Body:
        return self.add(Polygon.box(self.box, self.box), (x, (level + 0.5) * self.box), "box", friction=0.6)

    def observe(self) -> None:
        """Take the mean push of the ground under the first column, for as long as it stands."""
        first = self.columns[0]
        if _AT_REST < self.steps <= self.patience and not self.is_touched(*first):
            self._pushes += self.push(self.floor, first[0])
            if self.steps == self.patience:
                self.result = self._pushes / _TIMED

    @property
    def state(self) -> str:
        """State of the columns: two boxes or more, at rest, are "standing"."""
        if self.steps < _AT_REST and not self.touched.any():
            return "begun"
        return "standing" if len(self.standing()) > 1 else "fallen"

    def figures(self) -> dict[str, float]:
        standing = self.standing()
        weighed, push = standing, self.push(self.floor, standing[0]) if standing else 0.0
        if len(standing) <= 1:
            weighed, push = self.bodies, self.push(self.floor)
        return {"count": len(weighed), "weight": self.gravity * sum(body.mass for body in weighed), "push": push}

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


class Heap(Exhibit):
    """A hundred boxes and discs fall: impacts and friction turn their energy into heat."""

    name, patience, points = "heap", 480, 5
    quantities = (Quantity("count", (10.0, 100.0), 100.0, 5.0), Quantity("rubbing", (0.1, 1.0), 0.5, 0.1))
    columns = 14

    @classmethod
    def law(cls, gravity: float, values: Mapping[str, float]) -> float:
        """Return the mean push of the ground, in newtons, from the start until the heap lies: the weight n m g.

        Bodies of 1 kg are at rest at first and in the end, so all impulses of the ground undo all those of gravity.
        """
        return values["count"] * gravity

    def build(self) -> None:
        self.world.iterations = 6  # enough to come to rest: no load passes through more than a few bodies
        rng = np.random.default_rng(_SEED)
        for number in range(round(self.values["count"])):
            row, column = divmod(number, self.columns)
            x = 1.28 * (column - (self.columns - 1) / 2) + rng.uniform(-0.12, 0.12)
            place = (x, 1.0 + 1.26 * row)
            surface = {"angle": rng.uniform(0, 2 * np.pi), "friction": self.values["rubbing"]}
            if rng.random() < 0.4:
                self.add(Circle(rng.choice((0.34, 0.44, 0.54))), place, "ember-disc", **surface)
            else:
                wide, tall = rng.uniform(0.55, 0.95, 2)
                image = "bright-box" if rng.random() < 0.15 else "box"
                self.add(Polygon.box(wide, tall), place, image, **surface)
        self.at_first, self._pushes = self.energy, 0.0

    def observe(self) -> None:
        """Add up the pushes of the ground from the first step on, unless a hand has come in."""
        if self.steps <= self.patience and not self.touched.any():
            self._pushes += self.push(self.floor)
            if self.steps == self.patience:
                self.result = self._pushes / self.patience

    @property
    def state(self) -> str:
        """State of the energy: "untouched" while all lost energy has become heat."""
        return "touched" if self.touched.any() else "untouched"

    def figures(self) -> dict[str, float]:
        return {"first": self.at_first, "left": self.energy}


class Impacts(Exhibit):
    """Discs in a row on smooth rails, struck by one, two and three others: as many leave as arrive.

    The discs stand a hair apart, so that one impact follows the other; had they touched, all impacts would be
    one problem with many answers, and the solver's would spread the motion over the row.
    """

    name, patience = "impacts", 240
    quantities = (Quantity("restitution", (0.8, 1.0), 1.0, 0.05), Quantity("striker", (0.25, 1.25), 1.0, 0.25))
    radius = 0.45
    gap = 0.01
    row = 6
    pace = 3.0
    rails = (6.4, 3.2, 0.0)

    @classmethod
    def law(cls, gravity: float, values: Mapping[str, float]) -> float:  # noqa: ARG003
        """Return the speed that one striker gives to the last disc of its row, in m/s.

        An impact of masses M and m gives the struck disc (1 + e) M / (M + m) times the speed of the striking one; it
        is handed on by one impact for each further disc of the row. Less restitution or a heavier striker would bring
        further impacts before the first has passed through, which this law does not count; the limits exclude them.
        """
        handed = (1 + values["restitution"]) / 2
        return cls.pace * 2 * values["striker"] / (values["striker"] + 1) * handed**cls.row

    def build(self) -> None:
        self.discs: list[list[Body]] = []
        pitch = 2 * self.radius + self.gap
        for number, rail in enumerate(self.rails):
            if rail:
                self.add(Polygon.box(self.width, 0.12), (0.0, rail - 0.06), "rail", static=True)
            strikers = [self._disc(-7.0 - pitch * k, rail, self.pace) for k in reversed(range(number + 1))]
            self.discs.append(strikers + [self._disc(pitch * k, rail, 0.0) for k in range(self.row)])
        self.energy_at_first = self.kinetic_energy

    def _disc(self, x: float, rail: float, pace: float) -> Body:
        surface = {"friction": 0.0, "restitution": self.values["restitution"]}
        mass, image = (self.values["striker"], "ember-disc") if pace else (1.0, "disc")
        disc = self.add(Circle(self.radius), (x, rail + self.radius), image, mass=mass, **surface)
        disc.velocity = (pace, 0.0)
        return disc

    @property
    def state(self) -> str:
        """State of the energy: "losing" with a restitution below 1, "touched" once a hand changed it."""
        if self.touched.any():
            return "touched"
        return "untouched" if self.values["restitution"] == 1 else "losing"

    def observe(self) -> None:
        """Measure the speed of the last disc of the highest rail as soon as it moves, unless a hand has come in."""
        last = self.discs[0][-1]
        if self.result is None and speed(last) > _MOVES and not self.touched.any():
            self.result = speed(last)

    def figures(self) -> dict[str, float]:
        return {**self.values, "first": self.energy_at_first, "now": self.kinetic_energy}

    def labels(self) -> list[Label]:
        labels = []
        for number, rail in enumerate(self.rails):
            discs = self.on_rail(number)
            moving = sum(speed(disc) > _MOVES for disc in discs)
            momentum = sum(float(disc.velocity[0, 0]) * disc.mass for disc in discs)
            text = texts.IMPACTS_RAIL.format(sent=number + 1, moving=moving, momentum=abs(momentum))
            labels.append(Label(text, (8.6, rail + 1.5)))
        return labels

    def on_rail(self, number: int) -> list[Body]:
        """Return the discs between this rail and the one above it."""
        low, high = self.rails[number], self.rails[number - 1] if number else math.inf
        return [body for body in self.bodies if low <= height(body) < high]


class Spin(Exhibit):
    """Conservation of angular momentum, without gravity; an off-centre impulse both moves and turns a bar."""

    name, patience, weightless = "spin", 32, True
    quantities = (Quantity("reach", (0.0, 1.4), 1.2, 0.1), Quantity("impulse", (0.1, 1.0), 0.4, 0.05))
    momentum = 1.2  # kg·m²/s
    bar = (0.5, 3.0)  # metres
    push_at = 30  # steps

    @classmethod
    def law(cls, gravity: float, values: Mapping[str, float]) -> float:  # noqa: ARG003
        """Return the spin, in rad/s, of a bar of 1 kg pushed beside its middle: r J / I."""
        inertia = (cls.bar[0] ** 2 + cls.bar[1] ** 2) / 12
        return values["reach"] * values["impulse"] / inertia

    def build(self) -> None:
        ceiling = CLEAR * self.width
        self.world.add(Polygon.box(self.width, 4.0), (0.0, ceiling + 2.0), static=True)
        self.rules.append(((-self.width / 2, ceiling), (self.width / 2, ceiling)))
        middle = ceiling / 2
        self.turning = [
            self.add(Circle(0.7), (-11.4, middle), "ember-disc", restitution=0.8),
            self.add(Polygon.box(2.2, 2.2), (-7.6, middle), "box", restitution=0.8),
            self.add(Polygon.box(3.6, 0.5), (-2.8, middle), "bright-box", restitution=0.8),
        ]
        for body in self.turning:
            body.angular_velocity = self.momentum / body.inertia
        bar = Polygon.box(*self.bar)
        self.pushed = [False, False]
        self.bars = [self.add(bar, (3.4, y), "box", restitution=0.8) for y in (middle + 2.6, middle - 2.4)]

    def prepare(self) -> None:
        """Push both bars alike, unless a hand has moved one: one in the middle, one near its end."""
        if self.steps == self.push_at:
            self.pushed = [not self.is_touched(bar) for bar in self.bars]
            for bar, offset, still in zip(self.bars, (0.0, self.values["reach"]), self.pushed, strict=True):
                if still:
                    bar.apply_force((self.values["impulse"] / DT, 0.0), bar.position[0] + (0.0, offset))

    def observe(self) -> None:
        """Measure the spin of the bar that is pushed beside its middle, right after the push."""
        if self.steps == self.push_at + 1 and self.pushed[1]:
            self.result = abs(float(self.bars[1].angular_velocity[0]))

    def figures(self) -> dict[str, float]:
        pace = self.values["impulse"] / self.bars[1].mass
        return {**self.values, "pace": pace, "spin": self.law(self.gravity, self.values)}

    def angular_momenta(self) -> list[float]:
        """Angular momenta of the three spinning bodies, in kg·m²/s, each about its own centre."""
        return [float(body.angular_velocity[0]) * body.inertia for body in self.turning]

    def labels(self) -> list[Label]:
        labels = []
        for body, momentum in zip(self.turning, self.angular_momenta(), strict=True):
            spin = round(float(body.angular_velocity[0]), 2) + 0.0  # never -0.00
            for line, text in enumerate(texts.SPIN_TURNING):
                words = text.format(spin=spin, momentum=round(momentum, 2) + 0.0)
                labels.append(Label(words, (0.0, -2.35 - 0.6 * line), body))
        reach = self.values["reach"]
        for number, bar in enumerate(self.bars):
            motion = texts.SPIN_MOTION.format(pace=speed(bar), spin=float(np.abs(bar.angular_velocity[0])))
            if self.pushed[number]:
                motion = texts.SPIN_BARS[number].format(motion=motion, reach=reach)
            elif self.steps <= self.push_at and not self.is_touched(bar):
                motion = texts.SPIN_BARS_BEFORE[number].format(reach=reach)
            labels.append(Label(motion, (0.0, -1.95), bar))
        return labels


# Each is built for a gravity in m/s² and values of its quantities.
EXHIBITS: Final[dict[str, type[Exhibit]]] = {
    kind.name: kind for kind in (Stack, Heap, Slopes, Bounce, Impacts, DragRace, Spin)
}
