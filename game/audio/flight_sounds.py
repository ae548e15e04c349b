"""Sounds of a flight: engines that follow the thrust, touches and warnings."""

from __future__ import annotations

from typing import Final

from ai.environment import Doubles
from ai.lander.environment import LanderEnv, Outcome
from ai.lander.sensing import near_edges
from game.audio.mixer import Sound

_ENDS: Final = {Outcome.LANDED: "landed", Outcome.CRASHED: "crash"}  # any other flight is lost
_HARD_BRAKING: Final = 0.8  # share of the greatest deceleration above which a fall is warned of
_REACTION: Final = 0.4  # reaction time of a warned pilot in seconds
_WARN_TILT_BELOW: Final = 6.0  # metres
_WARN_EDGE: Final = 6.0  # metres
_WARN_EVERY: Final = 40  # steps


class FlightSound:
    """Sounds of one lander of an environment, which may warn of a likely crash; call `follow` once in every step."""

    def __init__(self, sound: Sound, env: LanderEnv, *, warns: bool = True) -> None:
        self._sound, self._env, self._warns = sound, env, warns
        self._slot, self._time, self._outcome = -1, 0.0, Outcome.FLYING
        self._rest = self._turn = 0

    def follow(self, thrust: Doubles, slot: int = 0) -> None:
        """Play a lander's sounds of this step; `thrust` (3,) is main engine, left-hand and right-hand jet, 0 to 1."""
        env = self._env
        if slot != self._slot or env.time[slot] < self._time:
            self._begin(slot)
        self._time = float(env.time[slot])
        for key, force in zip(("engine", "jet_left", "jet_right"), thrust.tolist(), strict=True):
            self._sound.loop(key, force)
        self._touch()
        outcome = Outcome(int(env.outcome[slot]))
        if outcome not in (self._outcome, Outcome.FLYING):
            self._end(outcome)
        self._outcome = outcome
        if outcome is Outcome.FLYING and self._warns:
            self._warn()

    def _begin(self, slot: int) -> None:
        """Start to follow another lander or flight, without sounds for what happened to it before."""
        env = self._env
        self._slot, self._time = slot, float(env.time[slot])
        self._outcome = Outcome(int(env.outcome[slot]))
        self._down, self._fall = env.feet_down[slot].copy(), 0.0
        self._touched = bool(self._down.any())

    def _end(self, outcome: Outcome) -> None:
        """Play the sound of an ending; a craft that is whole beside the pad is set down, and lost its landing."""
        env, slot = self._env, self._slot
        if env.intact[slot]:
            self._sound.play("touchdown", 0.15 + 0.85 * float(env.impact[slot, 0]) / env.limits.touch_speed)
            self._sound.play("lost")
        else:
            self._sound.play(_ENDS.get(outcome, "lost"))

    def _touch(self) -> None:
        """Play a thud for every foot that touches, as loud as its speed; and the contact note, once."""
        env, slot = self._env, self._slot
        down = env.feet_down[slot]
        if (down & ~self._down).any() and env.outcome[slot] != Outcome.CRASHED:
            self._sound.play("touchdown", 0.15 + 0.85 * min(1.0, max(0.0, self._fall) / env.limits.touch_speed))
            if not self._touched:
                self._sound.play("contact")
            self._touched = True
        self._down, self._fall = down.copy(), -float(env.velocity[slot, 1])

    def _warn(self) -> None:
        """Warn of a likely crash, by speed or by tilt, and of the area's edge; take turns if several apply."""
        env, slot = self._env, self._slot
        warnings = []
        if self._falls_too_fast():
            warnings.append("too_fast")
        if env.tilt[slot] > env.limits.touch_tilt and env.altitude[slot] < _WARN_TILT_BELOW:
            warnings.append("too_tilted")
        if any(edge.ahead and edge.away < _WARN_EDGE for edge in near_edges(env, slot)):
            warnings.append("edge")
        self._rest = max(0, self._rest - 1)
        if warnings and not self._rest:
            self._sound.play(warnings[self._turn % len(warnings)])
            self._rest, self._turn = _WARN_EVERY, self._turn + 1

    def _falls_too_fast(self) -> bool:
        """Whether only nearly full thrust, after the reaction time, would still slow the lander to a safe touchdown."""
        env, slot = self._env, self._slot
        descent = -float(env.velocity[slot, 1])
        if descent <= env.limits.touch_speed:
            return False
        braking = env.params.main_thrust / env.params.mass - env.gravity
        left = float(env.altitude[slot]) - (0.0 if env.actions[slot] >= 3 else _REACTION * descent)
        return descent**2 - env.limits.touch_speed**2 > 2 * max(left, 0.0) * _HARD_BRAKING * braking
