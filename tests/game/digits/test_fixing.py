"""Fix it, with a real process beside the window."""

import time
from pathlib import Path

import numpy as np
import pytest

from ai.digits.classifier import DigitClassifier
from ai.digits.mnist import load_part
from game.core.assets import MODELS_DIR
from game.scenes.digits.fixing import FixRunner
from game.scenes.digits.reader import Reader


@pytest.fixture(scope="module")
def misread():
    images, labels = load_part("test")
    images, labels = images[:1000], labels[:1000]
    read = DigitClassifier.load(MODELS_DIR / "digits" / "classic").predict(images).argmax(axis=1)
    wrong = np.flatnonzero(read != labels)[0]
    return images[wrong], int(labels[wrong])


@pytest.fixture
def fixing(tmp_path: Path):
    fixing = FixRunner(tmp_path / "user", MODELS_DIR)
    yield fixing
    fixing.close()


def done(fixing: FixRunner, seconds: float = 60):
    end = time.monotonic() + seconds
    while fixing.busy:
        assert time.monotonic() < end, "it never ended"
        if fixed := fixing.poll():
            return fixed
        time.sleep(0.01)
    return None


def test_a_fix_is_kept_reported_and_undone(fixing: FixRunner, misread, tmp_path: Path):
    image, digit = misread
    shipped = fixing.folder("classic")
    assert fixing.begin("classic", image, digit)
    assert not fixing.begin("classic", image, digit), "one at a time"
    fixed = done(fixing)
    assert fixed is fixing.fixed
    assert fixed.accuracy[0] == pytest.approx(0.9861), "what is known is not measured again"
    assert fixed.accuracy[1] == pytest.approx(fixed.accuracy[0], abs=0.02)
    folder = fixing.folder("classic")
    assert folder.is_relative_to(tmp_path / "user")
    assert fixing.folder("modern") == MODELS_DIR / "digits" / "modern"
    assert DigitClassifier.load(folder).predict(image)[0].argmax() == digit
    assert FixRunner(tmp_path / "user", MODELS_DIR).folder("classic") == folder, "the next visit finds it"
    assert fixing.undo("classic")
    assert fixing.folder("classic") == shipped
    assert fixing.fixed is None
    assert not fixing.undo("classic")


def test_fixes_stand_upon_each_other(fixing: FixRunner, misread, tmp_path: Path):
    image, digit = misread
    for wanted in (digit, (digit + 1) % 10):
        fixing.begin("classic", image, wanted)
        done(fixing)
    assert fixing.count("classic") == 2
    assert DigitClassifier.load(fixing.folder("classic")).predict(image)[0].argmax() == (digit + 1) % 10
    fixing.undo("classic")
    assert DigitClassifier.load(fixing.folder("classic")).predict(image)[0].argmax() == digit


def test_what_fails_is_said_and_changes_nothing(fixing: FixRunner, tmp_path: Path):
    fixing.begin("classic", np.zeros((28, 28), np.float32), 3)
    assert done(fixing) is None
    assert "nothing to learn from" in fixing.problem
    assert not fixing.busy
    assert fixing.folder("classic") == MODELS_DIR / "digits" / "classic"


def test_a_folder_that_cannot_be_written_is_reported(misread, tmp_path: Path):
    (tmp_path / "user").write_text("in the way")
    fixing = FixRunner(tmp_path / "user", MODELS_DIR)
    fixing.begin("classic", *misread)
    assert done(fixing).folder is None
    assert fixing.problem
    assert fixing.folder("classic") == MODELS_DIR / "digits" / "classic"


def test_a_damaged_fix_is_passed_over_and_the_next_one_has_a_number_of_its_own(
    fixing: FixRunner, misread, tmp_path: Path
):
    fixing.begin("classic", *misread)
    done(fixing)
    first = fixing.folder("classic")
    broken = first.with_name("0002")
    broken.mkdir()
    reader = Reader()
    assert reader.load("classic", *fixing.networks["classic"].versions())
    assert reader.sources["classic"] == first
    assert "config.json" in reader.problems["classic"]
    fixing.begin("classic", misread[0], (misread[1] + 1) % 10, reader.sources["classic"])
    done(fixing)
    assert not fixing.problem
    assert fixing.folder("classic").name == "0003"
    assert fixing.undo("classic")
    assert fixing.undo("classic")
    assert fixing.folder("classic") == first
