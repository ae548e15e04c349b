"""Courses other than free flights: missions, races against ghosts, and flying on from a replay."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Final

from ai.flights.recording import AS_IT_IS
from ai.lander.environment import Cause, LanderEnv, Outcome
from ai.lander.ground import Ground
from ai.lander.missions import Mission
from game.core import texts
from game.core.settings import Settings
from game.drawing.canvas import Canvas
from game.flight import sharing
from game.flight.credit import Credit
from game.flight.flight import Flight, Recording
from game.flight.flight_file import Entry, Record
from game.flight.networks import Policy
from game.flight.outcomes import OutcomeCard
from game.flight.replay import FlightReplay, ReplayedFlight, flown_elsewhere
from game.input.controls import Controls
from game.scenes.play.ghost import Ghost
from game.world.camera import View

_AFTER_OUTAGE: Final = 2.0  # seconds after an engine failure in which the speed that it left can't be braked


@dataclass(frozen=True)
class DrawnFlight:
    """Context in which a challenge draws over the world.

    Attributes:
        alpha: fraction of the current step that has passed, 0 to 1.
        waiting: whether the craft hangs until a control is touched.
        calm: whether motion is reduced.
        age: steps of 1/60 s since the flight was shown, whether or not it flies.

    """

    alpha: float
    waiting: bool = False
    calm: bool = False
    age: int = 0


class Challenge:
    """Challenge: a start and a goal, independent of the player's choices for free flights.

    Attributes:
        name: name of a mission in the logbook; empty for other courses.
        fixed: whether there is only one start.
        kept: whether its flights are recorded in the logbook.
        bar: key in `texts.NOT_COUNTED` of why its flights do not count as the player's own; empty if they may.
        alone: whether the network may neither help nor take over.
        next_hint: hint of the key for what comes next; empty where it does nothing.
        copy_hint: hint of the key that copies what a friend is told; empty for the usual words.
        title, line: name of the challenge, for the corner.
        goal: goal of the flight, for the corner as well.
        opening: text while the craft hangs and waits; empty to leave the middle free.
        through: whether the challenge is finished and free flights follow.
        eases: whether the player's easing applies to its flights.
        easing: the easing of its next flight.
        elsewhere: whether it is flown where it is not as on the moon.
        total: points of the chain of flights that it is, for the logbook.
        compares: whether the card compares the flight with the ghost's.
        ahead: the ground of the flight that comes next, to be painted while this one is flown; None if unknown.
        again_hint, new_hint: what the card calls another try, and another start; empty for the usual words.

    """

    name = ""
    fixed = True
    kept = True
    bar = ""
    alone = False
    through = False
    eases = False
    easing = AS_IT_IS
    elsewhere = False
    copy_hint = next_hint = again_hint = new_hint = ""
    title = line = goal = opening = ""
    total = 0
    compares = True
    ahead: Ground | None = None
    _help: Settings | None = None

    @property
    def under_way(self) -> bool:
        """Whether leaving now would end a chain of flights."""
        return False

    @property
    def stake(self) -> tuple[str, str] | None:
        """Question before another start, and what would be lost, while that is more than the present flight."""
        return None

    @property
    def following(self) -> Challenge | None:
        """The challenge that comes next after a landing; None for the way back."""
        return None

    def recall(self, entries: Iterable[Entry]) -> None:
        """Take what is known of earlier flights, before the first begins."""

    def flight(self, seed: int, network: Policy | None) -> Flight:
        """Begin a flight; `network` is the one to hand over to."""
        return Flight(seed, network)

    def ghost(self, seed: int, network: Policy | None) -> Ghost | None:
        """Begin the ghost that flies beside it; None without one."""
        return None

    def card(self, card: OutcomeCard, flight: Flight, credit: Credit) -> OutcomeCard:
        """Return the outcome card of a finished flight, with what this challenge adds to it."""
        return card

    def settle(self, flight: Flight, credit: Credit) -> None:
        """Take note of a flight that has just ended, before its card or the next flight."""

    def follow(self, flight: Flight) -> str:
        """Follow a step of the flight; return the name of a sound to play, empty for none."""
        return ""

    def again(self) -> bool:
        """Whether a finished flight restarts by itself, without a card."""
        return False

    def dial(self, settings: Settings) -> Settings:
        """Return the settings of help for this challenge alone: it begins without, whatever free flights have."""
        self._help = self._help or replace(settings, assist=0.0)
        return self._help

    @property
    def holds(self) -> bool:
        """Whether the craft goes on to hang, although it is touched."""
        return False

    @property
    def guides(self) -> bool:
        """Whether the network's path is previewed: not beside a ghost, where one blue path is enough."""
        return False

    @property
    def waits(self) -> bool:
        """Whether the craft hangs until the pilot touches a control; otherwise, only until all are released."""
        return True

    def skip(self) -> None:
        """Skip to the next part of the challenge, if there is one."""

    def leave(self) -> None:
        """Leave the challenge for free flights."""

    def written(self, entry: Entry) -> str:
        """Take note of the logbook's line of a finished flight; return what went wrong, empty if nothing did."""
        return ""

    def message(self, record: Record) -> tuple[str, str]:
        """Return what a friend is told of a flight that is over, and what the player is told of that."""
        code = sharing.code(record)
        return code, texts.CODE_COPIED.format(count=len(code))

    def remember(self, settings: Settings) -> bool:
        """Store the pilot's progress in the settings; return whether there was any to store."""
        return False

    def sentence(self, flight: Flight, controls: Controls, *, waiting: bool, stuck: bool) -> str | None:
        """Return the one sentence of the flight, in the player's keys; None for the usual one.

        `waiting` is whether the craft hangs until a control is touched, `stuck` whether one must first be let go.
        """
        return None

    def asides(self, flight: Flight) -> Sequence[str]:
        """Return what else is to be read while the craft waits."""
        return ()

    def draw(self, canvas: Canvas, view: View, flight: Flight, scene: DrawnFlight) -> None:
        """Draw the challenge's own text and marks over the world."""

    def medal(self, flight: Flight) -> int:
        """Return the medal of a finished flight if it counts: 3 for gold, 2 silver, 1 bronze, 0 none."""
        return 0


