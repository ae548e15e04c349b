"""How much knobs matter, beside functions whose shares are known exactly."""

import numpy as np
import pytest

from ai.sweep.importance import LEAST, importances
from ai.sweep.space import Dimension

SPACE = {"a": Dimension(0.0, 1.0), "b": Dimension(1e-4, 1.0, log=True), "c": Dimension(choices=("x", "y", "z"))}


def sampled(function, count=400):
    rng = np.random.default_rng(1)
    params = [{name: each.draw(rng) for name, each in SPACE.items()} for _ in range(count)]
    return params, [function(each) for each in params]


def test_shares_of_a_sum_are_those_of_its_parts():
    """3a + 1u, where u is the place of b: variances 9/12 and 1/12, so 90% and 10%, and none for c."""
    found = importances(SPACE, *sampled(lambda p: 3 * p["a"] + SPACE["b"].place(p["b"])))
    assert next(iter(found)) == "a"
    assert found["a"].share == pytest.approx(0.9, abs=0.06)
    assert found["b"].share == pytest.approx(0.1, abs=0.06)
    assert found["c"].share < 0.03


def test_a_choice_matters_by_itself():
    found = importances(SPACE, *sampled(lambda p: {"x": 0.0, "y": 5.0, "z": 1.0}[p["c"]] + 0.1 * p["a"]))
    assert found["c"].share > 0.9


def test_knobs_that_only_act_together_explain_nothing_by_themselves():
    found = importances(SPACE, *sampled(lambda p: float((p["a"] > 0.5) ^ (SPACE["b"].place(p["b"]) > 0.5))))
    assert found["a"].share + found["b"].share < 0.25


def test_nothing_is_said_of_too_few_trials_or_equal_values():
    params, values = sampled(lambda p: p["a"], LEAST - 1)
    assert importances(SPACE, params, values) == {}
    params, _ = sampled(lambda p: p["a"], 50)
    assert importances(SPACE, params, [1.0] * 50) == {}
