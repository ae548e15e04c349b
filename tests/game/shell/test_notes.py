"""Notes stand where they hide nothing that is to be read or pressed."""

from collections.abc import Callable
from functools import partial

import pygame
import pytest

from game.core.scene import Push, Scene
from game.drawing.tokens import VIEW_SIZE
from game.scenes.choices import ChoicesScene
from game.scenes.dialog import NameDialog
from game.scenes.digits import DigitsScene
from game.scenes.logbook import LogbookScene
from game.scenes.menu import MenuScene
from game.scenes.missions import MissionsScene
from game.scenes.pause import PauseScene
from game.scenes.play import PlayScene
from game.scenes.runs import NetworksScene
from game.scenes.settings import SettingsScene
from game.scenes.train import TrainScene
from game.scenes.watch import WatchScene
from game.ui.context import Context
from tests.support.driver import Driver

Open = Callable[..., Driver]
NOTE = "Saved as a network with a rather long name: fly with it, or watch it."


SCENES: dict[str, Callable[[Context], Scene]] = {
    "menu": MenuScene, "settings": SettingsScene, "logbook": LogbookScene, "missions": MissionsScene,
    "runs": NetworksScene, "digits": DigitsScene, "play": partial(PlayScene, seed=1),
    "watch": partial(WatchScene, seed=1), "pause": lambda context: PauseScene(context, MenuScene(context)),
    "choices": partial(PlayScene, seed=1), "naming": MenuScene, "train": TrainScene,
}  # fmt: skip


@pytest.mark.parametrize("name", SCENES)
def test_a_note_hides_nothing_that_is_to_be_read_or_pressed(open_game: Open, name: str):
    driver = open_game(SCENES[name])
    driver.frames(3)
    if name == "choices":
        driver.key(pygame.K_c)
        assert isinstance(driver.top, ChoicesScene)
    if name == "naming":
        driver.app.scenes.apply(Push(NameDialog(driver.top, "What shall it be called?", "one", lambda _: "")))
    driver.frames(3)
    driver.app.context.note(NOTE)
    driver.frames(2)
    notes, canvas = driver.app.notes, driver.app.canvas
    place = canvas.rect(*notes.box(canvas))
    canvas.turn_page()  # what stands on the last frame
    written = [area for area in canvas.words if area.colliderect(place)]
    assert not written, written
    driver.frames(30)
    assert place == canvas.rect(*notes.box(canvas))  # and it stays there


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
