"""Every screen opens, and goes on, in any window and after a long stop; a full screen may be as small as it likes."""

from collections.abc import Callable, Iterator

import pytest

from game.core.scene import Pop, Push
from game.drawing.paint_cache import A_FRAME, spread
from game.scenes.menus.menu import MenuScene
from game.shell import window
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.screens import FLOWN, OVER_OTHERS, SCREENS, opened, save_settings
from tests.support.small import learn

Open = Callable[..., Driver]
SMALLEST, LARGEST = (320, 200), (7680, 4320)
NARROW = (320, 1200), (1600, 200)
STOPPED = 30.0  # seconds


@pytest.fixture(autouse=True)
def any_size(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(window, "MINIMUM_SIZE", (1, 1))
    spread(A_FRAME)  # a rough land will do
    yield
    spread(0)


def open_in(driver: Driver, name: str, size: tuple[int, int]) -> None:
    """Open a screen over the menu in a window of that size."""
    driver.app.window.size = size
    driver.frames(2)
    assert driver.app.window.size == size
    if name == "FlightPauseScene":
        driver.app.scenes.apply(Push(FLOWN["Play"](driver.app.context)))
    make = (lambda _: OVER_OTHERS[name](driver.top)) if name in OVER_OTHERS else {**SCREENS, **FLOWN}[name]
    driver.app.scenes.apply(Push(make(driver.app.context)))


@pytest.mark.slow
def test_every_screen_opens_in_the_smallest_window_goes_on_in_narrow_ones_and_after_a_long_stop(
    open_game: Open, context: Context, subtests: pytest.Subtests
) -> None:
    """Half a minute in which nothing ran, as of a computer that slept, pauses a flight and nothing else."""
    save_settings(context, text_size="largest")
    driver = open_game(MenuScene)
    scenes, clock, slept = driver.app.scenes, driver.app._now, 0.0
    driver.app._now = lambda: clock() + slept
    for name in (*SCREENS, *FLOWN, *OVER_OTHERS):
        with subtests.test(name):
            open_in(driver, name, SMALLEST)
            screen = driver.top_name
            for size in (SMALLEST, *NARROW):
                driver.app.window.size = size
                driver.frames(2)
                assert (driver.top_name, driver.app.window.size) == (screen, size)
            slept += STOPPED
            driver.frames(3)
            assert driver.top_name in (screen, "FlightPauseScene")
        while len(scenes.stack) > 1:
            scenes.apply(Pop())


def test_a_flight_has_flown_no_further_than_the_frames_that_were_seen(open_game: Open, context: Context) -> None:
    save_settings(context)
    driver = opened(open_game, "Play")
    clock, flown = driver.app._now, driver.top.flight.at
    driver.app._now = lambda: clock() + STOPPED
    driver.frames(3)
    assert driver.top.flight.at <= flown + 8


def test_a_run_is_seen_in_the_smallest_window(train: Driver) -> None:
    learn(train)
    for size in (SMALLEST, *NARROW):
        train.app.window.size = size
        train.frames(5)
        assert train.top_name == "TrainScene"


@pytest.mark.slow
@pytest.mark.parametrize("name", ["MenuScene", "Play", "swarm", "TrainScene", "DigitsScene", "PhysicsScene"])
def test_screens_open_in_the_largest_window(open_game: Open, context: Context, name: str) -> None:
    save_settings(context)
    driver = open_game(MenuScene)
    open_in(driver, name, LARGEST)
    screen = driver.top_name
    driver.frames(2)
    assert driver.top_name == screen
