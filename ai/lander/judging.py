"""Judging: which flights have ended, and how, by what touches, by where they are, and by how long they stand still."""

from __future__ import annotations

from typing import Final

import numpy as np

from ai.common.environment import Bools, Doubles, Ints
from ai.lander.conditions import Conditions
from ai.lander.craft import Craft
from ai.lander.ground import Ground
from ai.lander.rules import Cause, LanderParams, Limits, Outcome
from engine import DT

# What a flight has come to so far, one entry for each lander.
JUDGEMENTS: Final = ("outcome", "cause", "contacts", "impact", "touched", "_still", "feet_steps", "tilted_steps")


class JudgedCraft(Craft):
    """Craft whose flights the rules judge after every physics step.

    Attributes:
        outcome, cause: `Outcome` of each flight, and `Cause` of a crash, (n,).
        contacts: whether the left and the right foot are on a pad, (n, 2).
        touched: number of the pad that a foot was last on, (n,).
        impact: greatest speed towards what was touched, along it, both m/s, and tilt in radians at any touch, (n, 3).
        feet_steps, tilted_steps: physics steps with both feet down, and tilted by more than `TILT_ALLOWED`, (n,).

    """

    def __init__(
        self, num_envs: int, params: LanderParams, ground: Ground, conditions: Conditions, limits: Limits
    ) -> None:
        super().__init__(num_envs, params, ground, conditions)
        self.limits = limits
        self.landings = 0
        self.outcome: Ints = np.zeros(num_envs, dtype=np.intp)
        self.cause: Ints = np.zeros(num_envs, dtype=np.intp)
        self.contacts: Bools = np.zeros((num_envs, 2), dtype=bool)
        self.touched: Ints = np.zeros(num_envs, dtype=np.intp)
        self.impact: Doubles = np.zeros((num_envs, 3))
        self._still: Ints = np.zeros(num_envs, dtype=np.intp)  # physics steps at rest on both feet, up to now
        self.feet_steps: Ints = np.zeros(num_envs, dtype=np.intp)
        self.tilted_steps: Ints = np.zeros(num_envs, dtype=np.intp)
        # Rows of the world's pairs: which part of the craft touches, and whether it is the pad it touches.
        pairs = self.world.pairs
        self._pair_part = pairs.min(axis=1)  # 0 hull, 1 left foot, 2 right foot
        self._pair_pad = pairs.max(axis=1) - 3  # the pad's number; the plain and its hills come after the pads
        self._pair_on_pad = self._pair_pad < len(self.ground.pads)

    @property
    def landed_on(self) -> Ints:
        """Number of the pad a flight has landed on, -1 for those that have not, (n,)."""
        return np.where(self.outcome == Outcome.LANDED, self.touched, -1)

    @property
    def intact(self) -> Bools:
        """Whether a flight ended in a touch beside the pad that broke nothing: within all limits of a touch, (n,).

        Its outcome is CRASHED all the same: no landing, and no reward for one.
        """
        limits = self.limits
        kept = self.impact <= np.array([limits.touch_speed, limits.slide_speed, limits.touch_tilt])
        whole: Bools = kept.all(axis=1) & (self.outcome == Outcome.CRASHED)
        return whole

    def _judge(self, flying: Bools) -> None:
        """Decide which flights have ended, and how."""
        limits, position = self.limits, self.position
        crashed = self._touch(flying)
        gone = np.abs(position[:, 0]) > limits.half_width
        gone |= position[:, 1] > limits.ceiling
        late = self.steps * DT >= limits.time - 1e-9
        landed = self._rest(flying)
        if not (flying & (gone | late | crashed | landed)).any():
            return
        verdict = np.where(late, Outcome.TIMED_OUT, Outcome.FLYING)
        for happened, outcome in (
            (gone, Outcome.OUT_OF_BOUNDS),
            (landed, Outcome.LANDED),
            (crashed, Outcome.CRASHED),
        ):
            verdict[happened] = outcome
        self.outcome = np.where(flying, verdict, self.outcome)
        self.lander.active = self.outcome == Outcome.FLYING
        self.landings += int((flying & (verdict == Outcome.LANDED)).sum())

    def _judge_untouched(self, outcome: Outcome) -> None:
        """Judge the only lander after steps in which nothing touched."""
        self.contacts, self._still[0] = np.zeros((1, 2), dtype=bool), 0
        if outcome:
            self.outcome, self.lander.active = np.array([int(outcome)], dtype=np.intp), False

    def _rest(self, flying: Bools) -> Bools:
        """Count for how long each has stood still on both feet; whether that is long enough, (n,)."""
        limits, calm = self.limits, flying & self.contacts.all(axis=1)
        if not calm.any():
            self._still *= ~flying
            return calm
        self.feet_steps += calm
        velocity = self._relative_velocity()
        calm &= velocity[:, 0] ** 2 + velocity[:, 1] ** 2 < limits.rest_speed**2
        calm &= (self.tilt < limits.rest_tilt) & (np.abs(self.angular_velocity) < limits.rest_spin)
        self._still = np.where(flying, (self._still + 1) * calm, self._still)
        return calm & (self._still >= limits.rest_steps) & self.ground.ends[self.touched]

    def _touch(self, flying: Bools) -> Bools:
        """Read the step's contacts: which feet are down, how hard the touch was, and which slots it wrecked."""
        self.contacts = self.contacts & ~flying[:, None]
        touches = self.world.contacts
        if touches is None:
            return np.zeros(self.num_envs, dtype=bool)
        world, part, on_pad = touches.world, self._pair_part[touches.pair], self._pair_on_pad[touches.pair]
        foot = (part > 0) & on_pad
        self.contacts[world[foot], part[foot] - 1] = True
        self.touched[world[foot]] = self._pair_pad[touches.pair[foot]]
        felt = np.zeros((self.num_envs, 3))
        np.maximum.at(felt[:, 0], world, touches.approach[:, :2].max(axis=1))
        np.maximum.at(felt[:, 1], world, np.abs(touches.approach[:, 2]))
        felt[world, 2] = self.tilt[world]
        self.impact = np.maximum(self.impact, felt)
        wrong_part, wrong_place = np.zeros((2, self.num_envs), dtype=bool)
        wrong_part[world[part == 0]] = True
        wrong_place[world[~on_pad]] = True
        limits = self.limits
        faults = {
            Cause.TILTED: felt[:, 2] > limits.touch_tilt,
            Cause.SLIDING: felt[:, 1] > limits.slide_speed,
            Cause.HARD: felt[:, 0] > limits.touch_speed,
            Cause.HULL: wrong_part,
            Cause.TERRAIN: wrong_place,
        }
        for cause, fault in faults.items():
            self.cause[fault] = cause
        crashed: Bools = self.cause != Cause.NONE
        return crashed
