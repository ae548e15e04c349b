"""What lies on disk and what comes from others: read within bounds, replaced only if it is ours, lost never."""

import errno
import io
import json
import os
import shutil
import stat
import subprocess
import sys
import tracemalloc
import zipfile
from contextlib import contextmanager
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from ai.agent.agent import DeepQAgent
from ai.agent.storage import KIND, write_agent
from ai.files.folder import atomic_folder, claimed_folder, recover_all, take_folder
from ai.files.reading import inside, parse_json, read_array, read_arrays, read_bytes, read_json
from ai.files.writing import append_line, take, write_text
from ai.nn import ActivationFunctions, ActivationLayer, ConvolutionLayer, CostFunctions, ModelFormatError, NeuralNetwork
from ai.nn.layer import MOST_LAYERS
from ai.training.config import PRESETS, gym_config
from ai.training.loop import Training
from ai.training.run import resume, save
from ai.training.tasks import LanderTask
from main import main
from tests.support.faults import damaged, killed, limited
from tests.support.saved import SUBJECTS

ROOT = Path(__file__).parents[3]
SMALL = PRESETS["modern"].changed(hidden=(8,), num_envs=2, replay_size=200)
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="pipes, forks and alarms are not there")


@pytest.fixture(autouse=True)
def _measured_quickly(monkeypatch):
    monkeypatch.setattr(LanderTask, "test_episodes", 4)


@contextmanager
def little_memory(megabytes: int = 100):
    """Fail if more is asked for in the block, NumPy's arrays included."""
    tracemalloc.start()
    try:
        yield
        assert tracemalloc.get_traced_memory()[1] < megabytes * 1e6
    finally:
        tracemalloc.stop()


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    folder = tmp_path_factory.mktemp("saved") / "run"
    training = Training(SMALL, validation_episodes=1)
    training.evaluate()  # so that it has a score
    save(training, folder, state=False)
    return folder


@pytest.fixture
def run(saved, tmp_path):
    return shutil.copytree(saved, tmp_path / "run")


def edit(path: Path, **changes):
    path.write_text(json.dumps(json.loads(path.read_text()) | changes))


# Readers


@pytest.mark.parametrize("subject", SUBJECTS, ids=lambda subject: subject.name)
def test_damage_of_any_kind_is_read_or_refused(subject, tmp_path):
    found = list(damaged(subject, 40, 1, tmp_path))
    assert set(found) <= {"read", "refused"}
    assert "refused" in found or not subject.refusals


def _holes(path):
    path.touch()
    os.truncate(path, 3_300_000_000)


def test_what_is_no_ordinary_file_of_the_folder_is_named(saved, run, subtests):
    damages = {
        "pipe": os.mkfifo,
        "device": lambda path: path.symlink_to("/dev/zero"),
        "loop": lambda path: path.symlink_to(path.name),
        "outside": lambda path: path.symlink_to(saved / path.relative_to(run)),
        "folder": Path.mkdir,
        "holes": _holes,
    }
    names = ["config", "online/layer-0-bias", "optimizer", "last/config"]
    kinds = {"online/layer-0-bias": ".npy", "optimizer": ".npz"}
    for name, (damage, make) in product(names, damages.items()):
        path = run / (name + kinds.get(name, ".json"))
        path.unlink()
        make(path)
        with subtests.test(name=name, damage=damage):
            with little_memory(), limited(20), pytest.raises(ModelFormatError) as caught:
                resume(Training, run)
            assert path.name in caught.value.problem or "last" in caught.value.problem
        path.rmdir() if damage == "folder" else path.unlink()
        shutil.copy(saved / path.relative_to(run), path)


def packed(path, method=zipfile.ZIP_DEFLATED, **arrays):
    with zipfile.ZipFile(path, "w", method) as archive:
        for name, array in arrays.items():
            held = io.BytesIO()
            np.save(held, np.array(array))
            archive.writestr(f"{name}.npy", held.getvalue())
    return path.read_bytes()


