"""Exhibits of single bodies: friction on a slope, restitution, drag."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from engine import Body, Circle, Polygon
from game.core import texts
from game.drawing.tokens import EMBER, FAINT, INK, MUTE
from game.scenes.physics.exhibit import Exhibit, Label, Quantity, height, speed

_FOOT: Final = -0.014  # shares of a room's width above the ground, for the names of columns
_TOUCH: Final = 0.005  # gap in metres below which a body counts as landed
_SLID: Final = 0.1  # metres from its place from which a box counts as having slid
_DISC: Final = 0.42  # metres, the radius of a disc of 1 kg: all have the same density


class Slopes(Exhibit):
    """Five boxes on one slope: those slide whose coefficient of friction is less than tan θ."""

    name, width = "slopes", 32.0
    quantities = (Quantity("degrees", (5.0, 36.0), 30.0, 1.0), Quantity("friction", (0.0, 1.0), 0.5, 0.05))
    size = (1.4, 0.9)
    length = 16.0 / math.cos(math.pi / 6)  # metres along the slope
    foot = 5.0  # its lower end
    which = 2  # the box whose friction can be changed

    def build(self) -> None:
        """Place the slipperiest box lowest, so that none runs into another."""
        self.frictions = (0.2, 0.35, self.values["friction"], 0.65, 0.8)
        slope = math.radians(self.values["degrees"])
        self.tangent = math.tan(slope)
        right, top = self.foot, self.length * math.sin(slope)
        left = right - self.length * math.cos(slope)
        middle = np.array([(left + right) / 2, top / 2])
        corners = np.array([(left, 0.0), (right, 0.0), (left, top)]) - middle
        self.add(Polygon(corners), middle, FAINT, static=True)
        down, away = np.array([math.cos(slope), -math.sin(slope)]), np.array([math.sin(slope), math.cos(slope)])
        self.boxes: list[Body] = []
        for number, friction in enumerate(self.frictions):
            place = np.array([right, 0.0]) - (3.4 + 3.3 * number) * down + self.size[1] / 2 * away
            colour = INK if number == self.which else MUTE
            self.boxes.append(self.add(Polygon.box(*self.size), place, colour, angle=-slope, friction=friction))
        self.places = [box.position[0].copy() for box in self.boxes]
        self.slid: set[int] = set()

    def observe(self) -> None:
        """Record the boxes that have slid, by their numbers."""
        for number, (box, place) in enumerate(zip(self.boxes, self.places, strict=True)):
            if np.hypot(*(box.position[0] - place)) > _SLID:
                self.slid.add(number)

    def figures(self) -> dict[str, float]:
        return {"degrees": self.values["degrees"], "tangent": self.tangent, "slid": len(self.slid)}

    def labels(self) -> list[Label]:
        return [
            Label(texts.SLOPE_FRICTION.format(friction=friction), (0.45, 1.0), box, self.tangent <= friction)
            for box, friction in zip(self.boxes, self.frictions, strict=True)
        ]


class Bounce(Exhibit):
    """Five balls dropped from one height h: each bounces back to e² h."""

    name, width = "bounce", 22.0
    quantities = (Quantity("restitution", (0.1, 1.0), 0.75, 0.05), Quantity("drop", (1.0, 6.5), 6.0, 0.5))
    radius = 0.4
    which = 3  # the ball that its sentence is about, and whose restitution can be changed

    def build(self) -> None:
        drop = self.values["drop"]
        self.restitutions = np.array((0.0, 0.25, 0.5, self.values["restitution"], 1.0))
        self.expected, self.columns = self.restitutions**2 * drop, -8.8 + 4.0 * np.arange(len(self.restitutions))
        self.balls: list[Body] = []
        for number, restitution in enumerate(self.restitutions.tolist()):
            x, y = float(self.columns[number]), float(self.expected[number])
            place, colour = (x, drop + self.radius), INK if number == self.which else EMBER
            self.balls.append(self.add(Circle(self.radius), place, colour, restitution=restitution))
            if restitution:
                self.rules.append(((x - 0.7, y), (x + 0.7, y)))
        self.peaks = np.zeros(len(self.balls))  # metres reached since the first impact
        self.bounced = np.zeros(len(self.balls), dtype=bool)

    def observe(self) -> None:
        """Follow each ball down, and up again."""
        bottom = self.world.state.pose[0, [ball.index for ball in self.balls], 1] - self.radius
        self.bounced |= bottom <= _TOUCH
        self.peaks = np.maximum(self.peaks, np.where(self.bounced, bottom, 0.0))

    def figures(self) -> dict[str, float]:
        return {**self.values, "expected": float(self.expected[self.which])}

    def labels(self) -> list[Label]:
        labels = []
        for number, restitution in enumerate(self.restitutions.tolist()):
            x, expected = float(self.columns[number]), float(self.expected[number])
            labels.append(Label(texts.BOUNCE_COLUMN.format(restitution=restitution), (x, _FOOT * self.width)))
            if restitution:
                words = texts.BOUNCE_PEAK if self.bounced[number] else texts.BOUNCE_MARK
                text = words.format(expected=expected, peak=self.peaks[number])
                labels.append(Label(text, (x + 2.15, expected - 0.02)))
        return labels


class DragRace(Exhibit):
    """Discs fall side by side without drag, with linear and with quadratic drag: each has its own terminal speed."""

    name, width = "drag", 40.0
    quantities = (Quantity("linear_drag", (0.5, 2.0), 1.0, 0.1), Quantity("mass", (0.5, 2.0), 1.0, 0.1))
    top = 13.0
    which = 1  # the disc that its sentence is about, and whose mass can be changed

    def build(self) -> None:
        drag = self.values["linear_drag"]
        # Name of the column, mass, linear drag in kg/s, quadratic drag in kg/m.
        self.lanes = (
            ("none", 1.0, 0.0, 0.0),
            ("linear", self.values["mass"], drag, 0.0),
            ("linear", 2.0, drag, 0.0),
            ("quadratic", 1.0, 0.0, 0.5),
            ("quadratic", 2.0, 0.0, 0.5),
        )
        self.discs = [
            self.add(
                Circle(_DISC * math.sqrt(mass)),
                (self._lane(number), self.top),
                {"none": MUTE, "linear": INK, "quadratic": EMBER}[name],
                mass=mass,
                linear_drag=linear,
                quadratic_drag=quadratic,
            )
            for number, (name, mass, linear, quadratic) in enumerate(self.lanes)
        ]
        self.speeds = [0.0] * len(self.discs)

    def observe(self) -> None:
        """Measure the speed of each disc until it lands."""
        for number, disc in enumerate(self.discs):
            if height(disc) - _DISC * math.sqrt(disc.mass) > _TOUCH and disc.velocity[0, 1] < 0:
                self.speeds[number] = speed(disc)

    def terminal(self, number: int) -> float:
        """Return the terminal speed, at which drag balances the weight, in metres per second; infinite without drag."""
        _, mass, linear, quadratic = self.lanes[number]
        if linear:
            return mass * self.gravity / linear
        return math.sqrt(mass * self.gravity / quadratic) if quadratic else math.inf

    def figures(self) -> dict[str, float]:
        return {"mass": self.values["mass"], "terminal": self.terminal(self.which)}

    def labels(self) -> list[Label]:
        labels = []
        for number, (name, mass, _, _) in enumerate(self.lanes):
            words = texts.DRAG_LANES[name]
            text = words.format(mass=mass, speed=self.speeds[number], terminal=self.terminal(number))
            below = _FOOT * self.width * (1 + 1.4 * (number % 2))  # in two rows: they are long
            labels.append(Label(text, (self._lane(number), below)))
        return labels

    def _lane(self, number: int) -> float:
        return -15.2 + 7.2 * number
