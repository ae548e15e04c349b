"""Judging: which flights have ended, and how, by what touches, by where they are, and by how long they stand still."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ai.environment import Bools
from ai.lander.rewards import TILT_ALLOWED
from ai.lander.rules import Cause, Outcome
from engine import DT

if TYPE_CHECKING:
    from ai.lander.environment import LanderEnv


def judge(env: LanderEnv, flying: Bools) -> None:
    """Judge the flights that were `flying` (n,) after a physics step: `outcome`, `cause` and what they follow from."""
    limits, position = env.limits, env.position
    crashed = _touch(env, flying)
    gone = np.abs(position[:, 0]) > limits.half_width
    gone |= position[:, 1] > limits.ceiling
    late = env.steps * DT >= limits.time - 1e-9
    landed = _rest(env, flying)
    env.tilted_steps += flying & (env.tilt > TILT_ALLOWED)
    if not (flying & (gone | late | crashed | landed)).any():
        return
    verdict = np.where(late, Outcome.TIMED_OUT, Outcome.FLYING)
    for happened, outcome in ((gone, Outcome.OUT_OF_BOUNDS), (landed, Outcome.LANDED), (crashed, Outcome.CRASHED)):
        verdict[happened] = outcome
    env.outcome = np.where(flying, verdict, env.outcome)
    env.lander.active = env.outcome == Outcome.FLYING
    env.landings += int((flying & (verdict == Outcome.LANDED)).sum())


def _touch(env: LanderEnv, flying: Bools) -> Bools:
    """Read the step's contacts: which feet are down, how hard the touch was, and which flights it wrecked, (n,)."""
    env.feet_down = env.feet_down & ~flying[:, None]
    touches = env.world.contacts
    if touches is None:
        return np.zeros(env.num_envs, dtype=bool)
    shapes = touches.shape
    world, part = touches.world, shapes.min(axis=1)  # 0 hull, 1 left foot, 2 right foot
    pad = shapes.max(axis=1) - 3  # the pad's number; the plain, hills and roofs come after the pads
    on_pad = pad < len(env.ground.pads)
    foot = (part > 0) & on_pad
    env.feet_down[world[foot], part[foot] - 1] = True
    env.touched[world[foot]] = pad[foot]
    felt = np.zeros((env.num_envs, 3))
    np.maximum.at(felt[:, 0], world, touches.approach[:, :2].max(axis=1))
    np.maximum.at(felt[:, 1], world, np.abs(touches.approach[:, 2]))
    felt[world, 2] = env.tilt[world]
    env.impact = np.maximum(env.impact, felt)
    wrong_part, wrong_place = np.zeros((2, env.num_envs), dtype=bool)
    wrong_part[world[part == 0]] = True
    wrong_place[world[~on_pad]] = True
    limits = env.limits.stricter(env.strictness)
    faults = {
        Cause.TILTED: felt[:, 2] > limits.touch_tilt,
        Cause.SLIDING: felt[:, 1] > limits.slide_speed,
        Cause.HARD: felt[:, 0] > limits.touch_speed,
        Cause.HULL: wrong_part,
        Cause.TERRAIN: wrong_place,
    }
    for cause, fault in faults.items():
        env.cause[fault] = cause
    crashed: Bools = env.cause != Cause.NONE
    return crashed


def _rest(env: LanderEnv, flying: Bools) -> Bools:
    """Count for how long each has stood still on both feet; whether that is long enough, (n,)."""
    limits, calm = env.limits, flying & env.feet_down.all(axis=1)
    if not calm.any():
        env.still_steps *= ~flying
        return calm
    env.feet_steps += calm
    velocity = env.relative_velocity
    calm &= velocity[:, 0] ** 2 + velocity[:, 1] ** 2 < limits.rest_speed**2
    calm &= (env.tilt < limits.rest_tilt) & (np.abs(env.angular_velocity) < limits.rest_spin)
    env.still_steps = np.where(flying, (env.still_steps + 1) * calm, env.still_steps)
    return calm & (env.still_steps >= limits.rest_steps) & env.ground.ends[env.touched]
