"""Learning to land anywhere: from the command to a network that sees what is around it."""

import json

import numpy as np
import pytest

from ai.agent.agent import DeepQAgent
from ai.lander.anywhere import SITES, AnywhereEnv, Site
from ai.lander.environment import NUM_FEATURES
from ai.lander.sensing import SURROUNDINGS, SURROUNDINGS_SCALE
from ai.training.config import ANYWHERE, LANDS_ANYWHERE
from ai.training.loop import task_of
from ai.training.tasks import ANYWHERE_SYMMETRY, AnywhereTask
from main import main

SMALL = LANDS_ANYWHERE.changed(
    hidden=(16,), batch_size=16, gradient_steps=1, learning_starts=32, replay_size=2000, num_envs=8
)


def test_what_a_mirrored_lander_sees_is_the_mirror_image_of_what_it_sees():
    site = Site(wind=0.2, gust=0.3, swing=2.0, tank=4.0, dead=1.0, back=2.0)
    mirrored = site._replace(wind=-0.2, gust=-0.3, swing=-2.0)
    env = AnywhereEnv(2, 0, frame_skip=4)
    env.reset()
    env.set_sites([site, mirrored])
    env.place(np.ones(2, bool), np.array([[3.0, 14, 0.5, -1, 0.2, 0.1], [-3.0, 14, -0.5, -1, -0.2, -0.1]]))
    for action in (3, 4, 1, 0, 5, 5, 3, 0) * 3:
        result = env.step(np.array([action, ANYWHERE_SYMMETRY.actions[action]]))
        assert result.observation[1] == pytest.approx(ANYWHERE_SYMMETRY.mirrored(result.observation[0]), abs=1e-5)


def test_touchdown_limits_tighten_and_what_is_observed_of_them_does_not():
    task = task_of(SMALL)
    assert isinstance(task, AnywhereTask)
    env = task.make_env(np.random.default_rng(0))
    task.update_env(SMALL.schedule_decisions, env)
    observed = env.reset()[:, NUM_FEATURES:] / SURROUNDINGS_SCALE
    share = SMALL.final_touchdown_limits
    assert env.strictness == share < 1
    assert env.limits.touch_speed == pytest.approx(observed[:, SURROUNDINGS.index("touch speed")])


def test_it_is_trained_resumed_and_measured_by_commands(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(AnywhereTask, "test_episodes", len(SITES))
    changes = ["hidden=[8]", "num_envs=8", "batch_size=16", "learning_starts=32", "gradient_steps=1"]
    given = [option for change in changes for option in ("--set", change)]
    folder = str(tmp_path / "flier")
    command = ["train", "--preset", "anywhere", "--decisions", "200", "--validation", "9", "--output", folder, *given]
    assert main(command) == 0
    described = json.loads((tmp_path / "flier" / "training.json").read_text(encoding="utf-8"))
    assert (described["env"], described["preset"]) == (ANYWHERE, "anywhere")
    assert main(["train", "--resume", folder, "--decisions", "300", "--validation", "9"]) == 0
    assert DeepQAgent.load(folder).num_features == AnywhereEnv.num_features
    capsys.readouterr()
    assert main(["evaluate", "--model", folder, "--episodes", "9", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["episodes"] == 9