class Duel(Challenge):
    """Duel: one start after another against a rival."""

    fixed = False

    def __init__(self, rival: Policy, name: str) -> None:
        self._rival, self._name, self.title = rival, name, texts.DUEL
        self.line = texts.DUEL_RIVAL.format(name=name)
        self.opening = texts.DUEL_BEGIN.format(name=name)

    def ghost(self, seed: int, network: Policy | None) -> Ghost:
        """Begin the rival at the same start."""
        return Ghost(Flight(seed, self._rival), self._name)


class Race(Challenge):
    """Race: the start of a recorded flight, against its ghost."""

    def __init__(self, record: Record, name: str) -> None:
        self._record, self._name, self.title = record, name, texts.RACE
        self.elsewhere = flown_elsewhere(record.recording)
        self.line = texts.DUEL_RIVAL.format(name=name)
        self.opening = texts.DUEL_BEGIN.format(name=name)

    def flight(self, seed: int, network: Policy | None) -> Flight:
        """Begin at the recorded start, under the recorded gravity."""
        recording = self._record.recording
        flight = _as_begun(recording, seed, network)
        flight.set_gravity(recording.gravity_at(0))
        return flight

    def ghost(self, seed: int, network: Policy | None) -> Ghost:
        """Begin the recorded flight as the ghost."""
        return Ghost(ReplayedFlight(self._record.recording), self._name)


class ContinuedFlight(Challenge):
    """Fly on from a moment of a recorded flight, whose own continuation flies beside as a ghost."""

    bar = "flown_on"

    def __init__(self, flight_replay: FlightReplay, name: str) -> None:
        self.title, self.opening = texts.FLY_ON, texts.FLY_ON_BEGIN
        self._recording, self._step, self._name = flight_replay.record.recording, flight_replay.at, name
        self._moment = flight_replay.flight.env.snapshot()
        self.elsewhere = flown_elsewhere(self._recording)
        self.name = flight_replay.record.recording.mission or flight_replay.record.entry.course
        self.line = texts.FLY_ON_LINE.format(seconds=flight_replay.at / 60)

    def flight(self, seed: int, network: Policy | None) -> Flight:
        """Begin at the chosen moment of the recorded flight."""
        flight = _as_begun(self._recording, seed, network)
        flight.put(self._moment, self._recording, self._step)
        return flight

    def ghost(self, seed: int, network: Policy | None) -> Ghost:
        """Begin the ghost of the recorded flight, from the same moment on."""
        rerun = ReplayedFlight(self._recording)
        rerun.put(self._moment, self._recording, self._step)
        return Ghost(rerun, self._name)


