"""Every action of every scene: its key, its button and a click on its hint run the same."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import pygame
import pytest

from ai.lander.missions import MISSIONS
from game.core import texts
from game.core.scene import Scene
from game.input.controls import Command
from game.play.challenge import FlownMission
from game.scenes.play import PlayScene
from game.scenes.watch import WatchScene
from game.ui.actions import Action, Table
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.screens import OVER_OTHERS, SCREENS, Make, opened, settle

Open = Callable[..., Driver]


def after(scene: Make, *keys: int, frames: int = 0) -> Callable[[Open], Driver]:
    """A way to open a scene, with keys that are pressed there and frames that pass."""

    def open_it(open_game: Open) -> Driver:
        driver = open_game(scene)
        driver.frames(3)
        driver.keys(*keys)
        driver.skip(frames)
        return driver

    return open_it


FLIGHT, MISSION = partial(PlayScene, seed=3), partial(PlayScene, seed=0, challenge=FlownMission(MISSIONS["fall"]))
STATES: dict[str, Callable[[Open], Driver]] = {
    **{name: partial(opened, name=name) for name in (*SCREENS, *OVER_OTHERS)},
    "swarm": after(partial(WatchScene, count=16, seed=2)),
    "stopped": after(partial(WatchScene, seed=2), pygame.K_SPACE),
    "touched": after(partial(WatchScene, seed=2), pygame.K_SPACE, pygame.K_q, pygame.K_m),
    "flight": after(FLIGHT),
    "network": after(FLIGHT, pygame.K_TAB),
    "card": after(FLIGHT, pygame.K_UP, frames=1300),
    "mission": after(MISSION),
    "mission, card": after(MISSION, pygame.K_UP, frames=700),
    "naming": after(SCREENS["NetworksScene"], pygame.K_F2),
    "quiz, read": after(SCREENS["QuizScene"], pygame.K_3),
    "binding": after(SCREENS["BindingsScene"], pygame.K_RETURN),
}
# What the keys of a typing widget, or the application itself, do before the scene's table is asked.
TAKEN = {
    "naming": {Command.CONFIRM, Command.BACK},
    "binding": {Command.PAUSE},
    "NameDialog": {Command.CONFIRM, Command.BACK},
}


class Recorder:
    """Stands in the table of a scene: notes which entry is run, and does nothing else."""

    def __init__(self, scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
        self.ran: list[Command | int] = []
        for name in ("actions", "_flight_actions", "_card_actions"):  # a flight has a table for each row of hints
            if table := getattr(scene, name, None):
                monkeypatch.setattr(scene, name, partial(self._noting, table))
        monkeypatch.setattr(scene, "update", lambda: None)

    def _noting(self, table: Callable[[], Table]) -> Table:
        return [
            replace(entry, run=partial(self.ran.append, entry.key)) if isinstance(entry, Action) else entry
            for entry in table()
        ]

    def take(self) -> list[Command | int]:
        ran, self.ran = self.ran, []
        return ran


@pytest.fixture
def unhurried(context: Context) -> None:
    settle(context)


@pytest.mark.parametrize("state", STATES)
@pytest.mark.usefixtures("unhurried", "scripted_network")
def test_the_key_the_button_and_the_click_run_the_same_action(
    open_game: Open, monkeypatch: pytest.MonkeyPatch, state: str
):
    driver = STATES[state](open_game)
    scene, controls = driver.top, driver.app.context.controls
    recorder, taken = Recorder(scene, monkeypatch), TAKEN.get(state, set())
    actions = [entry for entry in scene.actions() if isinstance(entry, Action)]
    assert actions
    for action in actions:
        if action.key is Command.FULLSCREEN or action.key in taken:  # the application's own
            continue
        codes = controls.keys.codes(action.key) if isinstance(action.key, Command) else [action.key]
        for code in codes:
            if code == pygame.K_TAB and not isinstance(scene, PlayScene) and state != "ReplayScene":
                continue  # moves the focus
            driver.key(code)
            assert recorder.take() == [action.key], f"{pygame.key.name(code)} of {action}"
        command = action.gamepad or (action.key if isinstance(action.key, Command) else None)
        for code in controls.buttons.codes(command) if command else ():
            if code < 32:  # the others are axes
                driver.button(code)
                assert recorder.take() == [action.key], f"button {code} of {action}"
    driver.key(pygame.K_F1)
    recorder.take()
    for pad in (False, True):
        controls.used_pad = 0 if pad else None
        told = {entry.hint: entry for entry in scene.actions() if isinstance(entry, Action) and entry.hint}
        for meaning, place in driver.hints().items():
            driver.post(pygame.MOUSEBUTTONDOWN, pos=driver.to_window(place), button=1)
            assert recorder.take() == [told.pop(meaning).key]
        assert not told or state in ("DigitsScene", "TrainScene")


@pytest.mark.parametrize("state", STATES)
@pytest.mark.usefixtures("unhurried", "scripted_network")
def test_every_hint_names_the_key_of_its_own_action(open_game: Open, state: str):
    driver = STATES[state](open_game)
    scene, controls = driver.top, driver.app.context.controls
    entries = {entry.hint: entry for entry in scene.actions() if isinstance(entry, Action) and entry.hint}
    rows = scene.hint_rows(driver.app.canvas)
    assert rows
    for row in rows:
        for hint in row.hints:
            if hint.run:
                assert hint.key == entries[hint.meaning].key_word(controls)


@pytest.mark.usefixtures("unhurried")
def test_full_screen_is_switched_by_its_key_and_by_a_click(open_game: Open, context: Context):
    driver = open_game(SCREENS["MenuScene"])
    driver.frames(2)
    action = next(entry for entry in driver.top.actions() if getattr(entry, "key", None) is Command.FULLSCREEN)
    for switch in (lambda: driver.key(pygame.K_F11), lambda: driver.click(driver.hints()[action.hint])):
        before = context.settings.full_screen
        switch()
        assert context.settings.full_screen is not before
    assert driver.app.window.full_screen is context.settings.full_screen


@pytest.mark.usefixtures("unhurried")
def test_a_press_and_a_click_on_its_hint_sound_the_same_and_once(
    open_game: Open, context: Context, monkeypatch: pytest.MonkeyPatch
):
    driver = open_game(SCREENS["SettingsScene"])
    driver.frames(2)
    played: list[str] = []
    monkeypatch.setattr(context.sound, "play", played.append)
    driver.key(pygame.K_RETURN)
    by_key, played[:] = list(played), []
    driver.post(pygame.MOUSEBUTTONDOWN, pos=driver.to_window(driver.hints()[texts.HINT_CHANGE]), button=1)
    assert len(by_key) == 1
    assert played == by_key
