"""Optuna's part of a study: what it proposes, what it goes on with, and what it is given of a study on disk."""

import json
from dataclasses import replace
from types import SimpleNamespace

import pytest

pytest.importorskip("optuna")

from ai.sweep.plan import Point
from ai.sweep.search import JOURNAL, LEAST, Proposals
from ai.sweep.study import FinishedTrial, SeedResult, Study
from tests.support.studies import tiny_plan


def finished(number, params, value, at=400, curve=()):
    seeds = tuple(SeedResult(seed, tuple(curve), value, "", 1.0, {}) for seed in (0, 1))
    return FinishedTrial(number, params, value, at, False, 1.0, seeds)


@pytest.fixture
def study(tmp_path):
    """A study with a finished trial and two that are under way."""
    study = Study.create(tmp_path / "study", tiny_plan(trials=9))
    search = Proposals(study)
    for _ in range(3):
        study.begin(search.next())
    trial = finished(0, study.under_way[0].params, 5.0)
    study.record(trial, {})
    search.tell(trial)
    return study


def test_what_was_under_way_goes_on_with_its_settings(study):
    kept = [study.under_way[number] for number in (1, 2)]
    for _ in range(2):
        again = Study.load(study.folder)
        search = Proposals(again)
        assert [search.next(), search.next()] == kept
        new = search.next()
        assert new.number == 3
        again.plan.check_params(new.params)


def test_a_study_that_goes_on_proposes_nothing_twice(study):
    again = Study.load(study.folder)
    search, asked = Proposals(again), [study.trials[0].params]
    for number in range(1, 9):
        trial = search.next()
        assert trial.number == number
        again.begin(trial)
        asked.append(trial.params)
        if number % 2:  # it ends before the next one begins
            again.record(finished(number, trial.params, 1.0), {})
            search.tell(again.trials[number])
    assert search.next() is None, "nine trials in all"
    assert len({json.dumps(params) for params in asked}) == 9


def test_a_trial_that_was_kept_or_is_damaged_is_not_run_again(study):
    study.record(finished(1, study.under_way[1].params, 7.0), {})
    study.trial_folder(2).mkdir()
    again = Study.load(study.folder)
    assert (sorted(again.trials), again.damaged, again.under_way) == ([0, 1], [2], {})
    search = Proposals(again)
    assert search.next().number == 3
    assert [row.value for row in search._optuna.trials[:2]] == [5.0, 7.0]


def test_what_a_file_says_of_trials_under_way_is_checked(study):
    file = study.folder / "study.json"
    saved = json.loads(file.read_text())
    sound = saved["under_way"][0]
    for name, change in {
        "another knob": {"params": sound["params"] | {"env": "evil:X-v0"}},
        "a knob less": {"params": {"tau": 0.1}},
        "out of the range": {"params": sound["params"] | {"tau": 5.0}},
        "a text": {"params": sound["params"] | {"tau": "0.1"}},
    }.items():
        file.write_text(json.dumps(saved | {"under_way": [sound | change]}))
        assert Study.load(study.folder).under_way == {}, name
    file.write_text(json.dumps(saved | {"under_way": [sound | {"number": -1}]}))
    with pytest.raises(ValueError, match="number"):
        Study.load(study.folder)


def test_a_trial_that_falls_behind_is_ended_also_when_the_study_goes_on(tmp_path):
    study = Study.create(tmp_path / "study", tiny_plan(trials=9, stop_early=True, budget=1800, every=200))
    search, ended = Proposals(study), []
    for value in (1.0, 9.0, 8.0, 0.5, 0.4, 10.0):
        asked = search.next()
        trial = finished(asked.number, asked.params, value, at=200, curve=[Point(200, None, value)])
        ended.append(search.falls_behind(trial))
        if later := {9.0: 9.0, 10.0: -9.0}.get(value):
            assert not search.falls_behind(replace(trial, value=later, at=400)), "only at powers of three"
        study.record(trial, {})
        search.tell(trial)
    assert ended == [False, False, True, True, True, False]
    again = Proposals(Study.load(study.folder))
    asked = again.next()
    assert again.falls_behind(finished(asked.number, asked.params, 7.0, at=200))
    asked = again.next()
    assert not again.falls_behind(finished(asked.number, asked.params, 11.0, at=200))
    study.plan = replace(study.plan, stop_early=False)
    plain = Proposals(study)
    asked = plain.next()
    assert not plain.falls_behind(finished(asked.number, asked.params, -9.0))


def test_the_knob_that_decides_matters_most_and_too_few_trials_say_nothing(tmp_path):
    for count, value_of, best in (
        (LEAST - 1, lambda params: params["tau"], None),
        (40, lambda params: params["tau"], "tau"),
        (LEAST, lambda params: 1.0, None),
    ):
        study = Study.create(tmp_path / f"{count}", tiny_plan(trials=count, search="random"))
        search = Proposals(study)
        while asked := search.next():
            trial = finished(asked.number, asked.params, value_of(asked.params))
            study.trials[asked.number] = trial
            search.tell(trial)
        shares = search.importance()
        assert next(iter(shares), None) == best, count
        assert sum(shares.values()) == pytest.approx(1.0 if best else 0.0)


def test_optunas_own_tools_read_the_journal_and_we_do_not(study):
    import optuna

    journal = study.folder / JOURNAL
    journal.write_text('{"op_code": 99}\nno line of a journal')
    Proposals(Study.load(study.folder)).next()
    storage = optuna.storages.JournalStorage(optuna.storages.journal.JournalFileBackend(str(journal)))
    done, begun = optuna.load_study(study_name=study.folder.name, storage=storage).trials
    assert (done.value, begun.state.name) == (5.0, "RUNNING")
    assert done.params["tau"] == study.trials[0].params["tau"]


# The driver, on a stand-in for Ray


def test_a_lost_worker_goes_on_from_its_checkpoint_and_is_given_up_after_some_tries(tmp_path, monkeypatch):
    driver, begun = pytest.importorskip("ai.sweep.driver"), []
    kept = finished(0, {}, 1.0, at=200), {"a": b"1"}

    def worker(code, plan, asked, source, runs, checkpoint):
        begun.append((source, runs))
        yield from [(*kept, False), (finished(0, {}, 1.0, at=300), {}, False)]
        raise driver.RayError("it died")

    monkeypatch.setattr("ray.remote", lambda **_: lambda _: SimpleNamespace(remote=worker))
    monkeypatch.setattr("ray.wait", lambda jobs, timeout: (jobs, []))
    monkeypatch.setattr("ray.get", lambda result: result)
    runner = driver.Driver(Study.create(tmp_path / "study", tiny_plan(trials=1)), 1, print, lambda: None)
    runner.run([])
    assert begun == [(None, {}), *[kept] * (driver.TRIES - 1)]
    assert runner.lost == {0: "it died"}
