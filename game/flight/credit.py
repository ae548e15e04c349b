"""Credit for a flight: who has the stick, who flew, what the flight counts for, and why not.

Header, corner, card, medal and logbook ask this one object, so that no two of them can say different things.
"""

from __future__ import annotations

from enum import Enum, auto
from typing import Final, Protocol

from ai.flights.verification import landing_score
from ai.lander.environment import Outcome
from game.core import texts
from game.flight.difficulty import Difficulty
from game.flight.flight import Flight, StickHolder
from game.flight.handicap import OWN

TOGETHER: Final = ("helped", "handed_over")  # reasons not to count that a landing together has


class CreditRules(Protocol):
    """Challenge of a flight, as far as it decides what counts; implemented in `game.scenes.play.challenge`."""

    @property
    def kept(self) -> bool:
        """Whether its flights are recorded."""

    @property
    def bar(self) -> str:
        """Reason why its flights do not count as the person's own, a key of `texts.NOT_COUNTED`; empty if they may."""

    @property
    def alone(self) -> bool:
        """Whether the person must fly alone: no help and no handing over."""

    def medal(self, flight: Flight) -> int:
        """Return the medal of a flight that is over: 3 for gold, 2, 1, and 0 for none."""


class FlownBy(Enum):
    """Holder of the stick."""

    PERSON = auto()
    BOTH = auto()  # the person, with a co-pilot that may intervene
    NETWORK = auto()


class Credit:
    """Credit for one flight; call `follow` once after every step.

    Args:
        flight: the flight.
        difficulty: its changes of gravity, and its assists.
        challenge: the challenge it belongs to; None for a free flight.
        hands: handicap of its keys, a name of `game.flight.handicap.HANDS`.

    """

    def __init__(
        self,
        flight: Flight,
        difficulty: Difficulty,
        challenge: CreditRules | None = None,
        hands: str = OWN,
    ) -> None:
        self._flight, self._difficulty, self._challenge, self._hands = flight, difficulty, challenge, hands
        self._shared = False

    def follow(self) -> None:
        """Record whether the step just flown was shared."""
        self._shared |= self._flight.shared

    # Who flies

    @property
    def stick(self) -> FlownBy:
        """Present holder of the stick, or the last one after the flight."""
        flight = self._flight
        if flight.hand is StickHolder.NETWORK:
            return FlownBy.NETWORK
        return FlownBy.BOTH if flight.shared else FlownBy.PERSON

    @property
    def helped(self) -> bool:
        """Whether a co-pilot has shared the stick at any time, or will in the next step."""
        return self._shared or (self._flight.shared and not self._flight.over)

    @property
    def alone(self) -> bool:
        """Whether the person must fly alone, as in some challenges."""
        return self._challenge is not None and self._challenge.alone

    @property
    def header(self) -> str:
        """Text that says who flies or, after the flight, who flew."""
        flight, stick = self._flight, self.stick
        if flight.over:
            return who_flew(flight.share)
        words = texts.NETWORK_FLIES if stick is FlownBy.NETWORK else texts.YOU_FLY
        if stick is FlownBy.BOTH and flight.copilot:
            return texts.YOU_SHARE[flight.copilot.mode]
        if not self.alone:
            return words
        return texts.JOINED.format(words=words, more=texts.WITHOUT_HELP)

    # What it counts for

    @property
    def bar(self) -> str:
        """Reason why it does not count as the person's own, a key of `texts.NOT_COUNTED`; empty while it does."""
        flight = self._flight
        if self._challenge and self._challenge.bar:
            return self._challenge.bar
        if self._hands != OWN:
            return "hands"
        if self.helped and flight.share < 1.0:
            return "helped"
        if flight.share < 1.0 or flight.hand is StickHolder.NETWORK:
            return "handed_over"
        if self._difficulty.practice:
            return "practice"
        return "assists" if self._difficulty.apart else ""

    @property
    def counts(self) -> bool:
        """Whether the person flew all of it, without handicap, changed gravity or assists that set it apart.

        Help that stood by and changed nothing takes nothing away.
        """
        return not self.bar

    @property
    def together(self) -> bool:
        """Whether person and network have landed it together, which earns a ring in place of a medal."""
        return self._flight.outcome is Outcome.LANDED and self._flight.share > 0 and self.bar in TOGETHER

    @property
    def notice(self) -> str:
        """Text that says why it does not count, and what is changed; empty if it counts, or never could."""
        if self._difficulty.words:
            return self._difficulty.words
        if self._challenge is not None and not self._challenge.kept:
            return ""
        if self.bar:
            return texts.NOT_COUNTED[self.bar]
        return texts.HELP_IS_ON if self.helped and not self._flight.over else ""

    @property
    def medal(self) -> int:
        """Medal of a flight that is over: 3 for gold, 2, 1, 0 for none."""
        return self._challenge.medal(self._flight) if self._challenge and self.counts else 0

    def score(self, best: int) -> str:
        """Return the text for the score of a flight that is over; `best` is the score to beat, 0 for none."""
        if self._difficulty.practice:
            return texts.PRACTICE
        points = landing_score(self._flight.env)
        beaten = self.counts and points > best > 0
        return (texts.SCORE_BEST if beaten else texts.SCORE).format(count=points) if points else ""

    def reason(self, reason: str) -> str:
        """Return the text below a card's title: `reason`, or why a landing does not count."""
        landed = self._flight.outcome is Outcome.LANDED
        return texts.NOT_COUNTED[self.bar] if landed and self.bar else reason

    @property
    def pace(self) -> float:
        """Slowest pace of time during the flight."""
        return self._difficulty.slowest

    @property
    def assists(self) -> str:
        """The assists of the flight in words; empty without any."""
        return self._difficulty.assists


def who_flew(share: float) -> str:
    """Return the text that says who flew, given the person's share of the steps, 0 to 1."""
    return texts.YOU_FLEW if share == 1 else texts.NETWORK_FLEW if share == 0 else texts.BOTH_FLEW
