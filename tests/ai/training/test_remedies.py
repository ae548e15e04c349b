"""Only remedies that brought a run back are offered: `benchmarks.remedies` has tried every one on real runs."""

import json
from pathlib import Path

from ai.training.config import PRESETS
from ai.training.curves import RecentCurves
from ai.training.hints import RULES
from tests.support.recordings import recorded

TRIED = json.loads(Path(__file__).with_name("remedies.json").read_text())


def test_only_what_brought_a_run_back_is_offered():
    pressed = {rule.partition(" ")[0] for each in TRIED.values() for rule in each["pressed"]}
    run = RecentCurves(recorded("modern healthy").history, PRESETS["classic"].changed(epsilon_end=0.5, tau=1e-4))
    offers = {rule.name for rule in RULES if rule.remedy(run) or rule.name in ("changed", "rate_too_high", "crashes")}
    assert offers <= pressed, "a remedy was never tried"
    for name, tried in TRIED.items():
        assert tried["pressed"], name
        assert tried["after"] > max(0.5, tried["with"] + 0.25), name
        assert tried["left alone"] is None or tried["after"] > tried["left alone"] + 0.25, name
