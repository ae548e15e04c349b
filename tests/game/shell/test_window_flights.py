"""The two flying scenes in a real window, with real keys."""

from collections.abc import Iterator
from pathlib import Path

import pygame
import pytest

from game.core.assets import MODELS_DIR
from game.drawing.tokens import HUMAN, NET, PALETTE, Colour
from tests.support.window import Window, screen, skip_without_a_screen, start

needs_a_network = pytest.mark.skipif(not (MODELS_DIR / "lander" / "modern").exists(), reason="no trained network here")
LAMP_AT_THE_TOP = pygame.Rect(360, 20, 280, 110)
CARDS = pygame.Rect(40, 140, 1200, 80)  # titles, wherever across the window the card stands

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def display() -> Iterator[str]:
    skip_without_a_screen()
    with screen() as name:
        yield name


def shows(window: Window, colour: Colour, area: pygame.Rect) -> bool:
    picture = window.picture().subsurface(area)
    width, height = picture.get_size()
    seen = (picture.get_at((x, y)) for x in range(width) for y in range(height))
    return sum(max(abs(a - b) for a, b in zip(pixel[:3], colour, strict=True)) < 8 for pixel in seen) > 12


@needs_a_network
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


@needs_a_network
def test_watch_flies_a_swarm_and_counts_its_landings(display: str, tmp_path: Path):
    with start(display, tmp_path / "user") as window:
        window.key("Down", "Return")
        window.wait_for(lambda: shows(window, NET, LAMP_AT_THE_TOP), "the network to fly")
        window.key("Down", "Right", "Right", "plus", "plus")
        window.wait_for(lambda: shows(window, PALETTE.good, pygame.Rect(60, 88, 80, 36)), "landings", 40)
        assert window.close() == 0
