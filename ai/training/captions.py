"""Captions of a run's charts: what each curve means now, by rules on its recent past.

A caption stands below a number, the latest of its curve, and every rule asks that number: none speaks of a curve that
its latest number contradicts, and where no rule is sure there is no caption. They share the readings of the hints, and
never speak against one: while a hint is shown, no caption of a chart that it is about praises the curve. The words that
a player reads belong to the game.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final, NamedTuple

import numpy as np

from ai.agent.decision import in_points
from ai.training.curves import RecentCurves
from ai.training.hints import RULES, returns
from ai.training.history import PARTS

CHARTS: Final = ("success", "mean_return", "loss", "epsilon")
_ABOUT: Final = {rule.name: rule.about for rule in RULES}
_MOST: Final = 0.5  # share of flights that are most of them
_LANDS: Final = 0.8  # from which it is said to land
_NEARLY_ALL: Final = 0.97
_CHANGE: Final = 0.05  # of a share, from which it rises or falls
_RETURN_CHANGE: Final = 10.0  # points of reward
_LOSS_CHANGE: Final = 1.2  # times
_ROUNDED: Final = 0.5  # points of reward that are written as 0
_HOPE: Final = 60.0  # points of reward by which a mean value is too high to be chance
_SIGHT: Final = 0.96  # discount below which a value does not reach to the end of a flight
_HALF: Final = 0.5


class Caption(NamedTuple):
    """Caption of a chart: the name of its rule, and figures for its words."""

    name: str
    values: Mapping[str, float | str]


class CaptionRule(NamedTuple):
    """Rule for one caption of a chart; `praises` if it says that all is well."""

    name: str
    holds: Callable[[RecentCurves], bool]
    praises: bool = False
    values: Callable[[RecentCurves], Mapping[str, float | str]] = lambda _: {}


def caption(chart: str, run: RecentCurves, hint: str = "", shown: str = "") -> Caption | None:
    """Return the caption of a run's chart now, or None; `hint` is the name of the hint that is shown with it, if any.

    The rule whose caption is `shown` goes before the others as long as it holds, so that it can be read.
    """
    if not run.count:
        return None
    if np.isnan(run.now(chart)):
        return Caption("unknown", {})
    quiet = chart in _ABOUT.get(hint, ())
    rules = sorted(CAPTION_RULES[chart], key=lambda rule: rule.name != shown)
    found = next((rule for rule in rules if not (rule.praises and quiet) and rule.holds(run)), None)
    return Caption(found.name, found.values(run)) if found else None


def expected_value(run: RecentCurves) -> float:
    """Estimate the mean value, in points, that recent flights would bear out.

    On average over a flight, half of what it is paid on the way still lies ahead, and its end, which is discounted.
    """
    end = run.config.reward_weights.terminal * (2.0 * run.now("success") - 1.0)
    ahead = _HALF * (run.now("mean_return") + end)
    return _HALF * ahead if ahead < 0 else ahead


# Readings: those of a curve's latest number, and of what it was a while ago


def _hint(name: str) -> Callable[[RecentCurves], bool]:
    """Return the condition of a hint's rule."""
    return next(rule for rule in RULES if rule.name == name).holds


def _stands(run: RecentCurves) -> bool:
    """Whether it has learnt, and does not now."""
    return bool(np.isnan(run.history["loss"][-1]))


def _gains(run: RecentCurves, column: str) -> tuple[float, float]:
    """Return how much a curve has risen over the last share of the run, and its latest number since before."""
    return run.gained(column), run.now(column) - run.before(column)


def _learning(holds: Callable[[RecentCurves], bool]) -> Callable[[RecentCurves], bool]:
    """Return whether a condition on the loss holds, of a run that learns now: else the number is an old one."""
    return lambda run: not _stands(run) and holds(run)


def _rises(column: str, by: float) -> Callable[[RecentCurves], bool]:
    """Return whether a curve is well above what it was, and its latest number not as far below its highest since."""
    return lambda run: min(_gains(run, column)) > by and run.highest(column) - run.now(column) <= by


def _falls(column: str, by: float) -> Callable[[RecentCurves], bool]:
    return lambda run: max(_gains(run, column)) < -by


def _loss_times(run: RecentCurves) -> float:
    """Return how many times its size the loss has become over the last share of the run, and in its latest number."""
    before, gained = run.before("loss"), run.gained("loss")
    if not before > 0:
        return float("nan")
    times, latest = 1.0 + gained / before, run.now("loss") / before
    return min(times, latest) if times > 1.0 else max(times, latest)


