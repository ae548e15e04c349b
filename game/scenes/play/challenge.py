"""Challenges: what a flight is flown as. Each is a start, rules, words, and two hooks, which one scene reads.

Here are the base, and the short ones: races against ghosts, flying on from a replay, and missions.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from ai.flights.recording import AS_IT_IS, Easing, Recording
from ai.lander.environment import Cause, LanderEnv, Outcome
from ai.lander.ground import Ground
from ai.lander.missions import MISSIONS, Mission
from game.core import texts
from game.core.catalogue import capital
from game.flight.choosers import Alone
from game.flight.flight import Flight
from game.flight.flight_file import Record
from game.flight.networks import Policy, who
from game.flight.outcomes import OutcomeCard
from game.flight.replay import FlightReplay, flown_elsewhere, replayed
from game.scenes.play.ghost import Ghost, Named

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas
    from game.scenes.play.flown_flight import FlownFlight
    from game.world.camera import View

_AFTER_OUTAGE: Final = 2.0  # seconds after an engine failure in which the speed that it left can't be braked


@dataclass(frozen=True)
class Wanted:
    """What a flight is to begin with.

    Attributes:
        seed: of the start.
        network: the one to hand over to, and to help.
        spawn: kind of start, where there are several; empty for the player's own.
        easing: what the player has chosen to make flights easier.

    """

    seed: int
    network: Policy | None = None
    spawn: str = ""
    easing: Easing = AS_IT_IS


@dataclass(frozen=True)
class Start:
    """How a flight begins.

    Attributes:
        recording: where it begins, and under which rules.
        ghost: what flies beside it; None without one.
        shares: whether the network may share the stick, and not only take it.
        place: puts the craft elsewhere than the recording says; None to leave it there.
        ahead: the ground of the flight that comes next, to be painted while this one is flown; None if unknown.

    """

    recording: Recording
    ghost: Ghost | None = None
    shares: bool = True
    place: Callable[[Flight[Any]], None] | None = None
    ahead: Ground | None = None


@dataclass
class Rules:
    """What a flight may do and what counts; a challenge may change them as it goes on.

    Attributes:
        free: whether it is a free flight: pads and start can be chosen, and the network's path and score are shown.
        fixed: whether there is only one start.
        kept: whether its flights are recorded in the logbook.
        bar: key in `texts.NOT_COUNTED` of why its flights do not count as the player's own; empty if they may.
        alone: whether the network may neither help nor take over.
        elsewhere: whether it is flown where it is not as on the moon.
        again: whether a finished flight restarts by itself, without a card.
        anew: whether the next flight begins now, whether or not this one is over.
        through: whether it is finished and free flights follow.
        staked: whether another start would lose more than the present flight.
        mission: whose medals can be won; None without.
        following: makes the challenge that comes after a landing; None for the way back.

    """

    free: bool = False
    fixed: bool = True
    kept: bool = True
    bar: str = ""
    alone: bool = False
    elsewhere: bool = False
    again: bool = False
    anew: bool = False
    through: bool = False
    staked: bool = False
    mission: Mission | None = None
    following: Callable[[], Challenge] | None = None


@dataclass(frozen=True)
class Words:
    """What is said of a flight, in the player's language, at this moment.

    Attributes:
        title, line: its kind and name, for the corner.
        goal: its goal, for the corner as well.
        opening: text while the craft hangs and waits; empty to leave the middle free.
        sentence: the one sentence of the flight; None for the usual one.
        next: hint of the key for what comes next; empty where it does nothing.
        stake: question before another start, and what would be lost.
        result: what is copied for a friend in place of the flight's code; empty for the code.
        marks: draws the challenge's own text and marks over the world; None for none.
        card: adds to the card of a flight that has ended what is to be said; None for nothing.

    """

    title: str = ""
    line: str = ""
    goal: str = ""
    opening: str = ""
    sentence: str | None = None
    next: str = ""
    stake: tuple[str, str] = ("", "")
    result: str = ""
    marks: Callable[[Canvas, View, float], None] | None = None
    card: Callable[[OutcomeCard], None] | None = None


class Challenge:
    """What a flight is flown as.

    Attributes:
        name: its name in the logbook; empty for flights of no course.
        rules: what its flights may do, and what counts.

    """

    name = ""

    def __init__(self, **rules: Any) -> None:
        self.rules = Rules(**rules)

    def start(self, wanted: Wanted) -> Start:
        """Return how the next flight begins."""
        return Start(Recording(wanted.seed, wanted.spawn or "random"))

    def words(self, flown: FlownFlight) -> Words:
        """Return what is said of a flight now."""
        return Words()

    def stepped(self, flown: FlownFlight) -> str:
        """Follow a step of the flight, also after its end; return the name of a sound to play, empty for none."""
        return ""

    def ended(self, flown: FlownFlight) -> None:
        """Take note of a flight that has just ended, and have it kept."""
        flown.keep()

    def skip(self) -> None:
        """Do what the key for what comes next does before another flight begins: nothing."""


class Race(Challenge):
    """Race beside a ghost, called by its name: a network's on one start after another, or a recorded flight's."""

    def __init__(self, rival: Policy | Recording, name: str) -> None:
        fixed = isinstance(rival, Recording)
        super().__init__(fixed=fixed, elsewhere=isinstance(rival, Recording) and flown_elsewhere(rival))
        self._rival, self._name = rival, name

    def start(self, wanted: Wanted) -> Start:
        if isinstance(self._rival, Recording):
            return Start(self._rival, Ghost(replayed(self._rival), self._name))
        recording = Recording(wanted.seed, "random")
        return Start(recording, Ghost(Flight(recording, Alone(self._rival)), self._name))

    def words(self, flown: FlownFlight) -> Words:
        opening = texts.RACE_BEGIN.format(name=self._name)
        return Words(texts.RACE, texts.RACE_AGAINST.format(name=self._name), opening=opening)


class ContinuedFlight(Challenge):
    """Fly on from a moment of a recorded flight, whose own continuation flies beside as a ghost."""

    def __init__(self, flight_replay: FlightReplay, name: str) -> None:
        self._recording, self._step, self._name = flight_replay.record.recording, flight_replay.at, name
        self._moment = flight_replay.flight.env.snapshot()
        super().__init__(bar="flown_on", elsewhere=flown_elsewhere(self._recording))
        self.name = self._recording.mission or flight_replay.record.entry.course

    def words(self, flown: FlownFlight) -> Words:
        line = texts.FLY_ON_LINE.format(seconds=self._step / 60)
        return Words(texts.FLY_ON, line, opening=texts.FLY_ON_BEGIN)

    def start(self, wanted: Wanted) -> Start:
        beside = replayed(self._recording)
        self._place(beside)
        return Start(self._recording, Ghost(beside, self._name), place=self._place)

    def _place(self, flight: Flight[Any]) -> None:
        flight.put(self._moment, self._recording, self._step)


class FlownMission(Challenge):
    """A mission of the campaign, beside a ghost: a recorded flight or, without one, the network.

    `following` makes the mission that comes next, where there is one and the way to it is known.
    """

    def __init__(
        self,
        mission: Mission,
        rival: Record | None = None,
        rival_name: Named = "",
        following: Callable[[], Challenge] | None = None,
    ) -> None:
        super().__init__(elsewhere=mission.elsewhere, mission=mission, following=following)
        self.mission, self.name = mission, mission.name
        self._rival, self._rival_name = rival.recording if rival else None, rival_name

    def words(self, flown: FlownFlight) -> Words:
        line, opening = texts.MISSIONS[self.name]
        goal = texts.MISSION_GOAL.format(fuel=self.mission.gold[0], seconds=self.mission.gold[1])
        return Words(texts.MISSION, line, goal, opening, card=partial(self._add_to, flown))

    def start(self, wanted: Wanted) -> Start:
        recording = Recording(wanted.seed, "random", mission=self.name, easing=wanted.easing)
        return Start(recording, self._ghost(replace(recording, easing=AS_IT_IS), wanted.network))

    def _ghost(self, start: Recording, network: Policy | None) -> Ghost | None:
        if self._rival:
            return Ghost(replayed(self._rival), self._rival_name)
        return Ghost(Flight(start, Alone(network)), partial(who, network)) if network else None

    def ended(self, flown: FlownFlight) -> None:
        """Keep a landing as the ghost of the next try."""
        flown.keep()
        if flown.flight.outcome is Outcome.LANDED and flown.flight.share > 0:
            self._rival, self._rival_name = flown.flight.recording, lambda: texts.GHOST_BEFORE

    def _add_to(self, flown: FlownFlight, card: OutcomeCard) -> None:
        """Say what the next medal asks, or why there is none."""
        flight, credit = flown.flight, flown.credit
        if not card.good:
            card.advice = _advice(flight.env) or card.advice
            return
        if not credit.counts:
            return
        card.score, card.medal = texts.DIAL_JOIN.join((card.score, texts.MEDALS[credit.medal])), credit.medal
        if card.title == texts.PERFECT and credit.medal < 3:  # a medal asks for more than a good touch
            card.title = texts.OUTCOMES[Outcome.LANDED.name][0]
        card.reason = self._missing(flight.env, credit.medal)

    def _missing(self, env: LanderEnv, medal: int) -> str:
        """Return what the next medal asks."""
        if medal == 3:
            return texts.MEDAL_GOLD
        much = self.mission.too_much(medal + 1, float(env.fuel[0]), float(env.time[0]))
        named = zip(much, (texts.MEDAL_LESS_FUEL, texts.MEDAL_LESS_TIME), strict=True)
        less = texts.AND.join(text.format(each) for each, text in named if each > 0)
        return texts.MEDAL_NEXT.format(medal=capital(texts.MEDALS[medal + 1]), less=less)


def _advice(env: LanderEnv) -> str:
    """Return advice on the mission's special condition; empty if that was not the cause of the crash."""
    conditions, seconds = env.conditions, float(env.time[0])
    if env.fuel[0] >= conditions.tank:
        return texts.ADVICE_TANK
    if conditions.outage[0] <= seconds < conditions.outage[1] + _AFTER_OUTAGE:
        return texts.ADVICE_OUTAGE
    if conditions.moves and env.cause[0] in (Cause.SLIDING, Cause.TERRAIN):
        return texts.ADVICE_MOVING
    return texts.ADVICE_WIND if conditions.pushes and env.cause[0] == Cause.TERRAIN else ""


def against(record: Record, rival: str = "") -> FlownMission | Race:
    """Return a race against a recorded flight, named by its date or as `rival`; a mission's is raced with medals."""
    mission, name = MISSIONS.get(record.recording.mission), rival or dated(record)
    return FlownMission(mission, record, name) if mission else Race(record.recording, name)


def dated(record: Record) -> str:
    """Return a flight as a ghost is called, by its date."""
    return texts.RACE_RIVAL.format(when=time.strftime("%Y-%m-%d %H:%M", time.localtime(record.entry.when)))
