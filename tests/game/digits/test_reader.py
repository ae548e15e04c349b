from itertools import product
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pygame
import pytest

from ai.digits.mnist import load_part
from ai.digits.preprocessing import redrawn
from game.core import texts
from game.core.assets import MODELS_DIR
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.scenes.digits.answer import write_answer
from game.scenes.digits.fixing import FixRunner
from game.scenes.digits.reader import Reader, Reading, Switches, Verdict, best_two
from game.scenes.digits.scene import fix_lines


@pytest.fixture(scope="module")
def reader() -> Reader:
    reader = Reader()
    for name in ("modern", "classic"):
        assert reader.load(name, MODELS_DIR / "digits" / name)
    return reader


@pytest.mark.parametrize(
    "ink",
    [np.full((40, 40), np.nan), np.zeros((1, 1)), np.ones((1, 1)), np.full((5, 300), np.inf), np.ones((260, 260))],
    ids=["nan", "one pixel", "one inked pixel", "infinite", "all ink"],
)
def test_any_canvas_has_an_answer_with_any_switches(reader: Reader, ink):
    for switches in (Switches(*on) for on in product((True, False), repeat=4)):
        for strokes in ([], [np.array([(3.0, np.nan)])], [np.array([(1e9, 2.0), (-1e9, 5.0)])]):
            reading = reader.read(switches.prepare(redrawn(strokes), ink))
            for name, values in reading.probabilities.items():
                assert values.sum() == pytest.approx(1, abs=1e-4)
                assert reading.verdict(name) in Verdict
            why = reader.saliency("modern", reading.stages.centred)
            assert np.isfinite(why).all()


def test_switches_are_those_of_preprocessing(reader: Reader):
    line = np.array([(20.0, 20.0), (40.0, 60.0)])
    ink = np.zeros((260, 260), np.float32)
    ink[10:30, 10:20] = 1
    seen = {switches: switches.prepare(redrawn([line]), ink).centred.tobytes() for switches in (
        Switches(), Switches(centre=False), Switches(width=False), Switches(fit=False), Switches(crop=False)
    )}  # fmt: skip
    assert len(set(seen.values())) == 5


def test_a_damaged_folder_falls_back_on_the_next(reader: Reader, tmp_path):
    fresh = Reader()
    assert fresh.load("modern", tmp_path, MODELS_DIR / "digits" / "classic")
    assert fresh.problems["modern"]
    assert "modern" in fresh.classifiers
    assert not fresh.load("classic", tmp_path)
    assert "classic" not in fresh.classifiers


def test_saliency_is_of_the_best_answer_against_the_next(reader: Reader):
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
        np.testing.assert_allclose(reader.saliency(name, image), expected, atol=2e-3)


def test_two_networks_have_to_agree_to_be_sure(reader: Reader):
    ring = 100 + 60 * np.stack([np.cos(np.linspace(0, 6.3, 60)), 1.3 * np.sin(np.linspace(0, 6.3, 60))], axis=1)
    reading = reader.read(Switches().prepare(redrawn([ring]), np.zeros((9, 9))))
    assert reading.verdict("modern") is Verdict.SURE
    reading.probabilities["classic"] = np.roll(reading.probabilities["classic"], 1)
    assert reading.verdict("modern") is Verdict.DISPUTED


def test_who_is_surer_never_sounds_less_sure(reader: Reader, monkeypatch: pytest.MonkeyPatch):
    ring = 100 + 60 * np.stack([np.cos(np.linspace(0, 6.3, 60)), 1.3 * np.sin(np.linspace(0, 6.3, 60))], axis=1)
    stages = reader.read(Switches().prepare(redrawn([ring]), np.zeros((9, 9)))).stages
    cursor = Cursor(0, 0, 400, canvas=Canvas(pygame.Surface((1280, 720))))
    said: dict[str, list[float]] = {}

    def text(canvas: Canvas, string: str, *__: object, **___: object) -> pygame.FRect:
        word, _, share = string.partition(", ")
        if share.endswith("%") and not word.startswith("or"):
            said.setdefault(word, []).append(float(share.removesuffix(" %")))
        return pygame.FRect()

    monkeypatch.setattr(Canvas, "text", text)
    for other in (0, 1):
        for share in np.linspace(0.5, 0.9999, 400):
            values = np.full(10, (1 - share) / 9)
            values[0] = share
            write_answer(cursor, Reading(stages, {"modern": values, "classic": np.eye(10)[other]}), "modern")
    sure, probably = (said[form.partition(",")[0]] for form in (texts.DIGITS_SURE, texts.DIGITS_LIKELY))
    assert max(probably) < min(sure)
    assert said[texts.DIGITS_DISPUTED.partition(",")[0]]  # where they disagree, it is called neither


def test_the_digit_that_is_being_learnt_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    fixing = FixRunner(tmp_path, MODELS_DIR)
    monkeypatch.setattr(
        "game.scenes.digits.fixing.Worker", lambda *_, **__: SimpleNamespace(poll=list, close=lambda _: None)
    )
    for digit in (7, 3):
        assert fixing.begin("modern", np.zeros((28, 28), np.float32), digit)
        assert texts.DIGITS_FIXING.format(digit=digit) in fix_lines(fixing, same=True)
        fixing.close()
