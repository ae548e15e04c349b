"""A digit is drawn, and read, by the keyboard alone and by a gamepad alone."""

import pygame
import pytest

from game.scenes.digits.quiz import QuizScene
from game.scenes.digits.scene import DigitsScene
from game.ui.virtual_pointer import PictureRow
from tests.support.player import DEVICES, Player
from tests.support.screens import reader


@pytest.fixture(params=DEVICES)
def player(request: pytest.FixtureRequest, open_game) -> Player:
    player = Player(open_game(DigitsScene), request.param)
    player.frames(3)
    return player


def take_the_pen(player: Player) -> None:
    for direction in ["left"] * 2 + ["down"] * 14 + ["left"] * 2:
        if isinstance(player.form.focused, PictureRow):
            break
        player.press(direction)
    player.press("confirm")
    assert player.form.typing


def go(player: Player, direction: str, frames: int) -> None:
    player.hold(direction, down=True)
    player.frames(frames)
    player.hold(direction, down=False)


def test_a_one_is_drawn_and_read(player: Player):
    take_the_pen(player)
    go(player, "up", 32)
    assert player.top.pad.empty
    player.hold("confirm", down=True)
    go(player, "down", 64)
    player.hold("confirm", down=False)
    go(player, "right", 20)
    [stroke] = player.top.pad.strokes
    assert stroke[-1][1] - stroke[0][1] > 250
    assert abs(stroke[-1][0] - stroke[0][0]) < 2
    assert player.top.probabilities.argmax() == 1
    player.press("back")
    assert not player.form.typing
    assert player.top_name == "DigitsScene"
    player.press("back")
    assert not player.app.scenes.running


def test_the_pen_stays_on_the_pad(player: Player):
    take_the_pen(player)
    player.hold("confirm", down=True)
    player.app.window.minimised = True  # nobody looks
    go(player, "left", 90)
    go(player, "up", 90)
    player.hold("confirm", down=False)
    [stroke] = player.top.pad.strokes
    assert stroke.min() < 3
    width, height = player.top.pad.rect.size
    assert ((stroke >= 0) & (stroke <= (width, height))).all()


def test_a_stick_moves_it_as_far_as_it_is_pushed(open_game):
    player = Player(open_game(DigitsScene), "pad")
    player.frames(3)
    take_the_pen(player)
    before = player.the(PictureRow).place.x
    player.axis(pygame.CONTROLLER_AXIS_LEFTX, 32767)
    player.frames(10)
    fast = player.the(PictureRow).place.x - before
    player.axis(pygame.CONTROLLER_AXIS_LEFTX, 16000)
    before = player.the(PictureRow).place.x
    player.frames(10)
    assert 0.3 * fast < player.the(PictureRow).place.x - before < 0.7 * fast
    player.axis(pygame.CONTROLLER_AXIS_LEFTX, 2000)
    before = player.the(PictureRow).place.x
    player.frames(10)
    assert player.the(PictureRow).place.x == before
    assert player.form.focused is player.the(PictureRow)


def test_a_lost_focus_lifts_the_pen(player: Player):
    take_the_pen(player)
    player.hold("confirm", down=True)
    player.key(pygame.K_TAB)
    player.frames(2)
    assert not player.form.typing
    assert not player.top.pad.drawing


@pytest.mark.parametrize("device", DEVICES)
def test_a_round_of_the_quiz_is_drawn_without_a_mouse(open_game, device: str):
    player = Player(open_game(QuizScene, reader()), device)
    player.frames(3)
    take_the_pen(player)
    player.hold("confirm", down=True)
    go(player, "down", 30)
    player.hold("confirm", down=False)
    player.press("back")
    player.press("right", "confirm")
    assert player.top.contest.rounds[0].answer is not None
