"""A game that was stopped for half a minute and woken goes on where it was, or pauses a flight, on every screen."""

from collections.abc import Callable

import pytest

from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.screens import FLOWN, OVER_OTHERS, SCREENS, opened, save_settings

Open = Callable[..., Driver]
STOPPED = 30.0  # seconds


@pytest.mark.parametrize("name", [*SCREENS, *FLOWN, *OVER_OTHERS])
def test_every_screen_goes_on_after_half_a_minute_in_which_nothing_ran(
    open_game: Open, context: Context, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    save_settings(context)
    driver = opened(open_game, name)
    before, clock = driver.top_name, driver.app._now
    monkeypatch.setattr(driver.app, "_now", lambda: clock() + STOPPED)
    driver.frames(20)
    assert driver.top_name in (before, "FlightPauseScene")


def test_a_flight_has_flown_no_further_than_the_frames_that_were_seen(
    open_game: Open, context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    save_settings(context)
    driver = opened(open_game, "Play")
    clock, flown = driver.app._now, driver.top.flight.at
    monkeypatch.setattr(driver.app, "_now", lambda: clock() + STOPPED)
    driver.frames(3)
    assert driver.top.flight.at <= flown + 8
