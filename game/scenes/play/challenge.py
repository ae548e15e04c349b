"""Challenges: what a flight is flown as. Each is a start, rules, and words, which one scene reads.

Here are the base, and the short ones: races against ghosts, flying on from a replay, and missions.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from ai.flights.recording import AS_IT_IS
from ai.lander.environment import Cause, LanderEnv, Outcome
from ai.lander.ground import Ground
from ai.lander.missions import MISSIONS, Mission
from game.core import texts
from game.core.catalogue import capital
from game.core.settings import Settings
from game.flight import sharing
from game.flight.choosers import Alone, Crew
from game.flight.credit import Credit
from game.flight.flight import Flight, Recording, begin
from game.flight.flight_file import Entry, Record
from game.flight.networks import Network, Policy, titled, who
from game.flight.outcomes import OutcomeCard
from game.flight.replay import FlightReplay, flown_elsewhere, replayed
from game.input.controls import Controls
from game.scenes.play.ghost import Ghost, Named

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas
    from game.scenes.play.flown_flight import FlownFlight
    from game.world.camera import View

_AFTER_OUTAGE: Final = 2.0  # seconds after an engine failure in which the speed that it left can't be braked


class Challenge:
    """What a flight is flown as.

    Attributes:
        name: name of a mission in the logbook; empty for other courses.
        title, line: its name, for the corner.
        goal: its goal, for the corner as well.
        opening: text while the craft hangs and waits; empty to leave the middle free.
        free: whether it is a free flight, for which pads and start can be chosen.
        fixed: whether there is only one start.
        kept: whether its flights are recorded in the logbook.
        bar: key in `texts.NOT_COUNTED` of why its flights do not count as the player's own; empty if they may.
        alone: whether the network may neither help nor take over.
        eases: whether the player's easing applies to its flights.
        easing: the easing of its next flight.
        guides: whether the network's path is previewed.
        elsewhere: whether it is flown where it is not as on the moon.
        compares: whether the card compares the flight with the ghost's.
        shadows: whether the network flies the same start unseen, so that the card tells its score.
        through: whether it is finished and free flights follow.
        total: points of the chain of flights that it is, for the logbook.
        ahead: the ground of the flight that comes next, to be painted while this one is flown; None if unknown.
        stake: question before another start, and what would be lost, while that is more than the present flight.
        eased_line: what is said before a flight that assists will set apart; empty for no more than their names.
        copy_hint: hint of the key that copies the text for a friend; empty for the usual words.
        next_hint: hint of the key for what comes next; empty where it does nothing.
        again_hint, new_hint: what the card calls another try, and another start; empty for the usual words.

    """

    name = title = line = goal = opening = eased_line = bar = copy_hint = next_hint = again_hint = new_hint = ""
    free = alone = eases = guides = elsewhere = shadows = through = False
    fixed = kept = compares = True
    easing = AS_IT_IS
    total = 0
    ahead: Ground | None = None
    stake: tuple[str, str] | None = None
    _help: Settings | None = None

    def word(self) -> None:
        """Set its texts, at first and whenever the language has changed."""

    # Before a flight

    def recall(self, entries: Iterable[Entry]) -> None:
        """Take what is known of earlier flights, before the first begins."""

    def chosen(self) -> Hashable:
        """Return what the player has chosen for its next flight."""
        return None

    def flight(self, seed: int, network: Policy | None, spawn: str = "") -> Flight[Crew]:
        """Begin a flight, of the kind of start `spawn` if there are several; `network` is the one to hand over to."""
        return begin(Recording(seed, "random"), network)

    def ghost(self, seed: int, network: Policy | None) -> Ghost | None:
        """Begin the ghost that flies beside it; None without one."""
        return None

    def dial(self, settings: Settings) -> Settings:
        """Return the settings of help for this challenge alone: it begins without, whatever free flights have."""
        self._help = self._help or replace(settings, help="off")
        return self._help

    # In flight

    @property
    def waits(self) -> bool:
        """Whether the craft hangs until the pilot touches a control; otherwise, only until all are released."""
        return True

    @property
    def holds(self) -> bool:
        """Whether the craft goes on to hang, although it is touched."""
        return False

    def keeps_stick(self, flight: Flight[Crew]) -> bool:
        """Whether the player cannot hand over the stick now."""
        return False

    def follow(self, flight: Flight[Crew]) -> str:
        """Follow a step of the flight; return the name of a sound to play, empty for none."""
        return ""

    def remember(self, settings: Settings) -> bool:
        """Store the pilot's progress in the settings; return whether there was any to store."""
        return False

    def titles(self, flight: Flight[Crew], network: Network, *, whole: bool) -> tuple[str, str]:
        """Return the kind of a flight, and its name; `whole` is for all that can be said of it."""
        named = whole and flight.chooser.network and self.elsewhere
        flown = texts.WITH_NETWORK.format(network=titled(network.name)) if named else ""
        return texts.DIAL_JOIN.join(filter(None, (self.title, flown))), self.line

    def sentence(self, flight: Flight[Crew], controls: Controls, *, waiting: bool, stuck: bool) -> str | None:
        """Return the one sentence of the flight, in the player's keys; None for the usual one.

        `waiting` is whether the craft hangs until a control is touched, `stuck` whether one must first be let go.
        """
        return None

    def asides(self, flight: Flight[Crew]) -> Sequence[str]:
        """Return what else is to be read while the craft waits."""
        return ()

    def draw(self, canvas: Canvas, view: View, flown: FlownFlight, alpha: float) -> None:
        """Draw the challenge's own text and marks over the world."""

    # After a flight

    def note_end(self, flight: Flight[Crew], credit: Credit) -> None:
        """Take note of a flight that has just ended, before its card or the next flight."""

    def again(self) -> bool:
        """Whether a finished flight restarts by itself, without a card."""
        return False

    def medal(self, flight: Flight[Crew]) -> int:
        """Return the medal of a finished flight if it counts: 3 for gold, 2 silver, 1 bronze, 0 none."""
        return 0

    def card(self, card: OutcomeCard, flight: Flight[Crew], credit: Credit) -> OutcomeCard:
        """Return the outcome card of a finished flight, with what this challenge adds to it."""
        return card

    def written(self, entry: Entry) -> str:
        """Take note of the logbook's line of a finished flight; return what went wrong, empty if nothing did."""
        return ""

    def message(self, record: Record) -> tuple[str, str]:
        """Return the text for a friend about a flight that is over, and the note for the player about it."""
        code = sharing.code(record)
        return code, texts.CODE_COPIED

    def following(self) -> Challenge | None:
        """Return the challenge that comes next after a landing; None for the way back."""
        return None

    def skip(self) -> None:
        """Skip to the next part of the challenge, if there is one."""

    def leave(self) -> None:
        """Leave the challenge for free flights."""


