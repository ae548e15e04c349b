"""Lunar lander environment: its rules on the physics engine, for any number of landers at once.

Actions are `3 * main + steer`; `steer` is 0 for none, 1 for left, 2 for right. Observations are
[rel_x, rel_y, vx, vy, sin θ, cos θ, ω, left contact, right contact], relative to standing on the middle of
the pad and scaled by `OBSERVATION_SCALE`. `ai.lander.rules` has the numbers.
"""

from __future__ import annotations

from dataclasses import fields
from typing import Any, Final

import numpy as np

from ai.common.environment import Bools, Doubles, Floats, Ints, StepResult
from ai.lander.alone import Alone
from ai.lander.conditions import CALM, Conditions
from ai.lander.craft import Craft
from ai.lander.ground import Ground
from ai.lander.rewards import (
    FEET_STEPS_PAID,
    REWARDS,
    TILT_ALLOWED,
    RewardWeights,
    Situation,
    SituationChange,
    situated,
)
from ai.lander.rules import (
    ACTION_NAMES,
    ACTION_SHARES,
    FEATURE_NAMES,
    FOOT_CENTRE,
    FOOT_SIZE,
    HULL,
    LIMITS,
    MIRROR_ACTIONS,
    MIRROR_FEATURES,
    MIRROR_SIGNS,
    NUM_ACTIONS,
    NUM_FEATURES,
    OBSERVATION_SCALE,
    PARAMS,
    Cause,
    LanderParams,
    Limits,
    Outcome,
    engines_switched,
)
from ai.lander.sensing import SURROUNDINGS, sensed, surroundings, terrain
from ai.lander.spawns import SPAWNS, Curriculum
from engine import DT

__all__ = [
    "ACTION_NAMES", "FEATURE_NAMES", "FOOT_CENTRE", "FOOT_SIZE", "HULL", "LIMITS", "MIRROR_ACTIONS",
    "MIRROR_FEATURES", "MIRROR_SIGNS", "NUM_ACTIONS", "NUM_FEATURES", "OBSERVATION_SCALE", "PARAMS", "Cause",
    "LanderEnv", "LanderParams", "Limits", "Outcome", "engines_switched",
]  # fmt: skip

_COUNTERS: Final = ("outcome", "cause", "actions", "shares", "contacts", "impact", "steps", "main_steps", "side_steps",
                    "touched", "_still", "_feet_steps")  # fmt: skip
# NumPy compares with plain numbers many times as fast as with members of an enumeration.
_FLYING, _LANDED, _CRASHED, _OUT, _LATE = (int(outcome) for outcome in Outcome)


