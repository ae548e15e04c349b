"""The real game in a real window, with real keys and the real mouse."""

import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pygame
import pytest

from game.core import texts
from game.drawing.tokens import HUMAN, NET, PALETTE, Colour
from game.scenes.menus.settings import SettingsScene
from game.shell.window import fitting
from tests.support.driver import Driver
from tests.support.window import ROOT, Window, screen, skip_without_a_screen, start

LESS_MOTION = texts.SETTINGS["reduced_motion"][0]
TO_SETTINGS = (*["Down"] * 5, "Return")
TO_LESS_MOTION = (*["Down"] * 4, "Return")
LAMP_AT_THE_TOP = pygame.Rect(360, 20, 280, 110)
CARDS = pygame.Rect(40, 140, 1200, 80)  # titles, wherever across the window the card stands
SHOWN = 2.0  # seconds after which a screen that was chosen is there, on a busy machine too


@pytest.fixture(scope="module")
def display() -> Iterator[str]:
    skip_without_a_screen()
    with screen() as name:
        yield name


def setting(window: Window, name: str) -> object:
    return json.loads((window.user_dir / "settings.json").read_text())[name]


@pytest.mark.slow
def test_a_setting_chosen_with_real_keys_survives_a_restart(display: str, tmp_path: Path):
    with start(display, tmp_path / "user") as window:
        window.key(*TO_SETTINGS)
        window.key(*TO_LESS_MOTION)
        window.wait_for(lambda: setting(window, "reduced_motion") is True, "the setting to be saved")
        window.key("Escape")
        assert window.close() == 0
    with start(display, tmp_path / "user") as window:
        window.key(*TO_SETTINGS, *TO_LESS_MOTION)
        window.wait_for(lambda: setting(window, "reduced_motion") is False, "the setting to change back")
        assert window.close() == 0


def place_of(driver: Driver, label: str, size: tuple[int, int]) -> tuple[int, int]:
    """Where the middle of a widget is in a window of that size, in pixels.

    That game keeps the settings of its folder: one in a real window beside it needs another.
    """
    driver.resize(size)
    return driver.to_window(driver.widget(label).box.center)


@pytest.mark.slow
def test_the_mouse_meets_what_it_sees_in_a_letterboxed_window(display: str, tmp_path: Path, open_game):
    size = (900, 760)
    settings = place_of(open_game(), texts.MENU["settings"][0], size)
    less_motion = place_of(open_game(SettingsScene), LESS_MOTION, size)
    with start(display, tmp_path / "window") as window:
        window.resize(*size)
        window.click(*settings)
        time.sleep(SHOWN)
        window.click(*less_motion)
        window.wait_for(lambda: setting(window, "reduced_motion") is True, "the setting to be saved")
        assert window.close() == 0


@pytest.mark.slow
def test_a_game_that_begins_in_full_screen_covers_the_screen_and_goes_to_and_fro(display: str, tmp_path: Path):
    with start(display, tmp_path / "user", "--fullscreen") as window:
        window.wait_for(lambda: window.picture().get_size() == (1280, 800), "the whole screen")
        for wanted in [False, True] * 4:
            window.key("F11")
            window.wait_for(lambda: setting(window, "full_screen") is wanted, "the toggle")  # noqa: B023
        assert window.picture_is_bright()
        window.key("F11")
        window.wait_for(lambda: window.picture().get_size() == (1280, 720), "the window's old size")
        assert window.close() == 0


@pytest.mark.parametrize(
    ("desktop", "size"),
    [((1920, 1080), (1280, 720)), ((1280, 720), (1280, 720)), ((800, 600), (800, 450)), ((1366, 700), (1244, 700))],
)
def test_the_first_window_fits_the_desktop(desktop: tuple[int, int], size: tuple[int, int]):
    assert fitting(desktop) == size


