"""Notes move aside; `tests/game/tour` asks every screen whether they hide anything there."""

from collections.abc import Callable

import pytest

from game.drawing.tokens import VIEW_SIZE
from game.scenes.menus.menu import MenuScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.screens import crashed, opened, save_settings

Open = Callable[..., Driver]
NOTE = "Saved as a network with a rather long name: fly with it, or watch it."


def test_a_note_moves_aside_where_the_middle_is_taken_in_every_row(open_game: Open, monkeypatch: pytest.MonkeyPatch):
    driver = open_game(MenuScene)
    driver.frames(2)
    notes, canvas = driver.app.notes, driver.app.canvas
    taken = canvas.rect(800, 0, VIEW_SIZE[0] - 800, VIEW_SIZE[1])
    monkeypatch.setattr(canvas, "words", [taken])
    notes.show(NOTE)
    notes.update(canvas)
    box = notes.box(canvas)
    assert not box.colliderect(taken)
    assert canvas.surface.get_rect().contains(box)


LONG = "The game is open in another window, which keeps the settings. What you set in this one is lost when it closes."


@pytest.mark.parametrize(("size", "text_size"), [((800, 600), "largest"), ((720, 1280), "large")])
def test_a_long_note_lies_on_no_word_pad_or_craft_before_a_flight_and_on_no_card_after_it(
    open_game: Open, context: Context, size: tuple[int, int], text_size: str
):
    save_settings(context, text_size=text_size)
    driver = opened(open_game, "Play")
    driver.resize(size)
    for happens in (lambda _: None, crashed):
        happens(driver)
        driver.app.context.note(LONG)
        driver.frames(3)
        notes, canvas = driver.app.notes, driver.app.canvas
        place = notes.box(canvas)
        canvas.turn_page()
        assert canvas.looked_at
        # The largest card in the smallest window leaves room on the row of hints alone.
        cards = [area for area in canvas.words if area.height > 0.6 * size[1]]
        words = cards or canvas.words
        hidden = [area for area in (*words, *canvas.looked_at) if area.colliderect(place)]
        assert not hidden
        assert canvas.surface.get_rect().contains(place)
