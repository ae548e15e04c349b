"""Captions of the chart of landings: what its curve means now, by rules on its recent past.

A caption stands below a number, the latest of the curve, and every rule asks that number: none speaks of a curve that
its latest number contradicts, and where no rule is sure there is no caption. While a hint is shown, none praises. The
words that a player reads belong to the game.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final, NamedTuple

import numpy as np

from ai.training.curves import RecentCurves

_MOST: Final = 0.5  # share of flights that are most of them
_NEARLY_ALL: Final = 0.97
_CHANGE: Final = 0.05  # of the share that lands, from which it rises or falls


class Caption(NamedTuple):
    """Caption: the name of its rule, and figures for its words."""

    name: str
    values: Mapping[str, float] = {}


class CaptionRule(NamedTuple):
    """Rule for one caption; `praises` if it says that all is well."""

    name: str
    holds: Callable[[RecentCurves], bool]
    praises: bool = False


def caption(run: RecentCurves, *, hinted: bool = False, shown: str = "") -> Caption | None:
    """Return the caption now, or None; `hinted` says whether a hint is shown with it.

    The rule whose caption is `shown` goes before the others as long as it holds, so that it can be read.
    """
    if not run.count:
        return None
    if np.isnan(run.now("success_rate")):
        return Caption("unknown")
    rules = sorted(RULES, key=lambda rule: rule.name != shown)
    found = next((rule for rule in rules if not (rule.praises and hinted) and rule.holds(run)), None)
    if found is None:
        return None
    highest = float(np.nanmax(run.history["success_rate"]))  # as the curve above the caption shows it
    shares = {"percent": run.now("success_rate"), "before": run.before("success_rate"), "best": highest}
    return Caption(found.name, {name: 100 * share for name, share in shares.items()})


def _gains(run: RecentCurves) -> tuple[float, float]:
    """Return how much the curve has risen over the last share of the run, and its latest number since before."""
    return run.gained("success_rate"), run.now("success_rate") - run.before("success_rate")


def _rises(run: RecentCurves) -> bool:
    """Whether the curve is well above what it was, and its latest number not as far below its highest since."""
    return min(_gains(run)) > _CHANGE and run.highest("success_rate") - run.now("success_rate") <= _CHANGE


def _steady(run: RecentCurves) -> bool:
    """Whether the curve is where it was, and its latest number not far below its highest since."""
    fallen = run.highest("success_rate") - run.now("success_rate")
    return max(*map(abs, _gains(run)), fallen) <= _CHANGE


def _most(column: str) -> Callable[[RecentCurves], bool]:
    return lambda run: run.now("success_rate") == 0.0 and run.now(column) >= _MOST


# The first that holds is the caption.
RULES: Final = (
    CaptionRule("collapsed", lambda run: run.now("success_rate") <= run.best() - 0.4),
    CaptionRule("crashes", _most("crashed")),
    CaptionRule("hovers", _most("timed_out")),
    CaptionRule("leaves", _most("out_of_bounds")),
    CaptionRule("none", lambda run: run.now("success_rate") == 0.0),
    CaptionRule(
        "high", lambda run: min(run.now("success_rate"), run.last("success_rate")) >= _NEARLY_ALL, praises=True
    ),
    CaptionRule("rises", _rises, praises=True),
    CaptionRule("falls", lambda run: max(_gains(run)) < -_CHANGE),
    CaptionRule("steady", _steady),
)
