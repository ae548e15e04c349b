"""What is seen behind the menu."""

import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ai.lander.environment import Outcome
from game.scenes.menu_background import Vista
from game.ui.context import Context


@pytest.mark.parametrize("folder", [None, "nothing here"], ids=["network", "no network"])
def test_it_takes_off_is_flown_back_and_begins_anew(context: Context, folder: str | None, tmp_path: Path) -> None:
    vista = Vista()
    vista.enter(replace(context, models_dir=tmp_path / folder) if folder else context)
    end = time.monotonic() + 20
    while vista._pilot is None:
        assert time.monotonic() < end
        time.sleep(0.01)
    env, landings, highest = vista._env, 0, 0.0
    for _ in range(2400):
        over = vista._over
        vista.update()
        landings += vista._over and not over and env.outcome[0] == Outcome.LANDED
        highest = max(highest, float(env.position[0, 1]))
        assert abs(env.position[0, 0]) < 8, "it stays in sight"
    assert landings >= 2
    assert 8 < highest < 14


def test_it_stands_still_where_motion_is_reduced(context: Context) -> None:
    context.settings.reduced_motion = True
    vista = Vista()
    vista.enter(context)
    pose = vista._poses.at(1.0)
    for _ in range(60):
        vista.update()
    assert np.array_equal(vista._poses.at(1.0), pose)


def test_it_stands_again_when_motion_is_reduced_in_its_midst(context: Context) -> None:
    vista = Vista()
    vista.enter(context)
    pose = vista._poses.at(1.0)
    for _ in range(60):
        vista.update()
    assert not np.array_equal(vista._poses.at(1.0), pose)
    context.settings.reduced_motion = True
    vista.enter(context)
    vista.update()
    assert np.array_equal(vista._poses.at(0.5), pose)
    assert not vista._stage.thrust.any()