class _Beside(Challenge):
    """A flight beside a rival's ghost, called by its name."""

    def __init__(self, name: str) -> None:
        self._name = name
        self.word()

    def word(self) -> None:
        self.title, self.line = texts.RACE, texts.DUEL_RIVAL.format(name=self._name)
        self.opening = texts.DUEL_BEGIN.format(name=self._name)


class Duel(_Beside):
    """Duel: one start after another against a rival."""

    fixed = False

    def __init__(self, rival: Policy, name: str) -> None:
        super().__init__(name)
        self._rival = rival

    def word(self) -> None:
        super().word()
        self.title = texts.DUEL

    def ghost(self, seed: int, network: Policy | None) -> Ghost:
        return Ghost(Flight(Recording(seed, "random"), Alone(self._rival)), self._name)


class Race(_Beside):
    """Race: the start of a recorded flight, against its ghost."""

    def __init__(self, record: Record, name: str) -> None:
        super().__init__(name)
        self._recording, self.elsewhere = record.recording, flown_elsewhere(record.recording)

    def flight(self, seed: int, network: Policy | None, spawn: str = "") -> Flight[Crew]:
        return begin(self._recording, network)

    def ghost(self, seed: int, network: Policy | None) -> Ghost:
        return Ghost(replayed(self._recording), self._name)


