"""The panel's figures and its sentence say the same chance in the same digits."""

from collections.abc import Callable

import pygame
import pytest

from game.core import texts
from game.drawing.canvas import Canvas
from game.panels.chance_values import ChanceValues, draw_chances
from game.scenes.play import PlayScene
from game.ui.context import Context
from tests.support.driver import Driver


@pytest.mark.parametrize(("asked", "required"), [(0.9991, 0.9994), (0.5, 0.97), (0.9696, 0.97), (0.99999, 0.9999)])
def test_the_head_of_the_panel_has_the_digits_of_its_sentence(asked: float, required: float, written: list[str]):
    values = ChanceValues((asked, 0.2, 0.3, 0.4, 0.5, 0.6), flown=1, asked=0, required=required)
    draw_chances(Canvas(pygame.Surface((1280, 720))), values, 100, 100, 240)
    assert values.told[0] != values.told[1]
    assert written[written.index(texts.CHANCE_ASKED) + 1] == values.told[1]
    assert values.told[0] in written


@pytest.mark.parametrize(("model", "told"), [("classic", True), ("", False)])
def test_a_guardian_without_a_critic_says_so_before_the_first_flight(
    open_game: Callable[..., Driver], context: Context, model: str, told: bool
):
    context.settings.model, context.settings.assist, context.settings.copilot = model, 0.4, "guardian"
    context.settings_file.save(context.settings)
    driver = open_game(PlayScene, 3)
    driver.frames(3)
    words = texts.GUARDIAN_NO_CRITIC.split("{")[0]
    assert driver.said.startswith(words) is told
