"""Every screen opens, and goes on, in a window of any size: a full screen may be smaller than the smallest window."""

from collections.abc import Callable, Iterator

import pytest

from game.core.scene import Push
from game.drawing.paint_cache import A_FRAME, spread
from game.scenes.menus.menu import MenuScene
from game.shell import window
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.screens import FLOWN, OVER_OTHERS, SCREENS, save_settings
from tests.support.small import learn

Open = Callable[..., Driver]
SMALLEST, LARGEST = (320, 200), (7680, 4320)
NARROW = (320, 1200), (1600, 200)


@pytest.fixture(autouse=True)
def any_size(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(window, "MINIMUM_SIZE", (1, 1))
    spread(A_FRAME)  # a rough land will do
    yield
    spread(0)


def opened_in(open_game: Open, name: str, size: tuple[int, int]) -> Driver:
    """Open a screen in a window of that size."""
    driver = open_game(FLOWN["Play"] if name == "FlightPauseScene" else MenuScene)
    driver.app.window.size = size
    driver.frames(2)
    assert driver.app.window.size == size
    make = (lambda _: OVER_OTHERS[name](driver.top)) if name in OVER_OTHERS else {**SCREENS, **FLOWN}[name]
    driver.app.scenes.apply(Push(make(driver.app.context)))
    return driver


@pytest.mark.parametrize("name", [*SCREENS, *FLOWN, *OVER_OTHERS])
def test_every_screen_opens_in_the_smallest_window_and_goes_on_in_narrow_ones(
    open_game: Open, context: Context, name: str
) -> None:
    save_settings(context, text_size="largest")
    driver = opened_in(open_game, name, SMALLEST)
    screen = driver.top_name
    for size in (SMALLEST, *NARROW):
        driver.app.window.size = size
        driver.frames(5)
        assert (driver.top_name, driver.app.window.size) == (screen, size)


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
    driver = opened_in(open_game, name, LARGEST)
    screen = driver.top_name
    driver.frames(2)
    assert driver.top_name == screen
