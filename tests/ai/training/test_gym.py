import json
import sys
import warnings

import numpy as np
import pytest

from ai.agent.agent import DeepQAgent
from ai.environment import finished
from ai.lander.anywhere import AnywhereEnv
from ai.lander.environment import LanderEnv
from ai.lander.one_engine import OneEngineEnv
from ai.nn import ModelFormatError
from ai.training.config import gym_config
from ai.training.gym_lander import GymLander
from ai.training.gym_task import PATIENCE, GymTask
from ai.training.loop import Training
from ai.training.run import resume
from main import main

LANDER = "ai.training.gym_lander:tranquility/Lander-v0"


class Rocking:
    """Pushes to and fro, which keeps a pole up for a while."""

    def act(self, observation, held=None):
        return 1 - held


def test_without_the_extra_one_line_names_the_command(tmp_path, monkeypatch, capsys):
    pytest.importorskip("gymnasium")
    monkeypatch.chdir(tmp_path)
    train_cart_pole("run", 400)
    capsys.readouterr()
    monkeypatch.setitem(sys.modules, "gymnasium", None)
    for arguments in (
        ["train", "--env", "CartPole-v1", "--output", "new", "--seconds", "1"],
        ["train", "--resume", "run", "--seconds", "1"],
        ["evaluate", "--model", "run"],
    ):
        assert main(arguments) == 1
        stderr = capsys.readouterr().err
        assert stderr.count("\n") == 1
        assert 'pip install -e ".[gym]"' in stderr


def train_cart_pole(folder, decisions, *more):
    return main(["train", "--env", "CartPole-v1", "--decisions", str(decisions), "--output", str(folder), *more])


class TestLearningOthersEnvironments:
    @pytest.fixture(autouse=True)
    def _needs_gymnasium(self):
        pytest.importorskip("gymnasium")

    @pytest.mark.slow
    def test_cart_pole_is_learnt_kept_evaluated_and_gone_on_with(self, tmp_path, capsys, monkeypatch):
        monkeypatch.setattr(GymTask, "validation_episodes", 8)
        monkeypatch.setattr(GymTask, "test_episodes", 10)
        run = tmp_path / "run"
        assert train_cart_pole(run, 5_000, "--set", "epsilon_decisions=3000", "--set", "learning_starts=500") == 0
        assert "mean return" in capsys.readouterr().out
        described = json.loads((run / "training.json").read_text())
        assert (described["env"], described["preset"]) == ("CartPole-v1", "gym")
        assert described["evaluation"]["episodes"] == 10
        assert main(["evaluate", "--model", str(run), "--episodes", "10", "--seed", "3", "--json"]) == 0
        measured = json.loads(capsys.readouterr().out)
        assert measured["mean_return"] > 60
        assert measured["mean_length"] == measured["mean_return"]
        assert 0 <= measured["success"] <= 1
        resumed, best = resume(Training, run), DeepQAgent.load(run)
        assert resumed.agent.normalizer.to_json() == DeepQAgent.load(run / "last").normalizer.to_json()
        assert np.array_equal(resumed.best_agent().q_values(np.ones(4)), best.q_values(np.ones(4)))
        assert main(["train", "--resume", str(run), "--decisions", "5200"]) == 0
        assert json.loads((run / "training.json").read_text())["decisions"] == 5_200
        assert main(["evaluate", "--model", str(run), "--spawn", "hard"]) == 1
        assert "--spawn is for the lander" in capsys.readouterr().err

    def test_the_contract_of_an_environment_holds(self):
        env = GymTask(gym_config("CartPole-v1")).make_env(np.random.default_rng(0))
        before = env.reset()
        for _ in range(30):
            result = env.step(np.ones(16, dtype=int))
        assert result.terminated.all()
        assert not result.succeeded.any()
        assert not result.reward.any()
        assert np.array_equal(env.step(np.zeros(16, dtype=int)).observation, result.observation)
        some = np.arange(16) < 4
        after = env.reset(some)
        assert np.array_equal(after[4:], result.observation[4:])
        assert not np.array_equal(after[:4], before[:4])
        assert (env.step(np.zeros(16, dtype=int)).reward == some).all()

    def test_only_episodes_of_training_are_cut_short(self, monkeypatch):
        monkeypatch.setitem(PATIENCE, "CartPole-v1", 8)
        task = GymTask(gym_config("CartPole-v1"))
        env = task.make_env(np.random.default_rng(0))
        env.reset()
        for turn in range(8):
            assert not env.outcome.any()
            result = env.step(np.full(16, turn % 2))
        assert result.truncated.all(), "what comes next still has a value"
        assert not result.terminated.any()
        assert finished(task.trial(Rocking(), 8, 0)).mean_length > 8

    def test_a_damaged_scale_is_named(self, tmp_path):
        train_cart_pole(tmp_path / "run", 400)
        described = tmp_path / "run" / "config.json"
        values = json.loads(described.read_text())
        values["scale"]["mean"] = [0.0]
        described.write_text(json.dumps(values))
        with pytest.raises(ModelFormatError, match="scale of observations"):
            DeepQAgent.load(tmp_path / "run")


