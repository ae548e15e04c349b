"""A batch of worlds with the same bodies in each: every array leads with the batch axis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from engine.body import Body
from engine.broad_phase import BroadPhase
from engine.contacts import MARGIN, Contacts, NarrowPhase
from engine.integrate import integrate_position, integrate_velocity
from engine.rest import Rest
from engine.shapes import Point, Shape, ShapeTable, mass_properties
from engine.solver import Solver
from engine.state import ALL, BodyParams, BodyState, Span, span
from engine.vector import Array, Bools, Ints, dot, finite

DT = 1.0 / 60.0


class World:
    """`batch` independent worlds under `gravity` (m/s²), advanced together by `step`.

    Bodies live in fixed slots, the same in every world; `active` masks, not shorter lists, take one out. `gravity` may
    be reassigned at any time to (2,) or (batch, 2), and so may `iterations` of the solver. After a step, `contacts`
    holds what touched in it (or would have, but for 2 mm), with closing speeds and impulses; contacts of sleeping
    bodies come last. Raises ValueError for values without physical sense.

    Unless `sleeping` is off, what lies still falls asleep and costs little, until something about it changes. So that
    a heap comes to lie still, impulses pass over to points that take the place of others. Flights are computed, and
    were recorded, with it off.
    """

    def __init__(
        self,
        gravity: Sequence[float] = (0.0, -1.62),
        batch: int = 1,
        *,
        iterations: int = 10,
        sleeping: bool = True,
    ) -> None:
        if batch < 1 or iterations < 1:
            raise ValueError(f"a world needs a batch and iterations of at least 1, not {batch} and {iterations}")
        self.batch = batch
        self.sleeping = sleeping
        self.bodies: list[Body] = []
        self.shapes: list[Shape] = []
        self._shape_bodies: list[int] = []
        self.state = BodyState.at_rest(np.zeros((batch, 0, 3)))
        self._params = BodyParams.empty()
        self.contacts: Contacts | None = None
        self._remembered: Contacts | None = None  # those of `contacts` whose impulses begin the next step
        self._prepared: BodyParams | None = None  # for which `_prepare` has made what follows from them
        self.gravity = gravity
        self.iterations = iterations

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
        if self._remembered:
            # Impulses that bore a stack under a stronger gravity would throw it up: they shrink to g·g' / g·g.
            before, strength = self._gravity, dot(self._gravity, self._gravity)
            share = np.where(strength > 0, dot(before, gravity) / np.maximum(strength, 1e-30), 1.0).clip(0.0, 1.0)
            impulse = self._remembered.impulse * np.broadcast_to(share, self.batch)[self._remembered.world, None]
            self._remembered = replace(self._remembered, impulse=impulse)
        self._gravity: Array = gravity
        if self.sleeping and self._prepared:
            self.wake()

    @property
    def params(self) -> BodyParams:
        """Mass, drag and surface of the bodies; assign others to change them: all wake, and begin without impulses.

        Tables that hold what the present ones do change nothing.
        """
        return self._params

    @params.setter
    def params(self, params: BodyParams) -> None:
        if len(params.group) != len(self.bodies) or params.quadratic_drag.shape[:-2] not in ((), (self.batch,)):
            raise ValueError(f"parameters must be those of {len(self.bodies)} bodies in {self.batch} worlds")
        present = vars(self._params)
        if not all(np.array_equal(table, present[name], equal_nan=True) for name, table in vars(params).items()):
            self._remembered = None
        elif self._prepared is self._params:
            self._prepared = params
        self._params = params

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
        inverse_mass = np.zeros(3)
        if not static:
            centroid, spread = mass_properties(shapes)
            origin = centroid if centre_of_mass is None else np.asarray(centre_of_mass, dtype=float)
            shapes = [part.moved(-origin) for part in shapes] if origin.any() else shapes
            offset = centroid - origin
            turning = mass * (spread + float(dot(offset, offset))) if inertia is None else inertia
            if not (0 < mass < np.inf and 0 < turning < np.inf):
                raise ValueError(f"mass and inertia must be positive and finite, not {mass} kg and {turning} kg·m²")
            inverse_mass = np.array([1 / mass, 1 / mass, 1 / turning])
        pose = np.empty((self.batch, 3))
        pose[:, :2], pose[:, 2] = finite("position", position), finite("angle", angle)
        row = BodyParams(
            inverse_mass=np.array([inverse_mass]),
            linear_drag=np.array([(linear_drag, linear_drag, angular_drag)]),
            quadratic_drag=np.array([(quadratic_drag, quadratic_drag, angular_quadratic_drag)]),
            restitution=finite("restitution", [restitution]) if restitution is not None else np.array([np.nan]),
            friction=finite("friction", [friction]) if friction is not None else np.array([np.nan]),
            group=np.array([group]),
        )
        self._params = self._params.with_body(row)
        self.state.append(pose)
        self.shapes += shapes
        self._shape_bodies += [len(self.bodies)] * len(shapes)
        self.bodies.append(Body(self, len(self.bodies)))
        return self.bodies[-1]

    def step(self, touching: bool = True) -> None:
        """Advance every world by exactly 1/60 s; without `touching`, skip collision detection.

        Skipping is cheaper, and gives the same result, bit for bit, as long as nothing touches.
        """
        self._prepare()
        state, params, movers, gravity, rest = self.state, self.params, self.movers, self.gravity, self._rest
        rest.wake_disturbed(state, self.contacts)
        contacts = self._find_contacts() if touching else None
        solver = Solver(state, params, contacts) if contacts else None
        integrate_velocity(state, params, movers, gravity, DT, rest.awake)
        if solver:
            solver.solve_velocities(state, self.iterations, DT)
        integrate_position(state, movers, DT, rest.awake)
        if solver:
            solver.correct_positions(state, max(2, self.iterations // 3), DT)
        state.refresh_rotation(movers)
        state.force[:, movers] = 0.0
        self._remember(contacts)
        rest.fall_asleep(state, self.contacts)

    def _find_contacts(self) -> Contacts | None:
        """Return what touches, with the impulses that it begins with; None if nothing does."""
        woken = True
        while woken:  # what has woken may touch others, which were left out as asleep
            world, pair = self._broad_phase.near(self.state, self._rest.awake)
            contacts = self._narrow_phase.touching(self.state, world, pair)
            woken = self._rest.wake_touched(contacts, self.contacts)
        if contacts:
            self._narrow_phase.warm_start(contacts, self._remembered, pass_on=self.sleeping)
        return contacts

    def _remember(self, contacts: Contacts | None) -> None:
        """Keep a step's contacts, and after them those of bodies that slept in it."""
        slept = self._rest.contacts_of_sleepers(self.contacts)
        self.contacts = self._remembered = contacts.with_others(slept) if contacts else slept

    def _prepare(self) -> None:
        """Bring up to date what is made of bodies and their parameters, if any has been added or replaced."""
        if self._prepared is self.params:
            return
        params = self._prepared = self.params
        self._movers: Span | None = None
        self._shape_table = ShapeTable(self.shapes, self._shape_bodies, params.dynamic)
        self._broad_phase = BroadPhase(params, self._shape_table, self.batch, MARGIN)
        self._narrow_phase = NarrowPhase(params, self._shape_table)
        self._rest = Rest(self.state, params, self.sleeping)

    @property
    def movers(self) -> Span:
        """Bodies that a step may move: those that forces can move, and static ones that have a velocity."""
        self._prepare()
        if self._movers is None:
            self._movers = span(self.params.dynamic | self.state.velocity.any(axis=(0, 2)))
        return self._movers

    @property
    def shape_table(self) -> ShapeTable:
        """Every shape as rows of arrays."""
        self._prepare()
        return self._shape_table

    @property
    def pairs(self) -> Ints:
        """All pairs of shapes that may ever meet, (pairs, 2) rows of `shapes`; of a polygon and a circle, it first."""
        self._prepare()
        return self._broad_phase.all_pairs()

    @property
    def asleep(self) -> Bools:
        """Whether each body sleeps, (batch, bodies)."""
        self._prepare()
        return self._rest.asleep.copy()

    def wake(self) -> None:
        """Wake every body in every world."""
        self._prepare()
        self._rest.wake(np.ones(self.state.active.shape, dtype=bool), self.contacts)

    def moved(self, body: int, worlds: Bools | None = None) -> None:
        """Take note that a body was put elsewhere by hand, in these worlds or in all: its contacts no longer apply."""
        self.state.refresh_rotation(slice(body, body + 1))
        if not self.params.dynamic[body]:
            self.forget_boxes(slice(body, body + 1))
        if self._remembered:
            kept = (self._remembered.body != body).all(axis=1)
            if worlds is not None:
                kept |= ~worlds[self._remembered.world]
            self._remembered = self._remembered.take(np.flatnonzero(kept))

    def forget_boxes(self, bodies: Span = ALL) -> None:
        """Take note that static bodies were put elsewhere, or were given a velocity, by writing into `state`."""
        self._movers = None
        if self._prepared is self.params:
            self._broad_phase.forget_boxes(bodies)

    def untouched(self) -> None:
        """Take note that nothing touched in the latest step, which was not taken here."""
        self.contacts = self._remembered = None

    def memory(self) -> dict[str, Any]:
        """Return what the next step takes over from the last one, arrays that no step changes; `recall` puts it back.

        Together with `state`, `params`, `gravity` and the settings of the constructor, the future follows from it, if
        nothing sleeps.
        """
        return dict(vars(self._remembered)) if self._remembered else {}

    def recall(self, memory: Mapping[str, Any]) -> None:
        """Put back what a call of `memory` returned."""
        self.contacts = self._remembered = Contacts(**memory) if memory else None
        self.forget_boxes()


def memory_of_worlds(memory: Mapping[str, Any], worlds: Ints) -> dict[str, Any]:
    """Return the memory of some worlds (m,), each as often as it is named."""
    if not memory:
        return {}
    world, row = np.nonzero(worlds[:, None] == memory["world"])
    return {name: table[row] for name, table in memory.items()} | {"world": world}
