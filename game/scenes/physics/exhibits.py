"""The exhibits of the physics gallery; here those of many bodies, and of what is conserved."""

from __future__ import annotations

from typing import Final

import numpy as np

from engine import Body, Circle, Polygon
from game.core import texts
from game.drawing.tokens import EMBER, FAINT, INK, MUTE
from game.scenes.physics.exhibit import Exhibit, Label, Quantity, speed
from game.scenes.physics.falls import Bounce, DragRace, Slopes

_SEED: Final = 3
_MOVES: Final = 0.05  # metres per second, from which a disc counts as moving


class Stack(Exhibit):
    """Three columns and a pyramid: the lowest contact carries every box above it. A ball to throw at them."""

    name = "stack"
    quantities = (Quantity("boxes", (2.0, 12.0), 10.0, 1.0), Quantity("iterations", (1.0, 20.0), 10.0, 1.0))
    box = 0.8
    base = 8

    def build(self) -> None:
        self.world.iterations = round(self.values["iterations"])
        levels = range(round(self.values["boxes"]))
        self.columns = [[self._box(x, level) for level in levels] for x in (-5.4, -2.7, 0.0)]
        for level in range(self.base):
            count = self.base - level
            for number in range(count):
                self._box(6.4 + 1.05 * self.box * (number - (count - 1) / 2), level)
        self.ball = self.add(Circle(0.7), (-10.5, 0.7), EMBER, mass=4.0, friction=0.6, restitution=0.2)

    def _box(self, x: float, level: int) -> Body:
        return self.add(Polygon.box(self.box, self.box), (x, (level + 0.5) * self.box), MUTE, friction=0.6)

    def figures(self) -> dict[str, float]:
        weight = self.gravity * sum(body.mass for body in self.bodies)
        return {"count": len(self.bodies), "weight": weight, "push": self.push(self.floor)}


class Heap(Exhibit):
    """A hundred boxes and discs fall: impacts and friction turn their energy into heat."""

    name = "heap"
    quantities = (Quantity("count", (10.0, 100.0), 100.0, 5.0), Quantity("rubbing", (0.1, 1.0), 0.5, 0.1))
    columns = 15

    def build(self) -> None:
        self.world.iterations = 6  # enough to come to rest: no load passes through more than a few bodies
        rng = np.random.default_rng(_SEED)
        for number in range(round(self.values["count"])):
            row, column = divmod(number, self.columns)
            x = 1.28 * (column - (self.columns - 1) / 2) + rng.uniform(-0.12, 0.12)
            place = (x, 1.0 + 1.26 * row)
            surface = {"angle": rng.uniform(0, 2 * np.pi), "friction": self.values["rubbing"]}
            if rng.random() < 0.4:
                self.add(Circle(rng.choice((0.34, 0.44, 0.54))), place, EMBER, **surface)
            else:
                wide, tall = rng.uniform(0.55, 0.95, 2)
                self.add(Polygon.box(wide, tall), place, INK if rng.random() < 0.15 else MUTE, **surface)
        self.at_first = self.energy

    def figures(self) -> dict[str, float]:
        return {"first": self.at_first, "left": self.energy}


class Impacts(Exhibit):
    """Discs in a row on smooth rails, struck by one, two and three others: as many leave as arrive.

    The discs stand a hair apart, so that one impact follows the other; had they touched, all impacts would be
    one problem with many answers, and the solver's would spread the motion over the row.
    """

    name = "impacts"
    quantities = (Quantity("restitution", (0.8, 1.0), 1.0, 0.05), Quantity("striker", (0.25, 1.25), 1.0, 0.25))
    radius = 0.45
    gap = 0.01
    row = 6
    pace = 3.0
    rails = (6.4, 3.2, 0.0)

    def build(self) -> None:
        self.discs: list[list[Body]] = []
        pitch = 2 * self.radius + self.gap
        for number, rail in enumerate(self.rails):
            if rail:
                self.add(Polygon.box(self.width, 0.12), (0.0, rail - 0.06), FAINT, static=True)
            strikers = [self._disc(-7.0 - pitch * k, rail, self.pace) for k in reversed(range(number + 1))]
            self.discs.append(strikers + [self._disc(pitch * k, rail, 0.0) for k in range(self.row)])
        self.energy_at_first = self.kinetic_energy

    def _disc(self, x: float, rail: float, pace: float) -> Body:
        surface = {"friction": 0.0, "restitution": self.values["restitution"]}
        mass, colour = (self.values["striker"], EMBER) if pace else (1.0, MUTE)
        disc = self.add(Circle(self.radius), (x, rail + self.radius), colour, mass=mass, **surface)
        disc.velocity = (pace, 0.0)
        return disc

    def figures(self) -> dict[str, float]:
        return {**self.values, "first": self.energy_at_first, "now": self.kinetic_energy}

    def labels(self) -> list[Label]:
        labels = []
        for number, (rail, discs) in enumerate(zip(self.rails, self.discs, strict=True)):
            moving = sum(speed(disc) > _MOVES for disc in discs)
            momentum = sum(float(disc.velocity[0, 0]) * disc.mass for disc in discs)
            text = texts.IMPACTS_RAIL.format(sent=number + 1, moving=moving, momentum=abs(momentum))
            labels.append(Label(text, (8.6, rail + 1.5)))
        return labels


# Each is built for a gravity in m/s² and values of its quantities.
EXHIBITS: Final[dict[str, type[Exhibit]]] = {
    kind.name: kind for kind in (Stack, Heap, Slopes, Bounce, Impacts, DragRace)
}
