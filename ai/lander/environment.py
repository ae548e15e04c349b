"""Lunar lander environment: its rules on the physics engine, for any number of landers at once.

Actions are `3 * main + steer`; `steer` is 0 for none, 1 for left, 2 for right. Observations are
[rel_x, rel_y, vx, vy, sin θ, cos θ, ω, left contact, right contact], relative to standing on the middle of
the pad and scaled by `OBSERVATION_SCALE`. `ai.lander.rules` has the numbers; `craft` pushes, `judging` judges,
`rewards` pay and `sensing` senses, as functions of a `LanderEnv`.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from ai.environment import Bools, Doubles, Floats, Ints, StepResult
from ai.lander import craft
from ai.lander.conditions import CALM, Conditions
from ai.lander.free_flight import FreeFlight
from ai.lander.ground import Ground
from ai.lander.judging import judge
from ai.lander.moment import Moment
from ai.lander.rewards import REWARDS, Pay, RewardWeights, Situation
from ai.lander.rules import (
    ACTION_NAMES,
    ACTION_SHARES,
    FLYING,
    LATE,
    LIMITS,
    NUM_ACTIONS,
    NUM_FEATURES,
    OBSERVATION_SCALE,
    PARAMS,
    Cause,
    LanderParams,
    Limits,
    Outcome,
)
from ai.lander.sensing import sensed, surroundings
from ai.lander.spawns import SPAWNS, Curriculum, checked_start
from engine import DT

__all__ = [
    "ACTION_NAMES", "LIMITS", "NUM_ACTIONS", "NUM_FEATURES", "OBSERVATION_SCALE", "PARAMS", "Cause", "LanderEnv",
    "LanderParams", "Limits", "Outcome",
]  # fmt: skip

# What begins at zero with each flight.
_DOWN: Final = 1.0  # metres between feet and ground from which on a craft is not down, however it stands
_BEGUN: Final = (
    "actions", "shares", "outcome", "cause", "feet_down", "touched", "impact", "steps", "main_steps", "side_steps",
    "still_steps", "feet_steps", "tilted_steps",
)  # fmt: skip


class LanderEnv:
    """Vectorised lunar lander environment: `num_envs` landers, each in a world of its own, stepped together.

    `spawn` names a distribution of `ai.lander.spawns` or is a Curriculum, then followed by this environment's own
    landings. `seed` is an int, a Generator or None; slot k draws from its own stream, so that a flight does
    not depend on how many fly beside it. A `step` is `frame_skip` physics steps of 1/60 s with one action.

    All fly over the same `ground`, by default a plain with one pad. Where that has several pads, a landing on any
    of them counts. `conditions` can make flights harder; on a pad that moves, observations and the limits of a landing
    are relative to it. Raises ValueError for options without sense.

    Attributes:
        params, ground, conditions, limits, weights: as given; numbers of all but ground and weights may be arrays (n,).
        curriculum: which spawn is drawn from, by landings.
        pay: pays for a decision in place of the usual parts, if given; these go on being reported beside it.
        strictness: share of the limits of a touch, as pilots observe them, that holds.
        landings: landings so far, in all flights.
        streams: the Generator from which each slot's flights are drawn, n of them; can be replaced at any time.
        world, lander, pad_bodies: the engine's worlds, the craft's body in them, and the pads' rows among bodies.

    """

    num_actions = NUM_ACTIONS
    num_features = NUM_FEATURES
    wide = False  # whether observations tell of the surroundings
    kept: tuple[str, ...] = (*_BEGUN, "target")  # arrays that a snapshot keeps

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
        pay: Pay | None = None,
    ) -> None:
        for name, number in (("num_envs", num_envs), ("frame_skip", frame_skip)):
            if isinstance(number, bool) or not isinstance(number, int | np.integer) or number < 1:
                raise ValueError(f"{name} is a whole number from 1 on, not {number}")
        if not (isinstance(spawn, Curriculum) or (isinstance(spawn, str) and spawn in SPAWNS)):
            raise ValueError(f"spawn is one of {', '.join(SPAWNS)}, or a Curriculum, not {spawn!r}")
        self.num_envs, self.frame_skip = num_envs, frame_skip
        self.curriculum = spawn if isinstance(spawn, Curriculum) else Curriculum(((0, spawn),))
        self.params, self.limits, self.conditions = params, limits, conditions
        self.ground = ground or Ground.flat(params)
        self.weights, self.pay, self.strictness, self.landings = weights or RewardWeights(), pay, 1.0, 0
        self.streams = np.random.default_rng(seed).spawn(num_envs)
        self.world, self.lander, self.pad_bodies = craft.build(num_envs, params, self.ground)

        def zeros(*shape: int, dtype: Any = np.intp) -> Any:
            return np.zeros((num_envs, *shape), dtype)

        self.target: Ints = zeros()  # number of the pad that observations and rewards are about
        self.actions: Ints = zeros()  # the latest of each, 0 to 5
        self.shares: Doubles = zeros(2, dtype=float)  # of thrust: main engine 0 to 1; jets -1, left, to 1, right
        self.outcome: Ints = zeros()  # an `Outcome`
        self.cause: Ints = zeros()  # of a crash, a `Cause`
        self.feet_down: Bools = zeros(2, dtype=bool)  # whether the left and the right foot are on a pad
        self.touched: Ints = zeros()  # number of the pad that a foot was last on
        # Greatest speed towards what was touched, along it, both m/s, and tilt in radians at any touch.
        self.impact: Doubles = zeros(3, dtype=float)
        self.steps: Ints = zeros()  # physics steps of 1/60 s flown
        self.main_steps: Doubles = zeros(dtype=float)  # of these with the main engine, each by its share of thrust
        self.side_steps: Doubles = zeros(dtype=float)  # the same with a jet
        self.still_steps: Ints = zeros()  # of these at rest on both feet, up to now
        self.feet_steps: Ints = zeros()  # of these with both feet down
        self.tilted_steps: Ints = zeros()  # of these tilted by more than `TILT_ALLOWED`
        self.begun = False
        self._free = FreeFlight(self) if num_envs == 1 else None

    @property
    def stage(self) -> int:
        """Stage of the curriculum, 0 without one."""
        return self.curriculum.stage(self.landings)

    @property
    def gravity(self) -> float:
        """Gravity in m/s², of the first lander where they differ."""
        return -float(self.world.gravity[..., 1].flat[0])

    @property
    def position(self) -> Doubles:
        """Centre of mass, metres, (n, 2)."""
        return self.lander.position

    @property
    def velocity(self) -> Doubles:
        """Metres a second, (n, 2)."""
        return self.lander.velocity

    @property
    def angle(self) -> Doubles:
        """Radians counter-clockwise from upright, unwrapped, (n,)."""
        return self.lander.angle

    @property
    def angular_velocity(self) -> Doubles:
        """Radians a second, (n,)."""
        return self.lander.angular_velocity

    @property
    def tilt(self) -> Doubles:
        """Radians from upright either way, 0 to pi, (n,)."""
        tilt: Doubles = np.abs(np.mod(self.angle + np.pi, 2 * np.pi) - np.pi)
        return tilt

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
    def thrust(self) -> Doubles:
        """Shares of thrust (n, 2) that take effect: zero where there is no fuel, or an engine does not work."""
        if not self.conditions.fails:
            return self.shares
        works = np.stack([self.conditions.main_works(self.time), np.ones(self.num_envs, dtype=bool)], axis=1)
        return np.where(works & (self.fuel < self.conditions.tank)[:, None], self.shares, 0.0)

    @property
    def fired(self) -> Ints:
        """Actions (n,) that take effect: those for which there is fuel and the engines work."""
        main, side = (self.thrust != 0).T
        fired: Ints = 3 * (main & (self.actions >= 3)) + side * (self.actions % 3)
        return fired

    @property
    def pad(self) -> Doubles:
        """Middle of the target pad's top, (n, 2)."""
        return self._top(self.target)

    @property
    def pad_width(self) -> Doubles:
        """Width of the target pad, metres, (n,)."""
        return self.ground.widths[self.target]

    @property
    def pad_shift(self) -> Doubles:
        """Displacement of the pads to the right of their places, metres, (n,)."""
        return self.conditions.shift(self.time)[0]

    @property
    def pad_velocity(self) -> Doubles:
        """Velocity of the pads to the right, m/s, (n,)."""
        return self.conditions.shift(self.time)[1]

    @property
    def relative_velocity(self) -> Doubles:
        """Velocity as seen from the pads, m/s, (n, 2)."""
        if not self.conditions.moves:
            return self.velocity
        return self.velocity - np.stack([self.pad_velocity, np.zeros(self.num_envs)], axis=1)

    @property
    def altitude(self) -> Doubles:
        """Metres between the level feet and the target pad's top, (n,)."""
        return self.position[:, 1] - self.pad[:, 1] - self.params.stand

    @property
    def landed_on(self) -> Ints:
        """Number of the pad a flight has landed on, -1 for those that have not, (n,)."""
        return np.where(self.outcome == Outcome.LANDED, self.touched, -1)

    @property
    def intact(self) -> Bools:
        """Whether a flight ended in a touch beside the pad that broke nothing: within all limits of a touch, (n,).

        Its outcome is CRASHED all the same: no landing, and no reward for one.
        """
        limits = self.limits.stricter(self.strictness)
        most = (limits.touch_speed, limits.slide_speed, limits.touch_tilt)
        kept = [felt <= allowed for felt, allowed in zip(self.impact.T, most, strict=True)]
        whole: Bools = np.all(kept, axis=0) & (self.outcome == Outcome.CRASHED)
        if self.ground.roofs:  # one that touched rock overhead is not down
            whole &= self.position[:, 1] - self.ground.height(self.position[:, 0]) < self.params.stand + _DOWN
        return whole

    def _top(self, pad: Any, above: float = 0.0) -> Doubles:
        """Return the point above the middle of one pad, or of one for each slot, where it is now: (2,) or (n, 2)."""
        middle: Doubles = self.ground.middles[pad] + np.array([0.0, above])
        return middle + np.stack([self.pad_shift, np.zeros(self.num_envs)], axis=1) if self.conditions.moves else middle

    def reset(self, mask: Bools | None = None) -> Floats:
        """Begin a new flight in the slots of `mask` (n,), or in all; return every slot's observation."""
        mask = np.ones(self.num_envs, dtype=bool) if mask is None else np.asarray(mask, dtype=bool)
        if mask.shape != (self.num_envs,):
            raise ValueError(f"the mask must have one entry for each of {self.num_envs} slots, not {mask.shape}")
        draw = SPAWNS[self.curriculum.spawn(self.landings)]
        start = np.array([draw(self.streams[slot]) for slot in np.flatnonzero(mask)]).reshape(-1, 6)
        self.place(mask, start)
        return self.observe()

    def place(self, mask: Bools, start: Doubles) -> None:
        """Begin a flight in the slots of `mask` at rows x, y, vx, vy, angle, spin of `start`, in the world's frame."""
        self.lander.set(
            position=start[:, :2], velocity=start[:, 2:4], angle=start[:, 4], angular_velocity=start[:, 5], mask=mask
        )
        for name in _BEGUN:
            getattr(self, name)[mask] = 0
        self.lander.active = self.outcome == FLYING
        self.begun = True

    def lowest(self, x: float, angle: float) -> float:
        """Return the least height, in metres, at which a lander at `x` that leans by `angle` clears the ground."""
        return craft.lowest(self.ground, x, angle)

    def begin_at(self, slot: int, start: Doubles) -> None:
        """Begin a flight of one slot at x, y, vx, vy, angle, spin, above the ground inside the area.

        Raises ValueError for any other start.
        """
        self.place(np.arange(self.num_envs) == slot, checked_start(start, self.ground, self.limits)[None])

    def step(self, actions: Any) -> StepResult:
        """Fly one decision; `actions` (n,) are 0 to 5. Raises ValueError for others, RuntimeError before a reset."""
        before = Situation.of(self)
        self.fly(actions)
        after = Situation.of(self)
        parts = np.array([part(self.weights, before, after) for part in REWARDS.values()], np.float32)
        truncated = self.outcome == LATE
        return StepResult(
            observation=self.observe(),
            # One by one, in their order: NumPy's sum takes them in another.
            reward=self.pay(before, after) if self.pay else np.add.accumulate(parts)[-1],
            terminated=(self.outcome != FLYING) & ~truncated,
            truncated=truncated,
            outcome=after.outcome,
            components=dict(zip(REWARDS, parts, strict=True)),
        )

    def fly(self, actions: Any, shares: Doubles | None = None) -> None:
        """Fly one decision as `step` does, without computing rewards; raises as that does.

        Engines give these `shares` of thrust, (n, 2), main 0 to 1 and side -1, left, to 1, right, instead of all that
        the actions ask for, which then only say what was meant. Raises ValueError for shares outside.
        """
        actions = np.asarray(actions)
        if actions.shape != (self.num_envs,) or actions.dtype.kind not in "iu":
            raise ValueError(f"actions must be {self.num_envs} whole numbers, not {actions.dtype} {actions.shape}")
        if np.count_nonzero(actions.astype(np.uintp) >= NUM_ACTIONS):  # those below 0 become huge
            raise ValueError(f"actions run from 0 to {NUM_ACTIONS - 1}, not {actions.min()} to {actions.max()}")
        if not self.begun:
            raise RuntimeError("reset() must come before the first step()")
        if shares is not None:
            shares = np.array(shares, dtype=float)
            if shares.shape != (self.num_envs, 2) or not ((shares >= (0.0, -1.0)) & (shares <= 1.0)).all():
                raise ValueError(f"shares of thrust are {self.num_envs} rows, main 0 to 1 and side -1 to 1")
        self.actions = actions.astype(np.intp)
        self.shares = ACTION_SHARES.take(self.actions, axis=0) if shares is None else shares
        left = self.frame_skip
        while left and np.count_nonzero(flying := self.outcome == FLYING):
            if self._free and (flown := self._free.fly(left)):
                left -= flown
                continue
            self._move(flying)
            judge(self, flying)
            left -= 1

    def glide(self, actions: Ints) -> None:
        """Fly one decision in every slot without collisions.

        For looking ahead: the same as `step`, bit for bit, as long as nothing touches, but without outcomes and
        rewards, and `actions` (n,) are not checked.
        """
        self.actions, self.shares = actions, ACTION_SHARES.take(actions, axis=0)
        flying = self.outcome == FLYING
        if self._free and flying[0]:
            self._free.fly(self.frame_skip, solid=False)
            return
        for _ in range(self.frame_skip):
            self._move(flying, touching=False)

    def _move(self, flying: Bools, touching: bool = True) -> None:
        """Fly one physics step; without `touching`, nothing collides."""
        main, side = self.thrust.T
        craft.push(self, main, side)
        self.world.step(touching)
        self.steps += flying
        self.main_steps += flying * main
        self.side_steps += flying * np.abs(side)

    def snapshot(self) -> dict[str, Any]:
        """Return everything flights depend on but their random streams, as a nested dict of arrays, numbers, texts."""
        return Moment.of(self).state

    def restore(self, state: dict[str, Any]) -> None:
        """Go back to a snapshot, of as many landers of the same craft over the same ground; else raises ValueError."""
        Moment(self.ground, state).put(self)

    def observe(self, pad: Any = None, *, wide: bool | None = None) -> Floats:
        """Return every lander's observation (n, 9) of its target, or of another `pad`, one number or (n,).

        If `wide`, surroundings are beside it, (n, 9 + k); by default as this environment's observations are.
        """
        pad = self.target if pad is None else pad
        pads = self.ground.at_once
        down = self.feet_down if pads == 1 else self.feet_down * np.equal(self.touched, pad)[:, None]
        offset = self.position - self._top(pad, self.params.stand)
        seen = sensed(offset, self.relative_velocity, *self.turned, down, pads=pads)
        wide = self.wide if wide is None else wide
        return np.concatenate([seen, surroundings(self, pad)], axis=1) if wide else seen

    def observe_at(self, slot: int, places: Doubles) -> Floats:
        """Return what lander `slot` would observe at other places (m, 2) in the air, moving as it does now: (m, 9)."""
        at = np.full(len(places), slot)
        offset = places - self._top(self.target, self.params.stand)[at]
        sin, cos, spin = (part[at] for part in self.turned)
        nothing = np.zeros((len(places), 2), dtype=bool)
        return sensed(offset, self.relative_velocity[at], sin, cos, spin, nothing, pads=self.ground.at_once)

    @property
    def turned(self) -> tuple[Doubles, Doubles, Doubles]:
        """Sine and cosine of every lander's angle, and its turning in rad/s, (n,) each."""
        state, body = self.world.state, self.lander.index
        return state.sin[:, body], state.cos[:, body], self.angular_velocity

    def observe_for(self, pilot: Any, pad: Any = None) -> Floats:
        """Return what a pilot reads: the surroundings as well if its network has inputs for them."""
        return self.observe(pad, wide=getattr(pilot, "num_features", NUM_FEATURES) > NUM_FEATURES)

    def observe_pads(self, pilot: Any = None) -> Floats:
        """Return every lander's observation of each pad, (n, pads, 9), or what `pilot` reads, (n, pads, features)."""
        return np.stack([self.observe_for(pilot, pad) for pad in range(len(self.ground.pads))], axis=1)

    def around(self, pad: Any = None) -> Floats:
        """Return the `ai.lander.sensing.SURROUNDINGS` of every lander, (n, k), for the target or another `pad`."""
        return surroundings(self, self.target if pad is None else pad)
