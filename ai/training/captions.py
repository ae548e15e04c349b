"""Captions of a run's charts: what each curve means now, by rules on its recent past.

They share the readings of the hints, and never speak against one: while a hint is shown, no caption of a chart that
it is about praises the curve. The words that a player reads belong to the game.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final, NamedTuple

import numpy as np

from ai.common.decision import in_points
from ai.lander.spawns import CURRICULA
from ai.training.hints import RULES, RecentCurves

CHARTS: Final = ("success", "mean_return", "loss", "mean_q", "epsilon", "stage")
# Charts that a hint is about, by its name.
ABOUT: Final[Mapping[str, tuple[str, ...]]] = {
    "rate_too_high": ("success", "mean_return", "loss", "mean_q"),
    "damaged": ("success", "mean_return", "loss", "mean_q"),
    "loss_explodes": ("loss",),
    "q_runs_away": ("mean_q", "loss"),
    "dead_units": ("success", "mean_return", "loss"),
    "collapsed": ("success", "mean_return"),
    "target_stands": ("success", "mean_return", "mean_q", "loss"),
    "short_sight": ("success", "mean_return"),
    "no_guide": ("success", "mean_return"),
    "crashes": ("success", "mean_return"),
    "hovers": ("success", "mean_return"),
    "small_memory": ("success", "mean_return", "loss"),
    "overfed": ("success", "mean_return", "loss"),
    "random": ("epsilon", "success"),
    "clipped": ("loss",),
    "plateau": ("success", "mean_return"),
}
_MOST: Final = 0.5  # share of flights that are most of them
_CHANGE: Final = 0.05  # of a share, from which it rises or falls
_RETURN_CHANGE: Final = 10.0  # points of reward
_Q_CHANGE: Final = 4.0
_LOSS_CHANGE: Final = 1.2  # times
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


def captions(run: RecentCurves, hint: str = "") -> dict[str, Caption]:
    """Return the caption of every chart of a run; `hint` is the name of the hint that is shown with them, if any."""
    if not run.count:
        return {}
    hushed = ABOUT.get(hint, ())
    found = {}
    for chart, rules in CAPTION_RULES.items():
        rule = next(rule for rule in rules if not (rule.praises and chart in hushed) and rule.holds(run))
        found[chart] = Caption(rule.name, rule.values(run))
    return found


def expected_value(run: RecentCurves) -> float:
    """Estimate the mean value, in points, that recent flights would bear out.

    On average over a flight, half of what it is paid on the way still lies ahead, and its end, which is discounted.
    """
    end = run.config.reward_weights.terminal * (2.0 * run.last("success") - 1.0)
    ahead = _HALF * (run.last("mean_return") + end)
    return _HALF * ahead if ahead < 0 else ahead


def _hint(name: str) -> Callable[[RecentCurves], bool]:
    """Return the condition of a hint's rule."""
    return next(rule for rule in RULES if rule.name == name).holds


def _unknown(column: str) -> Callable[[RecentCurves], bool]:
    return lambda run: bool(np.isnan(run.last(column)))


def _points(run: RecentCurves) -> float:
    return float(in_points(np.array(run.last("mean_q")), run.history.reward_scale))


def _stages(run: RecentCurves) -> dict[str, float]:
    return {"stage": run.last("stage", 1), "last": _last_stage(run)}


def _last_stage(run: RecentCurves) -> float:
    return float(len(CURRICULA[run.config.spawn].stages) - 1)


def _q_gained(run: RecentCurves) -> float:
    return float(in_points(np.array(run.gained("mean_q")), run.history.reward_scale))


def _loss_times(run: RecentCurves) -> float:
    """Return how many times its size the loss has become over the last share of the run."""
    now, gained = run.last("loss"), run.gained("loss")
    return now / (now - gained) if now > gained else float("inf")


def _none_lands(run: RecentCurves) -> bool:
    return run.last("success") < 0.02


