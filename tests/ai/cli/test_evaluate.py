"""The command evaluate: a share with its interval."""

import json

import pytest

from ai.training.statistics import wilson
from game.core.assets import MODELS_DIR
from main import main


def test_an_interval_holds_the_share_and_shrinks_with_the_number_of_trials():
    assert wilson(0.0, 20) == pytest.approx((0.0, 0.1611), abs=1e-4)
    assert wilson(1.0, 20) == pytest.approx((0.8389, 1.0), abs=1e-4)
    assert wilson(0.5, 100) == pytest.approx((0.4038, 0.5962), abs=1e-4)


def test_evaluate_prints_an_interval_around_the_share(capsys):
    command = ["evaluate", "--model", str(MODELS_DIR / "lander" / "modern"), "--episodes", "10"]
    assert main([*command, "--json"]) == 0
    values = json.loads(capsys.readouterr().out)
    low, high = values["success_interval"]
    assert low < values["success"] <= high
    assert main(command) == 0
    assert f"(95%: {low:.2%} to {high:.2%})" in capsys.readouterr().out
