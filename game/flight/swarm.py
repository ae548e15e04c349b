"""Swarm: landers that one network flies again and again, for Watch; a person may change the flight of one."""

from __future__ import annotations

from typing import Final

import numpy as np

from ai.agent.decision import Decision
from ai.environment import Bools, Doubles, Floats, Ints
from ai.lander.environment import LanderEnv, Outcome
from ai.lander.pilots import COAST
from game.flight.flight import Poses
from game.flight.networks import Policy, decide, decision_steps

# Steps that an ended flight of a swarm stays visible.
REST_STEPS: Final = 75


class Swarm:
    """Swarm of landers, all flown by one network, each again and again.

    Attributes:
        since_end: steps since each flight's end, 0 while it flies.
        landed, lost: numbers of flights that ended so.
        fresh: mask of the slots whose flight began with the last step.
        decision: latest decision of each slot, which is being flown.
        decided: number of decisions of each slot.
        touched: mask of the slots whose flight a person has changed; such a flight is not counted.
        decision_steps: number of steps from one decision to the next, as the network was trained.

    """

    def __init__(self, count: int, seed: int, policy: Policy) -> None:
        self.env = LanderEnv(count, seed, frame_skip=1)
        self.observation: Floats = self.env.reset()
        self.policy = policy
        self.poses = Poses(self.env)
        self.since_end: Ints = np.zeros(count, dtype=np.intp)
        self.landed = self.lost = 0
        self.fresh: Bools = np.ones(count, dtype=bool)
        self.touched: Bools = np.zeros(count, dtype=bool)
        self.decision = decide(policy, self.observation, np.zeros(count, dtype=np.intp))
        self.decided: Ints = np.ones(count, dtype=np.intp)
        self.decision_steps = decision_steps(policy)
        self._age: Ints = np.arange(count) % self.decision_steps  # steps since the latest decision; staggered at first

    def step(self) -> Bools:
        """Advance by 1/60 s, and restart flights that have been over for a while. Return a mask of those just ended."""
        self.fresh = self.since_end >= REST_STEPS
        if self.fresh.any():
            self.observation = self.env.reset(self.fresh)
            self.since_end[self.fresh] = 0
            self.touched[self.fresh] = False
        self._decide(np.flatnonzero(self.fresh | ((self._age == self.decision_steps) & (self.since_end == 0))))
        self._age += self.since_end == 0
        self.env.fly(self.decision.action)
        self.observation = self.env.observe()
        outcome = self.env.outcome
        over = outcome != Outcome.FLYING
        ended: Bools = over & (self.since_end == 0)
        self.since_end += over
        counted = ended & ~self.touched
        landed = int((outcome[counted] == Outcome.LANDED).sum())
        self.landed += landed
        self.lost += int(counted.sum()) - landed
        self.poses.take(self.fresh)
        return ended

    def touch(self, slot: int, start: Doubles) -> None:
        """Let one lander fly on from another state: x, y, vx, vy, angle, spin; raises ValueError as `begin_at` does.

        It decides anew at once, with no action held: that decision is shown, and then flown.
        """
        self.env.begin_at(slot, start)
        self.observation = self.env.observe()
        self.since_end[slot], self.touched[slot] = 0, True
        self.poses.take(np.arange(self.env.num_envs) == slot)
        due = np.array([slot])
        self._take(due, decide(self.policy, self.observation[due]))

    def _decide(self, due: Ints) -> None:
        """Decide for the slots that are due; these are staggered so that all frames cost the same."""
        if len(due):
            held = np.where(self.fresh, COAST, self.decision.action)[due]
            self._take(due, decide(self.policy, self.observation[due], held))

    def _take(self, due: Ints, decision: Decision) -> None:
        self.decision = self.decision.updated(due, decision)
        self.decided[due] += 1
        self._age[due] = 0
