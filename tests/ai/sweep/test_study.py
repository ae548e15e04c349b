"""Studies on disk: whole trials only, whatever happens, and the same result alone as in a study."""

import json
import os
import shutil
from dataclasses import asdict, replace

import numpy as np
import pytest

from ai.agent.storage import LAST
from ai.digits.config import DIGIT_PRESETS
from ai.digits.training import DigitTraining
from ai.files import read_arrays, read_as
from ai.sweep.plan import Plan, knob_space
from ai.sweep.report import table
from ai.sweep.study import Asked, FinishedTrial, Study, StudyError, write_files
from ai.sweep.trial import Trial
from ai.training.config import PRESETS
from ai.training.run import save
from ai.training.tasks import LanderTask
from main import main
from tests.support.studies import TINY, finished_study, networks_in, run_alone, tiny_plan


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return finished_study(tmp_path_factory.mktemp("studies") / "made")


@pytest.fixture
def study(made, tmp_path):
    """A copy that a test may damage."""
    shutil.copytree(made.folder, tmp_path / "made")
    return Study.load(tmp_path / "made")


def digits_plan(config, epochs):
    plan = Plan.of(config, knob_space(config, ["learning_rate"]), every=1, search="random", trials=1)
    assert plan.budget == epochs
    return replace(plan, seeds=(3,))


def optimizer_of(folder):
    return read_arrays(folder / LAST / "optimizer.npz", 10_000_000, lambda *_: None)


@pytest.mark.slow
def test_a_trials_run_is_that_of_train_bit_for_bit(made, tmp_path):
    changes = [f"{name}={list(value) if isinstance(value, tuple) else value}" for name, value in TINY.items()]
    changes += ["learning_rate=0.002", "tau=0.02"]
    sets = [part for change in changes for part in ("--set", change)]
    command = ["train", "--env", "CartPole-v1", "--decisions", "400", "--validation", "5", "--seed", "1", *sets]
    assert main([*command, "--output", str(tmp_path / "alone")]) == 0
    swept = made.run_folder(made.trials[1], 1)
    assert networks_in(tmp_path / "alone") == networks_in(swept)
    assert "online/layer-0-weights.npy" in networks_in(swept)
    ours, alone = optimizer_of(swept), optimizer_of(tmp_path / "alone")
    assert all(np.array_equal(ours[name], alone[name]) for name in ours | alone)


def test_a_study_reads_what_it_wrote(study, made):
    assert study.trials == made.trials
    assert study.plan == made.plan
    assert study.damaged == []
    summary = json.loads((study.folder / "study.json").read_text())
    best = study.best()
    assert summary["run"] == f"trials/{best.number:04}/seed-{best.best_seed.seed}"
    assert (study.folder / summary["run"] / "online").is_dir()


def test_a_full_disk_keeps_no_half_of_a_trial_and_the_next_record_succeeds(study, made, monkeypatch):
    result = replace(made.trials[0], number=2)

    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("ai.sweep.study.write_text", full)  # the runs have been written then
    with pytest.raises(OSError, match="No space"):
        study.record(result, {"seed-0/config.json": b"{}"})
    monkeypatch.undo()
    assert sorted(study.trials) == [0, 1]
    assert sorted(path.name for path in (study.folder / "trials").iterdir()) == ["0000", "0001"]
    study.record(result, {})
    assert Study.load(study.folder).trials[2] == result


def test_what_a_kill_leaves_half_written_is_no_trial_and_is_cleared_away(study):
    half = study.folder / "trials" / ".0002.0123abcd.new"
    half.mkdir()
    (half / "trial.json").write_text("{")
    os.utime(half, (1e9, 1e9))
    assert sorted(Study.load(study.folder).trials) == [0, 1]
    with study.claimed():
        assert not half.exists()
        with pytest.raises(BlockingIOError), Study.load(study.folder).claimed():
            pass


def test_a_damaged_trial_is_named_and_the_others_are_read_and_a_damaged_study_is_refused(study):
    whole = (study.folder / "study.json").read_bytes()
    for content in (b"", b"{}", b"[1]", b"\xff\xfe", b'{"number": 0}', b"[" * 5000):
        (study.trial_folder(0) / "trial.json").write_bytes(content)
        left = Study.load(study.folder)
        assert (left.damaged, sorted(left.trials)) == ([0], [1]), content[:20]
        assert "cannot be read: 0" in table(left)
        (study.folder / "study.json").write_bytes(content)
        with pytest.raises(StudyError, match="no study"):
            Study.load(study.folder)
        (study.folder / "study.json").write_bytes(whole)
    (study.folder / "study.json").write_text(json.dumps(json.loads(whole) | {"version": 1}))
    with pytest.raises(StudyError, match="version 1"):
        Study.load(study.folder)
    with pytest.raises(StudyError, match="--resume"):
        Study.create(study.folder, study.plan)


def test_settings_that_diverge_are_a_result_and_not_an_error(tmp_path, monkeypatch):
    def diverge(*_):
        raise FloatingPointError("the loss is not finite")

    monkeypatch.setattr("ai.sweep.trial.trained_to", diverge)
    plan = tiny_plan(metric="success", seeds=(0,))
    trial = Trial(plan, Asked(0, {"learning_rate": 0.1, "tau": 1.0}))
    trial.step()
    assert trial.done
    result, runs = trial.finish()
    assert (result.value, result.seeds[0].problem) == (0.0, "the loss is not finite")
    study = Study.create(tmp_path / "study", plan)
    study.record(result, runs)
    assert Study.load(study.folder).trials[0] == result


