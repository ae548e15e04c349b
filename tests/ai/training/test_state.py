"""A run that goes on has learnt what it had learnt, remembers it, and lands as well; what becomes of damaged states."""

import json
from importlib.util import find_spec

import numpy as np
import pytest

from ai.environment import finished
from ai.files.folder import STATE_FILE
from ai.nn import ModelFormatError
from ai.training import state as states
from ai.training.config import ANYWHERE, PRESETS, Config, gym_config
from ai.training.loop import Training
from ai.training.run import Keeper, Limit, resume, save
from ai.training.statistics import wilson
from ai.training.tasks import TEST_SEED, flights

SMALL = PRESETS["modern"].changed(
    hidden=(8,), batch_size=16, gradient_steps=1, learning_starts=32, replay_size=500, num_envs=8, spawn="near"
)
CLASSIC = PRESETS["classic"].changed(
    hidden=(8,), batch_size=8, replay_size=120, replay_prune=40, learning_starts=16, success_batch_size=4
)
RUNS = {
    "modern": SMALL.changed(spawn="widening"),
    "classic": CLASSIC,
    "prioritised": SMALL.changed(prioritised=True),
    "successes": SMALL.changed(success_pass=True, normalise_inputs=True),
    "one lander": SMALL.changed(num_envs=1, spawn="curriculum"),
    "anywhere": Config(env=ANYWHERE, hidden=(8,), num_envs=6, batch_size=16, gradient_steps=1, learning_starts=32),
}
if find_spec("gymnasium"):
    RUNS["gymnasium"] = gym_config("CartPole-v1").changed(learning_starts=64, num_envs=3, hidden=(8,))


def begun(config):
    return Training(config, 5, evaluate_every=0, validation_episodes=4)


def on(training, turns):
    training.clock = lambda: 0.0  # the time that it takes says nothing of what it knows
    for _ in range(turns):
        training.advance()
    return training


def resumed(folder):
    training = resume(Training, folder)
    training.evaluate_every, training.validation_episodes = 0, 4
    return training


def known(training):
    """What a run has learnt and remembers, each as bytes or as JSON has it, by name."""
    agent = training.agent
    arrays = {"online": agent.online.values, "target": agent.target.values, **agent.optimizer.state()}
    for name, buffer in training.buffers.items():
        arrays |= {f"{name}.{part}": array for part, array in buffer.state(buffer.capacity).items()}
    counts = {"decisions": agent.decisions, "steps": agent.gradient_steps, "episodes": training.episodes}
    counts |= {"landings": training.env.landings, "seconds": round(training.seconds, 3)}
    chance = {"rng": agent.rng.bit_generator.state, "scale": agent.normalizer and agent.normalizer.to_json()}
    return {name: np.asarray(array).tobytes() for name, array in arrays.items()} | counts | chance


def test_a_run_that_goes_on_knows_what_it_knew_and_begins_new_flights(tmp_path, subtests):
    for name, config in RUNS.items():
        with subtests.test(name):
            training = on(begun(config), 70)
            assert training.agent.gradient_steps > 0
            save(training, tmp_path / name)
            one, other = resumed(tmp_path / name), resumed(tmp_path / name)
            assert one.lost == ""
            assert known(one) == known(training)
            assert not np.array_equal(one.observation, training.observation), "its flights are new"
            assert known(on(one, 5)) == known(on(other, 5)), "and follow from the seed and the moment"
            assert one.agent.gradient_steps > training.agent.gradient_steps, "it learns at once"


def test_of_what_is_too_large_the_newest_is_kept(tmp_path, monkeypatch, subtests):
    monkeypatch.setattr(states, "MOST", 20_000)
    monkeypatch.setattr("ai.training.loop.MOST", 20_000)
    for prioritised in (False, True):
        with subtests.test(prioritised=prioritised):
            training = on(begun(SMALL.changed(prioritised=prioritised)), 60)
            save(training, tmp_path / "run")
            again, before = resumed(tmp_path / "run"), training.agent.replay.state(500)
            kept = again.agent.replay.state(500)
            count = len(kept["action"])
            assert 0 < count < len(before["action"])
            assert all(np.array_equal(before[name][-count:], part) for name, part in kept.items())
            assert (tmp_path / "run" / STATE_FILE).stat().st_size < 30_000
            on(again, 3)


