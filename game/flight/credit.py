"""Who has the stick of a flight, who has flown it, what it counts for, and why it does not.

Header, corner, card, medal and logbook ask this one object, so that no two of them can say different things.
"""

from __future__ import annotations

from enum import Enum, auto
from typing import Protocol

from ai.lander.environment import Outcome
from game.core import texts
from game.flight.difficulty import Difficulty
from game.flight.flight import Flight, Hand
from game.flight.handicap import OWN
from game.flight.outcomes import landing_score


class Challenge(Protocol):
    """What a flight is flown as, as far as it decides what counts: see `game.play.challenge`."""

    @property
    def kept(self) -> bool:
        """Whether its flights are written down."""

    @property
    def bar(self) -> str:
        """Why its flights do not count as the person's own, a name of `texts.NOT_COUNTED`; empty if they may."""

    @property
    def alone(self) -> bool:
        """Whether nobody may help, or take the stick."""

    def medal(self, flight: Flight) -> int:
        """What a flight that is over has earned: 3 for gold, 2, 1, and 0 for nothing."""


class Stick(Enum):
    """Who has the stick."""

    PERSON = auto()
    BOTH = auto()  # the person, and a co-pilot who may step in
    NETWORK = auto()


class Credit:
    """Of one flight; `follow` once after every step of it.

    Args:
        flight: the flight.
        difficulty: what is eased in it.
        course: what it is flown as; None for a free flight.
        hands: what its keys pass through, a name of `game.flight.handicap.HANDS`.
        check: whether it is a check flight.

    """

    def __init__(
        self,
        flight: Flight,
        difficulty: Difficulty,
        course: Challenge | None = None,
        hands: str = OWN,
        *,
        check: bool = False,
    ) -> None:
        self._flight, self._difficulty, self._course, self._hands = flight, difficulty, course, hands
        self._check = check
        self._shared = False

    def follow(self) -> None:
        """Note the step just flown."""
        self._shared |= self._flight.shared

    # Who flies

    @property
    def stick(self) -> Stick:
        """Who has the stick now, or had it at the end."""
        flight = self._flight
        if flight.hand is Hand.NETWORK:
            return Stick.NETWORK
        return Stick.BOTH if flight.shared else Stick.PERSON

    @property
    def helped(self) -> bool:
        """Whether a co-pilot has shared the stick at any time, or is going to with the next step."""
        return self._shared or (self._flight.shared and not self._flight.over)

    @property
    def alone(self) -> bool:
        """Whether nobody may help: in a check flight, and where a course is flown so."""
        return self._check or (self._course is not None and self._course.alone)

    @property
    def header(self) -> str:
        """Say who flies, or, of a flight that is over, who has flown it."""
        flight, stick = self._flight, self.stick
        if flight.over:
            return who_flew(flight.share)
        words = {Stick.PERSON: texts.YOU_FLY, Stick.BOTH: texts.YOU_SHARE, Stick.NETWORK: texts.NETWORK_FLIES}[stick]
        if stick is Stick.BOTH and flight.copilot:
            assist = round(100 * flight.copilot.assist)
            return texts.DIAL_JOIN.join((words, texts.DIAL_ASSISTS[flight.copilot.mode].format(percent=assist)))
        if not self.alone:
            return words
        if not self._check:
            return texts.DIAL_JOIN.join((words, texts.WITHOUT_HELP))
        return texts.DIAL_JOIN.join((texts.CHECK_FLIGHT, texts.CHECK_ALONE if self.counts else texts.WITHOUT_HELP))

    # What it counts for

    @property
    def bar(self) -> str:
        """Why it does not count as the person's own, a name of `texts.NOT_COUNTED`; empty as long as it does."""
        flight = self._flight
        if self._course and self._course.bar:
            return self._course.bar
        if self._hands != OWN:
            return "hands"
        if self.helped:
            return "helped"
        if flight.share < 1.0 or flight.hand is Hand.NETWORK:
            return "handed_over"
        return "practice" if self._difficulty.practice else ""

    @property
    def counts(self) -> bool:
        """Whether it was flown by the person's own hands, as flights are, from start to end."""
        return not self.bar

    @property
    def notice(self) -> str:
        """Say why it does not count, and what is eased; empty if it counts, or is nothing that could."""
        if self._difficulty.words:
            return self._difficulty.words
        return texts.NOT_COUNTED[self.bar] if self.bar and (self._course is None or self._course.kept) else ""

    @property
    def medal(self) -> int:
        """What a flight that is over has earned: 3 for gold, 2, 1, 0 for none."""
        return self._course.medal(self._flight) if self._course and self.counts else 0

    def score(self, best: int) -> str:
        """Say what a flight that is over has come to; `best` is the score to beat, 0 for none."""
        if self._difficulty.practice:
            return self._difficulty.words
        points = landing_score(self._flight.env)
        beaten = self.counts and points > best > 0
        return (texts.SCORE_BEST if beaten else texts.SCORE).format(points=points) if points else ""

    def reason(self, reason: str) -> str:
        """Return what a card says below its title: `reason`, or why a landing does not count."""
        landed = self._flight.outcome is Outcome.LANDED
        return texts.NOT_COUNTED[self.bar] if landed and self.bar else reason

    @property
    def pace(self) -> float:
        """The slowest pace of time that any of it was flown at."""
        return self._difficulty.slowest


def who_flew(share: float) -> str:
    """Say who has flown a flight, given the person's share of it, 0 to 1."""
    return texts.YOU_FLEW if share == 1 else texts.NETWORK_FLEW if share == 0 else texts.BOTH_FLEW
