"""Craft and its worlds: thrust, motion and readings of them, without any judgement of a flight."""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

from ai.common.environment import Bools, Doubles, Ints
from ai.lander.conditions import Conditions
from ai.lander.ground import Ground
from ai.lander.rules import FOOT_CENTRE, FOOT_SIZE, HULL, LanderParams
from engine import DT, Polygon, World

_ALONG: Final = np.linspace(0.0, 1.0, 32, endpoint=False)[:, None, None]  # of every edge of the craft


def _outline() -> Doubles:
    """Return points around the craft, metres from its centre of mass, (k, 2): every corner, and some between."""
    middle, (half, rise) = np.array(FOOT_CENTRE), np.array(FOOT_SIZE) / 2
    foot = middle + np.array([(-half, -rise), (half, -rise), (half, rise), (-half, rise)])
    parts = np.array(HULL), foot, foot * (-1, 1)
    return np.concatenate([(part + _ALONG * (np.roll(part, -1, axis=0) - part)).reshape(-1, 2) for part in parts])


_OUTLINE: Final = _outline()


class Craft:
    """`num_envs` landers, each in a world of its own over the same `ground`, and all under the same `conditions`.

    Attributes:
        actions: what each was last told to do, 0 to 5, (n,).
        shares: with which shares of thrust, (n, 2): of the main engine, 0 to 1, and of the jets, -1, left, to 1, right.
        steps: physics steps of 1/60 s flown, (n,).
        main_steps, side_steps: the same with the main engine and with a jet, each step by its share of thrust, (n,).
        target: the number of the pad that readings are relative to, (n,).

    """

    def __init__(self, num_envs: int, params: LanderParams, ground: Ground, conditions: Conditions) -> None:
        self.num_envs = num_envs
        self.params, self.ground, self.conditions = params, ground, conditions
        self._build_world()
        self.actions: Ints = np.zeros(num_envs, dtype=np.intp)
        self.steps: Ints = np.zeros(num_envs, dtype=np.intp)
        self.shares: Doubles = np.zeros((num_envs, 2))
        self.main_steps: Doubles = np.zeros(num_envs)
        self.side_steps: Doubles = np.zeros(num_envs)
        self.target: Ints = np.zeros(num_envs, dtype=np.intp)

    def _build_world(self) -> None:
        params = self.params
        surface: dict[str, Any] = {"restitution": params.restitution, "friction": params.friction}
        self.world = World(gravity=(0.0, -params.gravity), batch=self.num_envs, iterations=5, sleeping=False)
        foot_x, foot_y = FOOT_CENTRE
        self.lander = self.world.add(
            [Polygon(HULL), Polygon.box(*FOOT_SIZE, (-foot_x, foot_y)), Polygon.box(*FOOT_SIZE, (foot_x, foot_y))],
            (0.0, params.pad_top + params.stand),
            mass=params.mass,
            inertia=params.inertia,
            centre_of_mass=(0.0, 0.0),
            linear_drag=params.linear_drag,
            quadratic_drag=params.quadratic_drag,
            angular_drag=params.angular_drag,
            angular_quadratic_drag=params.angular_quadratic_drag,
            **surface,
        )
        pads = self.ground.build(self.world, **surface)
        self._pad_bodies = slice(pads[0].index, pads[-1].index + 1)

    @property
    def gravity(self) -> float:
        """Gravity in m/s²; can be changed at any time, for all landers."""
        return -float(self.world.gravity[1])

    @gravity.setter
    def gravity(self, gravity: float) -> None:
        self.world.gravity = np.array([0.0, -gravity])

    @property
    def position(self) -> Doubles:
        """Centre of mass, metres, (n, 2)."""
        return self.lander.position

    @property
    def angle(self) -> Doubles:
        """Radians counter-clockwise from upright, unwrapped, (n,)."""
        return self.lander.angle

    @property
    def velocity(self) -> Doubles:
        """Metres a second, (n, 2)."""
        return self.lander.velocity

    @property
    def angular_velocity(self) -> Doubles:
        """Radians a second, (n,)."""
        return self.lander.angular_velocity

    @property
    def pad(self) -> Doubles:
        """Middle of the target pad's top, (n, 2)."""
        return self._top(self.target)

    @property
    def pad_shift(self) -> Doubles:
        """Displacement of the pads to the right of their places, metres, (n,)."""
        return self.conditions.shift(self.time)[0]

    @property
    def pad_velocity(self) -> Doubles:
        """Velocity of the pads to the right, m/s, (n,)."""
        return self.conditions.shift(self.time)[1]

    @property
    def pad_acceleration(self) -> Doubles:
        """Acceleration of the pads to the right, m/s², (n,)."""
        acceleration: Doubles = -((2 * np.pi / self.conditions.swing_period) ** 2) * self.pad_shift
        return acceleration

    @property
    def fired(self) -> Ints:
        """Actions (n,) that take effect: those for which there is fuel and the engines work."""
        if not self.conditions.fails:
            return self.actions
        main = (self.actions >= 3) & self.conditions.main_works(self.time)
        return np.where(self.fuel < self.conditions.tank, 3 * main + self.actions % 3, 0)

    @property
    def thrust(self) -> Doubles:
        """Shares of thrust (n, 2) that take effect: zero where there is no fuel, or an engine does not work."""
        if not self.conditions.fails:
            return self.shares
        works = np.stack([self.conditions.main_works(self.time), np.ones(self.num_envs, dtype=bool)], axis=1)
        return np.where(works & (self.fuel < self.conditions.tank)[:, None], self.shares, 0.0)

    @property
    def pad_width(self) -> Doubles:
        """Width of the target pad, metres, (n,)."""
        return self.ground.widths[self.target]

    @property
    def time(self) -> Doubles:
        """Seconds flown, (n,)."""
        seconds: Doubles = np.multiply(self.steps, DT)
        return seconds

    @property
    def fuel(self) -> Doubles:
        """Fuel burnt, in seconds of main engine, (n,)."""
        return (self.main_steps + self.params.jet_fuel * self.side_steps) * DT

    @property
    def tilt(self) -> Doubles:
        """Radians from upright either way, 0 to pi, (n,)."""
        tilt: Doubles = np.abs(np.mod(self.angle + np.pi, 2 * np.pi) - np.pi)
        return tilt

    @property
    def altitude(self) -> Doubles:
        """Metres between the level feet and the target pad's top, (n,)."""
        return self.position[:, 1] - self.pad[:, 1] - self.params.stand

    def lowest(self, x: float, angle: float) -> float:
        """Return the least height, in metres, at which a lander at `x` that leans by `angle` clears the ground.

        Pads that move count where they are at rest.
        """
        cos, sin = math.cos(angle), math.sin(angle)
        across, up = (_OUTLINE @ np.array([[cos, sin], [-sin, cos]])).T
        return float((self.ground.height(x + across) - up).max())

    def _top(self, pad: Any) -> Doubles:
        """Middle of the top of one pad, or of one for each slot, where it is now: (2,) or (n, 2)."""
        middle: Doubles = self.ground.middles[pad]
        if not self.conditions.moves:
            return middle
        return np.broadcast_to(middle, (self.num_envs, 2)) + np.stack([self.pad_shift, np.zeros(self.num_envs)], axis=1)

    def _relative_velocity(self) -> Doubles:
        """Velocity as seen from the pad, (n, 2)."""
        if not self.conditions.moves:
            return self.velocity
        return self.velocity - np.stack([self.pad_velocity, np.zeros(self.num_envs)], axis=1)

    def _move_pads(self) -> None:
        """Set position and velocity of moving pads for the current time, so that they carry what stands on them."""
        state, bodies = self.world.state, self._pad_bodies
        shift, velocity = self.conditions.shift(self.time)
        state.pose[:, bodies, 0] = self.ground.middles[:, 0] + shift[:, None]
        state.velocity[:, bodies, 0] = velocity[:, None]
        self.world.forget_boxes(bodies)

    def leave_pads(self) -> None:
        """Put moving pads where a step of the world leaves them that has begun now: moved on by that step."""
        if self.conditions.moves:
            self._move_pads()
            state, bodies = self.world.state, self._pad_bodies
            state.pose[:, bodies, 0] += state.velocity[:, bodies, 0] * DT

    def _move(self, flying: Bools, touching: bool = True) -> None:
        """Apply thrust and wind, and step the worlds; without `touching`, nothing collides."""
        state, body = self.world.state, self.lander.index
        main, side = self.thrust.T
        up, aside = self.params.main_thrust * main, self.params.side_thrust * side
        cos, sin = state.cos[:, body], state.sin[:, body]
        state.force[:, body, 0] = aside * cos - up * sin
        state.force[:, body, 1] = aside * sin + up * cos
        state.force[:, body, 2] = -aside * self.params.side_arm
        if self.conditions.pushes:
            state.force[:, body, 0] += self.conditions.push(self.time)
        if self.conditions.moves:
            self._move_pads()
        self.world.step(touching)
        self.steps += flying
        self.main_steps += flying * main
        self.side_steps += flying * np.abs(side)
