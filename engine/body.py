"""A handle on one body's slot in every world of a batch, and how a body is to be drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from numpy.typing import NDArray

from engine.vector import Array, Bools, cross, finite

if TYPE_CHECKING:
    from engine.world import World

T = TypeVar("T", bound=np.generic)


class Body:
    """Handle on one body, which exists once in each of `world.batch` worlds.

    Arrays read through a handle are views that later steps change. They can't be written to: assign a whole
    property, or use `set` for some of the worlds, so that cached rotations, boxes and contacts are updated.
    """

    def __init__(self, world: World, index: int) -> None:
        self.world = world
        self.index = index

    @property
    def position(self) -> Array:
        """Centre of mass in metres, (batch, 2)."""
        return _read_only(self.world.state.pose[:, self.index, :2])

    @position.setter
    def position(self, value: object) -> None:
        self.set(position=value)

    @property
    def angle(self) -> Array:
        """Radians, counter-clockwise, unwrapped, (batch,)."""
        return _read_only(self.world.state.pose[:, self.index, 2])

    @angle.setter
    def angle(self, value: object) -> None:
        self.set(angle=value)

    @property
    def velocity(self) -> Array:
        """Metres a second, (batch, 2)."""
        return _read_only(self.world.state.velocity[:, self.index, :2])

    @velocity.setter
    def velocity(self, value: object) -> None:
        self.set(velocity=value)

    @property
    def angular_velocity(self) -> Array:
        """Radians a second, (batch,)."""
        return _read_only(self.world.state.velocity[:, self.index, 2])

    @angular_velocity.setter
    def angular_velocity(self, value: object) -> None:
        self.set(angular_velocity=value)

    @property
    def active(self) -> Bools:
        """Whether the body takes part, (batch,); an inactive body neither moves nor touches."""
        return _read_only(self.world.state.active[:, self.index])

    @active.setter
    def active(self, value: object) -> None:
        self.world.state.active[:, self.index] = value

    @property
    def asleep(self) -> Bools:
        """Whether the body lies still and is left alone until something changes about what it lies with, (batch,)."""
        return _read_only(self.world.asleep[:, self.index])

    def wake(self, mask: Bools | None = None) -> None:
        """Wake the body, and all that it lies with, in the worlds of `mask` (batch,), or in all."""
        chosen = np.zeros(self.world.state.active.shape, dtype=bool)
        chosen[:, self.index] = True if mask is None else mask
        self.world.wake(chosen)

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
        any is not finite.
        """
        worlds = None if mask is None else np.asarray(mask, dtype=bool)
        rows = slice(None) if worlds is None else worlds
        state = self.world.state
        places = (
            (state.pose, slice(2), "position", position),
            (state.pose, 2, "angle", angle),
            (state.velocity, slice(2), "velocity", velocity),
            (state.velocity, 2, "angular velocity", angular_velocity),
        )
        given = [(table, part, finite(name, value)) for table, part, name, value in places if value is not None]
        for table, part, value in given:
            table[rows, self.index, part] = value
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