def _most(column: str) -> Callable[[RecentCurves], bool]:
    return lambda run: _none_lands(run) and run.last(column) >= _MOST


def _percent(run: RecentCurves) -> Mapping[str, float]:
    gained = run.gained("success")
    now = run.last("success")
    return {"percent": 100 * now, "before": 100 * min(max(now - gained, 0.0), 1.0), "best": 100 * run.best()}


def _paid(run: RecentCurves) -> Mapping[str, float]:
    return {"points": abs(run.last("mean_return")), "terminal": abs(run.config.reward_weights.terminal)}


def _random(run: RecentCurves) -> Mapping[str, float]:
    return {"percent": 100 * run.last("epsilon", 1)}


def _hopes(run: RecentCurves) -> bool:
    return run.config.discount >= _SIGHT and _points(run) > expected_value(run) + _HOPE


def _always(_: RecentCurves) -> bool:
    return True


# The first that holds is the caption; the last of each chart always does.
CAPTION_RULES: Final[Mapping[str, tuple[CaptionRule, ...]]] = {
    "success": (
        CaptionRule("unknown", _unknown("success")),
        CaptionRule("collapsed", _hint("collapsed"), values=_percent),
        CaptionRule("crashes", _most("crashed")),
        CaptionRule("hovers", _most("timed_out")),
        CaptionRule("leaves", _most("out_of_bounds")),
        CaptionRule("none", _none_lands),
        CaptionRule("rises", lambda run: run.gained("success") > _CHANGE, True, _percent),
        CaptionRule("falls", lambda run: run.gained("success") < -_CHANGE, values=_percent),
        CaptionRule("high", lambda run: run.last("success") >= 0.9, True),
        CaptionRule("steady", _always, values=_percent),
    ),
    "mean_return": (
        CaptionRule("unknown", _unknown("mean_return")),
        CaptionRule("rises", lambda run: run.gained("mean_return") > _RETURN_CHANGE, True, _paid),
        CaptionRule("falls", lambda run: run.gained("mean_return") < -_RETURN_CHANGE, values=_paid),
        CaptionRule("costs", lambda run: run.last("mean_return") < 0, values=_paid),
        CaptionRule("earns", _always, values=_paid),
    ),
    "loss": (
        CaptionRule("unknown", _unknown("loss")),
        CaptionRule("explodes", _hint("loss_explodes")),
        CaptionRule("news", lambda run: _loss_times(run) > _LOSS_CHANGE and run.gained("success") > _CHANGE, True),
        CaptionRule("rises", lambda run: _loss_times(run) > _LOSS_CHANGE),
        CaptionRule("falls", lambda run: _loss_times(run) < 1 / _LOSS_CHANGE, True),
        CaptionRule("steady", _always),
    ),
    "mean_q": (
        CaptionRule("unknown", _unknown("mean_q")),
        CaptionRule("runs_away", _hint("q_runs_away")),
        CaptionRule("hopes", _hopes),
        CaptionRule("rises", lambda run: _q_gained(run) > _Q_CHANGE and run.gained("success") > _CHANGE, True),
        CaptionRule("crashes", lambda run: _q_gained(run) < -_Q_CHANGE and run.last("crashed") >= _MOST),
        CaptionRule("steady", _always),
    ),
    "epsilon": (
        CaptionRule("all", lambda run: run.last("epsilon", 1) > 0.99),
        CaptionRule("none", lambda run: run.last("epsilon", 1) == 0),
        CaptionRule("falls", lambda run: run.gained("epsilon") < -0.01, values=_random),
        CaptionRule("spread", lambda run: run.config.epsilon_spread > 0 and run.config.num_envs > 1, values=_random),
        CaptionRule("steady", _always, values=_random),
    ),
    "stage": (
        CaptionRule("same", lambda run: run.config.spawn not in CURRICULA),
        CaptionRule("last", lambda run: run.last("stage", 1) >= _last_stage(run), values=_stages),
        CaptionRule("grows", _always, values=_stages),
    ),
}
