"""A handle on one body's slot in every world of a batch, and how a body is to be drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from engine.vector import Array, Bools, cross, finite

if TYPE_CHECKING:
    from engine.world import World

T = TypeVar("T", bound=np.generic)


class _Part:
    """Part of a table of the world's state that belongs to a body: read as a view, set by assignment in all worlds."""

    def __init__(self, table: str, part: int | slice) -> None:
        self._table, self._part = table, part

    def __set_name__(self, owner: type[Body], name: str) -> None:
        self._name = name

    def of(self, body: Body) -> Array:
        """Return the part to write into, with a row for each world."""
        part: Array = getattr(body.world.state, self._table)[:, body.index, self._part]
        return part

    def __get__(self, body: Body, owner: type[Body]) -> Array:
        return _read_only(self.of(body))

    def __set__(self, body: Body, value: object) -> None:
        values: dict[str, Any] = {self._name: value}
        body.set(**values)


class Body:
    """Handle on one body, which exists once in each of `world.batch` worlds.

    A place or an angle that is set is a teleport: the body is there at once, passes through what lies between, pushes
    and carries nothing on its way, and is only slowly pressed out of what it then overlaps. What is to push others,
    as a lift does, is given a velocity.

    Arrays read through a handle are views that later steps change. They can't be written to: assign a whole
    property, or use `set` for some of the worlds, so that cached rotations, boxes and contacts are updated.

    Attributes:
        position: centre of mass in metres, (batch, 2).
        angle: radians, counter-clockwise, unwrapped, (batch,).
        velocity: metres a second, (batch, 2).
        angular_velocity: radians a second, (batch,).

    """

    position = _Part("pose", slice(2))
    angle = _Part("pose", 2)
    velocity = _Part("velocity", slice(2))
    angular_velocity = _Part("velocity", 2)

    def __init__(self, world: World, index: int) -> None:
        self.world = world
        self.index = index

    @property
    def active(self) -> Bools:
        """Whether the body takes part, (batch,); an inactive body neither moves nor touches."""
        return _read_only(self.world.state.active[:, self.index])

    @active.setter
    def active(self, value: object) -> None:
        self.world.state.active[:, self.index] = value

    @property
    def static(self) -> bool:
        """Whether no force can move the body. A static body with a velocity still moves along it, like a lift."""
        return not self.world.params.dynamic[self.index]

    @property
    def mass(self) -> float:
        """Kilograms; infinite for a static body."""
        return self._inverse(0)

    @property
    def inertia(self) -> float:
        """Moment of inertia about the centre of mass, kg·m²; infinite for a static body."""
        return self._inverse(2)

    def apply_force(self, force: object, point: object = None) -> None:
        """Add a force (2,) or (batch, 2) in newtons for the next step, at a world `point` or the centre."""
        push = np.broadcast_to(finite("force", force), (self.world.batch, 2))
        if point is not None:
            self.apply_torque(cross(finite("point", point) - self.position, push))
        if not self.static:
            self.world.state.force[:, self.index, :2] += push

    def apply_torque(self, torque: object) -> None:
        """Add a torque, one or (batch,), in newton metres for the next step."""
        turn = finite("torque", torque)
        if not self.static:
            self.world.state.force[:, self.index, 2] += turn

    def set(
        self,
        *,
        position: object = None,
        angle: object = None,
        velocity: object = None,
        angular_velocity: object = None,
        mask: Bools | None = None,
    ) -> None:
        """Set pose and velocity in the worlds of `mask` (batch,), or in all; what is left out stays.

        Values are one for all worlds or have a row for each world that is set. Raises ValueError, and sets nothing, if
        any is not finite or of another shape.
        """
        worlds = None if mask is None else np.asarray(mask, dtype=bool)
        rows = slice(None) if worlds is None else worlds
        values = {"position": position, "angle": angle, "velocity": velocity, "angular_velocity": angular_velocity}
        parts = {name: vars(Body)[name].of(self) for name, value in values.items() if value is not None}
        given = {name: np.broadcast_to(finite(name, values[name]), part[rows].shape) for name, part in parts.items()}
        for name, part in parts.items():
            part[rows] = given[name]
        if self.static or position is not None or angle is not None:
            self.world.moved(self.index, worlds)

    def _inverse(self, row: int) -> float:
        value = float(self.world.params.inverse_mass[self.index, row])
        return 1.0 / value if value else float("inf")


@dataclass(frozen=True)
class Sprite:
    """Description of the picture to draw at a body's position and angle.

    Attributes:
        image: key of a picture in the renderer's table; the engine has none.
        size: width and height of the picture in metres, its middle at the body's position.
        layer: higher ones lie on top.

    """

    body: Body
    image: str
    size: tuple[float, float]
    layer: int = 0


def _read_only(view: NDArray[T]) -> NDArray[T]:
    view.flags.writeable = False
    return view
