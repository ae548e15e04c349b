import numpy as np
import pygame
import pytest

from game.drawing.canvas import Canvas
from game.scenes.digits.pad import DrawingPad, Stroke

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


def test_long_ways_are_bent():
    bend = Stroke((0.0, 0.0))
    for point in ((60.0, 0.0), (110.0, 40.0), (120.0, 100.0)):
        bend.add(point)
    assert -10 < min(y for x, y in bend.path if 0 < x < 60) < -1


def test_a_click_is_a_dot(pad: DrawingPad):
    drag(pad, (200, 300))
    assert len(pad.strokes) == 1
    assert pad.ink()[150, 100] == 1
    assert pad.ink().sum() == pytest.approx(133, rel=0.05)


def test_undo_takes_back_a_stroke(pad: DrawingPad):
    pad.undo()
    drag(pad, (100, 100), (200, 100))
    before = pad.ink()
    drag(pad, (100, 300), (200, 300))
    pad.undo()
    assert np.array_equal(pad.ink(), before)
    pad.undo()
    assert not pad.strokes


def test_what_is_not_for_the_pad_is_left_alone(pad: DrawingPad):
    assert not mouse(pad, pygame.MOUSEBUTTONDOWN, (10, 10))
    assert not mouse(pad, pygame.MOUSEBUTTONDOWN, (100, 100), button=3)
    assert not mouse(pad, pygame.MOUSEMOTION, (100, 100))
    assert not pad.handle_event(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_a))
    assert not pad.strokes


def test_leaving_the_pad_draws_nothing_outside_and_no_line_back(pad: DrawingPad):
    drag(pad, (260, 100), (260, 20), (260, -300), (400, -300), (400, 20), (400, 100))
    assert len(pad.strokes) == 2
    assert pad.ink()[:, 150:180].max() == 0


def test_the_window_shows_the_drawing_at_any_size(pad: DrawingPad):
    drag(pad, (100, 100), (150, 130), (170, 200), (140, 260), (300, 300))
    for size, scale in (((1280, 720), 1.0), ((640, 360), 0.5), ((1280, 720), 1.0)):
        seen = picture(pad, size)
        for x, y in ((100, 100), (300, 300)):
            assert seen[round((y + RECT.top) * scale), round((x + RECT.left) * scale)] > 200
        assert seen[round((450 + RECT.top) * scale), round((450 + RECT.left) * scale)] < 40
    pad.undo()
    assert picture(pad)[RECT.top + 100, RECT.left + 100] < 40
