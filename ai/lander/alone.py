"""One lander alone: its free flight and its readings in plain numbers, many times as fast as in arrays of length one.

The arithmetic is that of `ai.lander.craft` and `ai.lander.environment`, operation for operation, so that a lander
alone flies as it would in a batch, bit for bit. Whatever comes near the ground is left to them.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import Any, NamedTuple

import numpy as np

from ai.common.environment import Floats
from ai.lander.judging import JudgedCraft
from ai.lander.rewards import FEET_STEPS_PAID, TILT_ALLOWED, Moment, Situation, situated
from ai.lander.rules import Outcome
from ai.lander.sensing import scaled
from engine import DT, FreeFlight

# Looked up once: by its enumeration, a member takes longer to find than a tenth of a step.
_FLYING, _OUT, _LATE = Outcome.FLYING, Outcome.OUT_OF_BOUNDS, Outcome.TIMED_OUT


class Flown(NamedTuple):
    """Physics steps that were flown, those of them that leaned by more than `TILT_ALLOWED`, and the outcome so far."""

    steps: int
    tilted: int
    outcome: Outcome


class Alone:
    """The only lander of an environment in free flight."""

    def __init__(self, env: JudgedCraft) -> None:
        self._env = env
        self._read_rules()

    def forget(self) -> None:
        """Read again where the ground is, before the next flight."""
        self._body.forget()

    def _read_rules(self) -> None:
        """Read all that stays the same in a flight: rules, conditions, and the ground that could be hit."""
        env = self._env
        self._rules = params, limits, conditions = env.params, env.limits, env.conditions
        self._body = FreeFlight(env.world, env.lander.index, _number(np.abs(conditions.swing)))
        self._main_thrust, self._side_thrust = _number(params.main_thrust), _number(params.side_thrust)
        self._half_width, self._ceiling = _number(limits.half_width), _number(limits.ceiling)
        self._latest = _number(limits.time) - 1e-9
        self._pads: list[list[float]] = env.ground.middles.tolist()

    def fly(self, steps: int, *, solid: bool = True) -> Flown:
        """Fly up to so many physics steps, until something is near or the flight ends.

        Without `solid`, fly all of them, through everything.
        """
        env, rules = self._env, self._rules
        if env.params is not rules[0] or env.limits is not rules[1] or env.conditions is not rules[2]:
            self._read_rules()
        body, pushes = self._body, env.conditions.pushes
        body.take()
        body.feel()
        start, tilted, outcome = env.steps.item(), 0, _FLYING
        now, main_steps, side_steps = start, env.main_steps.item(), env.side_steps.item()
        asked_main, asked_side = env.shares[0].tolist()
        while now - start < steps and not (outcome or (solid and body.near())):
            time, fuel = now * DT, (main_steps + env.params.jet_fuel * side_steps) * DT
            main, side = self._thrust(asked_main, asked_side, time, fuel)
            up, aside, cos, sin = self._main_thrust * main, self._side_thrust * side, body.cos, body.sin
            push = aside * cos - up * sin
            if pushes:
                push += env.conditions.push(time).item()
            body.step(push, aside * sin + up * cos, -aside * env.params.side_arm, DT)
            now, main_steps, side_steps = now + 1, main_steps + main, side_steps + abs(side)
            if solid:
                tilted += _tilt(body.angle) > TILT_ALLOWED
                outcome = self._judged(now * DT)
        if now > start:
            body.give()
            env.steps[0] = now - 1
            env.leave_pads()
            env.steps[0], env.main_steps[0], env.side_steps[0] = now, main_steps, side_steps
        return Flown(now - start, tilted, outcome)

    def _thrust(self, main: float, side: float, time: float, fuel: float) -> tuple[float, float]:
        """Return the shares of thrust that take effect."""
        conditions = self._env.conditions
        if not conditions.fails:
            return main, side
        if fuel >= conditions.tank:
            return 0.0, 0.0
        return (main if conditions.main_works(time) else 0.0), side

    def _judged(self, time: float) -> Outcome:
        """Return the outcome of a flight in the air."""
        if abs(self._body.x) > self._half_width or self._body.y > self._ceiling:
            return _OUT
        return _LATE if time >= self._latest else _FLYING

    def observe(self, pad: Any) -> Floats:
        """Return the observation (1, 9) of a pad."""
        env, body = self._env, self._body
        body.take()
        pad = _index(pad)
        x, top, drift = self._pad(pad)
        feet, pads = env.contacts[0].tolist(), env.ground.at_once
        if pads > 1 and env.touched.item() != pad:
            feet = [False, False]
        offset = body.x - x, body.y - (top + env.params.stand)
        numbers = np.array([[*offset, body.vx - drift, body.vy, body.sin, body.cos, body.spin, *feet]])
        return scaled(numbers, pads)

    def situation(self) -> Situation:
        """Return what the shaping reward depends on, in plain numbers."""
        body = self._body
        body.take()
        x, top, drift = self._pad(_index(self._env.target))
        above = body.y - top - self._env.params.stand
        return situated(body.x - x, above, body.vx - drift, body.vy, _tilt(body.angle), sqrt)

    def moment(self) -> Moment:
        """Return all that rewards compare, in plain numbers."""
        env = self._env
        return Moment(
            self.situation(),
            outcome=env.outcome.item(),
            actions=env.actions.item(),
            steps=env.steps.item(),
            tilted=env.tilted_steps.item(),
            feet_down=min(env.feet_steps.item(), FEET_STEPS_PAID),
        )

    def _pad(self, pad: int) -> tuple[float, float, float]:
        """Return the middle of a pad's top where it is now, and the pad's velocity to the right."""
        (x, top), conditions = self._pads[pad], self._env.conditions
        if not conditions.moves:
            return x, top, 0.0
        shift, drift = conditions.shift(self._env.steps.item() * DT)
        return x + shift.item(), top, drift.item()


def _tilt(angle: float) -> float:
    """Return radians from upright, 0 to pi."""
    return abs((angle + pi) % (2 * pi) - pi)


def _number(value: Any) -> float:
    """Return a number, or the only one of an array, as a plain float."""
    return float(value) if np.ndim(value) == 0 else float(value.item())


def _index(pad: Any) -> int:
    return pad if isinstance(pad, int) else int(pad.item())
