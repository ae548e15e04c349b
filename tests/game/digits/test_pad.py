import numpy as np
import pygame
import pytest

from game.drawing.canvas import Canvas
from game.scenes.digits.pad import PEN_WIDTH, DrawingPad, Stroke

RECT = pygame.Rect(40, 70, 520, 520)


def mouse(pad: DrawingPad, kind: int, point: tuple[float, float], button: int = 1) -> bool:
    return pad.handle_event(pygame.event.Event(kind, pos=point, button=button, rel=(0, 0), buttons=(1, 0, 0)))


def drag(pad: DrawingPad, *points: tuple[float, float]) -> None:
    """Draw a stroke through points of the pad."""
    first, *others = [(x + RECT.left, y + RECT.top) for x, y in points]
    mouse(pad, pygame.MOUSEBUTTONDOWN, first)
    for point in others:
        mouse(pad, pygame.MOUSEMOTION, point)
    mouse(pad, pygame.MOUSEBUTTONUP, (others or [first])[-1])


def fresh_pad() -> DrawingPad:
    pad = DrawingPad()
    pad.rect = pygame.FRect(RECT)
    return pad


@pytest.fixture
def pad() -> DrawingPad:
    return fresh_pad()


def picture(pad: DrawingPad, size: tuple[int, int] = (1280, 720)) -> np.ndarray:
    surface = pygame.Surface(size)
    pad.draw(Canvas(surface))
    return pygame.surfarray.array3d(surface)[..., 1].T


def test_a_stroke_goes_through_every_point_of_the_mouse_at_full_precision(pad: DrawingPad):
    points = [(100.25, 100.5), (160.0, 120.125), (210.5, 180.0), (220.0, 260.75)]
    drag(pad, *points)
    (path,) = pad.strokes
    for point in points:
        assert (path == point).all(axis=1).any()
    assert np.hypot(*np.diff(path[:-1], axis=0).T).max() < 8  # and straight to the last


def test_long_ways_are_bent_and_corners_stay_corners():
    bend, corner = Stroke((0.0, 0.0)), Stroke((0.0, 0.0))
    for point in ((60.0, 0.0), (110.0, 40.0), (120.0, 100.0)):
        bend.add(point)
    for point in ((60.0, 0.0), (60.0, 60.0)):
        corner.add(point)
    assert min(y for x, y in bend.path if 0 < x < 60) < -1
    assert all(abs(y) < 1e-9 or x == 60.0 for x, y in corner.path)


def test_a_slow_pen_is_thicker():
    slow, fast = Stroke((0.0, 0.0)), Stroke((0.0, 0.0))
    for number in range(1, 30):
        slow.add((2.0 * number, 0.0))
        fast.add((40.0 * number, 0.0))
    assert slow.widths[-1] > 1.2 * fast.widths[-1]


def test_ink_lies_where_it_was_drawn_however_it_was_painted(pad: DrawingPad):
    points = [(100, 100), (150, 130), (170, 200), (140, 260), (300, 300)]
    fresh = fresh_pad()
    drag(fresh, *points)
    mouse(pad, pygame.MOUSEBUTTONDOWN, (points[0][0] + RECT.left, points[0][1] + RECT.top))
    for x, y in points[1:]:
        mouse(pad, pygame.MOUSEMOTION, (x + RECT.left, y + RECT.top))
        assert pad.ink[y // 2, x // 2] == 1
    assert pad.ink.shape == (260, 260)
    assert np.abs(pad.ink - fresh.ink).mean() < 0.002
    assert pad.ink[200:].max() == 0
    rows = np.flatnonzero(pad.ink.any(axis=1))
    assert rows[0] == pytest.approx(50 - PEN_WIDTH / 4, abs=2)


def test_a_click_is_a_dot(pad: DrawingPad):
    drag(pad, (200, 300))
    assert len(pad.strokes) == 1
    assert pad.ink[150, 100] == 1
    assert 75 < pad.ink.sum() < 225


def test_undo_takes_back_strokes_and_clearing(pad: DrawingPad):
    pad.undo()
    drag(pad, (100, 100), (200, 100))
    before = pad.ink.copy()
    drag(pad, (100, 300), (200, 300))
    pad.undo()
    assert np.array_equal(pad.ink, before)
    pad.clear()
    assert pad.empty
    assert pad.ink.max() == 0
    pad.undo()
    assert np.array_equal(pad.ink, before)
    pad.undo()
    assert pad.empty


def test_what_is_not_for_the_pad_is_left_alone(pad: DrawingPad):
    assert not mouse(pad, pygame.MOUSEBUTTONDOWN, (10, 10))
    assert not mouse(pad, pygame.MOUSEBUTTONDOWN, (100, 100), button=3)
    assert not mouse(pad, pygame.MOUSEMOTION, (100, 100))
    assert not pad.handle_event(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_a))
    assert pad.empty


def test_leaving_the_pad_draws_nothing_outside_and_no_line_back(pad: DrawingPad):
    drag(pad, (260, 100), (260, 20), (260, -300), (400, -300), (400, 20), (400, 100))
    assert len(pad.strokes) == 2
    assert pad.ink[:, 150:180].max() == 0
    pad.undo()
    assert pad.empty


def test_losing_the_window_ends_the_stroke(pad: DrawingPad):
    mouse(pad, pygame.MOUSEBUTTONDOWN, (100, 100))
    pad.handle_event(pygame.event.Event(pygame.WINDOWFOCUSLOST))
    mouse(pad, pygame.MOUSEMOTION, (300, 300))
    assert len(pad.strokes[0]) == 1


def test_the_window_shows_the_drawing_at_any_size(pad: DrawingPad):
    drag(pad, (100, 100), (150, 130), (170, 200), (140, 260), (300, 300))
    for size, scale in (((1280, 720), 1.0), ((640, 360), 0.5), ((1280, 720), 1.0)):
        seen = picture(pad, size)
        for x, y in ((100, 100), (300, 300)):
            assert seen[round((y + RECT.top) * scale), round((x + RECT.left) * scale)] > 200
        assert seen[round((450 + RECT.top) * scale), round((450 + RECT.left) * scale)] < 40
    pad.undo()
    assert picture(pad)[RECT.top + 100, RECT.left + 100] < 40
