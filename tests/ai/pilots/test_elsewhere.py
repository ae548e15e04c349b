"""The files that docs/pilots.md shows for networks from elsewhere fly; one without its library, on a stand-in."""

import re
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

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


@pytest.fixture
def fly(tmp_path: Path):
    def fly(source: str, library: str = "", name: str = "") -> list[int]:
        if library:
            (tmp_path / f"{name}.py").write_text(library)
        (tmp_path / "pilot.py").write_text(source)
        pilot = MeasuredPilot(tmp_path / "pilot.py")
        actions = pilot.act(OBSERVATIONS).tolist()
        pilot.close()
        return actions

    return fly


def test_a_policy_of_stable_baselines3_flies(fly):
    assert len(SHOWN) == 2
    assert fly(SHOWN[0], STABLE_BASELINES3, "stable_baselines3") == [3, 3, 0, 0]


@pytest.mark.slow
@pytest.mark.skipif(find_spec("stable_baselines3") is None, reason="stable-baselines3 is not installed")
def test_a_policy_trained_on_our_lander_flies(fly, tmp_path: Path):
    import gymnasium
    from stable_baselines3 import DQN

    env = gymnasium.make("ai.training.gym_lander:tranquility/Lander-v0")
    model = DQN("MlpPolicy", env, learning_starts=50, buffer_size=1000, seed=1).learn(200)
    model.save(tmp_path / "lander")
    assert fly(SHOWN[0]) == model.predict(OBSERVATIONS, deterministic=True)[0].tolist()


@pytest.mark.slow
@pytest.mark.skipif(find_spec("torch") is None, reason="PyTorch is not installed")
def test_a_network_of_pytorch_flies(fly, tmp_path: Path):
    import torch

    torch.manual_seed(1)
    network = torch.nn.Sequential(torch.nn.Linear(9, 16), torch.nn.Tanh(), torch.nn.Linear(16, 6))
    torch.jit.script(network).save(str(tmp_path / "lander.pt"))
    with torch.no_grad():
        wanted = network(torch.from_numpy(OBSERVATIONS)).argmax(1).tolist()
    assert fly(SHOWN[1]) == wanted
