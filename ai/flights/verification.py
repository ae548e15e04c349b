"""Verification: recorded flights flown again, many at once, and what each really earned beside what was claimed."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import date
from functools import lru_cache
from typing import Final

import numpy as np

from ai.flights.recording import AS_IT_IS, ClaimedFlight, End, Recording
from ai.lander.descent import can_begin, leg_of
from ai.lander.environment import LIMITS, LanderEnv, Outcome
from ai.lander.ground import PADS, Ground, Pad, hilly
from ai.lander.missions import MISSIONS
from ai.lander.rules import PARAMS
from ai.lander.spawns import RUNGS
from engine import DT

DAILY: Final = "daily"
DESCENT: Final = "descent"
COURSES: Final = ("", DAILY, DESCENT, *MISSIONS)  # "" is a free flight
TOLERANCE: Final = 1e-3  # metres and radians by which the last pose may differ: other processors round differently
_BATCH: Final = 256  # flights that are flown at once


@lru_cache(maxsize=8)
def ground_of(seed: int, pads: int, width: float = 1.0) -> Ground:
    """Return the ground of a flight: a plain with one pad, or hills with a pad of every size.

    Pads are `width` times as wide as they usually are.
    """
    if pads == 1:
        return Ground((Pad(0.0, PARAMS.pad_top, width * PARAMS.pad_width),), base=PARAMS.ground)
    return hilly(np.random.default_rng(seed), [(width * wide, factor) for wide, factor in PADS])


def begun(start: Recording, seeds: Sequence[int] = ()) -> LanderEnv:
    """Return landers at the start of a recorded flight, one physics step to a decision.

    There is one for each of `seeds`, by default for the recording's own. A mission sets everything by itself. With
    several pads the ground is that of the first seed, so all must be equal.
    """
    seeds, easing = seeds or (start.seed,), start.easing
    if start.leg:
        return leg_of(seeds[0], start.leg).begin(start.leg.tank)
    if start.mission:
        env = easing.mission(start.mission).begin(len(seeds))
        env.limits = env.limits.roomy()
        return env
    limits = easing.limits(LIMITS).roomy()
    ground = ground_of(seeds[0], start.pads, easing.pads)
    env = LanderEnv(len(seeds), 0, start.spawn, frame_skip=1, ground=ground, limits=limits)
    for slot, seed in enumerate(seeds):  # as each would draw alone
        env.streams[slot] = np.random.default_rng(seed).spawn(1)[0]
    env.reset()
    return env


def day_of(seed: int) -> date | None:
    """Return the day whose start has this seed; None if no day has."""
    return date.fromordinal(seed) if 1 <= seed <= date.max.toordinal() else None


def in_its_place(flight: ClaimedFlight) -> bool:
    """Whether a flight began where its course begins, with the fuel of that place."""
    recording, course = flight.recording, flight.course
    start = recording.spawn, recording.pads, recording.mission, recording.leg
    if course == DAILY:
        return start == ("random", 3, "", None) and day_of(recording.seed) is not None
    if course in MISSIONS:
        return start == ("random", 1, course, None)
    if leg := recording.leg:  # one can be raced too, as a flight of no course
        plain = start[:3] == ("random", 1, "") and recording.easing == AS_IT_IS
        return course in ("", DESCENT) and plain and can_begin(recording.seed, leg)
    usual = recording.spawn == "random" or (recording.spawn in RUNGS and recording.pads == 1)
    return course == "" and start[2:] == ("", None) and usual


@dataclass(frozen=True)
class Earned:
    """What a flight really earned."""

    outcome: Outcome  # FLYING if its record stops before
    points: int  # of its landing
    medal: int  # 3 for gold, 2, 1, in a mission; 0 without a landing, in a free flight, or where it was eased
    steps: int  # of physics, flown until it ended
    fuel: float  # seconds of main engine
    end: End  # its last pose

    @property
    def seconds(self) -> float:
        """Duration of the flight."""
        return self.steps * DT


def landing_score(env: LanderEnv, slot: int = 0) -> int:
    """Return the score of a landing: up to 100 times its pad's factor, less for a hard touch or off the middle."""
    number = int(env.landed_on[slot])
    if number < 0:
        return 0
    pad = env.ground.pads[number]
    hard = min(1.0, float(env.impact[slot, 0]) / env.limits.touch_speed)
    aside = min(1.0, abs(float(env.position[slot, 0] - env.pad_shift[slot]) - pad.x) / (pad.width / 2))
    return pad.factor * round(100 - 40 * hard - 30 * aside)


def earned(env: LanderEnv, recording: Recording, slot: int = 0) -> Earned:
    """Return what a lander has earned so far in the flight that is recorded."""
    outcome, fuel = Outcome(int(env.outcome[slot])), float(env.fuel[slot])
    mission = MISSIONS.get(recording.mission)
    as_it_is = recording.easing == AS_IT_IS
    medal = mission.medal(fuel, float(env.time[slot])) if mission and as_it_is and outcome is Outcome.LANDED else 0
    (x, y), angle = env.position[slot].tolist(), float(env.angle[slot])
    return Earned(outcome, landing_score(env, slot), medal, int(env.steps[slot]), fuel, (x, y, angle))


def is_true(flight: ClaimedFlight, real: Earned) -> bool:
    """Whether a flight was flown where it says, and really earned what it claims."""
    claim, steps = flight.claim, len(flight.recording.pushes)
    away = max(abs(claimed - flown) for claimed, flown in zip(claim.end, real.end, strict=True))
    alike = (claim.outcome, claim.points, steps) == (real.outcome, real.points, real.steps)
    return in_its_place(flight) and alike and away <= TOLERANCE and claim.medal <= real.medal


def verified(flights: Sequence[ClaimedFlight]) -> Iterator[tuple[int, Earned]]:
    """Yield the index of every flight, and what it earned: those of one ground are flown together, in any order."""
    groups = defaultdict[object, list[int]](list)
    for index, flight in enumerate(flights):
        groups[_together(flight.recording)].append(index)
    for group in groups.values():
        group.sort(key=lambda index: len(flights[index].recording.pushes))  # a batch ends with its longest
        for first in range(0, len(group), _BATCH):
            batch = group[first : first + _BATCH]
            yield from zip(batch, fly_again([flights[index].recording for index in batch]), strict=True)


def _together(recording: Recording) -> object:
    """Return what flights must share to be flown in one environment."""
    if recording.leg:
        return object()  # a leg of a descent has an environment of its own
    seed = recording.seed if recording.pads > 1 else 0
    return recording.mission, recording.spawn, recording.pads, seed, recording.easing


def fly_again(recordings: Sequence[Recording]) -> list[Earned]:
    """Fly recordings of one ground again at once; return what each earned."""
    like, lengths = recordings[0], np.array([len(each.pushes) for each in recordings])
    env = begun(like, [each.seed for each in recordings])
    pushed = np.zeros((lengths.max(), len(recordings), 3))  # actions, and their shares of thrust
    for slot, each in enumerate(recordings):
        for step, push in enumerate(each.pushes):
            pushed[step, slot] = push.action, *push.shares
    found = {slot: earned(env, like, slot) for slot in np.flatnonzero(lengths == 0).tolist()}
    for step, row in enumerate(pushed):
        env.fly(row[:, 0].astype(int), row[:, 1:])
        found |= {slot: earned(env, like, slot) for slot in np.flatnonzero(lengths == step + 1).tolist()}
    return [found[slot] for slot in range(len(recordings))]
