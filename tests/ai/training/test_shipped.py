"""What docs/figures.md says of the shipped networks, beside what their files say."""

import json
from pathlib import Path

from ai.training.config import PRESETS, Config

ROOT = Path(__file__).resolve().parents[3]


def test_the_figures_name_every_setting_in_which_a_shipped_network_differs():
    differ = {}
    for name in ("modern", "classic"):
        folder = ROOT / "models" / "lander" / name
        saved = Config.from_json(json.loads((folder / "config.json").read_text(encoding="utf-8"))["config"])
        differ[name] = json.loads(json.dumps(saved.differences(PRESETS[name])))
        changes = json.loads((folder / "training.json").read_text(encoding="utf-8"))["changes"]
        assert changes == differ[name]
    modern = differ["modern"]
    assert (len(modern), differ["classic"]) == (16, {})
    said = [
        "with sixteen settings of its own",
        f"layers of {modern['hidden'][0]} with {modern['activation']}",
        f"{modern['gradient_steps']} learning steps of {modern['batch_size']} memories a decision",
        f"returns of {modern['n_step']} steps",
        f"replay of {modern['replay_size']:,}",
        f"from {modern['learning_rate']} to {modern['final_learning_rate']}",
        f"over {modern['schedule_decisions']:,} decisions",
        f"ε over {modern['epsilon_decisions']:,}",
        f"starts that are *{modern['spawn']}*",
        f"steadiness {modern['steadiness']}",
        f"time −{-modern['reward_weights']['time']}, switch −{-modern['reward_weights']['switch']}",
    ]
    figures = (ROOT / "docs" / "figures.md").read_text(encoding="utf-8")
    assert [words for words in said if words not in figures] == []
