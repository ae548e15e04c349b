"""Exhibits of conservation laws: momentum in impacts, angular momentum in spin."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final

import numpy as np

from engine import DT, Body, Circle, Polygon
from game.core import texts
from game.scenes.physics.exhibit import CLEAR, Exhibit, Label, Quantity, height, speed

_MOVES: Final = 0.05  # metres per second, from which a disc counts as moving


class Impacts(Exhibit):
    """Discs in a row on smooth rails, struck by one, two and three others: as many leave as arrive.

    The discs stand a hair apart, so that one impact follows the other; had they touched, all impacts would be
    one problem with many answers, and the solver's would spread the motion over the row.
    """

    name = "impacts"
    quantities = (Quantity("restitution", (0.8, 1.0), 1.0, 0.05), Quantity("striker", (0.25, 1.25), 1.0, 0.25))
    plot_side = "left"
    patience = 240
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
        """Lay the rails, and set the strikers in motion."""
        self.discs: list[list[Body]] = []
        pitch = 2 * self.radius + self.gap
        for number, rail in enumerate(self.rails[:1] if self.lean else self.rails):
            if rail:
                self.add(Polygon.box(self.width, 0.12), (0.0, rail - 0.06), "rail", static=True)
            strikers = [self._disc(-7.0 - pitch * k, rail, self.pace) for k in reversed(range(number + 1))]
            self.discs.append(strikers + [self._disc(pitch * k, rail, 0.0) for k in range(self.row)])
        self.energy_at_first = self.kinetic_energy

    @property
    def state(self) -> str:
        """State of the energy: "untouched", "losing" with a restitution below 1, "touched" once a hand changed it."""
        if self.touched.any():
            return "touched"
        return "untouched" if self.values["restitution"] == 1 else "losing"

    def observe(self) -> None:
        """Measure the speed of the last disc of the highest rail as soon as it moves, unless a hand has come in."""
        last = self.discs[0][-1]
        if self.result is None and speed(last) > _MOVES and not self.touched.any():
            self.result = speed(last)

    def figures(self) -> dict[str, float]:
        """Return the kinetic energy at the start and now, and the restitution."""
        restitution = self.values["restitution"]
        return {"first": self.energy_at_first, "now": self.kinetic_energy, "restitution": restitution}

    def labels(self) -> list[Label]:
        """Label each rail with the number of discs that moved at first, and that move on it now."""
        labels = []
        for number, rail in enumerate(self.rails):
            discs = self.on_rail(number)
            moving = sum(speed(disc) > _MOVES for disc in discs)
            momentum = sum(float(disc.velocity[0, 0]) * disc.mass for disc in discs)
            text = texts.IMPACTS_RAIL.format(sent=number + 1, moving=moving, momentum=abs(momentum))
            labels.append(Label(text, (9.6, rail + 1.5)))
        return labels

    def on_rail(self, number: int) -> list[Body]:
        """Return the discs between this rail and the one above it."""
        low, high = self.rails[number], self.rails[number - 1] if number else math.inf
        return [body for body in self.bodies if low <= height(body) < high]

    def _disc(self, x: float, rail: float, pace: float) -> Body:
        image = "ember-disc" if pace else "disc"
        surface = {"friction": 0.0, "restitution": self.values["restitution"]}
        mass = self.values["striker"] if pace else 1.0
        disc = self.add(Circle(self.radius), (x, rail + self.radius), image, mass=mass, **surface)
        disc.velocity = (pace, 0.0)
        return disc


class Spin(Exhibit):
    """Conservation of angular momentum, without gravity; an off-centre impulse both moves and turns a bar."""

    name = "spin"
    quantities = (Quantity("reach", (0.0, 1.4), 1.2, 0.1), Quantity("impulse", (0.1, 1.0), 0.4, 0.05))
    plot_side = "left"
    patience = 32
    weightless = True
    momentum = 1.2  # kg·m²/s
    bar = (0.5, 3.0)  # metres
    push_at = 30  # steps

    @classmethod
    def law(cls, gravity: float, values: Mapping[str, float]) -> float:  # noqa: ARG003
        """Return the spin, in rad/s, of a bar of 1 kg pushed beside its middle: r J / I."""
        inertia = (cls.bar[0] ** 2 + cls.bar[1] ** 2) / 12
        return values["reach"] * values["impulse"] / inertia

    def build(self) -> None:
        """Add three bodies spinning with the same angular momentum, and two bars to be pushed."""
        self.reach, self.impulse = self.values["reach"], self.values["impulse"]
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
        """Push both bars alike: one in the middle, one near its end."""
        if self.steps != self.push_at:
            return
        self.pushed = [not self.touched[bar.index] for bar in self.bars]  # a bar that a hand has moved is not pushed
        for bar, offset, still in zip(self.bars, (0.0, self.reach), self.pushed, strict=True):
            if still:
                bar.apply_force((self.impulse / DT, 0.0), bar.position[0] + (0.0, offset))

    def observe(self) -> None:
        """Measure the spin of the bar that is pushed beside its middle, right after the push."""
        if self.steps == self.push_at + 1 and self.pushed[1]:
            self.result = abs(float(self.bars[1].angular_velocity[0]))

    def figures(self) -> dict[str, float]:
        """Return the impulse, and the speed and spin that it gives to the bars."""
        spin = self.impulse * self.reach / self.bars[1].inertia
        return {"impulse": self.impulse, "reach": self.reach, "pace": self.impulse / self.bars[1].mass, "spin": spin}

    def angular_momenta(self) -> list[float]:
        """Angular momenta of the three spinning bodies, in kg·m²/s, each about its own centre."""
        return [float(body.angular_velocity[0]) * body.inertia for body in self.turning]

    def labels(self) -> list[Label]:
        """Label the spinning bodies and the bars with their speeds."""
        labels = []
        for body, momentum in zip(self.turning, self.angular_momenta(), strict=True):
            spin = round(float(body.angular_velocity[0]), 2) + 0.0  # never -0.00
            for line, text in enumerate(texts.SPIN_TURNING):
                words = text.format(spin=spin, momentum=round(momentum, 2) + 0.0)
                labels.append(Label(words, (0.0, -2.35 - 0.4 * line), body))
        waiting = self.steps <= self.push_at
        for number, bar in enumerate(self.bars):
            motion = texts.SPIN_MOTION.format(pace=speed(bar), spin=float(np.abs(bar.angular_velocity[0])))
            if self.pushed[number]:
                motion = texts.SPIN_BARS[number].format(motion=motion, reach=self.reach)
            elif waiting and not self.touched[bar.index]:
                motion = texts.SPIN_BARS_BEFORE[number].format(reach=self.reach)
            labels.append(Label(motion, (0.0, -1.95), bar))
        return labels
