"""Assists of a flight: what makes it easier to fly, followed while it is flown and told in one line."""

from __future__ import annotations

from typing import Final

from ai.flights.recording import Easing
from game.core import texts
from game.core.settings import Settings
from game.flight.flight import Flight

_NAMES: Final = ("toggle_thrust", "one_switch", "wider_pads", "untimed", "pace")  # in the order they are told
# Assists that change how the pilot's own hands are read, and nothing about the flight: it counts like any other.
_OWN_HANDS: Final = frozenset({"toggle_thrust"})


def eased(settings: Settings) -> Easing:
    """Return the easing that the player has chosen for the next flight."""
    return Easing(settings.wider_pads, settings.untimed)


def sets_apart(settings: Settings) -> bool:
    """Return whether the player's choices set their next flight apart from those flown without assists."""
    return settings.one_switch or settings.wider_pads or settings.untimed or settings.pace != 1


class Assists:
    """Assists of one flight; call `heed` before every step.

    Attributes:
        slowest: slowest pace so far.

    """

    def __init__(self, settings: Settings, flight: Flight) -> None:
        self._settings, self._flight = settings, flight
        self._used: set[str] = set()
        self.slowest = 1.0

    def heed(self) -> None:
        """Apply the player's settings to the next step, and remember what they are."""
        self._flight.steered = self._settings.one_switch
        self._used |= self._chosen
        self.slowest = min(self.slowest, self._settings.pace)

    @property
    def used(self) -> list[str]:
        """Names of the assists of the steps flown and, while the flight lasts, of the next step."""
        used = self._used if self._flight.over else self._used | self._chosen
        return [name for name in _NAMES if name in used]

    @property
    def apart(self) -> bool:
        """Whether the flight is kept apart from those flown without assists."""
        return not _OWN_HANDS.issuperset(self.used)

    @property
    def line(self) -> str:
        """The assists in words; empty without any."""
        words = [self._pace if name == "pace" else texts.ASSIST_WORDS[name] for name in self.used]
        return texts.ASSISTS_USED.format(assists=", ".join(words)) if words else ""

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

    @property
    def _pace(self) -> str:
        """The slowest pace in words."""
        slowest = self.slowest if self._flight.over else min(self.slowest, self._settings.pace)
        percent = round(100 * slowest)
        return texts.ASSIST_HALF_SPEED if percent == 50 else texts.ASSIST_WORDS["pace"].format(percent=percent)
