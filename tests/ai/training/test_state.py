"""A run that goes on from its state is the run that never stopped, bit for bit; and what becomes of damaged states."""

from importlib.util import find_spec

import numpy as np
import pytest

from ai.files import move_state, remove_state, state_folder
from ai.nn import ModelFormatError
from ai.training import state as states
from ai.training.config import ANYWHERE, PRESETS, Config, gym_config
from ai.training.loop import Training
from ai.training.run import Keeper, resume, save
from ai.training.tasks import LanderTask

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
TURNS = 70


def begun(config):
    return Training(config, 5, evaluate_every=0, validation_episodes=4)


def on(training, turns):
    for _ in range(turns):
        training.advance()
    return training


def gone_on(training, folder):
    save(training, folder)
    resumed = resume(Training, folder, env=training.config.env)
    resumed.evaluate_every, resumed.validation_episodes = 0, 4
    return resumed


def flat(value, path=""):
    """All leaves of a tree by their places."""
    if isinstance(value, dict):
        return {place: leaf for name in value for place, leaf in flat(value[name], f"{path}/{name}").items()}
    return {path: value.tobytes() if isinstance(value, np.ndarray) else value}


def differing(one, other):
    """Names of what differs between two runs, memories included, but for the time that they took."""
    found = []
    for part in (Training.state, lambda run: {name: buffer.size for name, buffer in run.buffers.items()}):
        first, second = (flat(part(run)) for run in (one, other))
        found += [place for place in first | second if place != "/seconds" and first.get(place) != second.get(place)]
    for name, buffer in one.buffers.items():
        rows = (buffer.start + np.arange(buffer.size)) % buffer.capacity
        again = other.buffers[name]
        alike = [np.array_equal(*pair) for pair in zip(buffer.at(rows), again.at(rows), strict=True)]
        found += [name] * (not all(alike) or (buffer.start, buffer.added) != (again.start, again.added))
    return found


def test_stopped_and_gone_on_with_at_any_point_it_is_the_straight_run(tmp_path, subtests, monkeypatch):
    monkeypatch.setattr(states, "BLOCK", 64)
    for name, config in RUNS.items():
        with subtests.test(name):
            straight, pieces, at = on(begun(config), TURNS), begun(config), 0
            for stop in (1, 40, 41, TURNS):
                pieces, at = gone_on(on(pieces, stop - at), tmp_path / name), stop
                assert pieces.lost == ""
            assert straight.agent.gradient_steps > 0
            assert differing(straight, pieces) == []
            assert differing(on(straight, 3), on(pieces, 3)) == [], "and so they go on"


def test_the_measurement_at_an_end_changes_nothing_of_a_run_that_goes_on(tmp_path, monkeypatch):
    monkeypatch.setattr(LanderTask, "test_episodes", 4)
    straight, stopped = on(begun(SMALL), 60), on(begun(SMALL), 30)
    save(stopped, tmp_path / "run", final=True)
    assert stopped.best is not None
    resumed = resume(Training, tmp_path / "run")
    assert resumed.best is None
    resumed.evaluate_every = 0
    assert differing(straight, on(resumed, 30)) == []


def test_a_validation_under_way_goes_on_with_its_run_and_is_of_the_same_network(tmp_path, monkeypatch):
    monkeypatch.setattr(LanderTask, "validation_episodes", 4)
    straight, stopped = begun(SMALL), begun(SMALL)
    for training in (straight, stopped):
        training.evaluate_every, training.validation_pace = 160, 1
    on(straight, 25)
    resumed = gone_on(on(stopped, 23), tmp_path / "run")
    resumed.validation_pace = 1
    on(resumed, 2)
    scores = [training.validate() for training in (straight, resumed)]
    assert scores[0] is not None
    assert scores[0] == scores[1]
    assert differing(straight, resumed) == []
    assert gone_on(resumed, tmp_path / "run").evaluated == straight.evaluated == 160


def files(folder):
    return {path.name: path for path in state_folder(folder).iterdir()}


def test_transitions_lie_in_blocks_that_are_written_once_and_go_when_they_are_forgotten(tmp_path, monkeypatch):
    monkeypatch.setattr(states, "BLOCK", 64)
    training, held = begun(SMALL), {}
    for _ in range(12):
        save(on(training, 10), tmp_path / "run")
        blocks = {name: path.stat().st_ino for name, path in files(tmp_path / "run").items() if name.endswith(".npy")}
        assert all(held.get(name, number) == number for name, number in blocks.items()), "none is written again"
        assert len(blocks) <= SMALL.replay_size // 64 + 1
        held |= blocks
    assert len(held) == training.agent.replay.added // 64
    assert len(files(tmp_path / "run")) == len(blocks) + 1, "and one state"
    save(training, tmp_path / "copy")
    assert differing(training, resume(Training, tmp_path / "copy")) == []


