"""What an exhibit is: a room with bodies that follow a law, live labels, and figures of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Final

import numpy as np

from engine import DT, Body, Polygon, Shape, World
from engine.shapes import Point
from engine.vector import Array, cross, rotate
from game.drawing.canvas import Canvas
from game.drawing.tokens import MUTE, SMALL, Colour
from game.world.camera import View

CLEAR: Final = 0.35  # height that is seen above the ground, as a share of the room's width
BELOW: Final = 0.05  # and below it
_WALL: Final = 12.0  # metres; in a step nothing moves so far that it would be pressed out on the other side
# Of a grip: its spring's rad/s, its damping, 1 being critical, and its greatest m/s²: a hand throws, it tears nothing.
_PACE, _DAMPING, _STRONGEST = 12.0, 0.8, 150.0


class Grip:
    """Spring that pulls the gripped point of `body` towards `target`, the place of the hand in metres."""

    def __init__(self, body: Body, place: Array) -> None:
        self.body = body
        self.target = place
        angle = float(body.angle[0])
        self._arm = rotate(place - body.position[0], np.cos(-angle), np.sin(-angle))

    def place(self, pose: Array) -> Array:
        """Return the gripped point, in metres, with the body at a pose (3,)."""
        return pose[:2] + rotate(self._arm, np.cos(pose[2]), np.sin(pose[2]))

    def pull(self) -> None:
        """Apply the spring's force for the next step."""
        body = self.body
        arm = self.place(np.append(body.position[0], body.angle[0])) - body.position[0]
        turning = float(body.angular_velocity[0])
        velocity = body.velocity[0] + turning * np.array([-arm[1], arm[0]])
        away = self.target - body.position[0] - arm
        # Effective mass of the body at that point: it falls with the distance from the centre of mass.
        mass = 1.0 / (1.0 / body.mass + float(arm @ arm) / body.inertia)
        force = mass * (_PACE**2 * away - 2 * _DAMPING * _PACE * velocity)
        most = _STRONGEST * mass
        force *= min(1.0, most / max(float(np.hypot(*force)), 1e-9))
        body.apply_force(force)
        body.apply_torque(cross(arm, force))


@dataclass(frozen=True)
class Label:
    """Words in the room, centred on a place in metres, or at that offset from a body.

    `within` says whether its value is within its limit, shown by a mark beside the words; None for no mark.
    """

    text: str
    place: tuple[float, float]
    body: Body | None = None
    within: bool | None = None

    def draw(self, canvas: Canvas, view: View, poses: Array) -> None:
        """Draw it with its mark; `poses` (bodies, 3) are as drawn."""
        place = np.asarray(self.place)
        if self.body is not None:
            place = place + poses[self.body.index, :2]
        x, y = view.points(place).tolist()
        left = canvas.text(self.text, (x, y + 4), size=SMALL, colour=MUTE, align="centre", tabular=True).left - 10
        if self.within:
            canvas.dot((left, y), 2.5, canvas.palette.good)
        elif self.within is not None:
            canvas.marker("triangle", (left, y), 9, canvas.palette.warn)


@dataclass(frozen=True)
class Quantity:
    """Quantity of an exhibit that the visitor can change, named and written with its unit in `texts.QUANTITIES`.

    Attributes:
        limits: least and greatest value.
        start: value at first.
        step: distance between two values that can be chosen.

    """

    name: str
    limits: tuple[float, float]
    start: float
    step: float


@dataclass(frozen=True)
class Drawn:
    """A body that is seen: its outline, and the colour of that."""

    body: Body
    shape: Shape
    colour: Colour


