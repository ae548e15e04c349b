"""Keys on other keyboards, and with Ctrl, Alt and the system key held: real events, the layout by its own table."""

from collections.abc import Callable

import pygame
import pytest

from game.core import texts
from game.flight.flight import StickHolder
from game.input import controls as module
from game.input.controls import Command, Held
from game.input.layout import Layout
from game.scenes.menus.keys import BindingsScene
from game.scenes.menus.menu import MenuScene
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.flights import actions, play

Open = Callable[..., Driver]
US = "`1234567890-=qwertyuiop[]\\asdfghjkl;'zxcvbnm,./"
ROWS = {
    "us": US,
    "fr": "²&é\"'(-è_çà)=azertyuiop^$*qsdfghjklmùwxcvbn,;:!",
    "ru": "ё1234567890-=йцукенгшщзхъ\\фывапролджэячсмитьбю.",
    "he": ";1234567890-=/'קראטוןםפ][\\שדגכעיחלךף,זסבהנמצתץ.",
}
SCANCODES = [
    53, *range(30, 40), 45, 46, 20, 26, 8, 21, 23, 28, 24, 12, 18, 19, 47, 48, 49,
    4, 22, 7, 9, 10, 11, 13, 14, 15, 51, 52, 29, 27, 6, 25, 5, 17, 16, 54, 55, 56,
]  # fmt: skip
ALL = ["fr", "ru", "he"]


def switch_on(driver: Driver, monkeypatch: pytest.MonkeyPatch, layout: str) -> None:
    """Switch on a layout, as the system reports it."""
    keys = {ord(letter): scancode for letter, scancode in zip(ROWS[layout], SCANCODES, strict=True)}
    monkeypatch.setattr(module, "Layout", lambda: Layout(lambda code: keys.get(code, 0)))
    driver.post(pygame.KEYMAPCHANGED)


def press(driver: Driver, layout: str, place: str, mod: int = 0) -> None:
    """Press the key at the place of an American key, and let go of it."""
    number = US.index(place)
    values = {"key": ord(ROWS[layout][number]), "mod": mod, "unicode": "", "scancode": SCANCODES[number]}
    driver.post(pygame.KEYDOWN, **values)
    driver.post(pygame.KEYUP, **values)


def place_of(layout: str, letter: str) -> str:
    """Where a letter stands; where it would on an American keyboard, if the layout has none."""
    row = ROWS[layout]
    return US[row.index(letter)] if letter in row else letter


@pytest.mark.parametrize("layout", ALL)
def test_flying_goes_by_place_and_letters_of_commands_by_what_is_written(
    open_game: Open, monkeypatch: pytest.MonkeyPatch, layout: str
):
    driver = open_game(PlayScene, seed=4)
    driver.frames(2)
    switch_on(driver, monkeypatch, layout)
    scene = play(driver)
    press(driver, layout, "w")
    driver.frames(3)
    assert actions(scene.flight)[0] >= 3, "the key of the American W fires"
    flown = scene.flight
    press(driver, layout, place_of(layout, "r"))
    assert scene.flight is not flown, "R tries again"
    press(driver, layout, place_of(layout, "c"))
    assert driver.top_name == "FlightPauseScene"
    press(driver, layout, place_of(layout, "c"))
    assert driver.top is scene


@pytest.mark.parametrize("layout", ALL)
def test_hints_show_what_is_printed_on_this_keyboard(open_game: Open, monkeypatch: pytest.MonkeyPatch, layout: str):
    driver = open_game(BindingsScene)
    switch_on(driver, monkeypatch, layout)
    controls = driver.app.context.controls
    left = {"fr": "Q", "ru": "Ф", "he": "A"}[layout]
    again = {"fr": "R", "ru": "К", "he": "R"}[layout]
    assert left in controls.key_names(Held.LEFT)
    assert controls.word(Command.RETRY) == again


@pytest.mark.parametrize("layout", ALL)
def test_ctrl_v_pastes_on_every_keyboard(open_game: Open, monkeypatch: pytest.MonkeyPatch, layout: str):
    driver = open_game(MenuScene)
    switch_on(driver, monkeypatch, layout)
    monkeypatch.setattr(pygame.scrap, "get_text", lambda: "no flight")
    press(driver, layout, place_of(layout, "v"), pygame.KMOD_LCTRL)
    assert driver.said == texts.CODE_PASTE_REFUSED.format(reason=texts.CODE_REFUSED["none"])


@pytest.mark.parametrize("mod", [pygame.KMOD_LCTRL, pygame.KMOD_LALT, pygame.KMOD_RALT, pygame.KMOD_LMETA])
def test_with_ctrl_alt_or_the_system_key_nothing_is_a_command(open_game: Open, mod: int):
    driver = open_game(PlayScene, seed=4)
    driver.frames(2)
    scene, flight = play(driver), play(driver).flight
    for key in (pygame.K_TAB, pygame.K_r, pygame.K_c, pygame.K_n, pygame.K_g, pygame.K_p, pygame.K_UP, pygame.K_w,
                pygame.K_SPACE, pygame.K_ESCAPE, pygame.K_PLUS, pygame.K_F1, pygame.K_F10, pygame.K_k):  # fmt: skip
        driver.key(key, mod, drawn=False)
        assert driver.top is scene, pygame.key.name(key)
        assert scene.flight is flight, pygame.key.name(key)
    assert scene.waiting
    assert flight.chooser.hand is StickHolder.HUMAN
    settings = driver.app.context.settings
    assert (settings.help, settings.show_thinking, settings.muted) == ("off", False, False)
    driver = open_game(MenuScene)
    before = driver.form.focused
    for key in (pygame.K_TAB, pygame.K_DOWN, pygame.K_s, pygame.K_RETURN * (mod & pygame.KMOD_ALT == 0) or pygame.K_UP):
        driver.key(key, mod, drawn=False)
    assert driver.form.focused is before
    assert isinstance(driver.top, MenuScene)


def test_alt_enter_stays_and_a_bound_ctrl_key_holds_nothing_back(open_game: Open, context: Context):
    driver = open_game(MenuScene)
    before = driver.app.context.settings.full_screen
    driver.key(pygame.K_RETURN, pygame.KMOD_LALT)
    assert driver.app.context.settings.full_screen is not before
    driver.key(pygame.K_RETURN, pygame.KMOD_LALT)
    driver.app.settings_writer.wait()  # or what it writes of before comes last
    context.settings.keys = {"fine": ["lctrl"]}
    context.settings_file.save(context.settings)
    driver = open_game(PlayScene, seed=4)
    driver.frames(2)
    driver.key(pygame.K_c, pygame.KMOD_LCTRL)
    assert driver.top_name == "FlightPauseScene"
