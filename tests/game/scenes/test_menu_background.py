"""What is seen behind the menu."""

import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ai.lander.environment import Outcome
from game.scenes.menus.background import MenuBackground
from game.ui.context import Context


@pytest.mark.parametrize("folder", [None, "nothing here"], ids=["network", "no network"])
def test_it_takes_off_is_flown_back_and_begins_anew(context: Context, folder: str | None, tmp_path: Path) -> None:
    background = MenuBackground(replace(context, models_dir=tmp_path / folder) if folder else context)
    end = time.monotonic() + 20
    while background.pilot is None:
        assert time.monotonic() < end
        time.sleep(0.01)
    env, landings, highest = background.env, 0, 0.0
    for _ in range(1800):
        over = background.over
        background.update()
        landings += background.over and not over and env.outcome[0] == Outcome.LANDED
        highest = max(highest, float(env.position[0, 1]))
        assert abs(env.position[0, 0]) < 8, "it stays in sight"
    assert landings >= 2
    assert 8 < highest < 14


def test_it_stands_again_when_motion_is_reduced_in_its_midst(context: Context) -> None:
    background = MenuBackground(context)
    pose = background.poses.at(1.0)
    for _ in range(60):
        background.update()
    assert not np.array_equal(background.poses.at(1.0), pose)
    context.settings.reduced_motion = True
    background.enter()
    background.update()
    assert np.array_equal(background.poses.at(0.5), pose)
    assert not background.stage.thrust.any()