def _as_begun(recording: Recording, seed: int, network: Policy | None) -> Flight:
    """Return a flight at the start of a recorded one."""
    return Flight(
        seed, network, recording.spawn, pads=recording.pads, mission=recording.mission, area=recording.area,
        easing=recording.easing, leg=recording.leg,
    )  # fmt: skip


class FlownMission(Challenge):
    """A mission of the campaign, beside a ghost: a recorded flight or, without one, the network."""

    eases = True

    def __init__(
        self,
        mission: Mission,
        rival: Record | None = None,
        rival_name: str = "",
        following: Callable[[], Challenge] | None = None,
    ) -> None:
        self.mission, self.name, self.elsewhere = mission, mission.name, mission.elsewhere
        self._following = following
        self._own: Recording | None = None  # the player's own landing just before, to be raced next
        self._rival, self._rival_name = rival, rival_name or texts.MISSION_RIVAL
        self.title = texts.MISSION
        self.line, self.opening = texts.MISSIONS[mission.name]
        self.goal = texts.MISSION_GOAL.format(fuel=mission.gold[0], seconds=mission.gold[1])

    def flight(self, seed: int, network: Policy | None) -> Flight:
        """Begin a flight of the mission."""
        return Flight(seed, network, mission=self.name, easing=self.easing)

    def ghost(self, seed: int, network: Policy | None) -> Ghost | None:
        """Begin the rival on the same mission."""
        if self._own:
            return Ghost(ReplayedFlight(self._own), texts.GHOST_BEFORE)
        if self._rival:
            return Ghost(ReplayedFlight(self._rival.recording), self._rival_name)
        return Ghost(Flight(seed, network, mission=self.name), self._rival_name) if network else None

    @property
    def following(self) -> Challenge | None:
        """The next mission, if there is one and the way to it is known."""
        return self._following() if self._following else None

    @property
    def again_hint(self) -> str:  # type: ignore[override]
        """After a landing, another try flies against it."""
        return texts.MISSION_AGAIN if self._own else ""

    @property
    def new_hint(self) -> str:  # type: ignore[override]
        """What the card calls the next mission."""
        return texts.MISSION_NEXT if self._following else ""

    def settle(self, flight: Flight, credit: Credit) -> None:
        """Keep a landing as the ghost of the next try."""
        if flight.outcome is Outcome.LANDED and flight.share > 0:
            self._own = flight.recording

    def medal(self, flight: Flight) -> int:
        """Return the medal of the flight if it counts, 0 to 3."""
        if flight.outcome is not Outcome.LANDED:
            return 0
        return self.mission.medal(float(flight.env.fuel[0]), float(flight.env.time[0]))

    def card(self, card: OutcomeCard, flight: Flight, credit: Credit) -> OutcomeCard:
        """Return the card with the medal beside the points, and what the next medal asks, or why there is none."""
        if not card.good:
            return replace(card, advice=_advice(flight.env) or card.advice)
        if not credit.counts:
            if credit.together:
                return replace(card, score=texts.MISSION_TOGETHER, ring=True)
            return replace(card, score=card.score if credit.bar in ("practice", "assists") else texts.MEDALS[0])
        medal = credit.medal
        score = texts.DIAL_JOIN.join(filter(None, (card.score, texts.MEDALS[medal])))
        return replace(card, score=score, medal=medal, reason=self._missing(medal, flight))

    def _missing(self, medal: int, flight: Flight) -> str:
        if medal == 3:
            return texts.MEDAL_GOLD
        fuel, seconds = self.mission.too_much(medal + 1, float(flight.env.fuel[0]), float(flight.env.time[0]))
        words = [
            text.format(much)
            for much, text in ((fuel, texts.MEDAL_LESS_FUEL), (seconds, texts.MEDAL_LESS_TIME))
            if much > 0
        ]
        return texts.MEDAL_NEXT.format(medal=texts.MEDALS[medal + 1].capitalize(), less=texts.AND.join(words))


def _advice(env: LanderEnv) -> str:
    """Return advice on the mission's special condition; empty if that was not the cause of the crash."""
    conditions, time = env.conditions, float(env.time[0])
    if env.fuel[0] >= conditions.tank:
        return texts.ADVICE_TANK
    if conditions.outage[0] <= time < conditions.outage[1] + _AFTER_OUTAGE:
        return texts.ADVICE_OUTAGE
    if conditions.moves and env.cause[0] in (Cause.SLIDING, Cause.TERRAIN):
        return texts.ADVICE_MOVING
    return texts.ADVICE_WIND if conditions.pushes and env.cause[0] == Cause.TERRAIN else ""
