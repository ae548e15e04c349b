"""The command evaluate: a share with its interval."""

import json

from game.core.assets import MODELS_DIR
from main import main


def test_evaluate_prints_an_interval_around_the_share(capsys):
    command = ["evaluate", "--model", str(MODELS_DIR / "lander" / "modern"), "--episodes", "10"]
    assert main([*command, "--json"]) == 0
    values = json.loads(capsys.readouterr().out)
    low, high = values["success_interval"]
    assert low < values["success"] <= high
    assert main(command) == 0
    assert f"(95%: {low:.2%} to {high:.2%})" in capsys.readouterr().out
