"""What the shipped *modern* network reads of hands and scans that no network learned from."""

from itertools import product

import numpy as np
import pytest

from ai.digits.classifier import DigitClassifier
from ai.digits.preprocessing import preprocess_strokes, stages
from game.core.assets import MODELS_DIR
from tests.support.digit_styles import template_strokes
from tests.support.stranger_digits import ENDS, TURNS, narrow, scan, slashed_zero


@pytest.fixture(scope="module")
def modern() -> DigitClassifier:
    return DigitClassifier.load(MODELS_DIR / "digits" / "modern")


def test_zeros_are_read_with_any_slash(modern: DigitClassifier):
    rng = np.random.default_rng(1)
    for turn in TURNS:
        drawn = [
            preprocess_strokes(slashed_zero(turn, ends, rng, in_one))
            for ends, in_one in product(ENDS, (False, True))
            for _ in range(6)
        ]
        assert (modern.predict(np.stack(drawn)).argmax(axis=1) == 0).mean() >= 0.92, turn


@pytest.mark.parametrize("digit", [0, 8])
def test_narrow_digits_are_read(modern: DigitClassifier, digit: int):
    rng = np.random.default_rng(2)
    drawn = np.stack([preprocess_strokes(narrow(digit, rng)) for _ in range(150)])
    assert (modern.predict(drawn).argmax(axis=1) == digit).mean() > 0.92


def test_a_scan_of_16_pixels_is_read_as_well_as_with_strokes_as_wide_as_they_are(modern: DigitClassifier):
    rng = np.random.default_rng(3)
    digits = np.repeat(np.arange(10), 6)
    strokes = [template_strokes(digit, rng) for digit in digits]
    for pen in (1.9, 4.0):
        scans = [scan(each, 16, pen, True) for each in strokes]
        hits = [
            (modern.predict(np.stack([stages(each, width=width).centred for each in scans])).argmax(axis=1) == digits)
            for width in (True, False)
        ]
        assert hits[0].mean() >= hits[1].mean(), pen


def test_strokes_of_a_large_drawing_are_normalised_and_those_of_a_small_one_are_left():
    line = [np.array([(10.0, 10.0), (90.0, 90.0)])]
    for side, changed in ((12, False), (17, False), (24, True), (60, True)):
        canvas = scan(line, side, 0.25 * side)
        assert np.allclose(stages(canvas).centred, stages(canvas, width=False).centred) != changed, side
