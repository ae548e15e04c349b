"""What can be flown other than free flights: against a rival, against a ghost of one's own, from another's midst."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import date
from typing import Final

from ai.lander.environment import Cause, LanderEnv, Outcome
from ai.lander.missions import Mission
from game.core import texts
from game.core.settings import Settings
from game.drawing.canvas import Canvas
from game.flight.credit import Credit
from game.flight.flight import Flight, Recording
from game.flight.flight_file import Record
from game.flight.networks import Flyer
from game.flight.outcomes import Card
from game.flight.replay import Rerun, Tape
from game.input.controls import Controls
from game.play.ghost import Ghost
from game.world.camera import Clear, View

_AFTER_OUTAGE: Final = 2.0  # seconds in which the speed of a fall without an engine can't be braked


@dataclass(frozen=True)
class Moment:
    """What a course needs to know of the moment in which it draws over the world.

    Attributes:
        alpha: how much of the way between two steps has passed.
        controls: in whose words keys are named.
        clear: where on the screen nothing else is said.
        waiting: whether the craft hangs until something is touched.
        stuck: whether it does so until something held is let go of first.

    """

    alpha: float
    controls: Controls
    clear: Clear
    waiting: bool = False
    stuck: bool = False


class Course:
    """A start and what is asked there; it is flown as it is, whatever the player has chosen for free flights.

    Attributes:
        name: of a mission, as the logbook has it; empty for all else.
        fixed: whether there is but the one start.
        kept: whether its flights are written down.
        bar: why its flights do not count as the person's own, a name of `texts.NOT_COUNTED`; empty if they may.
        alone: whether nobody may help, or take the stick.
        next_hint: what the key for what comes next does; empty where nothing does.
        title, line: what is being flown, for the corner.
        goal: what is asked of the flight, for the corner as well.
        opening: what to say while the craft hangs and waits; empty to leave the middle free.
        through: whether it makes way for free flights.

    """

    name = ""
    fixed = True
    kept = True
    bar = ""
    alone = False
    through = False
    next_hint = ""
    title = line = goal = opening = ""

    def flight(self, seed: int, network: Flyer | None) -> Flight:
        """Begin it; `network` is whom to hand over to."""
        return Flight(seed, network)

    def ghost(self, seed: int, network: Flyer | None) -> Ghost | None:  # noqa: ARG002
        """Begin what flies beside it."""
        return None

    def card(self, card: Card, flight: Flight, credit: Credit) -> Card:  # noqa: ARG002
        """Add to the card of a flight that is over."""
        return card

    def follow(self, flight: Flight) -> str:  # noqa: ARG002
        """See what a step of the flight has brought; return the sound that tells of it, empty for none."""
        return ""

    def again(self) -> bool:
        """Whether a flight that is over begins again by itself, without a card."""
        return False

    @property
    def waits(self) -> bool:
        """Whether the craft hangs until the pilot touches something; or else only until all is let go of."""
        return True

    def skip(self) -> None:
        """Go on with what comes next, if anything does."""

    def leave(self) -> None:
        """Make way for free flights."""

    def remember(self, settings: Settings) -> bool:  # noqa: ARG002
        """Note in the settings what the pilot has come to; whether there was anything to be noted."""
        return False

    def draw(self, canvas: Canvas, view: View, flight: Flight, scene: Moment) -> None:
        """Draw what belongs to it over the world."""

    def medal(self, flight: Flight) -> int:  # noqa: ARG002
        """What a flight that is over earns if it counts: 3 for gold, 2, 1, 0 for none."""
        return 0


class Duel(Course):
    """Start after start against a rival."""

    fixed = False
    title = texts.DUEL

    def __init__(self, rival: Flyer, name: str) -> None:
        self._rival, self._name = rival, name
        self.line = texts.DUEL_RIVAL.format(name=name)
        self.opening = texts.DUEL_BEGIN.format(name=name)

    def ghost(self, seed: int, network: Flyer | None) -> Ghost:  # noqa: ARG002
        """Let the rival begin there too."""
        return Ghost(Flight(seed, self._rival), self._name)


class Race(Course):
    """A recorded flight's own start, against its ghost."""

    title = texts.RACE

    def __init__(self, record: Record, name: str) -> None:
        self._record, self._name = record, name
        self.line = texts.DUEL_RIVAL.format(name=name)
        self.opening = texts.DUEL_BEGIN.format(name=name)

    def flight(self, seed: int, network: Flyer | None) -> Flight:
        """Begin where that flight began, under its gravity."""
        recording = self._record.recording
        flight = _as_begun(recording, seed, network)
        flight.set_gravity(recording.gravity_at(0))
        return flight

    def ghost(self, seed: int, network: Flyer | None) -> Ghost:  # noqa: ARG002
        """Let the recorded flight begin again."""
        return Ghost(Rerun(self._record.recording), self._name)


