"""Difficulty of a flight: changes of gravity, and assists that make it easier to fly."""

from __future__ import annotations

from typing import Final

from ai.flights.recording import Easing
from game.core import texts
from game.core.settings import Settings
from game.flight.flight import Flight

_NAMES: Final = ("toggle_thrust", "one_switch", "wider_pads", "untimed", "pace")  # assists in the order they are told
# Assists that change how the pilot's own hands are read, and nothing about the flight: it counts like any other.
_OWN_HANDS: Final = frozenset({"toggle_thrust"})


def eased(settings: Settings) -> Easing:
    """Return the easing that the player has chosen for the next flight."""
    return Easing(settings.wider_pads, settings.untimed)


class Difficulty:
    """Difficulty of one flight, from the settings; call `heed` before every step.

    Gravity can be chosen in free flights alone.

    Attributes:
        slowest: slowest pace so far.

    """

    def __init__(self, settings: Settings, flight: Flight, *, free: bool) -> None:
        self._settings, self._flight, self._free = settings, flight, free
        self._used: set[str] = set()
        self.slowest = 1.0

    def heed(self) -> None:
        """Apply the player's settings to the next step, and remember what they are."""
        if self._free:
            self._flight.set_gravity(self._settings.gravity)
        self._flight.steered = self._settings.one_switch
        self._used |= self._chosen
        self.slowest = min(self.slowest, self._settings.pace)

    @property
    def practice(self) -> bool:
        """Whether the flight is not to be ranked, or will not be after its next step, for its gravity is another."""
        return bool(self._flight.recording.gravity) or self._gravity != 1

    @property
    def words(self) -> str:
        """Sentence on what differs from normal, now or before; empty if nothing does."""
        words = [texts.PRACTICE] if self.practice else []
        if self._gravity != 1:
            words.append(texts.PRACTICE_GRAVITY.format(percent=round(100 * self._gravity)))
        return texts.DIAL_JOIN.join([*words, *([self.assists] if self.assists else [])])

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
    def assists(self) -> str:
        """The assists in words; empty without any."""
        words = [self._pace if name == "pace" else texts.ASSIST_WORDS[name] for name in self.used]
        return texts.ASSISTS_USED.format(assists=", ".join(words)) if words else ""

    @property
    def _gravity(self) -> float:
        """Share of normal gravity in the next step; after the flight, in the last."""
        recording = self._flight.recording
        if self._free and not self._flight.over:
            return self._settings.gravity
        return recording.gravity_at(len(recording.actions))

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