class ContinuedFlight(Challenge):
    """Fly on from a moment of a recorded flight, whose own continuation flies beside as a ghost."""

    bar = "flown_on"

    def __init__(self, flight_replay: FlightReplay, name: str) -> None:
        self._recording, self._step, self._name = flight_replay.record.recording, flight_replay.at, name
        self._moment = flight_replay.flight.env.snapshot()
        self.elsewhere = flown_elsewhere(self._recording)
        self.name = self._recording.mission or flight_replay.record.entry.course
        self.word()

    def word(self) -> None:
        self.title, self.opening = texts.FLY_ON, texts.FLY_ON_BEGIN
        self.line = texts.FLY_ON_LINE.format(seconds=self._step / 60)

    def flight(self, seed: int, network: Policy | None, spawn: str = "") -> Flight[Crew]:
        flight = begin(self._recording, network)
        self._put(flight)
        return flight

    def ghost(self, seed: int, network: Policy | None) -> Ghost:
        flight = replayed(self._recording)
        self._put(flight)
        return Ghost(flight, self._name)

    def _put(self, flight: Flight[Any]) -> None:
        flight.put(self._moment, self._recording, self._step)


class FlownMission(Challenge):
    """A mission of the campaign, beside a ghost: a recorded flight or, without one, the network.

    `following` makes the mission that comes next, where there is one and the way to it is known.
    """

    eases = True

    def __init__(
        self,
        mission: Mission,
        rival: Record | None = None,
        rival_name: Named = "",
        following: Callable[[], Challenge] | None = None,
    ) -> None:
        self.mission, self.name, self.elsewhere = mission, mission.name, mission.elsewhere
        self._following = following
        self._rival, self._rival_name = rival.recording if rival else None, rival_name
        self._landed = False
        self.word()

    def word(self) -> None:
        self.title = texts.MISSION
        self.line, self.opening = texts.MISSIONS[self.name]
        self.goal = texts.MISSION_GOAL.format(fuel=self.mission.gold[0], seconds=self.mission.gold[1])
        self.new_hint = texts.MISSION_NEXT if self._following else ""
        if self._landed:
            self.again_hint = texts.MISSION_AGAIN

    def flight(self, seed: int, network: Policy | None, spawn: str = "") -> Flight[Crew]:
        return begin(Recording(seed, "random", mission=self.name, easing=self.easing), network)

    def ghost(self, seed: int, network: Policy | None) -> Ghost | None:
        if self._rival:
            return Ghost(replayed(self._rival), self._rival_name)
        start = Recording(seed, "random", mission=self.name)
        return Ghost(Flight(start, Alone(network)), partial(who, network)) if network else None

    def following(self) -> Challenge | None:
        return self._following() if self._following else None

    def note_end(self, flight: Flight[Crew], credit: Credit) -> None:
        """Keep a landing as the ghost of the next try."""
        if flight.outcome is Outcome.LANDED and flight.share > 0:
            self._rival, self._rival_name, self._landed = flight.recording, lambda: texts.GHOST_BEFORE, True
            self.word()

    def medal(self, flight: Flight[Crew]) -> int:
        if flight.outcome is not Outcome.LANDED:
            return 0
        return self.mission.medal(float(flight.env.fuel[0]), float(flight.env.time[0]))

    def card(self, card: OutcomeCard, flight: Flight[Crew], credit: Credit) -> OutcomeCard:
        """Return the card with the medal beside the points, and what the next medal asks, or why there is none."""
        if not card.good:
            return replace(card, advice=_advice(flight.env) or card.advice)
        if not credit.counts and credit.bar == "assists":
            return card
        earned = texts.MISSION_TOGETHER if credit.together else texts.MEDALS[credit.medal]
        card = replace(card, score=texts.DIAL_JOIN.join(filter(None, (card.score, earned))), ring=credit.together)
        return replace(card, medal=credit.medal, reason=self._missing(flight)) if credit.counts else card

    def _missing(self, flight: Flight[Crew]) -> str:
        """Return what the next medal asks."""
        medal = self.medal(flight)
        if medal == 3:
            return texts.MEDAL_GOLD
        much = self.mission.too_much(medal + 1, float(flight.env.fuel[0]), float(flight.env.time[0]))
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
    return FlownMission(mission, record, name) if mission else Race(record, name)


def dated(record: Record) -> str:
    """Return a flight as a ghost is called, by its date."""
    return texts.RACE_RIVAL.format(when=time.strftime("%Y-%m-%d %H:%M", time.localtime(record.entry.when)))