class LanderEnv(Craft):
    """Vectorised lunar lander environment: `num_envs` landers, each in a world of its own, stepped together.

    `spawn` names a distribution of `ai.lander.spawns` or is a Curriculum, then followed by this environment's own
    landings. `seed` is an int, a Generator or None; slot k draws from its own stream, so that a flight does
    not depend on how many fly beside it. A `step` is `frame_skip` physics steps of 1/60 s with one action.

    All fly over the same `ground`, by default a plain with one pad. Where that has several pads, a landing on any
    of them counts; `target` (n,) says by number which one observations and rewards are about. `conditions` can make
    flights harder; on a pad that moves, observations and the limits of a landing are relative to it.
    """

    num_actions = NUM_ACTIONS
    num_features = NUM_FEATURES

    def __init__(
        self,
        num_envs: int = 1,
        seed: int | np.random.Generator | None = None,
        spawn: str | Curriculum = "random",
        frame_skip: int = 4,
        *,
        params: LanderParams = PARAMS,
        ground: Ground | None = None,
        limits: Limits = LIMITS,
        conditions: Conditions = CALM,
        weights: RewardWeights | None = None,
    ) -> None:
        if num_envs < 1 or frame_skip < 1:
            raise ValueError(f"num_envs and frame_skip start from 1, not {num_envs} and {frame_skip}")
        if not (isinstance(spawn, Curriculum) or (isinstance(spawn, str) and spawn in SPAWNS)):
            raise ValueError(f"spawn is one of {', '.join(SPAWNS)}, or a Curriculum, not {spawn!r}")
        super().__init__(num_envs, params, ground or Ground.flat(params), conditions)
        self.frame_skip, self.limits, self.weights = frame_skip, limits, weights or RewardWeights()
        self.spawn = spawn
        self.landings = 0
        self._rngs = np.random.default_rng(seed).spawn(num_envs)
        self.outcome: Ints = np.zeros(num_envs, dtype=np.intp)
        self.cause: Ints = np.zeros(num_envs, dtype=np.intp)
        self.contacts: Bools = np.zeros((num_envs, 2), dtype=bool)  # left and right foot on a pad
        self.touched: Ints = np.zeros(num_envs, dtype=np.intp)  # the pad that a foot was last on
        self.impact: Doubles = np.zeros((num_envs, 3))
        self._still: Ints = np.zeros(num_envs, dtype=np.intp)
        self._feet_steps: Ints = np.zeros(num_envs, dtype=np.intp)
        # Rows of the detector's pairs: which part of the craft touches, and whether it is the pad it touches.
        pairs = self.world.detector.pairs
        self._pair_part = pairs.min(axis=1)  # 0 hull, 1 left foot, 2 right foot
        self._pair_pad = pairs.max(axis=1) - 3  # the pad's number; the plain and its hills come after the pads
        self._pair_on_pad = self._pair_pad < len(self.ground.pads)
        self._started = False
        self._alone = Alone(self) if num_envs == 1 else None

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

    @property
    def stage(self) -> int:
        """Stage of the curriculum, 0 without one."""
        return self.spawn.stage(self.landings) if isinstance(self.spawn, Curriculum) else 0

    def reset(self, mask: Bools | None = None) -> Floats:
        """Begin a new flight in the slots of `mask` (n,), or in all; return every slot's observation."""
        mask = np.ones(self.num_envs, dtype=bool) if mask is None else np.asarray(mask, dtype=bool)
        if mask.shape != (self.num_envs,):
            raise ValueError(f"the mask must have one entry for each of {self.num_envs} slots, not {mask.shape}")
        draw = SPAWNS[self.spawn.spawn(self.landings) if isinstance(self.spawn, Curriculum) else self.spawn]
        slots = np.flatnonzero(mask)
        start = np.array([draw(self._rngs[slot]) for slot in slots]).reshape(-1, 6)
        self.place(mask, start)
        return self.observe()

    def draw_from(self, slot: int, rng: np.random.Generator) -> None:
        """Let one slot draw its flights from a stream of its own."""
        self._rngs[slot] = rng

    def place(self, mask: Bools, start: Doubles) -> None:
        """Begin a flight in the slots of `mask` at rows x, y, vx, vy, angle, spin of `start`, in the world's frame."""
        self.lander.set(
            position=start[:, :2], velocity=start[:, 2:4], angle=start[:, 4], angular_velocity=start[:, 5], mask=mask
        )
        for name in _COUNTERS:
            getattr(self, name)[mask] = 0
        self.outcome[mask] = Outcome.FLYING
        self.lander.active = self.outcome == Outcome.FLYING
        self._started = True

    def begin_at(self, slot: int, start: Doubles) -> None:
        """Begin a flight of one slot at x, y, vx, vy, angle, spin, above the ground inside the area.

        Raises ValueError for any other start.
        """
        start = np.asarray(start, dtype=float)
        if start.shape != (6,) or not np.isfinite(start).all():
            raise ValueError(f"a start is six finite numbers, not {start}")
        x, y, angle = start[[0, 1, 4]].tolist()
        if abs(x) > self.limits.half_width or y > self.limits.ceiling:
            raise ValueError(f"a flight begins inside the area, not at ({x:.2f}, {y:.2f})")
        if y < self.lowest(x, angle):
            raise ValueError(f"a flight begins above the ground, not at ({x:.2f}, {y:.2f})")
        self.place(np.arange(self.num_envs) == slot, start[None])

    def step(self, actions: Any) -> StepResult:
        """Fly one decision; `actions` (n,) are 0 to 5. Raises ValueError for others, RuntimeError before a reset."""
        held = self.actions
        self._take(actions)
        # The same rules for arrays and, where one lander is alone, for plain numbers, which are much faster.
        forms: tuple[Any, ...] = np.copy, self.situation, np.minimum
        if self._alone:
            forms = np.ndarray.item, self._alone.situation, min
        number, situation, least = forms
        flying, before = number(self.outcome) == _FLYING, situation()
        flown, feet = number(self.steps), number(self._feet_steps)
        tilted = self._fly_on()
        flown, actions, outcome = number(self.steps) - flown, number(self.actions), number(self.outcome)
        ended = flying & (outcome != _FLYING)
        change = SituationChange(
            before,
            situation(),
            flown=flown,
            fired=flown * (actions > 0),
            tilted=number(tilted),
            switched=flying * engines_switched(number(held), actions),
            feet_down=least(number(self._feet_steps), FEET_STEPS_PAID) - least(feet, FEET_STEPS_PAID),
            landed=ended & (outcome == _LANDED),
            lost=ended & ((outcome == _CRASHED) | (outcome == _OUT)),
        )
        parts = np.array([part(change, self.weights) for part in REWARDS.values()], np.float32)
        parts = parts.reshape(len(REWARDS), self.num_envs)
        # One by one, in their order; for one lander, NumPy's sum takes them in another.
        reward = np.add.accumulate(parts)[-1] if self._alone else sum(parts[1:], start=parts[0])
        truncated = self.outcome == _LATE
        return StepResult(
            observation=self.observe(),
            reward=reward,
            terminated=(self.outcome != _FLYING) & ~truncated,
            truncated=truncated,
            outcome=self.outcome.copy(),
            components=dict(zip(REWARDS, parts, strict=True)),
        )

    def fly(self, actions: Any, shares: Doubles | None = None) -> None:
        """Fly one decision as `step` does, without computing rewards; raises as that does.

        Engines give these `shares` of thrust, (n, 2), instead of all that the actions ask for: of the main engine
        0 to 1, of the jets -1, left, to 1, right. The actions then only say what was meant. Raises ValueError for
        shares outside.
        """
        self._take(actions)
        if shares is not None:
            self.shares = self._checked(shares)
        self._fly_on()

    def glide(self, actions: Ints) -> Floats:
        """Fly one decision in every slot without collisions; return the observations, (n, 9).

        For looking ahead: the same as `step`, bit for bit, as long as nothing touches, but without outcomes and
        rewards, and `actions` (n,) are not checked.
        """
        self.actions, self.shares = actions, ACTION_SHARES.take(actions, axis=0)
        flying = self.outcome == Outcome.FLYING
        if self._alone and flying[0]:
            self._alone.fly(self.frame_skip, solid=False)
            return self.observe()
        for _ in range(self.frame_skip):
            self._move(flying, touching=False)
        return self.observe()

    def observe(self, pad: Any = None) -> Floats:
        """Return every lander's observation (n, 9) of its target, or of another `pad`, one number or (n,)."""
        pad = self.target if pad is None else np.asarray(pad)
        if self._alone:
            return self._alone.observe(pad)
        pads = self.ground.at_once
        contacts = self.contacts if pads == 1 else self.contacts * (self.touched == pad)[:, None]
        offset = self.position - (self._top(pad) + np.array([0.0, self.params.stand]))
        return sensed(offset, self._relative_velocity(), *self._turned(), contacts, pads=pads)

    def observe_at(self, slot: int, places: Doubles, pad: int | None = None) -> Floats:
        """Return what lander `slot` would observe at other places (m, 2) in the air, moving as it does now: (m, 9).

        It is about the lander's target, or about another `pad` by its number.
        """
        at = np.full(len(places), slot)
        pads = self.target if pad is None else np.full(self.num_envs, pad)
        offset = places - (self._top(pads)[at] + np.array([0.0, self.params.stand]))
        sin, cos, spin = (part[at] for part in self._turned())
        nothing = np.zeros((len(places), 2), dtype=bool)
        return sensed(offset, self._relative_velocity()[at], sin, cos, spin, nothing, pads=len(self.ground.pads))

    def _turned(self) -> tuple[Doubles, Doubles, Doubles]:
        """Return sine and cosine of every lander's angle, and its turning in rad/s, (n,) each."""
        state, body = self.world.state, self.lander.index
        return state.sin[:, body], state.cos[:, body], self.angular_velocity

    def observe_pads(self, pilot: Any = None) -> Floats:
        """Return every lander's observation of each pad, (n, pads, 9), or what `pilot` reads, (n, pads, features)."""
        return np.stack([self.observe_for(pilot, pad) for pad in range(len(self.ground.pads))], axis=1)

    def surroundings(self, pad: Any = None) -> Floats:
        """Return what is around every lander (n, k) that `observe` leaves out, for the target or another `pad`.

        `ai.lander.sensing.SURROUNDINGS` names the k numbers.
        """
        return surroundings(self, self.limits, self.target if pad is None else np.asarray(pad))

    def around(self, pad: Any = None) -> Floats:
        """Return the surroundings and the ground beside every lander, (n, k): `ai.lander.sensing.AROUND` names them."""
        pad = self.target if pad is None else np.asarray(pad)
        return np.concatenate([self.surroundings(pad), terrain(self, pad)], axis=1)

    def around_pads(self) -> Floats:
        """Return what is around every lander on its way to each pad, (n, pads, k)."""
        return np.stack([self.around(pad) for pad in range(len(self.ground.pads))], axis=1)

    def observe_around(self) -> Floats:
        """Return every lander's observation of each pad and what is around it, side by side, (n, pads, 9 + k)."""
        return np.concatenate([self.observe_pads(), self.around_pads()], axis=2)

    def around_at(self, slot: int, places: Doubles, pad: int) -> Floats:
        """Return what would be around lander `slot` now at other places (m, 2), on its way to `pad`, (m, k)."""
        same = np.broadcast_to(self.surroundings(pad)[slot], (len(places), len(SURROUNDINGS)))
        return np.concatenate([same, terrain(self, pad, places[:, 0])], axis=1)

    def observe_wide(self, pad: Any = None) -> Floats:
        """Return every lander's observation and what is around it, side by side, (n, 9 + k)."""
        return np.concatenate([LanderEnv.observe(self, pad), self.surroundings(pad)], axis=1)

    def observe_for(self, pilot: Any, pad: Any = None) -> Floats:
        """Return what a pilot reads: `observe_wide` if its network has inputs for that, else `observe`."""
        wide = getattr(pilot, "num_features", NUM_FEATURES) > NUM_FEATURES
        return self.observe_wide(pad) if wide else LanderEnv.observe(self, pad)

    def snapshot(self) -> dict[str, Any]:
        """Return everything a flight depends on but its random streams, to be put back by `restore`."""
        state = self.world.state
        arrays = {name: getattr(self, name).copy() for name in (*_COUNTERS, "target")}
        bodies = {field.name: getattr(state, field.name).copy() for field in fields(state)}
        return {"counters": arrays, "bodies": bodies, "contacts": self.world.detector.memory()}

    def restore(self, snapshot: dict[str, Any]) -> None:
        """Go back to a snapshot of this environment, or of one with as many slots."""
        for name, value in snapshot["counters"].items():
            setattr(self, name, value.copy())
        for name, value in snapshot["bodies"].items():
            setattr(self.world.state, name, value.copy())
        self.world.detector.recall_memory(snapshot["contacts"])
        self._started = True
        if self._alone:
            self._alone.forget()

    def situation(self) -> Situation:
        """Return what the shaping reward depends on: distance, offset, speed and tilt from the pad, (batch,) each."""
        offset, velocity = self.position - self.pad, self._relative_velocity()
        return situated(offset[:, 0], offset[:, 1] - self.params.stand, velocity[:, 0], velocity[:, 1], self.tilt)

    def _take(self, actions: Any) -> None:
        """Set the actions to fly from now on; raises as `step` does."""
        actions = np.asarray(actions)
        if actions.shape != (self.num_envs,) or actions.dtype.kind not in "iu":
            raise ValueError(f"actions must be {self.num_envs} whole numbers, not {actions.dtype} {actions.shape}")
        if np.count_nonzero(actions.astype(np.uintp) >= NUM_ACTIONS):  # those below 0 become huge
            raise ValueError(f"actions run from 0 to {NUM_ACTIONS - 1}, not {actions.min()} to {actions.max()}")
        if not self._started:
            raise RuntimeError("reset() must come before the first step()")
        self.actions = actions.astype(np.intp)
        self.shares = ACTION_SHARES.take(self.actions, axis=0)

    def _checked(self, shares: Doubles) -> Doubles:
        """Return shares of thrust as doubles; raises ValueError for those that no engine has."""
        shares = np.array(shares, dtype=float)
        lowest, highest = (0.0, -1.0), (1.0, 1.0)
        if shares.shape != (self.num_envs, 2) or not ((shares >= lowest) & (shares <= highest)).all():
            raise ValueError(f"shares of thrust are {self.num_envs} rows, main 0 to 1 and side -1 to 1")
        return shares

    def _fly_on(self) -> Ints:
        """Fly one decision where flights go on; return in how many physics steps each tilted too far, (n,)."""
        tilted, left = np.zeros(self.num_envs, dtype=np.intp), self.frame_skip
        while left and np.count_nonzero(flying := self.outcome == _FLYING):
            if self._alone and (flown := self._alone.fly(left)).steps:
                left -= flown.steps
                tilted[0] += flown.tilted
                self._up_in_the_air(flown.outcome)
                continue
            self._fly(flying)
            tilted += flying & (self.tilt > TILT_ALLOWED)
            left -= 1
        return tilted

    def _up_in_the_air(self, outcome: Outcome) -> None:
        """Judge the only lander after steps in which nothing touched."""
        self.contacts, self._still[0] = np.zeros((1, 2), dtype=bool), 0
        if outcome:
            self.outcome, self.lander.active = np.array([int(outcome)], dtype=np.intp), False

    def _fly(self, flying: Bools) -> None:
        """One physics step of the slots that fly: push, move, judge."""
        self._move(flying)
        self._judge(flying)

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

    def _rest(self, flying: Bools) -> Bools:
        """Count for how long each has stood still on both feet; whether that is long enough, (n,)."""
        limits, calm = self.limits, flying & self.contacts.all(axis=1)
        if not calm.any():
            self._still *= ~flying
            return calm
        self._feet_steps += calm
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
        np.maximum.at(felt[:, 0], world, touches.approach[:2].max(axis=0))
        np.maximum.at(felt[:, 1], world, np.abs(touches.approach[2]))
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
