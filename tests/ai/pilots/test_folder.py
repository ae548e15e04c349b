"""The player's folder: new files and measurements."""

import errno
from pathlib import Path

import pytest

from ai.environment import finished
from ai.files import writing
from ai.pilots.folder import TEMPLATE, Measured, PilotFolder
from ai.pilots.own import MeasuredPilot
from ai.training.tasks import flights

EXAMPLES = Path(__file__).parents[3] / "examples"


def test_new_files_lie_beside_each_other_and_are_never_overwritten(tmp_path: Path):
    files = PilotFolder(tmp_path)
    assert files.files() == {}
    first = files.new()
    first.write_text("mine")
    files.new()
    assert list(files.files()) == ["pilot", "pilot 2"]
    assert first.read_text() == "mine"
    assert files.files()["pilot 2"].read_text() == TEMPLATE.read_text()


def test_a_full_disk_leaves_no_half_of_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    def full(path: Path) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(writing, "synchronise", full)
    with pytest.raises(OSError, match="space"):
        PilotFolder(tmp_path).new()
    assert PilotFolder(tmp_path).files() == {}
    assert not list((tmp_path / "pilots").iterdir())


def test_measurements_are_kept_in_their_order_and_are_stale_once_the_file_was_saved_again(tmp_path: Path):
    files = PilotFolder(tmp_path)
    assert files.measured() == []
    results = [Measured("pilot", 0.25, 7.5, 3.0, 1e9), Measured("pilot", 0.9, 8.0, 2.5, 1e9 + 1)]
    files.keep(results[0])
    with (tmp_path / "pilots" / "measured.jsonl").open("a") as file:
        file.write('{"name": 3}\nnonsense\n{"name": "x", "landed": 7}\n')
    files.keep(results[1])
    assert files.measured() == results
    path = files.new()
    saved = path.stat().st_mtime
    before, after = (Measured("pilot", 0.5, when=saved + late) for late in (-1, 1))
    assert (before.stale(path), after.stale(path)) == (True, False)
    path.unlink()
    assert not before.stale(path)


@pytest.mark.slow
def test_the_template_nearly_lands_and_the_example_does(tmp_path: Path):
    for path, aim, least, most in (
        (TEMPLATE, "0.0", 0.05, 0.5),
        (TEMPLATE, "-0.3 * offset(observation)", 0.8, 1.0),  # what it asks for
        (EXAMPLES / "pilot_by_hand.py", "0.0", 0.9, 1.0),
    ):
        (tmp_path / "pilot.py").write_text(path.read_text().replace("aim = 0.0", f"aim = {aim}"))
        pilot = MeasuredPilot(tmp_path / "pilot.py")
        score = finished(flights(pilot, 24, 7))
        pilot.close()
        assert least <= score.success <= most, (path.name, aim)