def test_damage_is_named_with_the_way_out_wherever_it_is(tmp_path):
    save(on(begun(SMALL.changed(prioritised=True)), 50), tmp_path / "run")
    rng, refused = np.random.default_rng(0), list[str]()
    path = tmp_path / "run" / STATE_FILE
    whole = path.read_bytes()
    for number in range(30):
        damaged = bytearray(whole)
        at = int(rng.integers(len(whole)))
        if number % 2:
            del damaged[at:]
        else:
            damaged[at : at + 8] = rng.bytes(8)
        path.write_bytes(damaged)
        try:  # some numbers are as good as others
            resume(Training, tmp_path / "run")
        except ModelFormatError as error:
            refused.append(str(error))
    assert len(refused) > 15
    assert [problem for problem in refused if "without which the run goes on" not in problem] == []
    path.unlink()
    assert "empty memory" in resume(Training, tmp_path / "run").lost


def test_numbers_that_no_run_can_have_had_are_refused(tmp_path, subtests):
    training = on(begun(SMALL.changed(prioritised=True)), 30)
    changes = {
        "action": lambda state: state["replay.action"].fill(6),
        "reward": lambda state: state["replay.reward"].fill(np.nan),
        "features": lambda state: state.update({"replay.state": state["replay.next_state"][:, :3]}),
        "count": lambda state: state.update({"replay.steps": state["replay.steps"][:3]}),
        "more than it holds": lambda state: state.update(
            {name: np.repeat(part, 4, axis=0) for name, part in state.items() if name != "rng"}
        ),
        "priorities": lambda state: state["replay.priorities"].fill(0.0),
        "generator": lambda state: state["rng"].update(bit_generator="MT19937"),
        "no generator": lambda state: state.update(rng=None),
    }
    for name, change in changes.items():
        with subtests.test(name), pytest.MonkeyPatch.context() as patch:
            state = training.state()
            change(state)
            patch.setattr(training, "state", lambda state=state: state)
            save(training, tmp_path / "run")
            with pytest.raises(ModelFormatError, match="without which"):
                resume(Training, tmp_path / "run")


def test_a_state_of_another_version_is_refused_by_name_and_left(tmp_path):
    save(on(begun(SMALL), 20), tmp_path / "run")
    path = tmp_path / "run" / STATE_FILE
    for said in ({}, {"version": 1}, {"version": 3, "more": 4}, []):
        np.savez(path, described=np.frombuffer(json.dumps(said).encode(), np.uint8))
        held = path.read_bytes()
        with pytest.raises(ModelFormatError, match=rf"{path.name}, .*: was saved by another version"):
            resume(Training, tmp_path / "run")
        assert path.read_bytes() == held


def test_a_process_that_is_killed_between_two_files_leaves_a_run_of_one_moment(tmp_path, monkeypatch):
    training = on(begun(SMALL), 20)
    keeper = Keeper(training, tmp_path / "run")
    assert keeper.save(tmp_path / "run").problem == ""
    before = known(resume(Training, tmp_path / "run"))

    def killed(*_):
        raise OSError(5, "killed")

    on(training, 5)
    with monkeypatch.context() as patch:
        patch.setattr("ai.training.run.write_state", killed)
        assert keeper.save(tmp_path / "run").problem == "killed"
    assert known(resume(Training, tmp_path / "run")) == before
    assert keeper.save(tmp_path / "run").problem == ""
    assert known(resume(Training, tmp_path / "run")) == known(training)
    keeper.end()


def test_a_run_that_has_diverged_leaves_no_state(tmp_path):
    training = on(begun(SMALL), 20)
    save(training, tmp_path / "run")
    assert (tmp_path / "run" / STATE_FILE).exists()
    training.restore_best()
    save(training, tmp_path / "run")
    assert not (tmp_path / "run" / STATE_FILE).exists()


DECISIONS = 300_000  # a third is many flights of each lander: a stop costs those under way


def landed(seed, stops, folder):
    """Share of 2,000 test starts that the best network lands of a run with stops on its way."""
    training = Training(PRESETS["modern"], seed, evaluate_every=20_000)
    for stop in (*stops, DECISIONS):
        for _ in Limit(moment=stop).run(training):
            pass
        if stop != DECISIONS:
            save(training, folder)
            training = resume(Training, folder)
            training.evaluate_every = 20_000
    return finished(flights(training.best_agent(), 2000, TEST_SEED)).success


@pytest.mark.slow
def test_runs_stopped_at_a_third_and_at_two_thirds_land_as_well_as_straight_ones(tmp_path):
    straight = [landed(seed, (), tmp_path / "run") for seed in range(3)]
    stopped = [landed(seed, (DECISIONS // 3, 2 * DECISIONS // 3), tmp_path / "run") for seed in range(3)]
    said = f"straight: {straight}, stopped: {stopped}"
    assert wilson(min(stopped), 2000)[1] >= min(straight), said  # as far as so many flights can tell them apart
