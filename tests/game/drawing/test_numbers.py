"""Numbers and days as the language writes them, wherever they are drawn."""

import pygame
import pytest

from game.core import texts
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import VIEW_SIZE


@pytest.fixture(autouse=True)
def german(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("LANGUAGE", "en")
    texts.choose("de")
    typeface.forget()
    yield
    texts.choose("en")
    typeface.forget()


def test_numbers_are_written_as_the_language_does(subtests: pytest.Subtests):
    for written, said in {
        "3.5 m/s": "3,5 m/s", "−12,345.67 of 1,000": "−12 345,67 of 1 000", "at 3.5.": "at 3,5.", "1, 2, 3": "1, 2, 3",
        "1.5k (0.25)": "1,5k (0,25)", "v1.2, 1.2.3": "v1.2, 1.2.3", "/tmp/1.5/a": "/tmp/1.5/a",
        "2026-11-24 10:20": "24.11.2026 10:20", "2026-11-24 10.20.30.png": "2026-11-24 10.20.30.png",
    }.items():  # fmt: skip
        with subtests.test(written=written):
            assert typeface.numbers(written) == said.replace(" 345", "\u00a0345").replace("1 000", "1\u00a0000")


def test_a_text_is_as_wide_as_what_is_written_and_code_stays():
    for tabular in (False, True):
        assert typeface.span("0.5 m", 16.0, "regular", tabular) == typeface.span("0,5 m", 16.0, "regular", tabular)
    assert typeface.reach("0.5", 160.0, "code") == typeface.reach("0,5", 160.0, "code")  # all signs are equally wide
    assert (typeface.render("0.5", 16.0, "code", (255,) * 3)[0].get_buffer().raw
            != typeface.render("0,5", 16.0, "code", (255,) * 3)[0].get_buffer().raw)  # fmt: skip


def test_a_translation_shrinks_to_the_smallest_text_of_the_game_and_english_not_at_all():
    canvas = Canvas(pygame.Surface(VIEW_SIZE))
    assert [canvas.least(size) for size in (30.0, 15.0, 11.0)] == [21.0, 11.5, 11.0]
    texts.choose("en")
    assert canvas.least(15.0) == 15.0