def _below_peak(run: RecentCurves) -> bool:
    """Whether the loss, larger than before, has fallen from its highest since."""
    lately = max(run.now("loss"), run.last("loss"))
    return _loss_times(run) > _LOSS_CHANGE and lately * _LOSS_CHANGE < run.highest("loss")


def _most(column: str) -> Callable[[RecentCurves], bool]:
    return lambda run: run.now("success") == 0.0 and run.now(column) >= _MOST


def _percent(run: RecentCurves) -> Mapping[str, float]:
    highest = float(np.nanmax(run.history["success"]))  # as the curve above the caption shows it
    return {"percent": 100 * run.now("success"), "before": 100 * run.before("success"), "best": 100 * highest}


def _split(run: RecentCurves) -> Mapping[str, float]:
    """Return what the end of a flight brings on average, and what came on the way."""
    end = float(run.history.parts[-1, PARTS.index("terminal")])
    return {"end": end, "way": run.now("mean_return") - end}


def _lands_for_little(run: RecentCurves) -> bool:
    """Whether it lands, and what is paid on the way takes most of that away."""
    parts = run.history.parts[-1]
    known = abs(float(parts.sum()) - run.now("mean_return")) < _ROUNDED
    return known and run.now("success") >= _LANDS and run.now("mean_return") < _HALF * _split(run)["end"]


def _random(run: RecentCurves) -> Mapping[str, float]:
    return {"percent": 100 * run.now("epsilon")}


def _hopes(run: RecentCurves) -> bool:
    hoped = float(in_points(np.array(run.now("mean_q")), run.history.reward_scale))
    return run.config.discount >= _SIGHT and hoped > expected_value(run) + _HOPE


def _runs_away(run: RecentCurves) -> bool:
    least, most = returns(run.config)
    return _hint("q_runs_away")(run) and not 2 * least <= run.now("mean_q") <= 2 * most


# The first that holds is the caption.
CAPTION_RULES: Final[Mapping[str, tuple[CaptionRule, ...]]] = {
    "success": (
        CaptionRule("collapsed", lambda run: run.now("success") <= run.best() - 0.4, values=_percent),
        CaptionRule("crashes", _most("crashed")),
        CaptionRule("hovers", _most("timed_out")),
        CaptionRule("leaves", _most("out_of_bounds")),
        CaptionRule("none", lambda run: run.now("success") == 0.0),
        CaptionRule("high", lambda run: min(run.now("success"), run.last("success")) >= _NEARLY_ALL, True),
        CaptionRule("rises", _rises("success", _CHANGE), True, _percent),
        CaptionRule("falls", _falls("success", _CHANGE), values=_percent),
        CaptionRule("steady", lambda run: max(map(abs, _gains(run, "success"))) <= _CHANGE, values=_percent),
    ),
    "mean_return": (
        CaptionRule("runs_away", _runs_away),
        CaptionRule("hopes", _hopes),
        CaptionRule("nothing", lambda run: abs(run.now("mean_return")) < _ROUNDED and not _lands_for_little(run)),
        CaptionRule("little", _lands_for_little, values=_split),
        CaptionRule("rises", _rises("mean_return", _RETURN_CHANGE), True),
        CaptionRule("falls", _falls("mean_return", _RETURN_CHANGE)),
    ),
    "loss": (
        CaptionRule("waits", _stands),
        CaptionRule("explodes", _learning(_hint("loss_explodes"))),
        CaptionRule("peaked", _learning(_below_peak)),
        CaptionRule(
            "news",
            _learning(lambda run: _loss_times(run) > _LOSS_CHANGE and _rises("success", _CHANGE)(run)),
            True,
        ),
        CaptionRule("rises", _learning(lambda run: _loss_times(run) > _LOSS_CHANGE)),
        CaptionRule("falls", _learning(lambda run: _loss_times(run) < 1 / _LOSS_CHANGE), True),
        CaptionRule(
            "steady",
            _learning(lambda run: 1 / _LOSS_CHANGE <= run.now("loss") / run.before("loss") <= _LOSS_CHANGE),
        ),
    ),
    "epsilon": (
        CaptionRule("all", lambda run: run.now("epsilon") == 1.0),
        CaptionRule("none", lambda run: run.now("epsilon") == 0.0),
        CaptionRule("falls", lambda run: run.now("epsilon") < run.history["epsilon"][-8:].max(), values=_random),
        CaptionRule("spread", lambda run: run.config.epsilon_spread > 0 and run.config.num_envs > 1, values=_random),
        CaptionRule("steady", lambda _: True, values=_random),
    ),
}
