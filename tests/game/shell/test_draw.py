"""Drawing changes nothing but pixels between two screens either; `tests/game/tour` asks it of each of them."""

from collections.abc import Callable

from game.ui.context import Context
from tests.game.tour.checkers import changed_by_drawing
from tests.support.driver import Driver
from tests.support.screens import SCREENS


def test_drawing_changes_nothing_while_one_scene_gives_way_to_another(
    open_game: Callable[..., Driver], context: Context
):
    driver = open_game(SCREENS["MenuScene"])
    driver.frames(5)
    driver.app.show(SCREENS["SettingsScene"])
    for _ in range(15):
        assert not changed_by_drawing(driver)
        driver.app.scenes.update()
