"""Notes have a row below all others, which give way to it."""

from collections.abc import Callable

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
def test_a_note_stands_whole_below_all_else_in_the_middle(
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
    driver.app.context.note(LONG)
    driver.frames(2)
    page = written.turn(driver.app.canvas)
    driver.frames(1)
    said = [note for note in page.notes if len(note.text) > 10 and note.text in LONG]
    assert " ".join(note.text for note in said) == LONG
    view = driver.app.canvas.view
    others = max(note.box.bottom for note in page.notes if note not in said)
    for note in said:
        assert view.contains(note.box)
        assert note.box.centerx == pytest.approx(view.centerx, abs=2)
        assert note.box.top > others
