"""Optuna's journal of a study: what it proposes, what it goes on with, and what a stranger's may say."""

import json
from dataclasses import replace

import pytest

pytest.importorskip("optuna")

from ai.sweep.search import JOURNAL, LEAST, Search
from ai.sweep.study import FinishedTrial, SeedResult, Study, StudyError
from tests.support.studies import tiny_plan


def finished(number, params, value, at=400):
    seeds = tuple(SeedResult(seed, (), value, "", 1.0, {}) for seed in (0, 1))
    return FinishedTrial(number, params, value, at, False, 1.0, seeds)


@pytest.fixture
def study(tmp_path):
    """A study with a finished trial and two that are under way."""
    study = Study.create(tmp_path / "study", tiny_plan(trials=9))
    search = Search(study)
    for _ in range(3):
        search.next()
    search.tell(finished(0, search.params(0), 5.0))
    study.record(finished(0, search.params(0), 5.0), {})
    return study


def again(study):
    return Search(Study.load(study.folder))


def test_what_was_under_way_goes_on_with_its_settings(study):
    first, second = again(study), again(study)
    assert first.left == second.left == [1, 2]
    assert {number: first.params(number) for number in (1, 2)} == {number: second.params(number) for number in (1, 2)}
    assert [second.next().number for _ in range(3)] == [1, 2, 3]
    space = study.plan.space
    assert all(space[name].low <= value <= space[name].high for name, value in second.params(3).items())


def test_a_trial_that_was_kept_and_not_told_is_not_run_again(study):
    search = again(study)
    study.record(finished(1, search.params(1), 7.0), {})
    assert again(study).left == [2]
    assert [row.value for row in again(study)._optuna.trials[:2]] == [5.0, 7.0]


def test_a_study_that_goes_on_proposes_nothing_twice(study):
    search = again(study)
    asked = [search.params(number) for number in (0, 1, 2)] + [search.next().params for _ in range(6)][2:]
    assert len({json.dumps(params) for params in asked}) == 7


def test_a_trial_cut_off_before_all_its_knobs_were_drawn_is_run_all_the_same(study):
    file, settings = study.folder / JOURNAL, again(study).params(2)
    lines = file.read_text().splitlines()
    last = max(index for index, line in enumerate(lines) if json.loads(line)["op_code"] == 5)
    file.write_text("".join(f"{line}\n" for line in lines[:last]))
    search = again(study)
    cut = search.params(2)
    assert search.left == [1, 2]
    assert [cut[name] == value for name, value in settings.items()].count(True) == 1
    assert again(study).params(2) == cut


def test_a_line_cut_off_by_a_kill_is_left_out(study):
    file = study.folder / JOURNAL
    whole = file.read_text()
    for cut in (1, 40):
        file.write_text(whole + whole.splitlines()[-1][:-cut])
        assert again(study).left == [1, 2]
        assert again(study).left == [1, 2], "what was appended meanwhile can be read"
        assert file.read_text().startswith(whole)


def test_a_full_disk_leaves_no_half_of_a_line(study, monkeypatch):
    search, before = again(study), (study.folder / JOURNAL).read_text()
    search.left = []
    journal = search._optuna._storage._backend
    monkeypatch.setattr(type(journal), "_path", property(lambda self: Full(study.folder / JOURNAL)), raising=False)
    with pytest.raises(OSError, match="No space"):
        search.next()
    monkeypatch.undo()
    assert (study.folder / JOURNAL).read_text() == before
    assert search.next().number == 3


class Full:
    """A file on a disk that takes half of what is written."""

    def __init__(self, path):
        self._path = path

    def open(self, mode):
        file = self._path.open(mode)

        class Half:
            def __enter__(self):
                return self

            def __exit__(self, *_):
                file.close()

            tell, truncate, flush = file.tell, file.truncate, file.flush

            def write(self, content):
                file.write(content[: len(content) // 2])
                file.flush()
                raise OSError(28, "No space left on device")

        return Half()


def test_a_strangers_journal_is_refused_in_a_sentence(study, subtests):
    file = study.folder / JOURNAL
    sound = file.read_text()
    lines = [json.loads(line) for line in sound.splitlines()]
    setting = next(line for line in lines if line["op_code"] == 5)
    for name, line in {
        "no JSON": "{",
        "a list": "[]",
        "nested": "[" * 5000,
        "another operation": json.dumps(lines[1] | {"op_code": 1}),
        "an unknown word": json.dumps(lines[1] | {"py/object": "os.system"}),
        "another study": json.dumps(lines[1] | {"study_id": 3}),
        "a long one": json.dumps(setting | {"param_name": "x" * 101}),
    }.items():
        with subtests.test(name=name):
            file.write_text(f"{sound}{line}\n")
            with pytest.raises(StudyError, match="cannot be read"):
                again(study)
    file.write_text(f"{sound}{json.dumps(setting | {'trial_id': 77})}\n")
    assert again(study).left == [1, 2], "settings of no trial are passed over"
    file.write_text("")
    with pytest.raises(StudyError, match="does not know trial 0"):
        again(study)
    with file.open("wb") as large:
        large.truncate(30 << 30)
    with pytest.raises(OSError, match=r"large"):
        again(study)


def test_settings_out_of_the_space_are_not_run(study):
    file = study.folder / JOURNAL
    lines = [json.loads(line) for line in file.read_text().splitlines()]
    for line in lines:
        if line["op_code"] == 5 and line["trial_id"] == 2 and line["param_name"] == "tau":
            lines.append(line | {"param_name": "env"})
            break
    file.write_text("".join(json.dumps(line) + "\n" for line in lines))
    assert again(study).left == [1]


def test_a_trial_that_falls_behind_is_ended(tmp_path):
    study = Study.create(tmp_path / "study", tiny_plan(trials=9, stop_early=True, budget=1800, every=200))
    search = Search(study)
    ended = []
    for value in (1.0, 9.0, 8.0, 0.5, 0.4, 10.0):
        asked = search.next()
        ended.append(search.falls_behind(finished(asked.number, asked.params, value, at=200)))
    assert ended == [False, False, True, True, True, False]
    plain = replace(study.plan, stop_early=False)
    study.plan = plain
    assert not search.falls_behind(finished(0, search.params(0), -9.0, at=400))


def test_the_knob_that_decides_matters_most_and_too_few_trials_say_nothing(tmp_path):
    for count, value_of, best in (
        (LEAST - 1, lambda params: params["tau"], None),
        (40, lambda params: params["tau"], "tau"),
        (LEAST, lambda params: 1.0, None),
    ):
        study = Study.create(tmp_path / f"{count}", tiny_plan(trials=count, search="random"))
        search = Search(study)
        while asked := search.next():
            trial = finished(asked.number, asked.params, value_of(asked.params))
            study.trials[asked.number] = trial
            search.tell(trial)
        shares = search.importance()
        assert next(iter(shares), None) == best, count
        assert sum(shares.values()) == pytest.approx(1.0 if best else 0.0)
