"""A tap counts, even if a slow frame brings the press and the release at once."""

from collections.abc import Callable
from typing import Any

import pygame
import pytest

from game.scenes.play.descent import Descent
from game.scenes.play.scene import PlayScene
from tests.support.driver import Driver
from tests.support.flights import play

Open = Callable[..., Driver]
pytestmark = pytest.mark.usefixtures("scripted_network")
PAIRS: dict[str, list[tuple[int, dict[str, Any]]]] = {
    "key": [(pygame.KEYDOWN, {"key": pygame.K_UP, "mod": 0}), (pygame.KEYUP, {"key": pygame.K_UP, "mod": 0})],
    "pad": [
        (pygame.CONTROLLERBUTTONDOWN, {"button": pygame.CONTROLLER_BUTTON_A, "instance_id": 0}),
        (pygame.CONTROLLERBUTTONUP, {"button": pygame.CONTROLLER_BUTTON_A, "instance_id": 0}),
    ],
    "mouse": [
        (pygame.MOUSEBUTTONDOWN, {"button": 1, "pos": (640, 300)}),
        (pygame.MOUSEBUTTONUP, {"button": 1, "pos": (640, 300)}),
    ],
}


def tap(driver: Driver, device: str) -> None:
    """Press and let go within one frame."""
    for kind, values in PAIRS[device]:
        pygame.event.post(pygame.event.Event(kind, values))
    driver.frames(1)


@pytest.mark.parametrize("one_switch", [False, True])
@pytest.mark.parametrize("device", PAIRS)
def test_a_tap_within_one_frame_begins_a_flight_that_waits(open_game: Open, device: str, one_switch: bool):
    driver = open_game(PlayScene, 4)
    driver.app.context.settings.one_switch = one_switch
    driver.frames(3)
    assert play(driver).waiting
    tap(driver, device)
    assert not play(driver).waiting
    driver.frames(3)
    actions = play(driver).flight.recording.actions
    assert actions[0] >= 3  # it fires for the step of the press, and no longer
    assert all(action < 3 for action in actions[1:])


def test_a_tap_switches_a_latched_engine_on_and_the_next_one_off(open_game: Open):
    driver = open_game(PlayScene, 4)
    driver.app.context.settings.toggle_thrust = True
    driver.frames(3)
    tap(driver, "key")
    driver.frames(5)
    assert play(driver).flight.recording.actions[-1] >= 3
    tap(driver, "key")
    driver.frames(5)
    assert play(driver).flight.recording.actions[-1] < 3


def test_the_tap_that_asks_for_another_start_does_not_begin_it(open_game: Open):
    driver = open_game(PlayScene, 4, challenge=Descent())
    driver.frames(3)
    tap(driver, "key")
    while not play(driver).flight.over:
        driver.post(pygame.KEYDOWN, key=pygame.K_UP, mod=0)
        driver.skip(30)
        driver.post(pygame.KEYUP, key=pygame.K_UP, mod=0)
        driver.skip(120)
    driver.skip(240)
    for kind in (pygame.KEYDOWN, pygame.KEYUP):
        pygame.event.post(pygame.event.Event(kind, key=pygame.K_SPACE, mod=0))
    driver.frames(5)
    assert play(driver).waiting
