"""A batch of worlds with the same bodies in each: every array leads with the batch axis."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from engine.body import Body
from engine.contact_set import Contacts
from engine.contacts import Detector
from engine.integrate import MovingBodies, integrate_position, integrate_velocity
from engine.rest import Rest
from engine.shapes import Point, Shape, mass_properties
from engine.solver import Solver
from engine.state import BodyParams, BodyState, ShapeTable
from engine.vector import Array, Bools, dot, finite

DT = 1.0 / 60.0


class World:
    """`batch` independent worlds under `gravity` (m/s²), advanced together by `step`.

    Bodies live in fixed slots, the same in every world; `active` masks, not shorter lists, take one out.
    `gravity` may be reassigned at any time to (2,) or (batch, 2), and so may `iterations` of the solver and
    `restitution_threshold`, the closing speed (m/s) from which bodies rebound; each raises ValueError for a value
    without physical sense. After a step, `contacts` holds what touched in it (or would have, but for 2 mm), with
    closing speeds and impulses.

    Unless `sleeping` is off, what lies still falls asleep and costs nothing, until something about it changes. So
    that it comes to lie still, impulses pass over to the points that take the place of others, and overlaps of
    up to 1.5 cm are left alone. Off, each step computes everything anew, as a flight needs that was
    recorded so.
    """

    def __init__(
        self,
        gravity: Sequence[float] = (0.0, -1.62),
        batch: int = 1,
        *,
        iterations: int = 10,
        restitution_threshold: float = 0.25,
        sleeping: bool = True,
    ) -> None:
        if batch < 1:
            raise ValueError(f"a world needs a batch of at least 1, not {batch}")
        self.batch = batch
        self.gravity = gravity
        self.iterations = iterations
        self.restitution_threshold = restitution_threshold
        self.sleeping = sleeping
        self.state = BodyState.empty(batch)
        self.params = BodyParams()
        self.bodies: list[Body] = []
        self.shapes: list[Shape] = []
        self._touched: tuple[Contacts | None, Contacts | None] = (None, None)  # in the last step, and of what slept
        self._shape_bodies: list[int] = []
        self._detector: Detector | None = None
        self._movers: MovingBodies | None = None
        self._version = 0  # of `params`, with which these were made

    @property
    def gravity(self) -> Array:
        """Metres a second squared, (2,) or (batch, 2)."""
        return self._gravity

    @gravity.setter
    def gravity(self, value: Sequence[float] | Array) -> None:
        gravity = finite("gravity", value).copy()
        if gravity.shape not in ((2,), (self.batch, 2)):
            raise ValueError(f"gravity must be of shape (2,) or ({self.batch}, 2), not {gravity.shape}")
        gravity.flags.writeable = False
        self._gravity = gravity

    @property
    def iterations(self) -> int:
        """Iterations of the solver, at least 1."""
        return self._iterations

    @iterations.setter
    def iterations(self, value: int) -> None:
        if not isinstance(value, int | np.integer) or value < 1:
            raise ValueError(f"the solver needs a whole number of iterations, at least 1, not {value}")
        self._iterations = int(value)

    @property
    def restitution_threshold(self) -> float:
        """Closing speed in m/s from which bodies rebound."""
        return self._restitution_threshold

    @restitution_threshold.setter
    def restitution_threshold(self, value: float) -> None:
        if not value >= 0:
            raise ValueError(f"the speed from which bodies rebound must be 0 m/s or more, not {value}")
        self._restitution_threshold = float(value)

    def add(
        self,
        shape: Shape | Sequence[Shape],
        position: Point,
        angle: float | Sequence[float] | Array = 0.0,
        *,
        mass: float = 1.0,
        static: bool = False,
        restitution: float | None = None,
        friction: float | None = None,
        linear_drag: float = 0.0,
        quadratic_drag: float = 0.0,
        angular_drag: float = 0.0,
        angular_quadratic_drag: float = 0.0,
        group: int = 0,
        inertia: float | None = None,
        centre_of_mass: Point | None = None,
    ) -> Body:
        """Put a body of one or several shapes into every world, and return its handle.

        `position` (2,) or (batch, 2) is where the centre of mass goes, `angle` one or (batch,). Unless
        `centre_of_mass` says where it is in the shapes' frame, it is their common centroid, and the shapes are
        shifted to have it at the origin; a static body's shapes stay as given. Inertia (kg·m²) follows from
        shapes and mass unless given. Drag coefficients: kg/s and kg/m, kg·m²/s and kg·m². Restitution or
        friction left out take the other body's; if both are given, the larger restitution and the geometric
        mean of the frictions hold. Bodies of the same non-zero group pass through each other. Raises ValueError
        for a mass or inertia that is not positive and finite, and for any other value without physical sense.
        """
        shapes = list(shape) if isinstance(shape, Sequence) else [shape]
        if not shapes:
            raise ValueError("a body needs at least one shape")
        if not static and not (np.isfinite(mass) and mass > 0):
            raise ValueError(f"a body that can move needs a positive, finite mass, not {mass}")
        if inertia is not None and not (np.isfinite(inertia) and inertia > 0):
            raise ValueError(f"inertia must be positive and finite, not {inertia}")
        drag = {
            "linear_drag": linear_drag,
            "quadratic_drag": quadratic_drag,
            "angular_drag": angular_drag,
            "angular_quadratic_drag": angular_quadratic_drag,
        }
        _refuse_outside(np.inf, friction=friction or 0.0, **drag)
        _refuse_outside(1.0, restitution=restitution or 0.0)
        centroid, spread = mass_properties(shapes)
        origin = centroid if centre_of_mass is None else np.asarray(centre_of_mass, dtype=float)
        if static:
            inverse_mass = np.zeros(3)
        else:
            shapes = [part.moved(-origin) for part in shapes] if origin.any() else shapes
            offset = centroid - origin
            turning = mass * (spread + float(dot(offset, offset))) if inertia is None else inertia
            with np.errstate(all="ignore"):
                inverse_mass = 1.0 / np.array([mass, mass, turning])
            if not (np.isfinite(inverse_mass) & (inverse_mass > 0)).all():
                raise ValueError(f"a mass of {mass} kg and an inertia of {turning} kg·m² are beyond all numbers")
        pose = np.empty((self.batch, 3))
        pose[:, :2], pose[:, 2] = position, angle
        if not np.isfinite(pose).all():
            raise ValueError(f"position and angle must be finite, not {position} and {angle}")
        self.state.append(pose)
        self.params.append(
            inverse_mass=inverse_mass,
            linear_drag=(linear_drag, linear_drag, angular_drag),
            quadratic_drag=(quadratic_drag, quadratic_drag, angular_quadratic_drag),
            restitution=np.nan if restitution is None else restitution,
            friction=np.nan if friction is None else friction,
            group=group,
        )
        self.shapes += shapes
        self._shape_bodies += [len(self.bodies)] * len(shapes)
        self.bodies.append(Body(self, len(self.bodies)))
        return self.bodies[-1]

    def step(self, touching: bool = True) -> None:
        """Advance every world by exactly 1/60 s; without `touching`, skip collision detection.

        Skipping is cheaper, and gives the same result, bit for bit, as long as nothing touches.
        """
        rest = self.detector.rest
        if self.gravity is not self.detector.gravity:
            self.detector.feel(self.gravity, self.batch)
        if rest and rest.undisturbed(self.state, self.gravity):
            self._touched = (rest.contacts, None)
            return
        contacts = self.detector.find(self.state) if touching else None
        awake = rest.awake if rest else None
        solver = Solver(self.state, self.params, contacts) if contacts else None
        integrate_velocity(self.state, self.movers, self.gravity, DT, awake)
        if solver:
            solver.solve_velocities(self.state, self.iterations, self.restitution_threshold, DT)
        integrate_position(self.state, self.movers.bodies, DT, awake)
        if solver:
            solver.solve_overlaps(self.state, max(2, self.iterations // 3), DT, lenient=rest is not None)
        self.state.refresh_rotation(self.movers.bodies)
        self.state.force[:] = 0.0
        self._touched = (contacts, rest.settle(self.state, contacts, self.gravity) if rest else None)
        self.detector.remember(contacts)

    @property
    def contacts(self) -> Contacts | None:
        """What touched in the last step, those of sleeping bodies last; joined when it is asked for."""
        if self._touched[1] is not None:
            self._touched = (Contacts.join(*self._touched), None)
        return self._touched[0]

    @property
    def asleep(self) -> Bools:
        """Whether each body sleeps, (batch, bodies)."""
        rest = self.detector.rest
        return rest.asleep.copy() if rest else np.zeros(self.state.active.shape, dtype=bool)

    def wake(self) -> None:
        """Wake every body in every world."""
        rest = self.detector.rest
        if rest:
            rest.wake(np.ones_like(rest.asleep))

    def untouched(self) -> None:
        """Note that nothing touched in the latest step, which `free_flight` took."""
        self.detector.remember(None)
        self._touched = (None, None)

    @property
    def detector(self) -> Detector:
        """Contact detector; made anew when a body has been added, or a parameter replaced."""
        self._heed_params()
        if self._detector is None:
            table = ShapeTable(self.shapes, self._shape_bodies, self.params.dynamic)
            self._detector = Detector(self.params, table, Rest(self.params, self.batch) if self.sleeping else None)
        return self._detector

    @property
    def movers(self) -> MovingBodies:
        """Bodies that a step may move: those that forces can move, and static ones that have a velocity."""
        self._heed_params()
        if self._movers is None:
            self._movers = MovingBodies(self.params, self.params.dynamic | self.state.velocity.any(axis=(0, 2)))
        return self._movers

    def _heed_params(self) -> None:
        """Forget what was made with other parameters."""
        if self._version != self.params.version:
            self._version = self.params.version
            self._detector = self._movers = None

    def moved(self, body: Body, worlds: Bools | None) -> None:
        """Update what is cached about a body that was changed by hand, in these worlds or in all."""
        self.state.refresh_rotation(slice(body.index, body.index + 1))
        if body.static:
            self._movers = None
        if self._detector is not None:
            self._detector.forget(body.index, worlds)
            if body.static:
                self._detector.broad.forget_boxes()


def _refuse_outside(most: float, **values: float) -> None:
    """Raise ValueError if one of the values is not finite, or not from 0 to `most`."""
    for name, value in values.items():
        if not (np.isfinite(value) and 0 <= value <= most):
            raise ValueError(f"{name} must be a number from 0 to {most}, not {value}")
