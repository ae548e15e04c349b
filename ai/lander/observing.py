"""Observing: what a pilot of each lander reads, of the pad it flies to, of other pads, and from other places."""

from __future__ import annotations

from typing import Any

import numpy as np

from ai.common.environment import Doubles, Floats
from ai.lander.alone import Alone
from ai.lander.judging import JudgedCraft
from ai.lander.rewards import FEET_STEPS_PAID, Moment, Situation, situated
from ai.lander.rules import NUM_FEATURES
from ai.lander.sensing import sensed, surroundings, terrain


class ObservedCraft(JudgedCraft):
    """Craft and what their pilots read; a lander alone is read in plain numbers, by `_alone`."""

    _alone: Alone | None

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

    def observe_wide(self, pad: Any = None) -> Floats:
        """Return every lander's observation and what is around it, side by side, (n, 9 + k)."""
        return np.concatenate([ObservedCraft.observe(self, pad), self.surroundings(pad)], axis=1)

    def observe_for(self, pilot: Any, pad: Any = None) -> Floats:
        """Return what a pilot reads: `observe_wide` if its network has inputs for that, else `observe`."""
        wide = getattr(pilot, "num_features", NUM_FEATURES) > NUM_FEATURES
        return self.observe_wide(pad) if wide else ObservedCraft.observe(self, pad)

    def situation(self) -> Situation:
        """Return what the shaping reward depends on: distance, offset, speed and tilt from the pad, (batch,) each."""
        offset, velocity = self.position - self.pad, self._relative_velocity()
        return situated(offset[:, 0], offset[:, 1] - self.params.stand, velocity[:, 0], velocity[:, 1], self.tilt)

    def moment(self) -> Moment:
        """Return all that rewards compare, as it is now."""
        if self._alone:
            return self._alone.moment()
        return Moment(
            self.situation(),
            outcome=self.outcome.copy(),
            actions=self.actions.copy(),
            steps=self.steps.copy(),
            tilted=self.tilted_steps.copy(),
            feet_down=np.minimum(self.feet_steps, FEET_STEPS_PAID),
        )
