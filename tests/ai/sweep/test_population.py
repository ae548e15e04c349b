"""Populations: what a member is asked follows from the generation before it, and from nothing else."""

import numpy as np
import pytest

pytest.importorskip("optuna")

from ai.sweep.plan import Dimension
from ai.sweep.search import explored, proposed
from ai.sweep.study import FinishedTrial, SeedResult, Study, write_files
from ai.training.loop import Training
from ai.training.run import resume, save
from tests.support.studies import networks_in, run_alone, tiny_plan


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """A population of four whose second generation has begun."""
    plan = tiny_plan(search="population", population=4, trials=8, seeds=(0,), budget=400, every=200)
    study = Study.create(tmp_path_factory.mktemp("studies") / "population", plan)
    for number in range(4):
        assert proposed(study, 4) is None, "the second generation waits for the last member of the first"
        study.record(*run_alone(plan, proposed(study, number)))
    return study


def test_the_worst_goes_on_with_a_copy_of_the_best_and_the_others_with_their_own(study):
    ranked = sorted(study.trials.values(), key=lambda trial: -trial.value)
    asked = {number: proposed(study, number) for number in range(4, 8)}
    worst = asked[4 + ranked[-1].number]
    assert worst.parent == ranked[0].number
    assert worst.params != ranked[0].params
    for trial in ranked[:-1]:
        assert (asked[4 + trial.number].parent, asked[4 + trial.number].params) == (trial.number, trial.params)


def test_what_is_asked_does_not_depend_on_when_it_is_asked(study):
    again = Study.load(study.folder)
    assert [proposed(again, number) for number in (6, 4)] == [proposed(study, number) for number in (6, 4)]


def test_a_copy_begins_with_the_networks_of_its_parent_and_goes_on_as_train_does(study, tmp_path):
    asked = proposed(study, 4)
    parent = study.trials[asked.parent]
    result, runs = run_alone(study.plan, asked, parent, study.runs_of(parent))
    assert result.parent == asked.parent
    assert [point.at for point in result.seeds[0].curve] == [200, 400]
    training = resume(Training, study.run_folder(parent, 0))
    assert not training.lost, "it has its whole state"
    training.validation_episodes = study.plan.validation
    training.apply_live(training.config.changed(**asked.params))
    while training.agent.decisions < 400:
        training.advance()
    save(training, tmp_path / "alone", final=True, state=False)
    write_files(runs, tmp_path / "swept")
    assert networks_in(tmp_path / "alone") == networks_in(tmp_path / "swept" / "seed-0")


def test_the_best_is_of_the_last_generation_that_is_whole_and_states_are_kept_until_then(tmp_path):
    plan = tiny_plan(search="population", population=2, trials=4, seeds=(0,))
    study = Study.create(tmp_path / "study", plan)
    values = [9.0, 8.0, 7.0, 6.0]
    for number, (value, best, states) in enumerate(zip(values, (0, 0, 0, 2), (1, 2, 3, 2), strict=True)):
        seed = SeedResult(0, (), value, "", 1.0, {})
        runs = {"seed-0/config.json": b"{}", ".seed-0.state/blocks": b"all"}
        study.record(FinishedTrial(number, {}, value, 400, False, 1.0, (seed,)), runs)
        assert study.best().number == best, number
        assert len([*study.folder.glob("trials/*/.seed-0.state")]) == states, number


def test_a_changed_knob_stays_in_its_range():
    space = tiny_plan().space
    rng = np.random.default_rng(0)
    for _ in range(200):
        params = {name: each.draw(rng) for name, each in space.items()}
        for name, value in explored(params, space, rng).items():
            assert space[name].low <= value <= space[name].high


def test_a_population_changes_only_what_can_change_while_a_run_goes_on():
    space = {"n_step": Dimension(1, 5, whole=True)}
    with pytest.raises(ValueError, match="n_step cannot change"):
        tiny_plan(search="population", population=2, space=space).check()