class FlyOn(Course):
    """From a moment of a recorded flight, its first part kept as it was flown; that flight goes on as a ghost."""

    bar = "flown_on"
    title = texts.FLY_ON
    opening = texts.FLY_ON_BEGIN

    def __init__(self, tape: Tape, name: str) -> None:
        self._recording, self._step, self._name = tape.record.recording, tape.at, name
        self._moment = tape.flight.env.snapshot()
        self.name = tape.record.recording.mission or tape.record.entry.course
        self.line = texts.FLY_ON_LINE.format(seconds=tape.at / 60)

    def flight(self, seed: int, network: Flyer | None) -> Flight:
        """Begin in its midst."""
        flight = _as_begun(self._recording, seed, network)
        flight.put(self._moment, self._recording, self._step)
        return flight

    def ghost(self, seed: int, network: Flyer | None) -> Ghost:  # noqa: ARG002
        """Let that flight go on as it did."""
        rerun = Rerun(self._recording)
        rerun.put(self._moment, self._recording, self._step)
        return Ghost(rerun, self._name)


def _as_begun(recording: Recording, seed: int, network: Flyer | None) -> Flight:
    """Begin where a recorded flight began."""
    return Flight(seed, network, recording.spawn, pads=recording.pads, mission=recording.mission)


class Flown(Course):
    """A mission of the campaign. What flies beside it is a recorded flight, or, without one, the network."""

    title = texts.MISSION

    def __init__(self, mission: Mission, rival: Record | None = None, rival_name: str = texts.MISSION_RIVAL) -> None:
        self.mission, self.name = mission, mission.name
        self._rival, self._rival_name = rival, rival_name
        self.line, self.opening = texts.MISSIONS[mission.name]
        self.goal = texts.MISSION_GOAL.format(fuel=mission.gold[0], seconds=mission.gold[1])

    def flight(self, seed: int, network: Flyer | None) -> Flight:
        """Begin it."""
        return Flight(seed, network, mission=self.name)

    def ghost(self, seed: int, network: Flyer | None) -> Ghost | None:
        """Let the rival fly it too."""
        if self._rival:
            return Ghost(Rerun(self._rival.recording), self._rival_name)
        return Ghost(Flight(seed, network, mission=self.name), self._rival_name) if network else None

    def medal(self, flight: Flight) -> int:
        """Return what the flight earns if it counts."""
        if flight.outcome is not Outcome.LANDED:
            return 0
        return self.mission.medal(float(flight.env.fuel[0]), float(flight.env.time[0]))

    def card(self, card: Card, flight: Flight, credit: Credit) -> Card:
        """Name the medal in place of points, and say what was missing for the next; or why there is none."""
        if not card.good:
            return replace(card, advice=_advice(flight.env) or card.advice)
        if not credit.counts:
            return replace(card, score=card.score if credit.bar == "practice" else texts.MEDALS[0])
        medal = credit.medal
        return replace(card, score=texts.MEDALS[medal], medal=medal, reason=self._missing(medal, flight))

    def _missing(self, medal: int, flight: Flight) -> str:
        if medal == 3:
            return texts.MEDAL_GOLD
        fuel, seconds = self.mission.too_much(medal + 1, float(flight.env.fuel[0]), float(flight.env.time[0]))
        words = [text.format(much) for much, text in
                 ((fuel, texts.MEDAL_LESS_FUEL), (seconds, texts.MEDAL_LESS_TIME)) if much > 0]  # fmt: skip
        return texts.MEDAL_NEXT.format(medal=texts.MEDALS[medal + 1].capitalize(), less=texts.AND.join(words))


def _advice(env: LanderEnv) -> str:
    """Say what to do better about what is harder there than on the moon; nothing if that was not at fault."""
    conditions, time = env.conditions, float(env.time[0])
    if env.fuel[0] >= conditions.tank:
        return texts.ADVICE_TANK
    if conditions.outage[0] <= time < conditions.outage[1] + _AFTER_OUTAGE:
        return texts.ADVICE_OUTAGE
    if conditions.moves and env.cause[0] in (Cause.SLIDING, Cause.TERRAIN):
        return texts.ADVICE_MOVING
    return texts.ADVICE_WIND if conditions.pushes and env.cause[0] == Cause.TERRAIN else ""


class Daily(Course):
    """The start that everybody has on this day, without a network to help."""

    name = "daily"
    alone = True
    title = texts.DAILY

    def __init__(self, day: date) -> None:
        self.seed = day.toordinal()
        self.line, self.opening = f"{day:%Y-%m-%d}", texts.DAILY_BEGIN

    def flight(self, seed: int, network: Flyer | None) -> Flight:  # noqa: ARG002
        """Begin it, on three pads among hills."""
        return Flight(self.seed, pads=3)
