"""Laws against what the engine does: over the whole range of every quantity, and as it is said on the panel."""

from collections.abc import Callable
from itertools import count, product
from typing import Any

import numpy as np
import pytest

from engine import Body
from game.core import texts
from game.scenes.physics.exhibit import Exhibit, Grip
from game.scenes.physics.exhibits import EXHIBITS
from game.scenes.physics.plot import LawPlot, RangeMeasurement, Results
from game.scenes.physics.scene import GRAVITIES

MOON, EARTH = GRAVITIES
# The body that is measured, where it is not the first
FOLLOWED: dict[str, Callable[[Any], Body]] = {
    "slopes": lambda slopes: slopes.boxes[2],
    "bounce": lambda bounce: bounce.balls[3],
    "drag": lambda race: race.discs[1],
    "spin": lambda spin: spin.bars[1],
}
QUANTITIES = [(name, each.name) for name, kind in EXHIBITS.items() for each in kind.quantities]


def measured(exhibit: Exhibit) -> float:
    while exhibit.result is None:
        assert exhibit.steps < exhibit.patience
        exhibit.step()
    return exhibit.result


def whole_range(
    name: str, quantity: str, gravity: float, points: int, **others: float
) -> list[tuple[float, float, float]]:
    """Value, law and measurement at some values over the whole range of a quantity."""
    kind = EXHIBITS[name]
    [chosen] = [each for each in kind.quantities if each.name == quantity]
    found = []
    for value in chosen.spread(points):
        exhibit = kind(gravity, others | {quantity: value})
        found.append((value, kind.law(gravity, exhibit.values), measured(exhibit)))
    return found


@pytest.mark.parametrize(
    ("name", "quantity"),
    [pytest.param(*each, marks=[pytest.mark.slow] * (each == ("heap", "count"))) for each in QUANTITIES],
)
def test_the_law_holds_over_the_whole_range(name: str, quantity: str):
    if name == "heap":  # whose hundred bodies take long
        found = whole_range(name, quantity, MOON, 2, **({"count": 10.0} if quantity == "rubbing" else {}))
    else:
        found = whole_range(name, quantity, MOON, 3)
    top = max(law for _, law, _ in found)
    for value, law, result in found:
        assert result == pytest.approx(law, abs=EXHIBITS[name].tolerance * top), f"{quantity} = {value}"


@pytest.mark.parametrize("name", EXHIBITS)
def test_extremes_of_all_quantities_together_obey_the_law_too(name: str):
    kind = EXHIBITS[name]
    names = [each.name for each in kind.quantities]
    corners = [dict(zip(names, ends, strict=True)) for ends in product(*(q.limits for q in kind.quantities))]
    top = max(kind.law(EARTH, values) for values in corners)
    for values in corners:
        if values.get("count") == 100.0:
            continue  # a hundred bodies are tested above, in the slow test
        exhibit = kind(EARTH, values)
        law = kind.law(EARTH, exhibit.values)
        assert measured(exhibit) == pytest.approx(law, abs=kind.tolerance * top), values


def test_a_run_that_a_hand_has_come_into_measures_nothing(subtests: pytest.Subtests):
    for name in EXHIBITS:
        with subtests.test(name=name):
            exhibit = EXHIBITS[name](EARTH, {"count": 10.0} if name == "heap" else {})
            body = FOLLOWED.get(name, lambda exhibit: exhibit.bodies[0])(exhibit)
            grip = Grip(body, body.position[0].copy())
            for _ in range(exhibit.patience):
                exhibit.step(grip)
            assert exhibit.result is None


def test_every_quantity_has_words_and_values_spread_over_its_range_that_can_be_chosen(subtests: pytest.Subtests):
    assert texts.LAWS.keys() == texts.EXHIBITS.keys() == EXHIBITS.keys()
    assert texts.QUANTITIES.keys() == {quantity for _, quantity in QUANTITIES}
    for name, quantity in QUANTITIES:
        with subtests.test(name=name, quantity=quantity):
            [chosen] = [each for each in EXHIBITS[name].quantities if each.name == quantity]
            values = chosen.spread(9)
            assert (values[0], values[-1]) == chosen.limits
            assert chosen.limits[0] <= chosen.start <= chosen.limits[1]
            steps = (np.array([*values, chosen.start]) - chosen.limits[0]) / chosen.step
            assert steps == pytest.approx(np.rint(steps), abs=1e-6)
            assert len(set(values)) == len(values)


