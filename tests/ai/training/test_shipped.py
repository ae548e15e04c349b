"""What docs/figures.md says of the shipped networks, beside what their files say."""

import json
from pathlib import Path

from ai.training.config import PRESETS, Config

ROOT = Path(__file__).resolve().parents[3]


def test_the_figures_name_every_setting_in_which_a_shipped_network_differs():
    differ = {}
    for name, then in (("modern", Config()), ("classic", PRESETS["classic"])):  # as they were when these were trained
        folder = ROOT / "models" / "lander" / name
        saved = Config.from_json(json.loads((folder / "config.json").read_text(encoding="utf-8"))["config"])
        made, preset = (json.loads(json.dumps(config.to_json())) for config in (saved, then))
        differ[name] = {setting: value for setting, value in made.items() if value != preset[setting]}
        changes = json.loads((folder / "training.json").read_text(encoding="utf-8"))["changes"]
        assert changes == differ[name]
    modern = differ["modern"]
    assert (len(modern), differ["classic"]) == (7, {})
    said = [
        "with seven settings of its own",
        f"layers of {modern['hidden'][0]}",
        f"{modern['gradient_steps']} learning steps a decision",
        f"replay of {modern['replay_size']:,}",
        f"to {modern['final_learning_rate']} over {modern['schedule_decisions']:,} decisions",
        f"steadiness {modern['steadiness']}",
        f"time −{-modern['reward_weights']['time']}, switch −{-modern['reward_weights']['switch']}",
    ]
    figures = (ROOT / "docs" / "figures.md").read_text(encoding="utf-8")
    assert [words for words in said if words not in figures] == []
