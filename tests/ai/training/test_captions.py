"""Captions of the chart of landings, on recordings of real runs."""

from functools import cache
from itertools import islice

import numpy as np
import pytest

from ai.training.captions import RULES, caption
from ai.training.config import Config
from ai.training.curves import RecentCurves
from ai.training.hints import Adviser
from ai.training.history import History
from tests.support.points import point
from tests.support.recordings import growing, names


def test_a_caption_agrees_with_the_number_above_it(subtests: pytest.Subtests):
    """While a run goes well, badly, and is broken by hand."""
    said = set()
    for name in ("modern healthy", "modern rates to 1 and back, late", "modern sabotage no_shaping", "classic healthy"):
        with subtests.test(name=name):
            shown = ""
            for run in islice(growing(name), None, None, 3):
                read = RecentCurves(run.history, run.config)
                found = caption(read, shown=shown)
                shown = found.name if found else ""
                said.add(shown)
                figures = {name: float(value) for name, value in found.values.items()} if found else {}
                assert agrees(shown, figures, read.now("success_rate"), run.history), found
    assert {"steady", "rises", "falls", "collapsed", ""} <= said


def agrees(name: str, figures: dict[str, float], now: float, history: History) -> bool:
    """Whether the figures of a caption, and what it says, are those of the curve."""
    match name:
        case "steady":
            return figures["percent"] == 100 * now and abs(figures["percent"] - figures["before"]) <= 5
        case "rises":
            return figures["before"] < 100 * now - 5
        case "falls":
            return figures["before"] > 100 * now + 5
        case "collapsed":
            return figures["best"] == 100 * np.nanmax(history["success_rate"])
        case "high":
            return now >= 0.97
        case "unknown":
            return np.isnan(now)
    return True


def curve(*, at: tuple[float, ...], land: tuple[float, ...]) -> History:
    """A run that lands these shares of its flights at these seconds, and between them along straight lines."""
    history = History()
    for row, success in enumerate(np.interp(np.arange(at[-1]), at, land).tolist()):
        history.append(
            point(
                seconds=row,
                decisions=1000.0 * row,
                episodes=10.0 * row,
                success_rate=success,
                mean_return=100.0,
                loss=0.05,
                mean_q=0.7,
                epsilon=0.05,
            )
        )
    return history


def test_a_curve_that_falls_again_is_not_said_to_rise(subtests: pytest.Subtests):
    for last, name in ((0.97, "high"), (0.85, "rises"), (0.75, None)):
        peak = 0.97 if last == 0.75 else last
        with subtests.test(last=last):
            history = curve(at=(0, 200, 240, 280, 300), land=(0.2, 0.6, 0.6, peak, last))
            found = caption(RecentCurves(history, Config()))
            assert (found.name if found else None) == name


def test_a_curve_that_falls_from_90_to_81_is_not_said_to_be_steady():
    for last in (0.9, 0.88, 0.84, 0.81):
        found = caption(RecentCurves(curve(at=(0, 60, 260, 300), land=(0.2, 0.85, 0.9, last)), Config()))
        assert (found is not None and found.name == "steady") == (last >= 0.88), last


@cache
def seen(name: str) -> list[str]:
    """The captions that a recording had, in order, beside the hints that were shown."""
    found: list[str] = []
    adviser = None
    for number, run in enumerate(islice(growing(name), None, None, 4)):
        adviser = adviser or Adviser()
        hint = adviser.advise(run.history, run.config)
        shown = None if number % 2 else caption(RecentCurves(run.history, run.config), hinted=hint is not None)
        if shown is None:
            continue
        praises = any(rule.praises for rule in RULES if rule.name == shown.name)
        assert not (hint and praises), (name, hint, shown)
        if found[-1:] != [shown.name]:
            found.append(shown.name)
    return found


def test_a_healthy_run_crashes_then_lands_more_and_then_nearly_always():
    shown = seen("modern healthy")
    assert shown[:2] == ["unknown", "crashes"]
    assert shown.index("crashes") < shown.index("rises")
    assert shown[-1] == "high"


def test_a_run_that_breaks_is_said_to_have_landed_more_before():
    assert seen("modern rates to 1 and back, late")[-1] == "collapsed"


def test_a_run_that_only_crashes_is_never_praised():
    assert not {"rises", "high"} & set(seen("modern rates 1"))


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", [name for name in names() if "sabotage" in name or "healthy" in name or "back" in name]
)
def test_no_caption_speaks_against_a_hint(name: str):
    assert seen(name)


def test_a_hint_on_the_screen_silences_praise():
    run = next(
        each for each in growing("modern healthy")
        if each.history["decisions"][-1] > 100_000 and each.history["success_rate"][-8:].min() >= 0.97
    )  # fmt: skip
    read = RecentCurves(run.history, run.config)
    assert [caption(read, hinted=hinted).name for hinted in (False, True)] == ["high", "steady"]
    assert caption(RecentCurves(History(), run.config)) is None
