"""Sprites are what the gallery and the lander are drawn from: by image key, size and layer."""

from collections.abc import Callable

import numpy as np
import pygame
import pytest

from ai.lander.environment import LanderEnv, Outcome
from engine import Circle, Polygon, Sprite, World
from game.drawing.canvas import Canvas
from game.drawing.tokens import EMBER, HUMAN, INK
from game.scenes.physics import bodies
from game.scenes.physics.bodies import Outlines
from game.scenes.physics.exhibits import EXHIBITS
from game.world import lander as art
from game.world.camera import View
from game.world.stage import Stage

MIDDLE = (640, 360)


@pytest.fixture
def drawn() -> Callable[[list[Sprite]], tuple[int, int, int]]:
    """Draw sprites and return the colour in the middle of the view."""

    def draw(sprites: list[Sprite]) -> tuple[int, int, int]:
        canvas = Canvas(pygame.Surface((1280, 720)))
        poses = np.array([[*sprite.body.position[0], sprite.body.angle[0]] for sprite in sprites])
        Outlines(sprites).draw(canvas, View(1.0, (0.0, 0.0)), poses, None, False)
        red, green, blue, _ = canvas.surface.get_at(MIDDLE)
        return red, green, blue

    return draw


def test_every_sprite_of_the_gallery_covers_the_shape_that_collides(subtests: pytest.Subtests):
    for name in EXHIBITS:
        with subtests.test(name=name):
            exhibit = EXHIBITS[name](1.62)
            outlines = Outlines(exhibit.sprites)
            assert {sprite.body for sprite in exhibit.sprites} >= set(exhibit.bodies)
            for sprite, (body, outline) in zip(exhibit.sprites, outlines.shapes, strict=True):
                shape = exhibit.world.shapes[body.index]
                assert sprite.body is body
                if isinstance(shape, Circle):
                    assert isinstance(outline, Circle)
                    assert outline.radius == shape.radius
                else:
                    assert isinstance(outline, Polygon)
                    np.testing.assert_allclose(outline.vertices, shape.vertices, atol=1e-9)


def test_the_highest_layer_is_seen_whatever_the_order(drawn):
    world = World()
    low, high = (world.add(Polygon.box(2.0, 2.0), (0.0, 0.0)) for _ in range(2))
    sprites = [Sprite(low, "box", (2.0, 2.0), layer=1), Sprite(high, "bright-box", (2.0, 2.0), layer=2)]
    alone = drawn([Sprite(low, "bright-box", (2.0, 2.0))])
    assert drawn(sprites) == drawn(sprites[::-1]) == alone != drawn(sprites[:1])


def test_a_picture_is_found_by_its_key_and_drawn_at_the_size_of_the_sprite(drawn, monkeypatch: pytest.MonkeyPatch):
    body = World().add(Circle(1.0), (0.6, 0.0))
    before = drawn([Sprite(body, "disc", (2.0, 2.0))])
    assert drawn([Sprite(body, "disc", (0.4, 0.4))]) != before
    monkeypatch.setitem(bodies.PICTURES, "disc", bodies.SpriteShape((), HUMAN))
    assert drawn([Sprite(body, "disc", (2.0, 2.0))]) != before
    with pytest.raises(KeyError, match="trebuchet"):
        Outlines([Sprite(body, "trebuchet", (2.0, 2.0))])
    assert bodies.PICTURES["ember-disc"].colour == EMBER != bodies.PICTURES["bright-disc"].colour == INK


@pytest.mark.parametrize("calm", [False, True])
def test_a_lander_is_one_sprite_and_what_a_crash_leaves_another(calm: bool):
    env = LanderEnv(1, seed=3, frame_skip=1)
    env.reset()
    stage = Stage(env, np.random.default_rng(0), calm)
    assert stage.sprite() == Sprite(env.lander, art.LANDER, art.SIZE)
    assert stage.sprite(size=0.5).size == pytest.approx((art.REACH, art.REACH))
    while env.outcome[0] == Outcome.FLYING:
        env.step(np.array([0]))
        stage.follow(np.array([False]), env.outcome != Outcome.FLYING)
    assert env.outcome[0] == Outcome.CRASHED
    wreck = stage.sprite()
    assert wreck.image == art.WRECK
    assert (wreck.body is env.lander) is calm  # otherwise it tumbles in a world of its own
    env.reset()
    stage.follow(np.array([False]), np.array([False]))
    assert stage.sprite() == Sprite(env.lander, art.LANDER, art.SIZE), "the next flight, in the same slot"
    assert stage.pose_after(1.0) is None


def test_the_lander_is_painted_by_its_key(monkeypatch: pytest.MonkeyPatch):
    def picture(image: str) -> bytes:
        return pygame.image.tobytes(art.turned(image, 31.5, 0.1)[0], "RGBA")

    assert picture(art.LANDER) != picture(art.WRECK)
    monkeypatch.setitem(art.PICTURES, "gilded", art.PICTURES[art.LANDER])
    assert picture("gilded") == picture(art.LANDER)
    with pytest.raises(KeyError):
        art.turned("trebuchet", 31.5, 0.1)
