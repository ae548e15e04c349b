"""The files that docs/pilots.md shows for networks from elsewhere fly; one without its library, on a stand-in."""

import re
from pathlib import Path

import numpy as np

from ai.pilots.own import MeasuredPilot

SHOWN = re.findall(
    r"flown by tests/.*?```python\n(.*?)```", (Path(__file__).parents[3] / "docs" / "pilots.md").read_text(), re.S
)
# As much of each library as the file calls: a policy that fires its main engine where the second number is negative.
STABLE_BASELINES3 = """
class DQN:
    @classmethod
    def load(cls, path):
        assert path.name == "lander"
        return cls()

    def predict(self, observations, deterministic):
        return 3 * (observations[:, 1] < 0), None
"""
OBSERVATIONS = np.linspace(-1, 1, 36, dtype=np.float32).reshape(4, 9)


def test_a_policy_of_stable_baselines3_flies(tmp_path: Path):
    assert len(SHOWN) == 2
    (tmp_path / "stable_baselines3.py").write_text(STABLE_BASELINES3)
    (tmp_path / "pilot.py").write_text(SHOWN[0])
    pilot = MeasuredPilot(tmp_path / "pilot.py")
    assert pilot.act(OBSERVATIONS).tolist() == [3, 3, 0, 0]
    pilot.close()
