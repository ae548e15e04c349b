"""How often a pilot would land alone: a belief that every flight changes, whether a guardian watched over it or not.

A state-space model of learning (Smith et al. 2004, Dynamic analysis of learning in behavioral experiments, Journal
of Neuroscience 24): the log-odds of a landing alone take a small random step from each flight to the next, so that
old flights are forgotten; a flight alone shows a landing with that chance. The belief is kept as a histogram and
updated exactly (Kitagawa 1987, Non-Gaussian state-space modeling, JASA 82).

A flight with a guardian is evidence too: where it changed little, the pilot would more probably have landed alone. How
much more was measured on simulated pilots (`benchmarks/becoming.py`), in some of whose flights it changes more than in
those of others with the same skill; that is a second, fixed unknown of each pilot.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from ai.environment import Doubles

DRIFT: Final = 0.12  # standard deviation of the step in log-odds from one flight to the next
INTERVAL: Final = 0.8  # chance that the truth lies between an estimate's ends
WIDEST: Final = 0.5  # of an interval that still says something
FEWEST: Final = 5  # flights from which on it does
CALM_SECONDS: Final = 1.6  # that a guardian may have changed in a flight that is called calm
# For some assists of a guardian: log-odds of a calm landing = base + slope · log-odds of a landing alone + spread · a
# standard normal number that each pilot has. With a base of 1.74, one who lands half of their flights alone has 85 % of
# them calm when guarded; a slope near 1 says that skill shows as clearly there, and the spread that some pilots are
# changed more than others of the same skill. Measured with a guardian that went by a learnt critic. In a first trial it
# changed more than one by futures does, of careless, late, heavy and freezing hands 12, 8, 10 and 23 % of the decisions
# instead of 8, 3, 8 and 19: so the estimate may be a little high. `benchmarks/becoming.py --calibrate` measures anew.
ASSISTS: Final = (0.1, 0.2, 0.4, 0.6)
BASE: Final = (1.74, 1.74, 1.74, 1.6)
SLOPE: Final = (0.93, 0.9, 0.96, 0.86)
SPREAD: Final = (0.84, 1.09, 1.25, 1.15)

_ODDS: Final[Doubles] = np.linspace(-5.0, 5.0, 41)  # log-odds of a landing alone
_PRONE, _PRONE_WEIGHTS = np.polynomial.hermite_e.hermegauss(5)
_CHANCE: Final[Doubles] = 1.0 / (1.0 + np.exp(-_ODDS))
_EDGES: Final[Doubles] = np.concatenate([[0.0], 1.0 / (1.0 + np.exp(-(_ODDS[1:] + _ODDS[:-1]) / 2)), [1.0]])


@dataclass(frozen=True)
class Estimate:
    """Estimate of how often a pilot would land alone, 0 to 1.

    Attributes:
        mean: expected share of landings.
        low, high: ends of the interval in which the truth lies with a chance of `INTERVAL`.
        alone: flights alone that it is made from.
        helped: flights with a guardian that it is made from.

    """

    mean: float
    low: float
    high: float
    alone: int = 0
    helped: int = 0

    @property
    def known(self) -> bool:
        """Whether there were enough flights to say anything."""
        return self.alone + self.helped >= FEWEST and self.high - self.low <= WIDEST


class LandingAlone:
    """Belief in how often one pilot would land alone, from one kind of start; every share is as likely at first."""

    def __init__(self) -> None:
        density = _CHANCE * (1.0 - _CHANCE)  # of the log-odds, if all shares are as likely
        self._belief: Doubles = np.outer(density / density.sum(), _PRONE_WEIGHTS / _PRONE_WEIGHTS.sum())
        self.alone = self.helped = 0

    def add_alone(self, *, landed: bool) -> None:
        """Learn from a flight without help."""
        self._learn((_CHANCE if landed else 1.0 - _CHANCE)[:, None])
        self.alone += 1

    def add_helped(self, *, landed: bool, changed: float, assist: float) -> None:
        """Learn from a flight that a guardian by futures watched over from its beginning to its end.

        `changed` is for how many seconds something else was flown than the pilot asked for. A guardian at an assist
        beyond those measured says nothing of what would be without it, and is left out.
        """
        if not 0.0 < assist <= ASSISTS[-1]:
            return
        base, slope, spread = (float(np.interp(assist, ASSISTS, of)) for of in (BASE, SLOPE, SPREAD))
        calm = 1.0 / (1.0 + np.exp(-(base + slope * _ODDS[:, None] + spread * _PRONE)))
        self._learn(calm if landed and changed <= CALM_SECONDS else 1.0 - calm)
        self.helped += 1

    @property
    def estimate(self) -> Estimate:
        """What is believed after the flights so far; the interval is the shortest that is wide enough."""
        share = self._belief.sum(axis=1)
        up_to = np.concatenate([[0.0], np.cumsum(share)])
        below = np.linspace(0.0, 1.0 - INTERVAL, 41)
        lows, highs = np.interp(below, up_to, _EDGES), np.interp(below + INTERVAL, up_to, _EDGES)
        shortest = int((highs - lows).argmin())
        return Estimate(float(share @ _CHANCE), float(lows[shortest]), float(highs[shortest]), self.alone, self.helped)

    def _learn(self, likelihood: Doubles) -> None:
        """Let time pass until the next flight, and multiply by the likelihood of what it showed."""
        belief = (_STEP @ self._belief) * likelihood
        self._belief = belief / belief.sum()


def _random_step() -> Doubles:
    """Return the chances (n, n) to go from each value of the log-odds, a column, to every other."""
    chances = np.exp(-0.5 * ((_ODDS[:, None] - _ODDS) / DRIFT) ** 2)
    steps: Doubles = chances / chances.sum(axis=0)
    return steps


_STEP: Final = _random_step()
