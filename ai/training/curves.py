"""Curves of a training run, as hints and verdicts look at them."""

from __future__ import annotations

from operator import attrgetter
from typing import Final

import numpy as np

from ai.agent.schedule import learning_rate
from ai.environment import Doubles
from ai.training.config import Config
from ai.training.history import History, SettingChange

LANDS: Final = 0.8  # share of a hundred flights from which a run counts as one that lands
ENOUGH: Final = 150_000  # decisions after which the modern preset lands nearly always
FALLEN: Final = 0.3  # share of flights fewer than before a change, from which that is to blame
COLLAPSE: Final = 3  # times a hundred flights for which a share must have been there, and must have gone
RATES: Final = ("learning_rate", "final_learning_rate")
_FLIGHTS: Final = 1_000  # flights after which a run with few landers should have learned something
_ENDS: Final = {"crashes": "crashed", "hovers": "timed_out", "leaves": "out_of_bounds"}  # columns, by captions
_MOST: Final = 0.5  # share of flights that are most of them
# Rates above which no step is sensible, by the optimizer. Modern still learns at 0.03, not at 0.1; classic's values
# have diverged at 0.1.
TOO_HIGH: Final = {"adam": 0.05, "momentum": 0.01, "sgd": 0.05}


class Curves:
    """Curves of a run, and the configuration it was flown with, with the questions about them that several ask."""

    def __init__(self, history: History, config: Config) -> None:
        self.history, self.config = history, config

    @property
    def turns(self) -> float:
        """Decisions of each lander so far."""
        return float(self.history["decisions"][-1]) / self.config.num_envs if len(self.history) else 0.0

    def landed(self, row: int = -1) -> float:
        """Return the share of the last hundred flights that landed, at a row; 0 before any has ended."""
        return float(np.nan_to_num(self.history["success_rate"][row])) if len(self.history) else 0.0

    def landed_after(self) -> float:
        """Decisions of each lander until a hundred flights landed as `LANDS` asks; infinite if they never did."""
        reached = np.flatnonzero(self.history["success_rate"] >= LANDS)
        return float(self.history["decisions"][reached[0]]) / self.config.num_envs if len(reached) else float("inf")

    def last(self, name: str, points: int = 8) -> float:
        """Median of a column over the last points that are finite; NaN without any."""
        return median(self.history[name][-points:])

    def is_late(self) -> bool:
        """Whether a run should be landing by now."""
        return self.last("decisions", 1) >= ENOUGH or self.last("episodes", 1) >= _FLIGHTS

    def by_hundreds(self) -> Doubles:
        """Return the share that landed of each successive hundred flights of this stage: none counts twice."""
        history = self.history
        here = (history["stage"] == history["stage"][-1]) & np.isfinite(history["success_rate"])
        episodes, success = history["episodes"][here], history["success_rate"][here]
        if not len(episodes):
            return np.empty(0)
        ends = np.arange(episodes[-1], max(episodes[0], 100.0) - 1.0, -100.0)[::-1]
        shares: Doubles = success[np.searchsorted(episodes, ends)]
        return shares

    def best(self) -> float:
        """Return the largest share that landed, in this stage, over so many flights that it is not chance."""
        shares = self.by_hundreds()
        if len(shares) < COLLAPSE:
            return 0.0
        return float(np.lib.stride_tricks.sliding_window_view(shares, COLLAPSE).min(axis=1).max())

    def blamed(self) -> list[SettingChange]:
        """Return the last change by hand since which far fewer flights land, and those of the same second.

        Empty if there is none, if all is as it was, or if starts have become harder since.
        """
        history, shares = self.history, self.by_hundreds()[-COLLAPSE:]
        if len(shares) < COLLAPSE:
            return []
        in_force = [each for each in history.setting_changes if self._in_force(each)]
        for change in reversed(in_force):
            row = history.row_at(change.decisions)
            before = median(history["success_rate"][max(row - 7, 0) : row + 1])
            same_starts = history["stage"][row] == history["stage"][-1]
            if same_starts and shares.max() <= before - FALLEN:
                return [each for each in in_force if abs(each.seconds - change.seconds) < 1.0]
        return []

    def since_change(self) -> float:
        """Return how many flights have ended since a setting was last changed; infinite if never."""
        history, changes = self.history, self.history.setting_changes
        if not changes:
            return float("inf")
        return float(history["episodes"][-1] - history["episodes"][history.row_at(changes[-1].decisions)])

    def _in_force(self, change: SettingChange) -> bool:
        """Whether a setting is still as this change has made it."""
        try:
            return bool(attrgetter(change.name)(self.config) == change.after)
        except AttributeError:  # a way back, or what a file says
            return False


def rate_too_high(config: Config, decisions: int) -> bool:
    """Whether the learning rate after so many decisions is one at which no step is sensible."""
    return learning_rate(config, decisions) > TOO_HIGH[config.optimizer]


def caption(history: History) -> str:
    """Return why no flight lands, the name of a text below the chart of landings; empty while some land."""
    landed = _finite(history["success_rate"])[-1:]
    if not len(landed):
        return "unknown" if len(history) else ""
    if landed[0] > 0:
        return ""
    return next((name for name, column in _ENDS.items() if history[column][-1] >= _MOST), "none")


def _finite(values: Doubles) -> Doubles:
    return values[np.isfinite(values)]


def median(values: Doubles) -> float:
    """Return the median of the finite values; NaN without any."""
    values = _finite(values)
    return float(np.median(values)) if len(values) else float("nan")