def test_a_trial_that_goes_on_from_a_checkpoint_ends_as_long_and_says_so():
    plan, asked = tiny_plan(every=100), Asked(0, {"learning_rate": 0.01, "tau": 0.1})
    trial = Trial(plan, asked)
    trial.step()
    trial.step()
    so_far, runs = trial.result(), trial.checkpoint()
    again = Trial(plan, asked, so_far, runs)
    assert (again.at, again.result().seeds[0].curve) == (200, so_far.seeds[0].curve)
    while not again.done:
        again.step()
    result, runs = again.finish()
    assert [[point.at for point in seed.curve] for seed in result.seeds] == [[100, 200, 300, 400]] * 2
    assert (result.restarts, result.parent, result.seeds[0].curve[:2]) == (1, None, so_far.seeds[0].curve)
    assert result.seconds >= so_far.seconds
    assert read_as(FinishedTrial, json.loads(json.dumps(asdict(result)))) == result


def test_a_killed_trial_of_the_lander_goes_on_bit_for_bit(tmp_path, monkeypatch):
    monkeypatch.setattr(LanderTask, "test_episodes", 2)
    settings = PRESETS["modern"].changed(**TINY, spawn="random")
    plan = tiny_plan(settings=json.loads(json.dumps(settings.to_json())), seeds=(0,), metric="success")
    asked = Asked(0, {"learning_rate": 0.01, "tau": 0.1})
    trial = Trial(plan, asked)
    trial.step()
    again = Trial(plan, asked, trial.result(), trial.checkpoint())
    again.step()
    write_files(again.finish()[1], tmp_path / "again")
    write_files(run_alone(plan, asked)[1], tmp_path / "straight")
    assert networks_in(tmp_path / "again") == networks_in(tmp_path / "straight")


def test_a_trial_of_digits_goes_on_from_a_checkpoint_as_if_nothing_had_been(tmp_path, monkeypatch):
    drawn = np.random.default_rng(0)
    part = drawn.random((600, 28, 28), np.float32), drawn.integers(10, size=600).astype(np.uint8)
    monkeypatch.setattr("ai.digits.training.load_part", lambda _: part)
    config = DIGIT_PRESETS["classic"].changed(hidden=(8,), batch_size=50, epochs=2, augmentation=0.0, held_out=100)
    plan = digits_plan(config, 2)
    asked = Asked(0, {"learning_rate": 0.01})
    straight, expected = run_alone(plan, asked)
    trial = Trial(plan, asked)
    trial.step()
    again = Trial(plan, asked, trial.result(), trial.checkpoint())
    again.step()
    result, runs = again.finish()
    write_files(expected, tmp_path / "straight")
    write_files(runs, tmp_path / "again")
    ours, uninterrupted = (networks_in(tmp_path / name) for name in ("again", "straight"))
    assert [name for name in uninterrupted if name.endswith(".npy") and ours[name] != uninterrupted[name]] == []
    assert result.value == straight.value


def test_a_trial_of_other_seeds_or_with_a_value_out_of_nowhere_is_damaged(study):
    file = study.trial_folder(0) / "trial.json"
    sound = json.loads(file.read_text())
    one, two = sound["seeds"]
    for name, change in {
        "another knob": {"params": sound["params"] | {"env": "evil:X-v0"}},
        "no seeds": {"seeds": []},
        "one seed": {"seeds": [one]},
        "seeds in another order": {"seeds": [two, one]},
        "a seed without a value": {"seeds": [one, two | {"value": None}]},
    }.items():
        file.write_text(json.dumps(sound | change))
        assert Study.load(study.folder).damaged == [0], name


def test_the_runs_of_a_trial_are_sent_without_anything_that_is_no_run(study, tmp_path):
    """A link to a secret, a pipe and 30 GB of nothing, each instead of a file of the run and beside it."""
    (tmp_path / "secret").write_text("a secret")
    run = study.trial_folder(0) / "seed-1"
    trial = study.trials[0]
    assert study.runs_of(trial)

    def large(path):
        with path.open("wb") as file:
            file.truncate(30 << 30)

    for name in ("training.json", "more"):
        for put in (lambda path: path.symlink_to(tmp_path / "secret"), os.mkfifo, large):
            path, kept = run / name, (run / name).read_bytes() if (run / name).exists() else None
            path.unlink(missing_ok=True)
            put(path)
            with pytest.raises(OSError, match=r"link|ordinary|larger|else"):
                study.runs_of(trial)
            path.unlink()
            if kept is not None:
                path.write_bytes(kept)


@pytest.mark.slow
def test_a_trial_of_digits_is_that_of_train_digits(tmp_path):
    config = DIGIT_PRESETS["classic"].changed(hidden=(8,), batch_size=5000, epochs=1, augmentation=0.0)
    plan = digits_plan(config, 1)
    result, runs = run_alone(plan, Asked(0, {"learning_rate": 0.01}))
    training = DigitTraining(config.changed(learning_rate=0.01), 3)
    while not training.done:
        training.advance()
    save(training, tmp_path / "alone", final=True)
    write_files(runs, tmp_path / "swept")
    assert networks_in(tmp_path / "alone") == networks_in(tmp_path / "swept" / "seed-3")
    assert result.value == training.best
    assert result.best_seed.figures["test"] > 0.1
