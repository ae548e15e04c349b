"""Optuna's part of a study, and the driver on a stand-in for Ray."""

import json
from types import SimpleNamespace

import pytest

pytest.importorskip("optuna")
pytest.importorskip("ray")

from ai.sweep import driver
from ai.sweep.study import Study
from tests.support.studies import made_study, result, tiny_design


def test_proposals_lie_in_the_space_and_a_study_that_goes_on_repeats_none(tmp_path):
    study = made_study(tmp_path / "study")
    asked = [trial.params for trial in study.trials.values()]
    for _ in range(2):
        proposals = driver.Proposals(study)
        for value in (1.0, None, 3.0):
            number, params = proposals.ask()
            study.design.check_params(params)
            asked.append(params)
            proposals.tell(number, value)
        study.record(result(len(study.trials)), {})
    assert len({json.dumps(params) for params in asked}) == 8


def test_a_study_that_goes_on_knows_what_was_good(tmp_path):
    study = Study.create(tmp_path / "study", tiny_design(trials=60, metric="return"))
    for number in range(40):
        tau = 0.001 + 0.02 * number
        trial = result(number, -abs(tau - 0.1))
        study.record(result(number, -abs(tau - 0.1), params=trial.params | {"tau": tau, "learning_rate": 0.01}), {})
    proposals = driver.Proposals(Study.load(study.folder))
    near = sorted(abs(proposals.ask()[1]["tau"] - 0.1) for _ in range(9))
    assert near[4] < 0.2, "of settings drawn at random, half lie farther away than 0.4"


@pytest.fixture
def workers(monkeypatch):
    """Ray whose tasks do at once what `does` says of a number."""
    begun = []

    def remote(design, number, params):
        begun.append((number, params))
        return len(begun) - 1

    made = SimpleNamespace(begun=begun, does=lambda number, params: (result(number, params=params), {}))
    monkeypatch.setattr("ray.remote", lambda **_: lambda _: SimpleNamespace(remote=remote))
    monkeypatch.setattr("ray.wait", lambda jobs, timeout: (list(jobs), []))
    monkeypatch.setattr("ray.get", lambda job: made.does(*begun[job]))
    return made


def test_finished_and_damaged_trials_are_not_run_again(tmp_path, workers):
    study = made_study(tmp_path / "study")
    study.trial_folder(2).mkdir()
    study = Study.load(study.folder)
    assert driver.run(study, 8, [], lambda _: None) == {}
    assert [number for number, _ in workers.begun] == [3, 4]
    assert (sorted(study.trials), study.damaged) == ([0, 1, 3, 4], [2])


def test_a_trial_that_ray_gives_up_waits_for_the_study_to_go_on(tmp_path, workers):
    from ray.exceptions import RayError

    def die(number, params):
        raise RayError("it died")

    workers.does = die
    study = Study.create(tmp_path / "study", tiny_design(trials=1))
    assert driver.run(study, 1, [], lambda _: None) == {0: "it died"}
    assert (len(workers.begun), study.trials) == (1, {})


def test_what_a_node_lacks_is_named_and_not_tried_for_ever(tmp_path, workers):
    from ray.exceptions import RayTaskError

    def miss(number, params):
        raise RayTaskError("trained", "", ImportError("gymnasium is missing"))

    workers.does = miss
    study = Study.create(tmp_path / "study", tiny_design(trials=50))
    lost = driver.run(study, 2, [], lambda _: None)
    assert set(lost.values()) == {"gymnasium is missing"}
    assert driver.MOST_LOST <= len(lost) <= driver.MOST_LOST + 1
    assert study.trials == {}