# The plot


def finish(measurement: RangeMeasurement) -> int:
    """Measure to the end, a step at a time; return how many calls that took."""
    ticks = count()
    return next(call for call in count(1) if measurement.advance(lambda: float(next(ticks)), 0.0))


def test_a_range_is_measured_in_small_pieces_and_agrees_with_whole_runs():
    results = Results()
    exhibit = EXHIBITS["spin"](EARTH)
    measurement = RangeMeasurement(exhibit, "reach", results)
    assert finish(measurement) > measurement.count * 30
    points = results.along(exhibit, "reach")
    assert [value for value, _ in points] == EXHIBITS["spin"].quantities[0].spread(9)
    for value, result in points:
        assert result == measured(EXHIBITS["spin"](EARTH, {"reach": value}))


def test_time_that_is_left_is_used_but_not_exceeded_by_more_than_a_step():
    ticks = count()
    measurement = RangeMeasurement(EXHIBITS["spin"](EARTH), "reach", Results())
    before = next(ticks)
    measurement.advance(lambda: float(next(ticks)), 20.0)  # each look at the clock is a second here
    assert 10 < next(ticks) - before < 24


def test_a_plot_shows_the_runs_that_differ_in_its_quantity_alone():
    results = Results()
    for values in ({}, {"impulse": 0.8}, {"reach": 0.5}, {"reach": 0.5, "impulse": 0.8}):
        measured(exhibit := EXHIBITS["spin"](EARTH, values))
        results.add(exhibit)
    here = EXHIBITS["spin"](EARTH)
    assert [value for value, _ in results.along(here, "reach")] == [0.5, 1.2]
    assert [value for value, _ in results.along(here, "impulse")] == [0.4, 0.8]
    assert results.along(EXHIBITS["impacts"](EARTH), "striker") == []


def test_the_panel_shows_law_measurement_and_their_difference():
    results, exhibit = Results(), EXHIBITS["bounce"](EARTH)
    panel = LawPlot(exhibit, "drop", results)
    [(waiting, _)] = panel.sentences("")
    assert waiting.startswith("Law 3.38 m. Measured")
    result = measured(exhibit)
    results.add(exhibit)
    panel.refresh()
    sentences = " ".join(words for words, _ in panel.sentences(""))
    assert f"measured {result:.2f} m: {abs(result - 3.375):.3f} m apart" in sentences
    assert "1 run in this plot" in sentences
    finish(RangeMeasurement(exhibit, "drop", results))
    panel.refresh()
    worst = max(abs(result - 0.5625 * value) for value, result in panel.points)
    assert panel.worst == pytest.approx(worst)
    sentences = " ".join(words for words, _ in panel.sentences(""))
    assert f"{len(panel.points)} runs in this plot: at most {worst:.3f} m apart" in sentences
    assert texts.LAWS["bounce"][4] in sentences
    assert panel.sentences("Measuring")[-1][0] == "Measuring"


# Why the engine and the law differ, where they do


def test_a_column_needs_some_iterations_to_carry_its_load_and_more_change_nothing():
    def difference(iterations: float) -> float:
        stack = EXHIBITS["stack"](EARTH, {"boxes": 12.0, "iterations": iterations})
        return abs(measured(stack) / stack.law(EARTH, stack.values) - 1)

    assert difference(1.0) > 0.03
    assert all(difference(iterations) < 1e-3 for iterations in (6.0, 20.0))


def test_what_a_heap_still_carries_explains_all_of_the_difference():
    heap = EXHIBITS["heap"](MOON, {"count": 20.0})
    result = measured(heap)
    momentum = sum(body.mass * float(body.velocity[0, 1]) for body in heap.bodies)
    assert result == pytest.approx(heap.law(MOON, heap.values) + momentum * 60 / heap.patience, rel=2e-3)
