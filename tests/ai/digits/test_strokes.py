from itertools import product

import numpy as np
import pytest

from ai.digits.preprocessing import preprocess, preprocess_strokes
from ai.digits.strokes import draw_segments, draw_strokes, spaced

WAVE = np.stack([np.linspace(20, 90, 200), 60 + 25 * np.sin(np.linspace(0, 7, 200))], axis=1)


def test_short_pieces_cover_what_long_ones_do():
    ends = np.array([(20.0, 30.0), (100.0, 70.0)])
    way = ends[0] + np.linspace(0, 1, 60)[:, None] * (ends[1] - ends[0])
    assert np.allclose(draw_strokes([way], (100, 120), 9.5), draw_strokes([ends], (100, 120), 9.5), atol=1e-4)


def test_what_lies_beyond_the_canvas_is_left_out():
    large = draw_strokes([WAVE + 200], (600, 600), 8)
    assert np.array_equal(draw_strokes([WAVE], (200, 200), 8), large[200:400, 200:400])
    for at, shape in product(((-60, 0), (0, -60), (70, 70), (1e7, -1e7)), ((100, 120), (1, 1), (3, 200))):
        assert np.isfinite(draw_strokes([WAVE + at], shape, 8)).all(), (at, shape)


def test_pieces_have_widths_of_their_own():
    canvas = np.zeros((60, 60), np.float32)
    draw_segments(canvas, [(10, 15), (10, 45)], [(50, 15), (50, 45)], [4.0, 10.0])
    assert canvas[:, 30].sum() == pytest.approx(14, abs=0.1)


def test_spaced_points_keep_both_ends_and_the_shape():
    few = spaced(WAVE, 4.0)
    assert len(few) < 50
    assert np.array_equal(few[[0, -1]], WAVE[[0, -1]])
    assert np.abs(draw_strokes([few], (100, 120), 9) - draw_strokes([WAVE], (100, 120), 9)).mean() < 0.004
    assert len(spaced(WAVE[:1], 4.0)) == 1


def test_a_loop_that_a_wide_pen_fills_is_still_seen_in_the_strokes():
    ring = 30 + 12 * np.stack([np.cos(np.linspace(0, 6.3, 60)), np.sin(np.linspace(0, 6.3, 60))], axis=1)
    canvas = draw_strokes([ring], (60, 60), 22)
    assert preprocess_strokes([ring])[14, 14] < 0.2 < preprocess(canvas)[14, 14]
