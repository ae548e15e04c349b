"""A batch of worlds with the same bodies in each: every array leads with the batch axis."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import replace
from operator import is_
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
        if batch < 1:
            raise ValueError(f"a world needs a batch of at least 1, not {batch}")
        self.batch = batch
        self._impulses: Contacts | None = None  # those of the last step's contacts whose impulses begin the next one
        self.gravity = gravity
        self.iterations = iterations
        self.sleeping = sleeping
        self.state = BodyState.at_rest(np.zeros((batch, 0, 3)))
        self.params = BodyParams.empty()
        self.bodies: list[Body] = []
        self.shapes: list[Shape] = []
        self.contacts: Contacts | None = None
        self._shape_bodies: list[int] = []
        self._known: dict[str, Array | Ints] = {}  # tables of `params`, for which the rest is made
        self._shape_table: ShapeTable
        self._broad_phase: BroadPhase
        self._rest: Rest
        self._movers: Span | None = None

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
        if self._impulses:
            # Impulses that bore a stack under a stronger gravity would throw it up: they shrink to g·g' / g·g.
            before, strength = self._gravity, dot(self._gravity, self._gravity)
            share = np.where(strength > 0, dot(before, gravity) / np.maximum(strength, 1e-30), 1.0).clip(0.0, 1.0)
            impulse = self._impulses.impulse * np.broadcast_to(share, self.batch)[self._impulses.world, None]
            self._impulses = replace(self._impulses, impulse=impulse)
        self._gravity: Array = gravity

    @property
    def iterations(self) -> int:
        """Iterations of the solver, at least 1."""
        return self._iterations

    @iterations.setter
    def iterations(self, value: int) -> None:
        if not isinstance(value, int | np.integer) or value < 1:
            raise ValueError(f"the solver needs a whole number of iterations, at least 1, not {value}")
        self._iterations = int(value)

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
            inverse_mass=[inverse_mass],
            linear_drag=[(linear_drag, linear_drag, angular_drag)],
            quadratic_drag=[(quadratic_drag, quadratic_drag, angular_quadratic_drag)],
            restitution=[np.nan if restitution is None else finite("restitution", restitution)],
            friction=[np.nan if friction is None else finite("friction", friction)],
            group=[group],
        )
        self.params.append(row)
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
        rest.wake_disturbed(state, gravity, self.contacts)
        contacts, solver = None, None
        while touching:
            world, pair = self._broad_phase.near(state, rest.awake)
            contacts = self._narrow_phase.touching(state, world, pair)
            if not rest.wake_touched(contacts, self.contacts):
                break  # else again: what has woken may touch others, which `near` left out as asleep
        if contacts:
            self._narrow_phase.warm_start(contacts, self._impulses, pass_on=self.sleeping)
            solver = Solver(state, params, contacts)
        integrate_velocity(state, params, movers, gravity, DT, rest.awake)
        if solver:
            solver.solve_velocities(state, self.iterations, DT)
        integrate_position(state, movers, DT, rest.awake)
        if solver:
            solver.correct_positions(state, max(2, self.iterations // 3), DT)
        state.refresh_rotation(movers)
        state.force[:, movers] = 0.0
        self._keep(contacts)
        rest.fall_asleep(state, gravity, self.contacts)

    def _keep(self, contacts: Contacts | None) -> None:
        """Remember a step's contacts, and those of bodies that slept in it."""
        slept, awake = None, self._rest.awake
        if self.contacts and awake is not None:
            kept = ~awake[self.contacts.world[:, None], self.contacts.body].any(axis=1)
            slept = self.contacts if kept.all() else self.contacts.take(np.flatnonzero(kept))
            slept.approach = np.zeros_like(slept.approach)
        self.contacts = self._impulses = contacts.with_others(slept) if contacts else slept or None

    def _prepare(self) -> None:
        """Bring up to date what depends on bodies and their parameters, if any has been added or replaced.

        What is remembered of other bodies stays, unless others may meet now than before.
        """
        if self._up_to_date():
            return
        params, before, self._known = self.params, self._known, dict(vars(self.params))
        count, self._movers = len(before.get("group", ())), None
        kept = before and np.array_equal(params.group[:count], before["group"])
        if kept and np.array_equal(params.dynamic[:count], before["inverse_mass"][:, 0] > 0):
            if len(self.bodies) > count:
                self._shape_table = ShapeTable(self.shapes, self._shape_bodies, params.dynamic, self._shape_table)
                self._broad_phase = BroadPhase(params, self._shape_table, self.batch, MARGIN, self._broad_phase)
                self._rest.add(params, self.state)
            if (changed := params.changed(before)).any():
                changed = np.append(changed, np.zeros(len(self.bodies) - count, dtype=bool))
                self._forget(np.broadcast_to(changed, (self.batch, len(changed))))
                self._rest.wake(np.broadcast_to(changed, (self.batch, len(changed))), self.contacts)
        else:
            self._shape_table = ShapeTable(self.shapes, self._shape_bodies, params.dynamic)
            self._broad_phase = BroadPhase(params, self._shape_table, self.batch, MARGIN)
            self._rest = Rest(params, self.state, self.gravity, self.sleeping)
            self.contacts = self._impulses = None
        self._narrow_phase = NarrowPhase(params, self._shape_table, self._broad_phase.pairs)

    def _up_to_date(self) -> bool:
        return bool(self._known) and all(map(is_, self._known.values(), vars(self.params).values()))

    def _forget(self, bodies: Bools) -> None:
        """Drop the remembered impulses of some bodies, (batch, bodies)."""
        if self._impulses:
            gone = bodies[self._impulses.world[:, None], self._impulses.body].any(axis=1)
            self._impulses = self._impulses.take(np.flatnonzero(~gone))

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
        return self._broad_phase.pairs

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
        gone = np.zeros(self.state.active.shape, dtype=bool)
        gone[slice(None) if worlds is None else worlds, body] = True
        self._forget(gone)

    def forget_boxes(self, bodies: Span = ALL) -> None:
        """Take note that static bodies were put elsewhere, or were given a velocity, by writing into `state`."""
        self._movers = None
        if self._up_to_date():
            self._broad_phase.forget_boxes(bodies)

    def untouched(self) -> None:
        """Take note that nothing touched in the latest step, which was not taken here."""
        self.contacts = self._impulses = None

    def memory(self) -> dict[str, Any]:
        """Return what the next step takes over from the last one, arrays that no step changes; `recall` puts it back.

        Together with `state`, `gravity`, `params` and the settings of the constructor, it is all that a world's future
        depends on.
        """
        self._prepare()
        contacts = vars(self._impulses) if self._impulses else {}
        rest = {"rest": copy.deepcopy(vars(self._rest))} if self.sleeping else {}
        return {"gravity": self.gravity, "contacts": dict(contacts), **rest}

    def recall(self, memory: Mapping[str, Any]) -> None:
        """Put back what a call of `memory` returned."""
        self._prepare()
        contacts = memory["contacts"]
        self.contacts = self._impulses = Contacts(**contacts) if contacts else None
        vars(self._rest).update(copy.deepcopy(memory.get("rest", {})))
        self.forget_boxes()


def memory_of_worlds(memory: Mapping[str, Any], worlds: Ints) -> dict[str, Any]:
    """Return the memory of some worlds (m,), each as often as it is named; of worlds without sleep."""
    contacts, gravity = memory["contacts"], memory["gravity"]
    if "rest" in memory:
        raise ValueError("worlds in which bodies sleep are remembered as a whole")
    if contacts:
        world, row = np.nonzero(worlds[:, None] == contacts["world"])
        contacts = {name: table[row] for name, table in contacts.items()} | {"world": world}
    return {"gravity": gravity if gravity.ndim == 1 else gravity[worlds], "contacts": contacts}