class TestOurLanderForOthers:
    @pytest.fixture(autouse=True)
    def gymnasium(self):
        return pytest.importorskip("gymnasium")

    def test_gymnasiums_own_check_finds_nothing(self, gymnasium):
        from gymnasium.utils.env_checker import check_env

        with warnings.catch_warnings():
            warnings.simplefilter("error")
            check_env(gymnasium.make(LANDER).unwrapped)

    def test_the_same_seed_gives_the_same_flight(self, gymnasium):
        def flight(env, seed):
            steps, ended = [env.reset(seed=seed)[0]], False
            while not ended:
                observation, reward, terminated, truncated, info = env.step(3)
                ended = terminated or truncated
                steps.append(np.append(observation, [reward, terminated]))
            return np.concatenate(steps), info

        env = gymnasium.make(LANDER, spawn="hard")
        first, info = flight(env, 11)
        for other in (gymnasium.make(LANDER, spawn="hard"), env):
            assert np.array_equal(first, flight(other, 11)[0])
        assert not np.array_equal(first[:9], flight(env, 12)[0][:9])
        assert info == {"outcome": 3, "is_success": False}


class Calm:
    """Generator whose every uniform number is the middle of its range: flat ground, no push, no noise of engines."""

    def uniform(self, low=0.0, high=1.0, size=None):
        return (low + high) / 2 if size is None else np.full(size, (low + high) / 2)


@pytest.mark.slow
def test_lunar_lander_looks_the_same_in_a_mirror():
    gymnasium = pytest.importorskip("gymnasium")
    pytest.importorskip("Box2D")
    mirror = GymTask(gym_config("LunarLander-v3")).symmetry
    here, there = (gymnasium.make("LunarLander-v3").unwrapped for _ in range(2))
    for env in (here, there):
        env.reset(seed=0)
        env._np_random = Calm()
        env.reset()
    rng = np.random.default_rng(0)
    for _ in range(80):
        action = int(rng.choice(4, p=[0.3, 0.2, 0.3, 0.2]))  # more to the one side than to the other
        one, other = here.step(action), there.step(int(mirror.actions[action]))
        assert mirror.mirrored(one[0]) == pytest.approx(other[0], abs=0.01)
        assert one[1] == pytest.approx(other[1], abs=0.05)
    assert abs(one[0][4]) > 0.1, "it has turned: the test is not of a lander that falls straight"


def test_true_is_an_action_in_none_of_our_environments():
    one_engine = OneEngineEnv(1, np.random.default_rng(0), (1.0, 2.0))
    for env in (LanderEnv(1, 0), AnywhereEnv(1, 0), one_engine, GymLander()):
        env.reset()
        with pytest.raises(ValueError, match="whole numbers, not bool"):
            env.step(True if isinstance(env, GymLander) else [True])
    assert one_engine.step([1]).reward.shape == (1,)