def test_an_archive_is_read_whole_or_refused_in_a_sentence(tmp_path, subtests):
    path = tmp_path / "a.npz"
    whole = packed(path, zipfile.ZIP_STORED, steps=3)
    assert read_arrays(path, 1000)["steps"] == 3
    for held, most, said in (
        (whole[: len(whole) // 2], 1000, "no arrays that can be read"),
        (b"whatever", 1000, "no arrays that can be read"),
        (packed(path, objects=[None]), 10_000, "no arrays that can be read"),
        (packed(path, zeros=np.zeros(1_000_000)), 100_000, "larger than"),  # a small file, unpacked
        (whole, 100, "larger than"),
    ):
        path.write_bytes(held)
        with subtests.test(said=said), pytest.raises((ValueError, OSError), match=said):
            read_arrays(path, most)
    np.save(tmp_path / "one.npy", np.zeros(2))
    with pytest.raises(ValueError, match="no archive"):
        read_arrays(tmp_path / "one.npy", 1000)


def test_an_array_is_of_the_shape_and_kind_that_is_asked_for(tmp_path, subtests):
    path = tmp_path / "a.npy"
    for array, said in (
        (np.zeros((2, 3), np.float32), ""),
        (np.zeros((3, 2), np.float32), r"should hold float32 \[2, 3\]"),
        (np.zeros((2, 3)), "should hold float32"),
        (np.full((2, 3), np.nan, np.float32), "not finite"),
        (np.array([[None] * 3] * 2), "no arrays that can be read"),
    ):
        np.save(path, array)
        with subtests.test(said=said):
            if said:
                with pytest.raises(ValueError, match=said):
                    read_array(path, (2, 3), np.float32)
            else:
                assert read_array(path, (2, 3), np.float32).shape == (2, 3)
    np.save(path, np.asfortranarray(np.arange(6, dtype=np.float32).reshape(2, 3)))
    assert read_array(path, (2, 3), np.float32).ravel().tolist() == [0, 1, 2, 3, 4, 5]
    path.write_bytes(path.read_bytes()[:-4])
    with pytest.raises(ValueError, match="no arrays that can be read"):
        read_array(path, (2, 3), np.float32)


def fully(inputs, outputs):
    return {"type": "FullyConnectedLayer", "inputs": inputs, "outputs": outputs, "arrays": {}}


def convolution(shape, filters):
    sizes = {"inputs": shape, "filters": filters, "kernel": 3}
    return {"type": "ConvolutionLayer", **sizes, "arrays": {}}


def test_a_small_config_cannot_ask_for_a_huge_network(tmp_path, subtests):
    NeuralNetwork(*CostFunctions.use_mse()).save(tmp_path / "model")
    for layers, said in (
        ([{"type": "ActivationLayer", "activation": {"name": "tanh"}}] * 60_000, "at most 500 layers"),
        ([fully(4000, 4000)], "12,000,000 parameters"),
        ([fully(1_000_000, 64)], "whole number from 1 to 262144"),
        ([convolution([28, 28, 1], 1 << 18)], "height · width · channels"),
    ):
        edit(tmp_path / "model" / "config.json", layers=layers)
        with subtests.test(said=said):
            with little_memory(), limited(20), pytest.raises(ModelFormatError, match=said) as caught:
                NeuralNetwork.load(tmp_path / "model")
            assert len(str(caught.value)) < 10_000


def test_what_a_run_says_of_itself_is_checked_before_there_is_room_for_it(run, subtests):
    config = json.loads((run / "config.json").read_text())["config"]
    best = json.loads((run / "training.json").read_text())["best"]
    asked = [{"hidden": [1024] * 400}, {"hidden": [1] * 6_000}, {"env": None}, {"env": "x" * 100_000 + ":y"},
             {"preset" * 20_000: 1}]  # fmt: skip
    counts = [{"features": 1_000_000}, {"actions": True}, {"decisions": 10**400}]
    for name, changes, said in (
        *[("config.json", {"config": config | each}, None) for each in asked],
        *[("config.json", each, r"config\.json") for each in counts],
        ("training.json", {"best": best | {"success": None}}, "no finite number"),
        *[("training.json", each, r"training\.json") for each in ('{"seed": Infinity}', "[" * 100_000)],
    ):  # fmt: skip
        whole = (run / name).read_text()
        (run / name).write_text(changes if isinstance(changes, str) else json.dumps(json.loads(whole) | changes))
        with subtests.test(changes=str(changes)[:80]):
            with little_memory(), limited(20), pytest.raises(ModelFormatError, match=said) as caught:
                resume(Training, run)
            assert len(str(caught.value)) < 1000
        (run / name).write_text(whole)


def test_a_written_file_waits_for_its_content_and_then_for_its_name(tmp_path, monkeypatch):
    flushed, fsync = [], os.fsync

    def note(descriptor):
        if not stat.S_ISDIR(os.fstat(descriptor).st_mode):
            flushed.append("content")
            return fsync(descriptor)
        flushed.append([path.name for path in tmp_path.iterdir()])
        raise OSError(errno.EINVAL, "not here")  # a folder that cannot wait for the disk is no failure

    monkeypatch.setattr(os, "fsync", note)
    write_text(tmp_path / "settings.json", "{}")
    assert flushed == ["content", ["settings.json"]]
    write_text(tmp_path / "settings.json", "[]", flush=False)
    assert len(flushed) == 2
    assert (tmp_path / "settings.json").read_text() == "[]"


def test_json_has_finite_numbers_and_an_end():
    for text in ("[" * 100_000, '{"a":' * 100_000):
        with pytest.raises(ValueError, match="too deeply"):
            parse_json(text)
    for text in ("1e999", "Infinity", "[NaN]", "1" * 5000):
        with pytest.raises(ValueError, match=r"no finite number|limit"):
            parse_json(text)


def test_a_file_is_as_large_as_it_may_be_and_no_larger(tmp_path):
    (tmp_path / "a").write_bytes(b"12345")
    assert read_bytes(tmp_path / "a", 5) == b"12345"
    with pytest.raises(OSError, match="larger than"):
        read_bytes(tmp_path / "a", 4)
    with pytest.raises(OSError, match="not an ordinary file"):
        read_json("/dev/zero")
    with pytest.raises(OSError, match="leads out"):
        inside(tmp_path, "../a")


def test_a_network_too_large_to_be_read_is_not_made_either():
    network = NeuralNetwork(*CostFunctions.use_mse())
    for _ in range(MOST_LAYERS):
        network.add_layer(ActivationLayer(*ActivationFunctions.use_tanh()))
    with pytest.raises(ValueError, match="at most 500 layers"):
        network.add_layer(ActivationLayer(*ActivationFunctions.use_tanh()))
    network = NeuralNetwork(*CostFunctions.use_mse())
    with pytest.raises(ValueError, match="multiplications"):
        network.add_layer(*(ConvolutionLayer((side, side, 226), 226, 3) for side in (34, 32, 30)))
    with little_memory(), pytest.raises(ValueError, match="parameters"):
        DeepQAgent(config=PRESETS["modern"].changed(hidden=(1024,) * 400))


# No code from files


def test_a_file_never_starts_code(tmp_path, monkeypatch, capsys):
    pytest.importorskip("gymnasium")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    (tmp_path / "payload.py").write_text("from pathlib import Path\nPath('ran').touch()\n")
    training = Training(gym_config("CartPole-v1").changed(num_envs=2), validation_episodes=1)
    save(training, "run", state=False)
    for folder in (Path("run"), Path("run", "last")):
        config = json.loads((folder / "config.json").read_text())["config"]
        edit(folder / "config.json", config=config | {"env": "payload:CartPole-v1"})
    for command in (
        ["evaluate", "--model", "run", "--episodes", "2"],
        ["train", "--resume", "run", "--decisions", "9"],
    ):
        assert main(command) == 1
        assert "--env" in capsys.readouterr().err
        assert not Path("ran").exists()
    assert main(["evaluate", "--model", "run", "--episodes", "2", "--env", "payload:CartPole-v1"]) == 0
    assert Path("ran").exists()


# Writers


@pytest.mark.slow
@pytest.mark.parametrize("subject", SUBJECTS, ids=lambda subject: subject.name)
def test_a_writer_that_is_killed_leaves_the_old_or_the_new(subject, tmp_path):
    found = list(killed(subject, tmp_path, every=29 if subject.name == "run" else 7 if subject.name == "digits" else 1))
    assert found
    assert set(found) <= {"old", "new"}


def listing(folder):
    return {path: path.read_bytes() if path.is_file() else None for path in sorted(folder.rglob("*"))}


def _of_another(path):
    path.parent.mkdir(exist_ok=True)
    path.write_text("of somebody's own")


def _thesis(folder):
    _of_another(folder / "chapter")
    (folder / "config.json").write_text("{}")


def _within_linked(folder):
    (folder / "training.json").rename(folder.parent / "mine.json")
    (folder / "training.json").symlink_to(folder.parent / "mine.json")


def _linked(folder):
    (folder / "target").rename(folder.parent / "elsewhere")
    (folder / "target").symlink_to(folder.parent / "elsewhere")


def test_training_replaces_only_what_is_its_own(saved, tmp_path, capsys, subtests):
    classic = ROOT / "models" / "digits" / "classic"
    small = ["--set=num_envs=2", "--set=hidden=[8]"]
    for name, source, change in (
        ("a file", None, lambda folder: folder.write_text("a file")),
        ("thesis", None, _thesis),
        ("digits", classic, lambda folder: None),
        ("notes", saved, lambda folder: _of_another(folder / "notes.txt")),
        ("a link within", saved, _within_linked),
        ("linked", saved, _linked),
    ):
        place = tmp_path / name
        place.mkdir()
        if source:
            shutil.copytree(source, place / "d")
        change(place / "d")
        before = listing(place)
        for option in ("--output", "--resume"):
            changes = small if option == "--output" else []
            with subtests.test(name=name, option=option):
                command = ["train", "--decisions", "300", "--validation", "4", option, str(place / "d"), *changes]
                assert main(command) == 1
                stderr = capsys.readouterr().err.strip()
                assert str(place / "d") in stderr
                assert "left as it is" in stderr or "no readable model" in stderr
                assert listing(place) == before


def test_the_second_training_of_a_folder_is_refused(tmp_path, capsys):
    command = ["train", "--decisions", "9", "--set", "num_envs=2", "--output", str(tmp_path / "run")]
    with take_folder(tmp_path / "run"):
        holder = "from ai.files.folder import take_folder; import sys; take_folder(sys.argv[1])"
        other = subprocess.run(
            [sys.executable, "-c", holder, str(tmp_path / "run")], cwd=ROOT, capture_output=True, text=True, check=False
        )
        assert "BlockingIOError" in other.stderr
        assert main(command) == 1
        assert "another training" in capsys.readouterr().err
    assert main(command) == 0
    assert not list(tmp_path.glob("*.lock"))


def test_a_lock_that_was_let_go_is_free_at_once_and_leaves_nothing(tmp_path):
    first = take(tmp_path / "a.lock")
    assert take(tmp_path / "a.lock") is None
    first.close()
    with take(tmp_path / "a.lock"):
        assert take(tmp_path / "a.lock") is None
        first.close()  # once more, which must not free what another holds
        assert take(tmp_path / "a.lock") is None
    assert not list(tmp_path.iterdir())


def test_what_a_save_left_half_made_goes_after_an_hour_and_an_old_one_comes_back(tmp_path):
    young, stale = tmp_path / ".run.01234567.new", tmp_path / ".run.89abcdef.new"
    for number, folder in enumerate((young, stale, tmp_path / ".gone.01234567.old", tmp_path / ".gone.89abcdef.old")):
        folder.mkdir()
        (folder / "number").write_text(str(number))
        os.utime(folder, (0, 1000 * number) if folder != young else None)
    recover_all(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {young.name, "gone", ".gone.01234567.old"}
    assert (tmp_path / "gone" / "number").read_text() == "3"  # the later of the two


def test_a_save_that_fails_or_meets_what_is_not_ours_leaves_all_as_it_was(tmp_path):
    NeuralNetwork(*CostFunctions.use_mse()).save(tmp_path / "run")
    before = listing(tmp_path)
    with pytest.raises(FileNotFoundError), atomic_folder(tmp_path / "run") as new:
        shutil.copy(tmp_path / "no such file", new)
    assert listing(tmp_path) == before
    with pytest.raises(FileExistsError, match="left as it is"), atomic_folder(tmp_path / "run"):
        (tmp_path / "run" / "diary").write_text("dear")
    with pytest.raises(FileExistsError, match="left as it is"), claimed_folder(tmp_path / "run", KIND):
        pytest.fail("this was not ours")
    (tmp_path / "settings.json" / "within").mkdir(parents=True)
    with pytest.raises(OSError, match="settings"):
        write_text(tmp_path / "settings.json", "{}")
    shutil.rmtree(tmp_path / "settings.json")
    assert listing(tmp_path) == before | {tmp_path / "run" / "diary": b"dear"}


def test_a_line_stands_alone_after_one_that_was_cut_short(tmp_path):
    (tmp_path / "log").write_bytes(b'{"a": ')
    append_line(tmp_path / "log", {"a": 1})
    assert parse_json((tmp_path / "log").read_text().splitlines()[-1]) == {"a": 1}


def test_two_writers_of_one_folder_never_mix_and_what_systems_leave_is_no_obstacle(tmp_path):
    with atomic_folder(tmp_path / "run", KIND) as first, atomic_folder(tmp_path / "run", KIND) as second:
        assert first != second
        write_agent(DeepQAgent(config=SMALL), first)
        write_agent(DeepQAgent(config=SMALL), second)
    assert DeepQAgent.load(tmp_path / "run")
    assert [path.name for path in tmp_path.iterdir()] == ["run"]
    (tmp_path / "run" / ".DS_Store").write_bytes(b"\0")
    DeepQAgent(config=SMALL).save(tmp_path / "run")
