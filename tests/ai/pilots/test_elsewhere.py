"""The files that docs/pilots.md shows for networks from elsewhere fly: one on a stand-in, one where PyTorch is."""

import re
from pathlib import Path

import numpy as np
import pytest

from ai.pilots.own import MeasuredPilot

SHOWN = re.findall(
    r"flown by tests/.*?```python\n(.*?)```", (Path(__file__).parents[3] / "docs" / "pilots.md").read_text(), re.S
)
# As much of the library as the file calls: a policy that fires its main engine where the second number is negative.
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


def flown(folder: Path, source: str) -> list[int]:
    (folder / "pilot.py").write_text(source)
    pilot = MeasuredPilot(folder / "pilot.py")
    actions = pilot.act(OBSERVATIONS).tolist()
    pilot.close()
    return actions


def test_a_policy_of_stable_baselines3_flies(tmp_path: Path):
    assert len(SHOWN) == 2
    (tmp_path / "stable_baselines3.py").write_text(STABLE_BASELINES3)
    assert flown(tmp_path, SHOWN[0]) == [3, 3, 0, 0]


@pytest.mark.slow
def test_a_network_of_pytorch_flies(tmp_path: Path):
    torch = pytest.importorskip("torch")
    torch.manual_seed(1)
    network = torch.nn.Sequential(torch.nn.Linear(9, 16), torch.nn.Tanh(), torch.nn.Linear(16, 6))
    torch.jit.script(network).save(str(tmp_path / "lander.pt"))
    wanted = network(torch.from_numpy(OBSERVATIONS)).argmax(1).tolist()
    assert flown(tmp_path, SHOWN[1]) == wanted
