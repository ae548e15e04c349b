"""Notes move aside; `tests/game/tour` asks every screen whether they hide anything there."""

from collections.abc import Callable

import pytest

from game.drawing.tokens import VIEW_SIZE
from game.scenes.menus.menu import MenuScene
from tests.support.driver import Driver

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
    box = canvas.rect(*notes.box(canvas))
    assert not box.colliderect(taken)
    assert canvas.surface.get_rect().contains(box)
