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
from ai.lander.ground import Ground
from ai.lander.judging import JUDGEMENTS
from ai.lander.observing import ObservedCraft
from ai.lander.rewards import REWARDS, TILT_ALLOWED, RewardWeights, SituationChange
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
from ai.lander.spawns import SPAWNS, Curriculum

__all__ = [
    "ACTION_NAMES", "FEATURE_NAMES", "FOOT_CENTRE", "FOOT_SIZE", "HULL", "LIMITS", "MIRROR_ACTIONS",
    "MIRROR_FEATURES", "MIRROR_SIGNS", "NUM_ACTIONS", "NUM_FEATURES", "OBSERVATION_SCALE", "PARAMS", "Cause",
    "LanderEnv", "LanderParams", "Limits", "Outcome", "engines_switched",
]  # fmt: skip

_COUNTERS: Final = (*JUDGEMENTS, "actions", "shares", "steps", "main_steps", "side_steps")
# NumPy compares with plain numbers many times as fast as with members of an enumeration.
_FLYING, _LATE = int(Outcome.FLYING), int(Outcome.TIMED_OUT)


class LanderEnv(ObservedCraft):
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
        super().__init__(num_envs, params, ground or Ground.flat(params), conditions, limits)
        self.frame_skip, self.weights = frame_skip, weights or RewardWeights()
        self.spawn = spawn
        self._rngs = np.random.default_rng(seed).spawn(num_envs)
        self._started = False
        self._alone = Alone(self) if num_envs == 1 else None

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
        before = self.moment()
        self._take(actions)
        self._fly_on()
        change = SituationChange.between(before, self.moment())
        parts = np.array([part(change, self.weights) for part in REWARDS.values()], np.float32)
        parts = parts.reshape(len(REWARDS), self.num_envs)
        reward = np.add.accumulate(parts)[-1]  # one by one, in their order: NumPy's sum takes them in another
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

    def snapshot(self) -> dict[str, Any]:
        """Return everything a flight depends on but its random streams, to be put back by `restore`."""
        state = self.world.state
        arrays = {name: getattr(self, name).copy() for name in (*_COUNTERS, "target")}
        bodies = {field.name: getattr(state, field.name).copy() for field in fields(state)}
        return {"counters": arrays, "bodies": bodies, "contacts": self.world.memory()}

    def restore(self, snapshot: dict[str, Any]) -> None:
        """Go back to a snapshot of this environment, or of one with as many slots."""
        for name, value in snapshot["counters"].items():
            setattr(self, name, value.copy())
        for name, value in snapshot["bodies"].items():
            setattr(self.world.state, name, value.copy())
        self.world.recall(snapshot["contacts"])
        self._started = True
        if self._alone:
            self._alone.forget()

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

    def _fly_on(self) -> None:
        """Fly one decision where flights go on."""
        left = self.frame_skip
        while left and np.count_nonzero(flying := self.outcome == _FLYING):
            if self._alone and (flown := self._alone.fly(left)).steps:
                left -= flown.steps
                self.tilted_steps[0] += flown.tilted
                self._judge_untouched(flown.outcome)
                continue
            self._fly(flying)
            self.tilted_steps += flying & (self.tilt > TILT_ALLOWED)
            left -= 1

    def _fly(self, flying: Bools) -> None:
        """One physics step of the slots that fly: push, move, judge."""
        self._move(flying)
        self._judge(flying)
