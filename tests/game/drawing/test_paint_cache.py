"""Pictures that are kept: painted when what they show changes, and only then."""

import pygame

from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache


def painted(kept: PaintCache, canvas: Canvas, *shown: object) -> list[object]:
    """Return what of `shown` had to be painted."""
    seen: list[object] = []
    for each in shown:
        kept.draw(canvas, (10, 20, 30, 40), each, lambda _, each=each: seen.append(each))  # type: ignore[misc]
    return seen


def test_what_has_not_changed_is_not_painted_again():
    canvas = Canvas(pygame.Surface((1280, 720)))
    assert painted(PaintCache(), canvas, "a", "a", "b", "b", "a") == ["a", "b", "a"]
    assert painted(PaintCache(2), canvas, "a", "b", "a", "b", "c", "b", "a") == ["a", "b", "c", "a"]


def test_another_scale_is_painted_anew_and_the_picture_stands_in_its_box():
    kept = PaintCache()
    for size in ((1280, 720), (640, 360)):
        canvas = Canvas(pygame.Surface(size))
        kept.draw(canvas, (100, 40, 20, 20), "dot", lambda sheet: sheet.fill(sheet.rect(5, 5, 2, 2), (255, 0, 0)))
        lit = pygame.mask.from_threshold(canvas.surface, (255, 0, 0), (1, 1, 1)).get_bounding_rects()
        assert lit == [canvas.rect(105, 45, 2, 2)]
