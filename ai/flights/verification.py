"""Verification: recorded flights flown again, many at once, and what each really earned beside what was claimed."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from ai.common.environment import Doubles, Ints
from ai.flights.easing import AS_IT_IS
from ai.flights.places import in_its_place
from ai.flights.recording import Recording
from ai.flights.score import landing_score
from ai.flights.shared import End, SharedFlight
from ai.flights.starts import begun
from ai.flights.stick import STEPS, full
from ai.lander.environment import LanderEnv, Outcome
from ai.lander.missions import MISSIONS
from engine import DT

TOLERANCE: Final = 1e-3  # metres and radians by which the last pose may differ: other processors round differently
_BATCH: Final = 256  # flights that are flown at once


@dataclass(frozen=True)
class Earned:
    """What a flight really earned.

    Attributes:
        outcome: its outcome; FLYING if its record stops before.
        points: the points of its landing.
        medal: 3 for gold, 2, 1, in a mission; 0 without a landing, in a free flight, or under other rules.
        steps: physics steps flown until it ended.
        fuel: seconds of main engine.
        end: its last pose.

    """

    outcome: Outcome
    points: int
    medal: int
    steps: int
    fuel: float
    end: End

    @property
    def seconds(self) -> float:
        """Duration of the flight."""
        return self.steps * DT


def earned(env: LanderEnv, recording: Recording, slot: int = 0) -> Earned:
    """Return what a lander has earned so far in the flight that is recorded."""
    outcome, fuel = Outcome(int(env.outcome[slot])), float(env.fuel[slot])
    mission = MISSIONS.get(recording.mission)
    as_it_is = recording.easing == AS_IT_IS and not recording.gravity
    medal = mission.medal(fuel, float(env.time[slot])) if mission and as_it_is and outcome is Outcome.LANDED else 0
    (x, y), angle = env.position[slot].tolist(), float(env.angle[slot])
    return Earned(outcome, landing_score(env, slot), medal, int(env.steps[slot]), fuel, (x, y, angle))


def is_true(flight: SharedFlight, real: Earned) -> bool:
    """Whether a flight was flown where it says, and really earned what it claims."""
    claim, steps = flight.claim, len(flight.recording.actions)
    away = max(abs(told - flown) for told, flown in zip(claim.end, real.end, strict=True))
    return (
        in_its_place(flight) and away <= TOLERANCE and claim.medal <= real.medal
        and (claim.outcome, claim.points, steps) == (real.outcome, real.points, real.steps)
    )  # fmt: skip


def verified(flights: Sequence[SharedFlight]) -> Iterator[tuple[int, Earned]]:
    """Yield the index of every flight, and what it earned: those of one ground are flown together, in any order."""
    groups = defaultdict[object, list[int]](list)
    for index, flight in enumerate(flights):
        groups[_together(flight.recording)].append(index)
    for group in groups.values():
        group.sort(key=lambda index: len(flights[index].recording.actions))  # a batch ends with its longest
        for first in range(0, len(group), _BATCH):
            batch = group[first : first + _BATCH]
            yield from zip(batch, fly_again([flights[index].recording for index in batch]), strict=True)


def _together(recording: Recording) -> object:
    """Return what flights must share to be flown in one environment."""
    if recording.leg:
        return object()  # a leg of a descent has an environment of its own
    seed = recording.seed if recording.pads > 1 else 0
    rules = tuple(recording.gravity), recording.easing, recording.area
    return recording.mission, recording.spawn, recording.pads, seed, rules


def fly_again(recordings: Sequence[Recording]) -> list[Earned]:
    """Fly recordings of one ground and gravity again at once; return what each earned."""
    like = recordings[0]
    env = begun(like, [each.seed for each in recordings])
    lengths = np.array([len(each.actions) for each in recordings])
    actions = np.zeros((lengths.max(), len(recordings)), dtype=np.intp)
    for slot, each in enumerate(recordings):
        actions[: lengths[slot], slot] = each.actions
    found = {slot: earned(env, like, slot) for slot in np.flatnonzero(lengths == 0).tolist()}
    gravity = dict(like.gravity)
    for step, row in enumerate(actions):
        if step in gravity:
            env.gravity = gravity[step] * env.params.gravity
        env.fly(row, _shares(recordings, step, row))
        found |= {slot: earned(env, like, slot) for slot in np.flatnonzero(lengths == step + 1).tolist()}
    return [found[slot] for slot in range(len(recordings))]


def _shares(recordings: Sequence[Recording], step: int, actions: Ints) -> Doubles | None:
    """Return the shares of thrust (n, 2) of a step; None if every engine gave all of it."""
    if not any(step in each.shares for each in recordings):
        return None
    told = zip(recordings, actions.tolist(), strict=True)
    return np.array([each.shares.get(step) or full(action) for each, action in told]) / STEPS
