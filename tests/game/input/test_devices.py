"""What devices do that nobody holds, and what is said of those that nobody knows; all by real events."""

import re
from collections.abc import Callable
from pathlib import Path

import pygame
import pytest

import game
from game.core import texts
from game.core.scene import Transition
from game.input.bindings import KEYBOARD, Bindings, Command, Held
from game.scenes.digits.scene import DigitsScene
from game.scenes.menus.settings import SettingsScene
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from game.ui.panel import Panel
from game.ui.panel_scene import PanelScene
from tests.game.input.test_pads import VirtualPads, pads  # noqa: F401
from tests.support.driver import Driver
from tests.support.flights import actions, play
from tests.support.screens import save_settings

Open = Callable[..., Driver]
TURN, RISE, PULL = pygame.CONTROLLER_AXIS_LEFTX, pygame.CONTROLLER_AXIS_RIGHTY, pygame.CONTROLLER_AXIS_TRIGGERRIGHT


@pytest.mark.parametrize(("axis", "end"), [(TURN, -32768), (PULL, 32767)])
def test_an_axis_that_rests_at_its_end_is_heard_once_it_was_moved_away_and_back(open_game: Open, axis: int, end: int):
    driver = open_game(PlayScene, seed=4)
    driver.frames(2)
    scene = play(driver)
    for value in (end, end - (end > 0), end):
        driver.axis(axis, value)
        driver.frames(5)
    assert scene.waiting
    driver.axis(axis, 0)
    driver.axis(axis, end)
    driver.frames(5)
    assert not play(driver).waiting
    assert any(actions(scene.flight))


def test_a_device_without_a_mapping_is_told(game: Driver, pads: VirtualPads):  # noqa: F811
    game.frames(2)
    assert pads._sdl.SDL_JoystickAttachVirtual(0, 2, 4, 0) >= 0
    game.frames(3)
    assert game.said == texts.PAD_UNKNOWN
    pads.plug_in()
    game.frames(3)
    assert game.said.startswith(texts.PAD_FOUND.partition("{")[0])


# Menus go by their own keys


def held(driver: Driver, key: int, frames: int) -> None:
    driver.post(pygame.KEYDOWN, key=key, mod=0, unicode="", scancode=0)
    driver.frames(frames)
    driver.post(pygame.KEYUP, key=key, mod=0, unicode="", scancode=0)


def test_a_held_direction_repeats_by_the_keys_of_menus_whatever_flies(open_game: Open, context: Context):
    save_settings(context, keys={"left": ["j"]})
    driver = open_game(SettingsScene, "sound")
    slider = driver.widget(texts.SOUND_GROUPS["master"])
    driver.form.focus(slider)
    held(driver, pygame.K_j, 80)
    assert slider.value == 1.0
    held(driver, pygame.K_LEFT, 80)
    assert slider.value == 0.0
    driver.form.focus(driver.form.widgets[0])
    held(driver, pygame.K_DOWN, 40)
    assert driver.form.widgets.index(driver.form.focused) > 2


def test_keys_that_screens_use_themselves_cannot_be_bound_to_anything():
    sources = [path.read_text() for path in Path(game.__file__).parent.rglob("*.py") if path.parent.name != "input"]
    used = {getattr(pygame, name) for source in sources for name in re.findall(r"Action\(\s*pygame\.(K_\w+)", source)}
    assert {pygame.K_z, pygame.K_k} <= used
    bindings = Bindings(KEYBOARD)
    for key in used:
        for meaning in (Command.RETRY, Command.NEXT, Held.FINE, Held.MAIN):
            allowed = bindings.may(meaning, key)
            assert not allowed or (key in KEYBOARD.engines and isinstance(meaning, Held)), pygame.key.name(key)


# The mouse


