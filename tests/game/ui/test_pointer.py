"""What a mouse can do, keys alone and a gamepad alone can do as well."""

from collections.abc import Callable

import numpy as np
import pygame
import pytest

from ai.agent.network import build_network
from ai.lander.environment import NUM_ACTIONS, NUM_FEATURES
from ai.training.config import Config
from game.scenes.physics.scene import PhysicsScene
from game.scenes.train.landers import INSIDE
from game.scenes.train.scene import TrainScene
from game.ui.virtual_pointer import VirtualPointer
from tests.support.driver import Driver
from tests.support.player import DEVICES, Player

Open = Callable[..., Driver]
Take = Callable[..., Player]


@pytest.fixture(params=DEVICES)
def take(request: pytest.FixtureRequest, open_game: Open) -> Take:
    """Open a scene and take its first pointer in hand, by one device alone."""

    def taken(*scene: object) -> Player:
        player = Player(open_game(*scene), request.param)
        player.frames(3)
        pointer = next(widget for widget in player.form.widgets if isinstance(widget, VirtualPointer))
        player.form.focus(pointer)
        player.press("confirm")
        assert pointer.typing
        return player

    return taken


def pointer(player: Player) -> VirtualPointer:
    assert isinstance(player.form.focused, VirtualPointer)
    return player.form.focused


def bring(player: Player, place: tuple[float, float]) -> None:
    """Hold arrows until the pointer is near a place, in points."""
    for axis, names in enumerate((("left", "right"), ("up", "down"))):
        away = place[axis] - pointer(player).place[axis]
        if abs(away) < 4:
            continue
        name = names[away > 0]
        player.hold(name, down=True)
        for _ in range(400):
            if abs(place[axis] - pointer(player).place[axis]) < 7:
                break
            player.frames(1)
        player.hold(name, down=False)


@pytest.mark.parametrize("take", ["keys"], indirect=True)
def test_who_looks_elsewhere_lets_go(take: Take):
    player = take(PhysicsScene, "stack")
    scene = player.top
    bring(player, tuple(scene.view(1.0).points(scene.exhibit.ball.position[0]).tolist()))
    player.hold("confirm", down=True)
    assert scene.grip is not None
    player.hold("confirm", down=False)
    assert scene.grip is None
    player.hold("confirm", down=True)
    player.hold("left", down=True)
    pygame.event.post(pygame.Event(pygame.WINDOWFOCUSLOST))
    player.frames(2)
    assert scene.grip is None
    place = pointer(player).place.copy()
    player.frames(5)
    assert pointer(player).place == place


@pytest.mark.parametrize("take", ["pad"], indirect=True)
def test_the_network_of_a_run_can_be_pointed_into(take: Take):
    player = take(TrainScene)
    player.press("back")
    player.app.context.unfold(INSIDE)
    player.frames(2)
    player.form.focus(player.the(VirtualPointer))
    player.press("confirm")
    view = player.top.view.inside.view
    view.set(build_network(NUM_FEATURES, NUM_ACTIONS, Config(hidden=(8,)), np.random.default_rng(0)))
    bring(player, view.centres[1][3])
    assert view.hovered == (1, 3)
    player.press("back")
    assert view.hovered is None
    assert player.top_name == "TrainScene"
