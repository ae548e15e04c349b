import time
from itertools import groupby
from pathlib import Path

import numpy as np
import pytest

from ai.digits.classifier import DigitClassifier
from ai.digits.mnist import load_part
from ai.digits.preprocessing import preprocess_strokes
from game.core.assets import MODELS_DIR
from game.scenes.digits.fixing import FixRunner
from game.scenes.digits.pad import DrawingPad
from game.scenes.digits.reader import LiveReading, Reading, Verdict, best_two, saliency
from tests.support import inline_worker
from tests.support.chores import biased_fix
from tests.support.stranger_digits import narrow


@pytest.fixture(scope="module")
def reader() -> LiveReading:
    reader = LiveReading(DrawingPad(), "modern")
    for name in ("modern", "classic"):
        assert reader.load(name, MODELS_DIR / "digits" / name)
    return reader


def read(reader: LiveReading, strokes: list[np.ndarray]) -> Reading:
    image = preprocess_strokes(strokes)
    return Reading(image, {name: each.predict(image)[0] for name, each in reader.classifiers.items()})


RING = 100 + 60 * np.stack([np.cos(np.linspace(0, 6.3, 60)), 1.3 * np.sin(np.linspace(0, 6.3, 60))], axis=1)


def test_any_drawing_has_an_answer(reader: LiveReading):
    for strokes in ([], [np.array([(3.0, np.nan)])], [np.array([(1e9, 2.0), (-1e9, 5.0)])]):
        reading = read(reader, strokes)
        for name, values in reading.probabilities.items():
            assert values.sum() == pytest.approx(1, abs=1e-4)
            assert reading.verdict(name) in Verdict
        assert np.isfinite(saliency(reader.classifiers["modern"], reading.image)).all()


def test_a_damaged_folder_falls_back_on_the_next(tmp_path):
    fresh = LiveReading(DrawingPad(), "modern")
    assert fresh.load("modern", tmp_path, MODELS_DIR / "digits" / "classic")
    assert fresh.problems["modern"]
    assert "modern" in fresh.classifiers
    assert not fresh.load("classic", tmp_path)
    assert "classic" not in fresh.classifiers


def test_saliency_is_of_the_best_answer_against_the_next(reader: LiveReading):
    image = load_part("test")[0][18]
    for name in ("modern", "classic"):
        classifier = reader.classifiers[name]
        first, second = best_two(classifier.network.predict(classifier.shaped(image))[0])
        one, other = (
            classifier.network.input_gradient(classifier.shaped(image), np.eye(10, dtype=np.float32)[[digit]])
            for digit in (first, second)
        )
        said = (one - other).reshape(28, 28) * image
        expected = np.sign(said) * np.sqrt(np.abs(said) / np.abs(said).max())
        np.testing.assert_allclose(saliency(classifier, image), expected, atol=2e-3)


def test_two_networks_have_to_agree_to_be_sure(reader: LiveReading):
    reading = read(reader, [RING])
    assert reading.verdict("modern") is Verdict.SURE
    reading.probabilities["classic"] = np.roll(reading.probabilities["classic"], 1)
    assert reading.verdict("modern") is Verdict.DISPUTED


@pytest.mark.parametrize("digit", [0, 8])
def test_a_narrow_digit_is_never_surely_another(reader: LiveReading, digit: int):
    rng = np.random.default_rng(2)
    for _ in range(150):
        reading = read(reader, narrow(digit, rng))
        if reading.probabilities["modern"].argmax() != digit:
            assert reading.verdict("modern") is not Verdict.SURE


def test_a_one_of_one_stroke_is_sure(reader: LiveReading):
    for style in ([(48, 0), (52, 100)], [(56, 0), (44, 100)]):
        reading = read(reader, [np.array(style, float)])
        assert reading.verdict("modern") is Verdict.SURE


def test_who_is_surer_never_sounds_less_sure():
    image, shares = preprocess_strokes([RING]), np.linspace(0.5, 0.9999, 400)
    for other, wanted in ((0, [Verdict.UNSURE, Verdict.LIKELY, Verdict.SURE]), (1, [Verdict.UNSURE, Verdict.DISPUTED])):
        said = []
        for share in shares:
            values = np.full(10, (1 - share) / 9)
            values[0] = share
            said.append(Reading(image, {"modern": values, "classic": np.eye(10)[other]}).verdict("modern"))
        assert [verdict for verdict, _ in groupby(said)] == wanted


# Fix it, with a real process beside the window.


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


@pytest.mark.slow
def test_a_fix_is_kept_reported_and_undone_by_a_process_of_its_own(fixing: FixRunner, misread, tmp_path: Path):
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


def test_fixes_stand_upon_each_other_and_a_damaged_one_is_named(
    fixing: FixRunner, misread, monkeypatch: pytest.MonkeyPatch
):
    inline_worker.install(monkeypatch.setattr)
    monkeypatch.setattr("game.scenes.digits.fixing.fix", biased_fix)
    image, digit = misread
    for _ in range(2):
        fixing.begin("modern", image, digit)
        done(fixing)
    second = fixing.folder("modern")
    assert second.name == "0002"
    second.with_name("0003").mkdir()
    reader = LiveReading(DrawingPad(), "modern")
    assert reader.load("modern", *fixing.networks["modern"].versions())
    assert "config.json" in reader.problems["modern"]
    fixing.begin("modern", image, digit)
    assert done(fixing) is None
    assert "config.json" in fixing.problem
    assert fixing.undo("modern")
    assert fixing.folder("modern") == second


def test_what_fails_is_said_and_changes_nothing(fixing: FixRunner, monkeypatch: pytest.MonkeyPatch):
    inline_worker.install(monkeypatch.setattr)
    fixing.begin("classic", np.zeros((28, 28), np.float32), 3)
    assert done(fixing) is None
    assert "nothing to learn from" in fixing.problem
    assert not fixing.busy
    assert fixing.folder("classic") == MODELS_DIR / "digits" / "classic"
