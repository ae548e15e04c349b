"""Credit for a flight: who has the stick, who flew, what made it easier, what it counts for, and why not.

Header, corner, card, medal and logbook ask this one object, so that no two of them can say different things.
"""

from __future__ import annotations

from typing import Final, Protocol

from ai.flights.recording import Easing
from ai.flights.verification import landing_score
from ai.lander.environment import Outcome
from ai.lander.missions import Mission
from game.core import texts
from game.core.settings import HELP, Settings
from game.flight.choosers import Crew
from game.flight.flight import Flight, StickHolder
from game.flight.networks import sentence, who
from game.flight.outcomes import OutcomeCard

# Assist of each word: a guardian looks so far ahead that it steps in at the last moment, or eight decisions before it.
ASSISTS: Final = dict(zip(HELP, (0.0, 0.04, 0.64), strict=True))
OWN: Final = 0.9  # share of the steps from which on a helped landing is the person's own
_EASINGS: Final = ("toggle_thrust", "one_switch", "wider_pads", "untimed", "pace")  # in the order they are named
# Assists that change how the pilot's own hands are read, and nothing about the flight: it counts like any other.
_OWN_HANDS: Final = frozenset({"toggle_thrust"})


class Rules(Protocol):
    """What a flight is flown as, as far as that decides what counts; see `game.scenes.play.challenge.Rules`."""

    kept: bool
    bar: str
    alone: bool
    mission: Mission | None


def eased(settings: Settings) -> Easing:
    """Return the easing that the player has chosen for the next flight."""
    return Easing(settings.wider_pads, settings.untimed)


class Credit:
    """Credit for one flight; call `prepare` before every step, and `follow` after it.

    Attributes:
        alone: whether the person must fly alone, as in some challenges.
        pace: slowest pace of time so far.

    """

    def __init__(self, flight: Flight[Crew], settings: Settings, rules: Rules) -> None:
        self._flight, self._settings, self._rules = flight, settings, rules
        self._used: set[str] = set()  # assists of the steps so far
        self._shared = self._handed_over = False
        self.alone, self.pace = rules.alone, 1.0

    def prepare(self) -> None:
        """Apply the player's settings to the next step, and remember what they are."""
        self._used |= self._chosen
        self.pace = min(self.pace, self._settings.pace)

    def follow(self) -> None:
        """Record who had the stick in the step just flown."""
        self._shared |= self._flight.chooser.shared
        self._handed_over |= self._flight.chooser.hand is StickHolder.NETWORK

    # Who flies

    @property
    def helped(self) -> bool:
        """Whether a co-pilot has shared the stick at any time, or will in the next step."""
        return self._shared or (self._flight.chooser.shared and not self._flight.over)

    @property
    def who(self) -> str:
        """Who flies when the person does not: the network, or their own pilot by its name."""
        return who(self._flight.chooser.network)

    @property
    def header(self) -> str:
        """Text that says who flies."""
        flight = self._flight
        if flight.chooser.hand is StickHolder.NETWORK:
            return sentence(texts.NETWORK_FLIES, self.who)
        if flight.chooser.shared and flight.chooser.copilot:
            assist = flight.chooser.copilot.assist
            return texts.YOU_SHARE[next(word for word in reversed(HELP) if assist >= ASSISTS[word])]
        return texts.JOINED.format(words=texts.YOU_FLY, more=texts.WITHOUT_HELP) if self.alone else texts.YOU_FLY

    # What made it easier

    @property
    def assists(self) -> str:
        """The assists in words, of the steps flown and, while the flight lasts, of the next one; empty without any."""
        percent = round(100 * (self.pace if self._flight.over else min(self.pace, self._settings.pace)))
        words = [texts.ASSIST_WORDS[name].format(percent=percent) for name in self._named]
        return texts.ASSISTS_USED.format(assists=", ".join(words)) if words else ""

    @property
    def _named(self) -> list[str]:
        used = self._used if self._flight.over else self._used | self._chosen
        return [name for name in _EASINGS if name in used]

    @property
    def _chosen(self) -> set[str]:
        settings, easing = self._settings, self._flight.recording.easing
        chosen = {
            "toggle_thrust": settings.toggle_thrust and not settings.one_switch,
            "one_switch": settings.one_switch,
            "wider_pads": easing.wider_pads,
            "untimed": easing.untimed,
            "pace": settings.pace != 1,
        }
        return {name for name, on in chosen.items() if on}

    # What it counts for

    @property
    def bar(self) -> str:
        """Reason why it does not count as the person's own, a key of `texts.NOT_COUNTED`; empty while it does."""
        if self._rules.bar:
            return self._rules.bar
        if not self.own:
            return "helped" if self.helped else "handed_over"
        return "" if _OWN_HANDS.issuperset(self._named) else "assists"

    @property
    def own(self) -> bool:
        """Whether it is the person's own: they had the stick all the way, and help has changed a tenth at most."""
        flight = self._flight
        handed_over = self._handed_over or flight.chooser.hand is StickHolder.NETWORK
        return not handed_over and flight.share >= (OWN if self._shared else 1.0)

    @property
    def barred(self) -> str:
        """The reason in a sentence, where there is one."""
        return texts.NOT_COUNTED[self.bar].format(who=self.who)

    @property
    def counts(self) -> bool:
        """Whether it is the person's own, without assists that set it apart."""
        return not self.bar

    @property
    def notice(self) -> str:
        """Text that says why it does not count, and what makes it easier; empty if it counts, or never could."""
        if self.assists:
            return self.assists
        if not self._rules.kept:
            return ""
        if self.bar:
            return self.barred
        return texts.HELP_IS_ON if self.helped and not self._flight.over else ""

    @property
    def medal(self) -> int:
        """Medal of a flight that is over: 3 for gold, 2, 1, 0 for none."""
        mission, env = self._rules.mission, self._flight.env
        if mission is None or not self.counts or self._flight.outcome is not Outcome.LANDED:
            return 0
        return mission.medal(float(env.fuel[0]), float(env.time[0]))

    def add_to(self, card: OutcomeCard) -> None:
        """Add to a landing's card what it has earned, what made it easier, and why it does not count."""
        points = landing_score(self._flight.env)
        card.score = texts.SCORE.format(count=points) if points else ""
        if card.good:
            card.reason, card.advice = self.barred if self.bar else card.reason, self.assists
