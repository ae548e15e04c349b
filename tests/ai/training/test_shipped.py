"""What docs/figures.md says of the shipped networks, beside what their files say."""

import json
from pathlib import Path

from ai.training.config import PRESETS, Config

ROOT = Path(__file__).resolve().parents[3]


def test_a_shipped_network_says_itself_every_setting_in_which_it_differs_from_its_preset():
    differ = {}
    for name in ("modern", "classic"):
        folder = ROOT / "models" / "lander" / name
        saved = Config.from_json(json.loads((folder / "config.json").read_text(encoding="utf-8"))["config"])
        differ[name] = json.loads(json.dumps(saved.differences(PRESETS[name])))
        changes = json.loads((folder / "training.json").read_text(encoding="utf-8"))["changes"]
        assert changes == differ[name]
    assert (len(differ["modern"]), differ["classic"]) == (16, {})
