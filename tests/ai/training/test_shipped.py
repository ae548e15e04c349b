"""What docs/figures.md says of the shipped networks, beside what their files say."""

import json
from pathlib import Path

from ai.training.config import PRESETS, Config

# The settings that differ stand beside those that the presets had when the networks were trained.
THEN = PRESETS | {"modern": Config()}
ROOT = Path(__file__).resolve().parents[3]
FIGURES = (ROOT / "docs" / "figures.md").read_text(encoding="utf-8")


def differences(name):
    """Settings of the shipped network that were not those of the preset of its name."""
    folder = ROOT / "models" / "lander" / name
    made = Config.from_json(json.loads((folder / "config.json").read_text(encoding="utf-8"))["config"])
    made, preset = (json.loads(json.dumps(config.to_json())) for config in (made, THEN[name]))
    differ = {setting: value for setting, value in made.items() if value != preset[setting]}
    changes = json.loads((folder / "training.json").read_text(encoding="utf-8"))["changes"]
    assert Config.renamed(changes) == differ
    return differ


def test_the_figures_name_every_setting_in_which_the_shipped_modern_network_differs():
    differ = differences("modern")
    assert len(differ) == 7
    usual = vars(THEN["modern"].reward_weights)
    weights = {part: pays for part, pays in differ["reward_weights"].items() if pays != usual[part]}
    assert set(weights) == {"switch", "time"}
    said = [
        "with seven settings of its own",
        f"layers of {differ['hidden'][0]}",
        f"{differ['gradient_steps']} learning steps a decision",
        f"replay of {differ['replay_size']:,}",
        f"to {differ['final_learning_rate']} over {differ['schedule_decisions']:,} decisions",
        f"steadiness {differ['steadiness']}",
        f"time −{-weights['time']}, switch −{-weights['switch']}",
    ]
    assert [words for words in said if words not in FIGURES] == []


def test_the_shipped_classic_network_has_the_settings_of_its_preset():
    assert differences("classic") == {}
