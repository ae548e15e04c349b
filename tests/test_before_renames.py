"""A run, a model, a digit run and a flight from before settings were renamed: they load unchanged, for ever."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from ai.agent import DeepQAgent
from ai.digits.classifier import DigitClassifier
from ai.digits.config import DigitConfig
from ai.digits.training import DigitTraining, read_settings
from ai.nn import ModelFormatError
from ai.training.config import Config, load_agent
from ai.training.history import History, SettingChange
from ai.training.lander_session import LanderSession
from ai.training.loop import Training
from ai.training.run import resume
from game.flight import flight_file
from game.flight.replay import FlightReplay

DATA = Path(__file__).parent / "data" / "before_renames"
EXPECTED = json.loads((DATA / "expected.json").read_text(encoding="utf-8"))
OBSERVATIONS = np.array(EXPECTED["observations"], np.float32)
RENAMED = {
    "horizon": "schedule_decisions", "updates": "gradient_steps", "target_rate": "tau", "warm_up": "learning_starts",
    "target_every": "target_update_interval", "care": "final_touchdown_limits", "weights": "reward_weights",
}  # fmt: skip
RENAMED_DIGITS = {
    "warm_up": "warm_up_epochs", "smoothing": "label_smoothing", "averaging": "ema_decay", "original": "unaugmented",
}  # fmt: skip
MARKS = ["gradient_steps", "target_update_interval", "tau", "reward_weights.time"]


def assert_same_settings(config, expected, renamed):
    """The settings have the values of then, under the names of now, and are written under those alone."""
    written = json.loads(json.dumps(config.to_json()))
    if isinstance(config, Config):
        assert written.pop("target_judges"), "as it was when there was no choice"
        assert written.pop("final_tau") == 1.0, "as it was when τ did not fall"
    assert written == {renamed.get(name, name): value for name, value in expected.items()}
    assert written != expected


def assert_same_values(values, expected):
    """The network computes the same, but for rounding that differs from one processor to another."""
    np.testing.assert_allclose(values, np.array(expected), rtol=1e-5, atol=1e-7)


def test_a_model_loads_with_the_same_settings_and_values():
    (agent, config), expected = load_agent(DATA / "model"), EXPECTED["model"]
    assert_same_settings(config, expected["config"], RENAMED)
    assert_same_values(agent.q_values(OBSERVATIONS), expected["values"])
    assert agent.decisions == expected["decisions"]


def test_a_run_resumes_with_the_same_settings_networks_and_counts():
    training, expected = resume(Training, DATA / "run"), EXPECTED["run"]
    assert_same_settings(training.config, expected["config"], RENAMED)
    agent = training.agent
    assert_same_values(agent.q_values(OBSERVATIONS), expected["values"])
    assert_same_values(DeepQAgent.load(DATA / "run").q_values(OBSERVATIONS), expected["best"])
    assert (agent.decisions, agent.gradient_steps) == (expected["decisions"], expected["train_count"])
    assert (training.episodes, training.seconds) == (expected["episodes"], expected["seconds"])


def test_a_history_shows_the_same_marks_by_the_words_of_now():
    history, expected = History.read(DATA / "run"), EXPECTED["run"]
    assert len(history) == expected["points"]
    assert history.points[-1].tolist() == expected["last_point"][:9] + expected["last_point"][11:]  # two are gone
    assert [each.decisions for each in history.checkpoints] == expected["checkpoints"]
    assert [{**vars(mark), "seconds": 0.0} for mark in history.setting_changes] == [
        {**then, "name": name, "seconds": 0.0} for then, name in zip(expected["alterations"], MARKS, strict=True)
    ]


def test_a_run_of_then_goes_on_and_is_saved_under_the_names_of_now(tmp_path):
    shutil.copytree(DATA / "run", tmp_path / "run")
    run = LanderSession.live(Config(), keep=tmp_path / "kept", resume=tmp_path / "run")
    for _ in range(3):
        next(run)
    assert run.send(("change", "updates", 7))[0] == SettingChange(1002, "gradient_steps", 3, 7)
    assert run.send(("change", "weights.time", -0.5))[0] == SettingChange(1002, "reward_weights.time", -0.2, -0.5)
    run.close()
    saved = json.loads((tmp_path / "kept" / "last" / "config.json").read_text(encoding="utf-8"))["config"]
    assert (saved["gradient_steps"], saved["reward_weights"]["time"]) == (7, -0.5)
    assert not saved.keys() & RENAMED.keys()
    marks = [mark.name for mark in History.read(tmp_path / "kept").setting_changes]
    assert marks == [*MARKS, "gradient_steps", "reward_weights.time"]


def test_a_digit_run_without_a_state_says_so_and_its_settings_and_network_are_read():
    rng, expected = np.random.default_rng(EXPECTED["digit_run"]["data_seed"]), EXPECTED["digit_run"]
    images, labels = rng.random((40, 28, 28), dtype=np.float32), rng.integers(0, 10, 40)
    with pytest.raises(ModelFormatError, match="its state is gone"):
        resume(DigitTraining, DATA / "digit_run", data=(images, labels))
    config, described = read_settings(DATA / "digit_run")
    came_since = {"drawn": 0.0}  # and changes nothing of a run of then
    assert_same_settings(config, expected["config"] | came_since, RENAMED_DIGITS)
    assert described.step == expected["step"]
    assert_same_values(DigitClassifier.load(DATA / "digit_run").predict(images[:3]), expected["values"])


def test_a_flight_replays_to_the_pose_it_ended_in():
    record = flight_file.read(DATA / "flight.json")
    replay = FlightReplay(record)
    replay.scout(replay.length)
    replay.go_to(replay.length)
    assert replay.at == replay.length == 698
    assert replay.faithful
    assert record.entry.landed


def test_every_former_name_leads_to_one_setting_of_now_and_both_at_once_are_refused():
    for kind, renamed in ((Config, RENAMED), (DigitConfig, RENAMED_DIGITS)):
        assert {former: kind.name_now(former) for former in renamed} == renamed
        assert [name for name in kind().to_json() if kind.name_now(name) != name] == []
    with pytest.raises(ValueError, match="former name: updates"):
        Config.from_json({"updates": 3, "gradient_steps": 4})
