"""An exhibit is added as docs/adding.md says: a class, its row in the table, its texts. Nothing else knows it."""

import math
from collections.abc import Callable

import pytest

from engine import Circle
from game.core import texts
from game.drawing.tokens import INK
from game.scenes.physics.exhibit import Exhibit, Quantity, speed
from game.scenes.physics.exhibits import EXHIBITS
from game.scenes.physics.scene import PhysicsScene
from tests.support.driver import Driver

FALL = ("Fall", "The speed of a fall follows from its height.", "It fell at {speed:.1f} m/s.")
RADIUS = 0.5


class Fall(Exhibit):
    """A ball falls; the one quantity is its height."""

    name = "fall"
    quantities = (Quantity("height", (2.0, 8.0), 5.0, 0.5),)

    def build(self) -> None:
        self.ball = self.add(Circle(RADIUS), (0.0, self.values["height"] + RADIUS), INK)
        self.speed = 0.0

    def observe(self) -> None:
        self.speed = max(self.speed, speed(self.ball))

    def figures(self) -> dict[str, float]:
        return {"speed": self.speed}


def test_an_exhibit_with_one_slider_is_added(
    open_game: Callable[..., Driver], monkeypatch: pytest.MonkeyPatch, written: list[str]
):
    for table, key, value in (
        (EXHIBITS, "fall", Fall),
        (texts.EXHIBITS, "fall", FALL),
        (texts.QUANTITIES, "height", ("Height, h", "{value:.1f} m")),
    ):
        monkeypatch.setitem(table, key, value)
    driver = open_game(PhysicsScene, "fall")
    driver.widget("Height, h").set(8.0)
    driver.frames(300)
    exhibit = driver.top.exhibit
    assert exhibit.speed == pytest.approx(math.sqrt(2 * exhibit.gravity * 8.0), rel=0.02)
    assert {"Fall", FALL[1], "Height, h", "8.0 m", f"It fell at {exhibit.speed:.1f} m/s."} <= set(written)