@pytest.mark.slow
def test_interrupt_ends_the_game_without_a_traceback(display: str, tmp_path: Path):
    with start(display, tmp_path / "user") as window:
        assert window.interrupt() == 130
        assert "Traceback" not in window.output()
        assert (tmp_path / "user" / "settings.json").exists()


def test_no_screen_is_a_message_and_exit_code_2(tmp_path: Path):
    hidden = ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")
    environment = {name: value for name, value in os.environ.items() if name not in hidden}
    finished = subprocess.run(
        [sys.executable, str(ROOT / "main.py"), "--user-dir", str(tmp_path)],
        env=environment,
        capture_output=True,
        check=False,
        text=True,
        timeout=300,
    )
    assert finished.returncode == 2
    assert "needs a screen" in finished.stderr
    assert "Traceback" not in finished.stderr


@pytest.mark.slow
def test_the_mouse_meets_what_it_sees_in_full_screen_and_back(tmp_path: Path, open_game):
    skip_without_a_screen()
    driver = open_game(SettingsScene)
    with screen("1366x768x24") as display, start(display, tmp_path / "window") as window:
        for wide, high in ((1366, 768), (1280, 720)):  # the whole screen, and the window as it was before
            if wide == 1366:
                window.key("F11")
                window.wait_for(lambda: window.picture().get_size() == (1366, 768), "the whole screen")
                window.key(*TO_SETTINGS)
                time.sleep(SHOWN)
            else:
                window.key("F11")
                window.wait_for(lambda: window.picture().get_size() == (1280, 720), "the window")
            window.click(*place_of(driver, LESS_MOTION, (wide, high)))
            wanted = wide == 1366
            window.wait_for(lambda: setting(window, "reduced_motion") is wanted, "the switch")  # noqa: B023
        assert window.close() == 0


# Flights


def shows(window: Window, colour: Colour, area: pygame.Rect) -> bool:
    picture = window.picture().subsurface(area)
    width, height = picture.get_size()
    seen = (picture.get_at((x, y)) for x in range(width) for y in range(height))
    return sum(max(abs(a - b) for a, b in zip(pixel[:3], colour, strict=True)) < 8 for pixel in seen) > 12


@pytest.mark.slow
def test_play_hand_over_take_back_hand_over_and_it_lands(display: str, tmp_path: Path):
    (tmp_path / "user").mkdir()
    (tmp_path / "user" / "settings.json").write_text('{"tutored": true}', encoding="utf-8")  # or a first flight teaches
    with start(display, tmp_path / "user") as window:
        window.key("Return", "Return")  # the page of Play, and free flight
        window.wait_for(lambda: shows(window, HUMAN, LAMP_AT_THE_TOP), "the lamp that says you fly")
        window.key("Tab")
        window.wait_for(lambda: shows(window, NET, LAMP_AT_THE_TOP), "the lamp that says the network flies")
        window.key("Tab")
        window.wait_for(lambda: shows(window, HUMAN, LAMP_AT_THE_TOP), "the stick to come back")
        window.key("Tab")
        for _ in range(4):  # even a good network may lose one that was steered badly before
            window.wait_for(
                lambda: shows(window, PALETTE.good, CARDS) or shows(window, PALETTE.warn, CARDS),
                "the end of the flight",
                40,
            )
            if shows(window, PALETTE.good, CARDS):
                break
            window.key("Return", "Tab")
        assert shows(window, PALETTE.good, CARDS)
        assert window.close() == 0


@pytest.mark.slow
def test_watch_flies_a_swarm_and_counts_its_landings(display: str, tmp_path: Path):
    with start(display, tmp_path / "user") as window:
        window.key("Down", "Return")
        window.wait_for(lambda: shows(window, NET, pygame.Rect(60, 16, 24, 24)), "the network to fly")
        window.key("Down", "Right", "Down", "Right")  # many, and faster
        window.wait_for(lambda: shows(window, PALETTE.good, pygame.Rect(60, 44, 80, 36)), "landings", 60)
        assert window.close() == 0
