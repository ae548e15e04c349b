"""Captions of charts, on recordings of real runs."""

from functools import cache
from itertools import islice

import numpy as np
import pytest

from ai.training.captions import CAPTION_RULES, CHARTS, Caption, caption
from ai.training.config import Config
from ai.training.curves import RecentCurves
from ai.training.hints import RULES, Adviser
from ai.training.history import History, Point
from tests.support.recordings import growing, names, recorded

ABOUT = {rule.name: rule.about for rule in RULES}


def captions(run: RecentCurves, hint: str = "") -> dict[str, Caption]:
    return {chart: said for chart in CHARTS if (said := caption(chart, run, hint))}


def test_a_caption_agrees_with_the_number_above_it(subtests: pytest.Subtests):
    """While a run goes well, badly, and is broken by hand."""
    said = set()
    for name in ("modern healthy", "modern rates to 1 and back, late", "modern sabotage no_shaping", "classic healthy"):
        with subtests.test(name=name):
            shown: dict[str, str] = {}
            for run in islice(growing(name), None, None, 3):
                read = RecentCurves(run.history, run.config)
                now = {column: read.now(column) for column in ("success", "epsilon", "loss")}
                for chart in CHARTS:
                    found = caption(chart, read, shown=shown.get(chart, ""))
                    shown[chart] = found.name if found else ""
                    said.add((chart, shown[chart]))
                    figures = {name: float(value) for name, value in found.values.items()} if found else {}
                    assert agrees(chart, shown[chart], figures, now, run.history), (found, now)
    assert {("success", each) for each in ("steady", "rises", "falls", "collapsed")} <= said
    assert {("epsilon", "falls"), ("success", ""), ("loss", "rises"), ("loss", "falls")} <= said


def agrees(chart: str, name: str, figures: dict[str, float], now: dict[str, float], history: History) -> bool:
    """Whether the figures of a caption, and what it says, are those of the curve."""
    match chart, name:
        case "success", "steady":
            return figures["percent"] == 100 * now["success"] and abs(figures["percent"] - figures["before"]) <= 5
        case "success", "rises":
            return figures["before"] < 100 * now["success"] - 5
        case "success", "falls":
            return figures["before"] > 100 * now["success"] + 5
        case "success", "collapsed":
            return figures["best"] == 100 * np.nanmax(history["success"])
        case "success", "high":
            return now["success"] >= 0.97
        case "epsilon", "falls" | "spread" | "steady":
            return figures["percent"] == 100 * now["epsilon"]
        case "loss", "unknown":
            return np.isnan(now["loss"])
    return True


def test_a_curve_that_falls_again_is_not_said_to_rise(subtests: pytest.Subtests):
    for last, name in ((0.97, "high"), (0.85, "rises"), (0.75, None)):
        peak = 0.97 if last == 0.75 else last
        curve = np.interp(np.arange(300), (0, 200, 240, 280, 300), (0.2, 0.6, 0.6, peak, last))
        with subtests.test(last=last):
            history = History()
            for row, success in enumerate(curve.tolist()):
                history.append(Point(seconds=row, decisions=1000.0 * row, episodes=10.0 * row, success=success,
                                     mean_return=100.0, loss=0.05, mean_q=0.7, epsilon=0.05, stage=0.0))  # fmt: skip
            found = captions(RecentCurves(history, Config())).get("success")
            assert (found.name if found else None) == name


def test_a_loss_that_falls_from_its_peak_is_not_said_to_rise(subtests: pytest.Subtests):
    """A knob was set to something absurd, and back."""
    for last, name in ((10.0, "rises"), (2.0, "peaked"), (0.5, "falls")):
        curve = np.interp(np.arange(300), (0, 250, 260, 299), (0.05, 0.05, 0.5, 0.05 * last))
        with subtests.test(last=last):
            history = History()
            for row, loss in enumerate(curve.tolist()):
                history.append(Point(seconds=row, decisions=1000.0 * row, episodes=10.0 * row, success=0.5,
                                     mean_return=100.0, loss=loss, mean_q=0.7, epsilon=0.05, stage=0.0))  # fmt: skip
            found = captions(RecentCurves(history, Config())).get("loss")
            assert (found.name if found else None) == name


@cache
def seen(name: str) -> dict[str, list[str]]:
    """The captions that each chart of a recording had, in order, beside the hints that were shown."""
    found: dict[str, list[str]] = {chart: [] for chart in CHARTS}
    adviser = None
    for number, run in enumerate(islice(growing(name), None, None, 4)):
        adviser = adviser or Adviser(run.config)
        hint = adviser.advise(run.history, run.config, run.dead_share, run.clipped_share)
        if number % 2:
            continue
        for chart, shown in captions(RecentCurves(run.history, run.config), hint.name if hint else "").items():
            praises = any(rule.praises for rule in CAPTION_RULES[chart] if rule.name == shown.name)
            assert not (hint and chart in ABOUT[hint.name] and praises), (name, hint, chart, shown)
            if found[chart][-1:] != [shown.name]:
                found[chart].append(shown.name)
    return found


def test_a_healthy_run_crashes_then_lands_more_and_then_nearly_always():
    charts = seen("modern healthy")
    assert charts["success"][:2] == ["unknown", "crashes"]
    assert charts["success"].index("crashes") < charts["success"].index("rises")
    assert charts["success"][-1] == "high"
    assert charts["loss"][0] == "unknown"
    assert charts["mean_return"][:2] == ["unknown", "hopes"], "values begin at 0, and flights cost points"
    assert "runs_away" not in charts["mean_return"]
    assert "falls" in charts["epsilon"]
    assert charts["epsilon"][-1] == "spread"


def test_a_run_that_breaks_is_said_to_have_landed_more_before():
    charts = seen("modern rates to 1 and back, late")
    assert charts["success"][-1] == "collapsed"
    assert charts["mean_return"][-1] == "falls"


def test_a_run_that_only_crashes_is_never_praised_for_landing_and_values_that_run_away_are_named():
    assert not {"rises", "high"} & set(seen("modern rates 1")["success"])
    assert seen("classic rates 1")["mean_return"][-1] == "runs_away"


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", [name for name in names() if "sabotage" in name or "healthy" in name or "back" in name]
)
def test_no_caption_speaks_against_a_hint(name: str):
    assert seen(name)


def test_a_hint_on_the_screen_silences_praise_of_its_charts():
    run = next(
        each for each in growing("modern healthy")
        if each.history["decisions"][-1] > 100_000 and each.history["success"][-8:].min() >= 0.97
    )  # fmt: skip
    read = RecentCurves(run.history, run.config)
    assert [captions(read, hint)["success"].name for hint in ("", "plateau")] == ["high", "steady"]


def test_a_run_without_chance_has_a_caption_of_its_own():
    run = recorded("modern healthy", until=60_000)
    history, config = run.history, run.config.changed(epsilon_spread=0.0)
    assert captions(RecentCurves(history, config))["epsilon"].name in ("falls", "steady")
    assert captions(RecentCurves(History(), config)) == {}
