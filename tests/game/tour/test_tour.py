"""One tour opens each screen in each of its states, and every checker looks at it."""

from pathlib import Path

import numpy as np
import pytest

from game.core.settings import TOP_RUNG, Settings
from game.ui.context import Context
from tests.game.tour.checkers import Visit, checkers_at
from tests.game.tour.stops import STOPS, Stop
from tests.game.tour.walks import devices, walk
from tests.support.driver import Driver
from tests.support.games import games
from tests.support.written import Written

PARTS = 8  # so that several processes share the way


@pytest.mark.parametrize("part", range(PARTS))
def test_what_holds_on_every_screen(subtests: pytest.Subtests, tmp_path: Path, part: int):
    for number, stop in enumerate(STOPS[part::PARTS]):
        visit(subtests, stop, tmp_path / str(number))


def visit(subtests: pytest.Subtests, stop: Stop, folder: Path) -> None:
    context = Context(folder / "user", Settings(rung=TOP_RUNG), rng=np.random.default_rng(1))
    with pytest.MonkeyPatch.context() as patch, games(context) as open_game:
        with subtests.test(stop=str(stop)):
            visit = Visit(stop, stop.open(open_game, context), Written(patch.setattr))
            scene = visit.driver.top
            for checker in checkers_at(stop):
                with subtests.test(stop=str(stop), checker=checker.__name__):
                    checker(visit)
                    assert visit.driver.top is scene, f"{visit.driver.top_name} stands there now"
        game: Driver | None = visit.driver  # as it was found; who has left a screen opens it anew
        for device in devices(stop):
            with subtests.test(stop=str(stop), device=device):
                walk(game or stop.open(open_game, context), stop.screen, device)
            game = None