def test_of_what_is_too_large_the_newest_is_kept_and_it_is_said(tmp_path, monkeypatch, subtests):
    monkeypatch.setattr(states, "BLOCK", 16)
    for prioritised, most in ((False, 30_000), (True, 38_000)):
        with subtests.test(prioritised=prioritised):
            monkeypatch.setattr(states, "MOST", most)
            training = on(begun(SMALL.changed(prioritised=prioritised)), 60)
            save(training, tmp_path / "run")
            resumed = resume(Training, tmp_path / "run")
            assert "too large" in resumed.lost
            kept = resumed.agent.replay
            assert 0 < len(kept) < len(training.agent.replay)
            paths = files(tmp_path / "run").values()
            assert sum(path.stat().st_size for path in paths if path.suffix == ".npy") < most
            ours, theirs = (newest(buffer, 20) for buffer in (training.agent.replay, kept))
            assert all(np.array_equal(*pair) for pair in zip(ours, theirs, strict=True))
            on(resumed, 3)


def newest(buffer, count):
    """Rewards of the newest transitions, and their priorities, if they have any."""
    rows = (buffer.start + np.arange(len(buffer) - count, len(buffer))) % buffer.capacity
    tree = getattr(buffer, "tree", None)
    return [buffer.at(rows).reward, *([tree.leaves[rows]] if tree else [])]


def test_damage_is_named_with_the_way_out_wherever_it_is(tmp_path, monkeypatch):
    monkeypatch.setattr(states, "BLOCK", 64)
    save(on(begun(SMALL.changed(prioritised=True)), 50), tmp_path / "run")
    rng, refused = np.random.default_rng(0), list[str]()
    for path in files(tmp_path / "run").values():
        whole = path.read_bytes()
        for number in range(6):
            damaged = bytearray(whole)
            if number % 2:
                del damaged[int(rng.integers(len(whole))) :]
            else:
                at = int(rng.integers(len(whole)))
                damaged[at : at + 8] = rng.bytes(8)
            path.write_bytes(damaged)
            try:  # some numbers are as good as others
                resume(Training, tmp_path / "run")
            except ModelFormatError as error:
                refused.append(str(error))
        path.unlink()
        if path.suffix == ".npy":
            with pytest.raises(ModelFormatError, match=path.name.split(".")[0]):
                resume(Training, tmp_path / "run")
        path.write_bytes(whole)
    assert len(refused) > 15
    assert [problem for problem in refused if "without this folder" not in problem] == []
    remove_state(tmp_path / "run")
    assert "empty memory" in resume(Training, tmp_path / "run").lost


def test_numbers_that_no_run_can_have_had_are_refused(tmp_path, subtests):
    training = on(begun(SMALL.changed(success_pass=True)), 30)
    while not training.state()["env"]["flights"]["contacts"]["contacts"]:
        training.advance()
    changes = {
        "held": lambda state: state["held"].fill(6),
        "contacts": lambda state: state["env"]["flights"]["contacts"]["contacts"]["world"].fill(10**9),
        "outcome": lambda state: state["env"]["flights"]["landers"]["outcome"].fill(9),
        "target": lambda state: state["env"]["flights"]["landers"]["target"].fill(3),
        "streams": lambda state: state["env"]["streams"].pop(),
        "stream": lambda state: state["env"]["streams"][0].update(bit_generator="MT19937"),
        "target network": lambda state: state["agent"]["target"].fill(np.nan),
        "optimizer": lambda state: state["agent"]["optimizer"].update(steps=np.array(-1)),
        "n-step": lambda state: state["agent"]["n_step"].update(_ages=np.zeros(3)),
        "counts": lambda state: state["agent"].update(gradient_steps=-1),
        "best": lambda state: state.update(best={"score": {}, "values": training.agent.online.values}),
        "paid": lambda state: state["statistics"].update(paid=np.full((2, 3), 1.0)),
    }
    for name, change in changes.items():
        with subtests.test(name), pytest.MonkeyPatch.context() as patch:
            state = training.state()
            change(state)
            patch.setattr(training, "state", lambda state=state: state)
            save(training, tmp_path / "run")
            with pytest.raises(ModelFormatError, match="without this folder"):
                resume(Training, tmp_path / "run")


def test_a_process_that_is_killed_between_two_files_leaves_a_run_of_one_moment(tmp_path, monkeypatch):
    training = on(begun(SMALL), 20)
    keeper = Keeper(training, tmp_path / "run")
    assert keeper.save(tmp_path / "run").problem == ""
    before = on(resume(Training, tmp_path / "run"), 0)

    def killed(*_):
        raise OSError(5, "killed")

    for moment in ("network", "state"):
        on(training, 5)
        with monkeypatch.context() as patch:
            if moment == "network":
                patch.setattr("ai.training.loop.write_agent", killed)
            else:
                patch.setattr(states, "_archive", killed)
            assert keeper.save(tmp_path / "run").problem == "killed"
        assert differing(before, resume(Training, tmp_path / "run")) == []
    assert keeper.save(tmp_path / "run").problem == ""
    assert differing(training, resume(Training, tmp_path / "run")) == []
    keeper.end()


def test_a_state_of_other_networks_is_another_runs_and_a_run_that_has_diverged_leaves_none(tmp_path):
    training, other = on(begun(SMALL), 20), on(Training(SMALL, 6, evaluate_every=0), 20)
    save(training, tmp_path / "run")
    save(other, tmp_path / "other")
    move_state(tmp_path / "other", tmp_path / "run")
    assert "empty memory" in resume(Training, tmp_path / "run").lost
    save(training, tmp_path / "run")
    assert state_folder(tmp_path / "run").exists()
    training.restore_best()
    save(training, tmp_path / "run")
    assert not state_folder(tmp_path / "run").exists()
