"""Help follows simulated pilots who improve, who get worse, and who stay as they are."""

from collections.abc import Callable

import numpy as np
import pytest

from ai.copilot.alone import ASSISTS, BASE, SLOPE, Estimate
from game.core.settings import Settings
from game.flight import fading
from game.flight.becoming import Becoming
from game.flight.flight_file import Entry


def fly(settings: Settings, share: Callable[[int], float], flights: int, seed: int) -> list[float]:
    """Fly with checks now and then; `share` is how often the pilot would land alone in each flight."""
    rng = np.random.default_rng(seed)
    becoming, dial = Becoming(), []
    for number in range(flights):
        would = share(number)
        assist = settings.assist
        if assist == 0 or number % 5 == 4:
            entry = Entry(0.0, "LANDED" if rng.random() < would else "CRASHED", 10.0, 3.0, 0.4, 1.0, alone=True)
        else:
            base, slope = (float(np.interp(assist, ASSISTS, each)) for each in (BASE, SLOPE))
            calm = rng.random() < 1 / (1 + np.exp(-(base + slope * np.log(would / (1 - would)))))
            entry = Entry(0.0, "LANDED", 10.0, 3.0, 0.4, 0.98 if calm else 0.5, barred="helped", guarded=assist)
        change = becoming.add(entry)
        if change is not None:
            fading.fade(settings, change.after)
        dial.append(settings.assist)
    return dial


def fading_from(assist: float) -> Settings:
    settings = Settings(assist=assist)
    fading.switch(settings, on=True)
    return settings


@pytest.mark.parametrize("seed", range(3))
def test_help_goes_as_the_pilot_improves_and_comes_back_as_they_get_worse(seed: int):
    settings = fading_from(0.6)
    better = fly(settings, lambda number: 0.1 + 0.88 * min(1.0, number / 60), 160, seed)
    assert better[-1] <= 0.1
    worse = fly(fading_from(better[-1]), lambda _: 0.15, 80, seed)
    assert worse[-1] >= 0.5


@pytest.mark.parametrize("share", [0.1, 0.6, 0.97])
def test_help_is_steady_for_a_pilot_who_stays_as_they_are(share: float):
    dial = fly(fading_from(0.4), lambda _: share, 200, seed=1)[60:]
    assert np.ptp(dial) <= 0.2 + 1e-9
    turns = np.count_nonzero(np.diff(dial))
    assert turns <= 14  # of 140 flights


def test_it_goes_in_small_steps_and_waits_until_enough_is_known():
    dial = np.array([0.4, *fly(fading_from(0.4), lambda _: 0.98, 60, seed=2)])
    assert abs(np.diff(dial)).max() <= fading.STEP + 1e-9
    unknown = Estimate(0.9, 0.3, 1.0, alone=20)
    assert not unknown.known
    assert fading.faded(0.4, unknown) == 0.4
    assert fading.faded(0.1, Estimate(0.96, 0.9, 1.0, alone=20)) == 0.0
    assert fading.faded(0.0, Estimate(0.2, 0.1, 0.3, alone=20)) == 0.1
    assert fading.faded(0.6, Estimate(0.2, 0.1, 0.3, alone=20)) == 0.6


def test_the_players_own_turn_of_the_dial_is_respected():
    settings = fading_from(0.4)
    sure = Estimate(0.97, 0.93, 1.0, alone=20)
    assert fading.fade(settings, sure)
    assert (settings.assist, settings.fade) == (0.3, True)
    settings.assist = 0.5
    assert not fading.fade(settings, sure)
    assert (settings.assist, settings.fade) == (0.5, False)
    fading.switch(settings, on=True)
    assert fading.fade(settings, sure)
    assert settings.assist == 0.4


def test_without_the_switch_the_dial_stays():
    settings = Settings(assist=0.4, faded_to=0.4)
    assert not fading.fade(settings, Estimate(0.97, 0.93, 1.0, alone=20))
    assert settings.assist == 0.4
