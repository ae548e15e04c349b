"""Free flight of one lander alone, in plain floats.

It stays beside the engine because a guardian needs it: of one future, 380 steps with 20 in contact, it makes 26 ms
instead of 59 in arrays of length one, and a decision lasts 67. A step in the air takes 3 µs at four to a decision
instead of 37, a scripted flight to its landing 45 µs a step instead of 90. A frame of Play would not feel that.

The arithmetic is that of `engine.integrate` and `ai.lander.craft`, operation for operation: the bits are those of a
batch. What comes near the ground, and all that touches, is left to the engine.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ai.lander.craft import carry_pads, parts
from ai.lander.rewards import TILT_ALLOWED
from ai.lander.rules import FLYING, LATE, OUT
from engine import DT
from engine.contacts import MARGIN
from engine.vector import dot

if TYPE_CHECKING:
    from ai.lander.environment import LanderEnv

# A shape of the ground: its box (left, low, right, high), and its faces (nx, ny, far), before which it ends.
Rock = tuple[list[float], list[list[float]]]
_APART: Final = MARGIN + 1e-6  # metres between shapes that do not touch, and far more than rounding makes of them


class FreeFlight:
    """The only lander of an environment, while nothing is near it."""

    def __init__(self, env: LanderEnv) -> None:
        self._env = env
        table, body = env.world.params, env.lander.index
        self._ease, _, self._turn_ease = (table.inverse_mass[body] * DT).tolist()  # change of speed by a unit of force
        self._drag, _, self._turn_drag = table.linear_drag[body].tolist()
        self._corners = sorted({(x, y) for part in parts() for x, y in part.vertices.tolist()})
        self._reach = max(sqrt(x * x + y * y) for x, y in self._corners) + _APART
        self._rocks: list[Rock] = []
        self._rocks_of: tuple[float, int] | None = None  # sway of the pads and number of the only one

    def fly(self, steps: int, *, solid: bool = True) -> int:
        """Fly up to so many physics steps, until something is near or the flight ends; return how many were flown.

        Without `solid`, fly all of them, through everything.
        """
        env, state, body = self._env, self._env.world.state, self._env.lander.index
        params, conditions, main_thrust = env.params, env.conditions, _number(env.params.main_thrust)
        if solid:
            self._look_around()
        x, y, angle = state.pose[0, body].tolist()
        vx, vy, spin = state.velocity[0, body].tolist()
        cos, sin = state.cos.item(0, body), state.sin.item(0, body)
        fall_x, fall_y = (env.world.gravity * DT).ravel().tolist()
        air, _, turn_air = env.world.params.quadratic_drag[..., body, :].ravel().tolist()
        ease, turn_ease = self._ease, self._turn_ease
        asked = main, side = env.shares[0].tolist()
        main_steps, side_steps = env.main_steps.item(), env.side_steps.item()
        start = now = env.steps.item()
        tilted, outcome = 0, FLYING
        while now - start < steps and not (outcome or (solid and self._near(x, y, cos, sin))):
            if conditions.fails:
                main, side = asked
                if (main_steps + params.jet_fuel * side_steps) * DT >= conditions.tank:
                    main = side = 0.0
                elif not conditions.main_works(now * DT):
                    main = 0.0
            up, aside = main_thrust * main, params.side_thrust * side
            push = aside * cos - up * sin
            if conditions.pushes:
                push += conditions.push(now * DT).item()
            slowing = 1.0 + (self._drag + air * sqrt(vx * vx + vy * vy)) * ease
            turn_slowing = 1.0 + (self._turn_drag + turn_air * abs(spin)) * turn_ease
            vx = (vx + push * ease + fall_x) / slowing
            vy = (vy + (aside * sin + up * cos) * ease + fall_y) / slowing
            spin = (spin + -aside * params.side_arm * turn_ease) / turn_slowing
            x, y, angle = x + vx * DT, y + vy * DT, angle + spin * DT
            # NumPy's own: those of `math` may differ in the last bit.
            cos, sin = float(np.cos(angle)), float(np.sin(angle))
            now, main_steps, side_steps = now + 1, main_steps + main, side_steps + abs(side)
            if solid:
                tilted += abs((angle + pi) % (2 * pi) - pi) > TILT_ALLOWED
                outcome = self._judged(x, y, now * DT)
        if now > start:
            state.pose[0, body], state.velocity[0, body] = (x, y, angle), (vx, vy, spin)
            state.cos[0, body], state.sin[0, body] = cos, sin
            env.steps[0], env.main_steps[0], env.side_steps[0] = now, main_steps, side_steps
            env.world.untouched()
            carry_pads(env, np.array([(now - 1) * DT]))
            if solid:
                self._leave(tilted, outcome)
        return now - start

    def _judged(self, x: float, y: float, time: float) -> int:
        """Return the outcome of a flight in the air."""
        limits = self._env.limits
        gone = abs(x) > limits.half_width or y > limits.ceiling
        return OUT if gone else LATE if time >= limits.time - 1e-9 else FLYING

    def _leave(self, tilted: int, outcome: int) -> None:
        """Leave the judgements of the last steps in the environment: in so many of them it was tilted too far."""
        env = self._env
        env.tilted_steps[0] += tilted
        env.feet_down, env.still_steps[0] = np.zeros((1, 2), dtype=bool), 0
        if outcome:
            env.outcome, env.lander.active = np.array([outcome], dtype=np.intp), False

    def _near(self, x: float, y: float, cos: float, sin: float) -> bool:
        """Whether anything is so near that a step must look for contacts.

        It need not where a face of every rock has the whole craft before it: a separating axis, as in `engine.collide`.
        """
        west, east, below, above = x - self._reach, x + self._reach, y - self._reach, y + self._reach
        near = []
        for (left, low, right, high), faces in self._rocks:
            if below <= high and low <= above and west <= right and left <= east:
                near.append(faces)
        if not near:
            return False
        corners = [(right * cos - up * sin + x, right * sin + up * cos + y) for right, up in self._corners]
        return not all(
            any(all(nx * right + ny * up > far for right, up in corners) for nx, ny, far in faces) for faces in near
        )

    def _look_around(self) -> None:
        """Read where the ground is, if that has changed; pads that sway count as everywhere on their way at once."""
        env = self._env
        sway, pad = _number(np.abs(env.conditions.swing)), env.target.item() if env.ground.in_turn else -1
        if self._rocks_of == (sway, pad):
            return
        self._rocks, self._rocks_of = [], (sway, pad)
        shapes, pads = env.world.shape_table, env.pad_bodies
        for row, body in enumerate(shapes.body.tolist()):
            is_pad = pads.start <= body < pads.stop
            if body == env.lander.index or (is_pad and pad not in (-1, body - pads.start)):
                continue
            middle = env.ground.middles[body - pads.start] if is_pad else env.world.state.pose[0, body, :2]
            corners, normals = shapes.start[row] + middle, shapes.normal[row]
            aside = np.array([sway if is_pad else 0.0, 0.0])
            far = dot(corners, normals) + dot(aside, np.abs(normals)) + _APART
            box = np.concatenate([corners.min(axis=0) - aside, corners.max(axis=0) + aside])
            self._rocks.append((box.tolist(), np.column_stack([normals, far]).tolist()))


def _number(value: Any) -> float:
    """Return a number, or the only one of an array, as a plain float."""
    return value if isinstance(value, float) else float(np.asarray(value).item())
