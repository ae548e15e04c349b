"""Notes stand over all else at the foot of a window, and move nothing."""

from collections.abc import Callable

import pygame
import pytest

from game.scenes.menus.menu import MenuScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.screens import opened, save_settings
from tests.support.written import Written

Open = Callable[..., Driver]
LONG = "The game is open in another window, which keeps the settings. What you set in this one is lost when it closes."


@pytest.mark.parametrize(
    ("size", "text_size", "scene"), [((1280, 720), "normal", "Play"), ((800, 600), "largest", "MenuScene")]
)
def test_a_note_stands_whole_in_the_middle_moves_nothing_and_goes_by_a_click(
    open_game: Open,
    context: Context,
    monkeypatch: pytest.MonkeyPatch,
    size: tuple[int, int],
    text_size: str,
    scene: str,
):
    save_settings(context, text_size=text_size)
    written = Written(monkeypatch.setattr)
    driver = open_game(MenuScene) if scene == "MenuScene" else opened(open_game, scene)
    driver.resize(size)
    places = [pygame.FRect(widget.box) for widget in driver.form.widgets]
    hints = driver.hints()
    driver.app.context.note(LONG)
    driver.frames(2)
    assert [widget.box for widget in driver.form.widgets] == places
    assert driver.hints() == hints
    page = written.turn(driver.app.canvas)
    driver.frames(1)
    said = [note for note in page.notes if len(note.text) > 10 and note.text in LONG]
    assert " ".join(note.text for note in said) == LONG
    view = driver.app.canvas.view
    for note in said:
        assert view.contains(note.box)
        assert note.box.centerx == pytest.approx(view.centerx, abs=2)
    place = driver.app.canvas.reading.points(driver.app.canvas.pixels(said[0].box.center))
    scene = driver.top
    driver.click(place)
    assert (driver.top, driver.app.canvas.message.height) == (scene, 0.0)
