"""Sizes of text; `tests/game/tour` asks every screen whether texts fit at the largest."""

from itertools import product

import pygame
import pytest

from game.core import texts
from game.drawing import typeface
from game.drawing.canvas import Canvas, least
from game.drawing.tokens import LABEL, TEXT_SIZES, VIEW_SIZE


def test_text_has_one_size_on_the_world_and_before_it_and_is_never_less_than_asked():
    for window, factor in product([(640, 360), VIEW_SIZE, (2560, 1440)], TEXT_SIZES.values()):
        canvas = Canvas(pygame.Surface(window))
        canvas.zoom = factor
        heights = {each.text("Size", (0, 100), size=LABEL).height * each.scale for each in (canvas, canvas.reading)}
        assert max(heights) == pytest.approx(min(heights))
        sheet = canvas.sheet(100, 100)
        assert sheet.text("Size", (0, 50), size=LABEL).height * sheet.scale == pytest.approx(min(heights))
        assert canvas.type * LABEL >= 12 * factor


def test_names_that_no_font_can_write_are_written_all_the_same():
    canvas = Canvas(pygame.Surface(VIEW_SIZE))  # a folder's name can be any bytes
    assert canvas.text("a\udcff\0", (0, 100)).width == canvas.text("a??", (0, 100)).width
    for letter in "\n\r\t\x07\x1b\x85\u2028\u202e\u2066":  # nor do they begin a line, or turn the order around
        assert canvas.text(f"a{letter}b", (0, 100)) == canvas.text("a?b", (0, 100)), ascii(letter)


# Numbers and days as the language writes them, wherever they are drawn.


@pytest.fixture
def german(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("LANGUAGE", "en")
    texts.choose("de")
    typeface.forget()
    yield
    texts.choose("en")
    typeface.forget()


@pytest.mark.usefixtures("german")
def test_numbers_are_written_as_the_language_does(subtests: pytest.Subtests):
    for written, said in {
        "3.5 m/s": "3,5 m/s", "−12,345.67 of 1,000": "−12 345,67 of 1 000", "at 3.5.": "at 3,5.", "1, 2, 3": "1, 2, 3",
        "1.5k (0.25)": "1,5k (0,25)", "v1.2, 1.2.3": "v1.2, 1.2.3", "/tmp/1.5/a": "/tmp/1.5/a",
        "2026-11-24 10:20": "24.11.2026 10:20", "2026-11-24 10.20.30.png": "2026-11-24 10.20.30.png",
    }.items():  # fmt: skip
        with subtests.test(written=written):
            assert typeface.numbers(written) == said.replace(" 345", "\u00a0345").replace("1 000", "1\u00a0000")


@pytest.mark.usefixtures("german")
def test_a_text_is_as_wide_as_what_is_written_and_code_stays():
    for tabular in (False, True):
        assert typeface.span("0.5 m", 16.0, "regular", tabular) == typeface.span("0,5 m", 16.0, "regular", tabular)
    assert typeface.reach("0.5", 160.0, "code") == typeface.reach("0,5", 160.0, "code")  # all signs are equally wide
    assert (typeface.render("0.5", 16.0, "code", (255,) * 3)[0].get_buffer().raw
            != typeface.render("0,5", 16.0, "code", (255,) * 3)[0].get_buffer().raw)  # fmt: skip


@pytest.mark.usefixtures("german")
def test_a_translation_shrinks_to_the_smallest_text_of_the_game_and_english_not_at_all():
    assert [least(size) for size in (30.0, 15.0, 11.0)] == [21.0, 12.0, 11.0]
    texts.choose("en")
    assert least(15.0) == 15.0
