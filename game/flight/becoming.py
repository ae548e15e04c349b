"""Who the player is becoming: how often they would land alone, by kind of start, after each of their flights.

A state-space model of learning (Smith et al. 2004, Dynamic analysis of learning in behavioral experiments, Journal
of Neuroscience 24): the log-odds of a landing take a small random step from each flight to the next, so that old
flights are forgotten; a flight shows a landing with that chance. The belief is kept as a histogram and updated exactly
(Kitagawa 1987, Non-Gaussian state-space modeling, JASA 82).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np

from ai.environment import Doubles
from game.core import texts
from game.flight.flight_file import Entry

KINDS: Final = ("plain", "ladder", "hills", "missions")  # keys of `texts.BECOMING_KINDS`
_MOST: Final = 300  # latest flights of a kind that are looked at: older ones are forgotten anyway
_DRIFT: Final = 0.12  # standard deviation of the step in log-odds from one flight to the next
_INTERVAL: Final = 0.8  # chance that the truth lies between an estimate's ends
_WIDEST: Final = 0.5  # of an interval that still says something
_FEWEST: Final = 5  # flights from which on it does

_ODDS: Final[Doubles] = np.linspace(-5.0, 5.0, 41)  # log-odds of a landing
_CHANCE: Final[Doubles] = 1.0 / (1.0 + np.exp(-_ODDS))
_EDGES: Final[Doubles] = np.concatenate([[0.0], 1.0 / (1.0 + np.exp(-(_ODDS[1:] + _ODDS[:-1]) / 2)), [1.0]])
_NEAR: Final[Doubles] = np.exp(-0.5 * ((_ODDS[:, None] - _ODDS) / _DRIFT) ** 2)
_STEP: Final[Doubles] = _NEAR / _NEAR.sum(axis=0)  # chances (n, n) to go from each value, a column, to every other


@dataclass(frozen=True)
class Estimate:
    """Estimate of how often a pilot would land alone, 0 to 1.

    Attributes:
        mean: expected share of landings.
        low, high: ends of the interval in which the truth lies with a chance of `_INTERVAL`.
        flights: flights that it is made from.

    """

    mean: float
    low: float
    high: float
    flights: int = 0

    @property
    def known(self) -> bool:
        """Whether there were enough flights to say anything."""
        return self.flights >= _FEWEST and self.high - self.low <= _WIDEST


class LandingAlone:
    """Belief in how often one pilot would land alone, from one kind of start; every share is as likely at first."""

    def __init__(self) -> None:
        density = _CHANCE * (1.0 - _CHANCE)  # of the log-odds, if all shares are as likely
        self._belief: Doubles = density / density.sum()
        self._flights = 0

    def add(self, *, landed: bool) -> None:
        """Let time pass until the next flight, and learn from it."""
        belief = (_STEP @ self._belief) * (_CHANCE if landed else 1.0 - _CHANCE)
        self._belief = belief / belief.sum()
        self._flights += 1

    @property
    def estimate(self) -> Estimate:
        """What is believed after the flights so far; the interval is the shortest that is wide enough."""
        up_to = np.concatenate([[0.0], np.cumsum(self._belief)])
        below = np.linspace(0.0, 1.0 - _INTERVAL, 41)
        lows, highs = np.interp(below, up_to, _EDGES), np.interp(below + _INTERVAL, up_to, _EDGES)
        shortest = int((highs - lows).argmin())
        return Estimate(float(self._belief @ _CHANCE), float(lows[shortest]), float(highs[shortest]), self._flights)


def kind_of(entry: Entry) -> str:
    """Return the kind of start of a flight, one of `KINDS`."""
    if entry.course:
        return "missions"
    return "hills" if entry.pads > 1 else "ladder" if entry.on_ladder else "plain"


def counts(entry: Entry) -> bool:
    """Whether a flight tells how often the player would land alone: they flew all of it, under the usual rules."""
    return entry.alone and not entry.practice


def curves(entries: Iterable[Entry]) -> dict[str, list[Estimate]]:
    """Return for each kind of start the estimate before any flight, and after each that tells something."""
    counted = [entry for entry in entries if counts(entry)]
    return {kind: _curve([entry for entry in counted if kind_of(entry) == kind][-_MOST:]) for kind in KINDS}


def _curve(flights: Iterable[Entry]) -> list[Estimate]:
    belief = LandingAlone()
    found = [belief.estimate]
    for entry in flights:
        belief.add(landed=entry.landed)
        found.append(belief.estimate)
    return found


def said(estimate: Estimate) -> str:
    """Return an estimate in words, with its uncertainty."""
    if not estimate.known:
        return texts.BECOMING_TOO_FEW.format(count=estimate.flights)
    low, mean, high = (round(10 * share) for share in (estimate.low, estimate.mean, estimate.high))
    if low == high:
        return texts.BECOMING_SURE.format(share=mean)
    return texts.BECOMING_ESTIMATE.format(share=mean, low=low, high=high)
