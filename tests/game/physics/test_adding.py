"""An exhibit is added as docs/adding.md says: a class, its row in the table, its texts. Nothing else knows it."""

import math
from collections.abc import Callable, Mapping
from typing import Any

import pygame
import pytest

from engine import Circle
from game.core import texts
from game.scenes.physics.exhibit import Exhibit, Quantity, height, speed
from game.scenes.physics.exhibits import EXHIBITS
from game.scenes.physics.scene import PhysicsScene
from tests.support.driver import Driver

FALL = ("Fall", "The speed of a fall follows from its height.", {"always": "It falls at {speed:.1f} m/s."})
LAW = ("Speed at the floor", "m/s", "√(2·g·h)", "It is measured at the floor.", "Time passes in steps.")
RADIUS = 0.5


class Fall(Exhibit):
    """A ball falls; the one quantity is its height."""

    name = "fall"
    quantities = (Quantity("height", (2.0, 8.0), 5.0, 0.5),)
    patience = 400

    @classmethod
    def law(cls, gravity: float, values: Mapping[str, float]) -> float:
        return math.sqrt(2 * gravity * values["height"])

    def build(self) -> None:
        self.ball = self.add(Circle(RADIUS), (0.0, self.values["height"] + RADIUS), "bright-disc")
        self.speed = 0.0

    def observe(self) -> None:
        if self.result is None and height(self.ball) - RADIUS < 0.005:
            self.result = self.speed
        self.speed = speed(self.ball)

    def figures(self) -> dict[str, float]:
        return {"speed": speed(self.ball)}


def test_an_exhibit_with_one_slider_is_added(
    open_game: Callable[..., Driver], monkeypatch: pytest.MonkeyPatch, written: list[str]
):
    table: tuple[tuple[dict[str, Any], str, Any], ...] = (
        (EXHIBITS, "fall", Fall), (texts.EXHIBITS, "fall", FALL), (texts.LAWS, "fall", LAW),
        (texts.QUANTITIES, "height", ("Height, h", "{value:.1f} m")),
    )  # fmt: skip
    for row in table:
        monkeypatch.setitem(*row)
    driver = open_game(PhysicsScene, "fall")
    driver.widget("Height, h").set(8.0)
    driver.key(pygame.K_g)
    driver.wait(lambda: driver.top.exhibit.result is not None)
    driver.frames(2)
    exhibit = driver.top.exhibit
    assert exhibit.result == pytest.approx(exhibit.law(exhibit.gravity, {"height": 8.0}), rel=0.02)
    assert {"Fall", FALL[1], "Height, h", "8.0 m"} <= set(written)
    assert any("√(2·g·h)" in words for words in written)