def test_a_mouse_button_that_was_let_go_unheard_draws_no_more(open_game: Open):
    driver = open_game(DigitsScene)
    driver.frames(2)
    pad = driver.top.pad
    start, (x, y) = pygame.Vector2(pad.rect.center), pad.rect.topleft
    driver.post(pygame.MOUSEBUTTONDOWN, pos=driver.to_window(start), button=1)
    for buttons, place in (((1, 0, 0), (x + 60, y + 60)), ((0, 0, 0), (x + 90, y + 200))):
        driver.post(pygame.MOUSEMOTION, pos=driver.to_window(place), rel=(0, 0), buttons=buttons)
        driver.frames(2)
        ink = pad.ink().sum()
    driver.post(pygame.MOUSEMOTION, pos=driver.to_window((x + 200, y + 30)), rel=(0, 0), buttons=(0, 0, 0))
    driver.frames(2)
    assert pad.ink().sum() == ink > 0


# One switch


class Page(PanelScene):
    """A word, a choice and a switch."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self.chosen: list[object] = []
        self.build()

    def describe(self, panel: Panel) -> None:
        panel.button("word", self._word)
        panel.choice("choice", ("a", "b", "c"), 0, lambda number: self.chosen.append(("choice", number)))
        panel.toggle("switch", False, lambda on: self.chosen.append(("switch", on)), "")

    def _word(self) -> Transition | None:
        self.chosen.append("word")
        return None


PRESSES = {
    "key": (pygame.KEYDOWN, {"key": pygame.K_SPACE, "mod": 0, "unicode": " ", "scancode": 0}),
    "mouse": (pygame.MOUSEBUTTONDOWN, {"pos": (4, 4), "button": 1}),
    "trigger": (pygame.CONTROLLERAXISMOTION, {"instance_id": 0, "axis": PULL, "value": 20000}),
}
RELEASES = {
    "key": (pygame.KEYUP, PRESSES["key"][1]),
    "mouse": (pygame.MOUSEBUTTONUP, PRESSES["mouse"][1]),
    "trigger": (pygame.CONTROLLERAXISMOTION, {"instance_id": 0, "axis": PULL, "value": 0}),
}


def marked(driver: Driver) -> str:
    scan = driver.app.scan
    stops = scan.stops(driver.top, driver.app.canvas)
    stop = stops[scan.index % len(stops)]
    return stop.widget.label if stop.widget else ""


@pytest.mark.parametrize("device", list(PRESSES))
def test_one_switch_changes_a_choice_and_a_trembling_hand_presses_once(open_game: Open, context: Context, device: str):
    save_settings(context, one_switch=True)
    driver = open_game(Page)
    page = driver.top
    for label, after in (("choice", [("choice", 1)]), ("switch", [("choice", 1), ("switch", True)])):
        driver.frames(15)
        while marked(driver) != label:
            driver.skip()
        driver.frames(4)
        for _ in range(3):  # as a hand that trembles
            for kind, values in (PRESSES[device], RELEASES[device]):
                driver.post(kind, **values)
        assert page.chosen == after
        driver.frames(20)


# Text


def test_letters_are_composed_only_while_a_line_takes_them(open_game: Open, monkeypatch: pytest.MonkeyPatch, written):
    calls = list[str]()
    for name in ("start_text_input", "stop_text_input"):
        monkeypatch.setattr(pygame.key, name, lambda name=name: calls.append(name))

    class Naming(PanelScene):
        def __init__(self, context: Context) -> None:
            super().__init__(context)
            self.build()

        def describe(self, panel: Panel) -> None:
            self.entry = panel.entry("old", lambda _: None, lambda: None, 12, str)

    driver = open_game(Naming)
    driver.frames(2)
    assert calls == ["stop_text_input"]
    driver.key(pygame.K_RETURN)
    driver.frames(1)
    assert calls[1:] == ["start_text_input"]
    entry = driver.top.entry
    driver.post(pygame.TEXTEDITING, text="にh", start=0, length=2)
    assert "oldにh" in written
    assert entry.text == "old"
    driver.key(pygame.K_BACKSPACE)  # belongs to the composition
    assert entry.text == "old"
    driver.post(pygame.TEXTINPUT, text="日")
    assert entry.text == "日"
    assert not entry.composed
    driver.key(pygame.K_RETURN)
    driver.frames(1)
    assert calls[2:] == ["stop_text_input"]