class Exhibit:
    """One law of the engine, in a room of its own: a floor at y = 0, walls and a ceiling at the edges of the view.

    Attributes:
        name: its name in `texts.EXHIBITS`.
        width, height: of the room, in metres.
        values: the quantities, by name.
        drawn: all bodies that are seen.
        bodies: the movable bodies.
        rules: reference lines at known heights or places, as start and end in metres.
        touched: whether a hand has moved anything.

    """

    name: ClassVar[str]
    quantities: ClassVar[tuple[Quantity, ...]]
    width: ClassVar[float] = 28.0

    def __init__(self, gravity: float, values: Mapping[str, float] | None = None) -> None:
        self.gravity = gravity
        self.values = {each.name: each.start for each in self.quantities} | dict(values or {})
        self.world = World((0.0, -gravity))
        self.drawn: list[Drawn] = []
        self.bodies: list[Body] = []
        self.rules: list[tuple[tuple[float, float], tuple[float, float]]] = []
        self.steps, self.touched = 0, False
        self.height = CLEAR * self.width
        # All four reach past the corners, where the nearest way out would else lead along one of them.
        side, plate = (self.width + _WALL) / 2, Polygon.box(self.width + 2 * _WALL, _WALL)
        self.floor = self.world.add(plate, (0.0, -_WALL / 2), static=True)
        for x in (-side, side):
            self.world.add(Polygon.box(_WALL, self.height + 2 * _WALL), (x, self.height / 2), static=True)
        self.world.add(plate, (0.0, self.height + _WALL / 2), static=True, friction=0.0)
        self.build()

    # What each exhibit says

    def build(self) -> None:
        """Add the bodies."""
        raise NotImplementedError

    def observe(self) -> None:
        """Measure, after each step in which no hand has come to it yet."""

    def figures(self) -> dict[str, float]:
        """Return the figures quoted in its sentence, by their names there."""
        raise NotImplementedError

    def labels(self) -> list[Label]:
        """Return the current labels."""
        return []

    # What they share

    def step(self, grip: Grip | None = None) -> None:
        """Advance by 1/60 s, during which a grip may pull at a body, towards a place within the room."""
        if grip:
            grip.target = np.clip(grip.target, (-self.width / 2, 0.0), (self.width / 2, self.height))
            grip.pull()
            self.touched = True
        self.world.step()
        self.steps += 1
        if not self.touched:
            self.observe()

    def add(self, shape: Shape, position: Point, colour: Colour, **physics: Any) -> Body:
        """Add a visible body, its shape's middle at `position`; `physics` are keyword arguments of `World.add`."""
        body = self.world.add(shape, position, **physics)
        self.drawn.append(Drawn(body, shape, colour))
        if not body.static:
            self.bodies.append(body)
        return body

    @property
    def poses(self) -> Array:
        """Copy of the poses (x, y, angle) of all bodies, (bodies, 3)."""
        poses: Array = self.world.state.pose[0].copy()
        return poses

    @property
    def kinetic_energy(self) -> float:
        """Kinetic energy of translation and rotation, in joules."""
        inverse, velocity = self.world.params.inverse_mass, self.world.state.velocity[0]
        moving = inverse[:, 0] > 0
        return float((0.5 * velocity[moving] ** 2 / inverse[moving]).sum())

    @property
    def energy(self) -> float:
        """Mechanical energy, in joules: kinetic, and potential above the floor."""
        inverse, heights = self.world.params.inverse_mass[:, 0], self.world.state.pose[0, :, 1]
        moving = inverse > 0
        return self.kinetic_energy + self.gravity * float((heights[moving] / inverse[moving]).sum())

    def push(self, body: Body) -> float:
        """Return the last step's normal force of all others on a body, in newtons."""
        contacts = self.world.contacts
        if contacts is None:
            return 0.0
        return float(contacts.impulse[(contacts.body == body.index).any(axis=1), :2].sum()) / DT


def height(body: Body) -> float:
    """Return the height of a body's centre above the floor, in metres."""
    return float(body.position[0, 1])


def speed(body: Body) -> float:
    """Return the speed of a body, in metres per second."""
    return float(np.hypot(*body.velocity[0]))
