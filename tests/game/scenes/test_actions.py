"""What actions do and sound like; `tests/game/tour` asks each whether key, button and click run the same."""

from collections.abc import Callable

import pygame
import pytest

from game.core import texts
from game.input.controls import Command
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.screens import SCREENS, save_settings

Open = Callable[..., Driver]


@pytest.fixture
def unhurried(context: Context) -> None:
    save_settings(context)


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
    driver.key(pygame.K_DOWN)
    played: list[str] = []
    monkeypatch.setattr(context.sound, "play", played.append)
    driver.key(pygame.K_RETURN)
    by_key, played[:] = list(played), []
    driver.post(pygame.MOUSEBUTTONDOWN, pos=driver.to_window(driver.hints()[texts.HINT_CHANGE]), button=1)
    assert len(by_key) == 1
    assert played == by_key
