"""Free flight of one body in a world that is alone in its batch, in plain floats.

NumPy takes about a microsecond for a call on an array of length one, and a step without contacts makes eighty such
calls. Python's floats are the same doubles and take a thirtieth of that, so that one body flies many times as fast.
"""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING, Final

import numpy as np

from engine.contacts import MARGIN
from engine.vector import dot, length, rotate

if TYPE_CHECKING:
    from engine.world import World

# A fixed shape: its row, its box (low and high corner), and its faces (nx, ny, far).
Fixed = tuple[int, list[float], list[list[float]]]
_APART: Final = MARGIN + 1e-6  # metres between shapes that do not touch, and far more than rounding makes of them


class FreeFlight:
    """The only body that forces can move in a world of batch 1 and of polygons, while nothing fixed is near it.

    `step` is `World.step` without contacts, in the same operations and the same order: its results are the same, bit
    for bit. `take` and `feel` read what it needs, `give` writes the body's state back after some steps. Mass and linear
    drag are read once, and so are the faces of fixed bodies, until `forget`; what may sway by some metres to both
    sides of its place counts as everywhere at once. Raises ValueError if any shape of the world is a circle.

    Attributes:
        body: index of the body.
        x, y, angle: metres and radians.
        vx, vy, spin: m/s and rad/s.
        cos, sin: of the angle.

    """

    def __init__(self, world: World, body: int, sway: float = 0.0) -> None:
        self._world, self.body, self._sway = world, body, sway
        self._seen: tuple[int, bytes] | None = None  # what tells whether fixed bodies are as they were when read
        params, shapes = world.params, world.shape_table
        if shapes.is_circle.any():
            raise ValueError("free flight knows polygons alone")
        self._inverse_mass, _, self._inverse_inertia = params.inverse_mass[body].tolist()
        self._drag, _, self._turn_drag = params.linear_drag[body].tolist()
        corners = shapes.start[shapes.body == body].reshape(-1, 2)
        self._corners = sorted({(right, up) for right, up in corners.tolist()})
        self._reach = float(length(corners).max()) + _APART
        self._fixed: list[Fixed] | None = None
        self._highest = -np.inf
        self.take()
        self.feel()

    def forget(self) -> None:
        """Read again where fixed bodies are, before it matters: they were put elsewhere."""
        self._fixed = None

    def _look_around(self) -> list[Fixed]:
        """Read where fixed bodies are, and how high the highest reaches."""
        shapes, state = self._world.shape_table, self._world.state
        fixed = np.flatnonzero((shapes.body != self.body) & state.active[0, shapes.body])
        body = shapes.body[fixed]
        sway = np.array([2 * self._sway, 0.0])  # what is at one end of its way now may go to the other
        cos, sin = state.cos[0, body, None], state.sin[0, body, None]
        start = rotate(shapes.start[fixed], cos, sin) + state.pose[0, body, None, :2]
        normal = rotate(shapes.normal[fixed], cos, sin)
        far = dot(normal, start) + dot(np.abs(normal), sway) + _APART
        boxes = np.concatenate([start.min(axis=1) - sway, start.max(axis=1) + sway], axis=1)
        faces = np.concatenate([normal, far[..., None]], axis=2)
        self._highest = float(boxes[:, 3].max(initial=-np.inf))
        return list(zip(fixed.tolist(), boxes.tolist(), faces.tolist(), strict=True))

    def take(self) -> None:
        """Read the body's state."""
        state, body = self._world.state, self.body
        self.x, self.y, self.angle = state.pose[0, body].tolist()
        self.vx, self.vy, self.spin = state.velocity[0, body].tolist()
        self.cos, self.sin = state.cos.item(0, body), state.sin.item(0, body)

    def feel(self) -> None:
        """Read gravity and the air's drag, which may have changed since the last flight."""
        self._gravity = self._world.gravity.ravel().tolist()
        self._air, _, self._turn_air = self._world.params.quadratic_drag[..., self.body, :].ravel().tolist()

    def give(self) -> None:
        """Write the body's state back, as after a step in which nothing touched."""
        state, body = self._world.state, self.body
        pose, velocity = state.pose, state.velocity
        pose[0, body, 0], pose[0, body, 1], pose[0, body, 2] = self.x, self.y, self.angle
        velocity[0, body, 0], velocity[0, body, 1], velocity[0, body, 2] = self.vx, self.vy, self.spin
        state.cos[0, body], state.sin[0, body] = self.cos, self.sin
        self._world.untouched()

    def near(self) -> bool:
        """Whether anything fixed is so near that a step must look for contacts.

        It need not where a face of every fixed shape has the whole body before it: a separating axis, as in `collide`.
        """
        around = self.around()
        if not around:
            return False
        x, y, cos, sin = self.x, self.y, self.cos, self.sin
        corners = [(right * cos - up * sin + x, right * sin + up * cos + y) for right, up in self._corners]
        return not all(
            any(all(nx * right + ny * up > far for right, up in corners) for nx, ny, far in faces)
            for _, _, faces in around
        )

    def around(self) -> list[Fixed]:
        """Return the fixed shapes whose boxes the body might touch, however it is turned."""
        world = self._world
        # What sways is everywhere at once, and is moved about all the time.
        seen = (0 if self._sway else world.fixed_version, world.state.active.tobytes())
        if self._fixed is None or self._seen != seen:
            self._fixed, self._seen = self._look_around(), seen
        x, y, reach = self.x, self.y, self._reach
        if y - reach > self._highest:
            return []
        left, right, low, high = x - reach, x + reach, y - reach, y + reach
        return [
            fixed
            for fixed in self._fixed
            if low <= fixed[1][3] and fixed[1][1] <= high and left <= fixed[1][2] and fixed[1][0] <= right
        ]

    def step(self, force_x: float, force_y: float, torque: float, dt: float) -> None:
        """Advance by `dt` seconds under gravity, drag and this force, as `integrate` does."""
        self.fall(force_x, force_y, torque, dt)
        self.move(dt)

    def fall(self, force_x: float, force_y: float, torque: float, dt: float) -> None:
        """Change the velocity alone."""
        vx, vy, spin = self.vx, self.vy, self.spin
        ease, turn_ease = self._inverse_mass * dt, self._inverse_inertia * dt
        gravity_x, gravity_y = self._gravity
        slowing = 1.0 + (self._drag + self._air * sqrt(vx * vx + vy * vy)) * ease
        turn_slowing = 1.0 + (self._turn_drag + self._turn_air * abs(spin)) * turn_ease
        self.vx = (vx + force_x * ease + gravity_x * dt) / slowing
        self.vy = (vy + force_y * ease + gravity_y * dt) / slowing
        self.spin = (spin + torque * turn_ease) / turn_slowing

    def move(self, dt: float) -> None:
        """Move along the velocity."""
        self.x += self.vx * dt
        self.y += self.vy * dt
        self.angle += self.spin * dt
        self.turn()

    def turn(self) -> None:
        """Bring `cos` and `sin` up to date."""
        # NumPy's own functions: `math` has others, which may differ in the last bit.
        self.cos, self.sin = float(np.cos(self.angle)), float(np.sin(self.angle))
