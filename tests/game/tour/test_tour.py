"""One tour opens each screen in each of its states, and every checker looks at it."""

from pathlib import Path

import numpy as np
import pytest

from game.core.settings import TOP_RUNG, Settings
from game.ui.context import Context
from tests.game.tour.checkers import Visit, checkers_at
from tests.game.tour.stops import STOPS, Stop
from tests.game.tour.walks import every_widget_is_reached_and_there_is_a_way_out, the_mouse_alone_finds_a_way_out
from tests.support.games import games
from tests.support.player import DEVICES
from tests.support.screens import SCREENS
from tests.support.written import Written

PARTS = 8  # so that several processes share the way


@pytest.mark.parametrize("part", range(PARTS))
def test_what_holds_on_every_screen(subtests: pytest.Subtests, tmp_path: Path, part: int):
    for number, stop in enumerate(STOPS[part::PARTS]):
        visit(subtests, stop, tmp_path / str(number))


def visit(subtests: pytest.Subtests, stop: Stop, folder: Path) -> None:
    context = Context(folder / "user", Settings(rung=TOP_RUNG), rng=np.random.default_rng(1))
    with pytest.MonkeyPatch.context() as patch, games(context) as open_game:
        written = Written(patch.setattr)
        with subtests.test(stop=str(stop)):
            visit = Visit(stop, stop.open(open_game, context), written)
            scene = visit.driver.top
            for checker in checkers_at(stop):
                with subtests.test(stop=str(stop), checker=checker.__name__):
                    checker(visit)
                    assert visit.driver.top is scene, f"{visit.driver.top_name} stands there now"
        if stop.walked:
            for device in DEVICES:
                with subtests.test(stop=str(stop), device=device):
                    every_widget_is_reached_and_there_is_a_way_out(stop.open(open_game, context), stop.screen, device)
        if stop.screen in SCREENS and stop.walked:
            with subtests.test(stop=str(stop), device="mouse"):
                the_mouse_alone_finds_a_way_out(stop.open(open_game, context))
