"""Policy map: over the whole sky, what a network would do there.

Like the heat map of TensorFlow Playground, for flying: a grid of places is put before the network that flies, with the
tilt, turn and speed of the shown lander, and its decisions colour the sky.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import pygame

from ai.environment import Floats, Ints
from ai.lander.environment import LIMITS, LanderEnv
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import Colour
from game.flight.networks import Policy, decide
from game.world.camera import GROUND_LINE, View

# Of the six actions, in their order: a hue says which jet fires, and a light one that the main engine burns as well.
# Blue to yellow stays apart for eyes without the red or the green cones.
COLOURS: Final[tuple[Colour, ...]] = (
    (60, 66, 84), (64, 60, 190), (150, 118, 24), (150, 166, 170), (150, 146, 255), (240, 206, 96),
)  # fmt: skip
_COVER: Final = 0.5  # opacity of the map over the sky
HALF: Final = LIMITS.half_width  # metres to either side
TOP: Final = 20.0  # metres; above it stand words
_FADE, _FADE_LOW = 2.5, 0.5  # metres over which it fades out at its top and sides, and at the ground
_ACROSS, _UP = 65, 29  # places
PLACES: Final = np.stack(  # metres, (up, across, 2), the highest first
    np.meshgrid(np.linspace(-HALF, HALF, _ACROSS), np.linspace(TOP, GROUND_LINE, _UP)), axis=-1
)


class PolicyMap:
    """Policy map of the sky, computed row by row; call `follow` once per update.

    Attributes:
        on: whether it is shown.
        actions: what is done at each of `PLACES`, (up, across), in the latest whole map; None before the first.

    """

    def __init__(self) -> None:
        self.on = False
        self._picture = PaintCache()
        self.forget()

    def forget(self) -> None:
        """Forget all that was computed: another network flies."""
        self.actions: Ints | None = None
        self._seen: Floats = np.empty((0, 0, 0), np.float32)  # what is observed at the places of the map under way
        self._rows: list[Ints] = []

    def follow(self, env: LanderEnv, slot: int, policy: Policy) -> None:
        """Compute a row of the map for the tilt, turn and speed that a lander had when it began; nothing while off."""
        if not self.on:
            return
        if not self._rows:
            self._seen = env.observe_at(slot, PLACES.reshape(-1, 2)).reshape(_UP, _ACROSS, -1)
        self._rows.append(decide(policy, self._seen[len(self._rows)]).action)
        if len(self._rows) == _UP:
            self.actions, self._rows = np.array(self._rows), []

    def draw(self, canvas: Canvas, view: View) -> None:
        """Draw the map over the sky."""
        if not self.on or self.actions is None:
            return
        (left, top), (right, bottom) = view.points(PLACES[[0, -1], [0, -1]]).tolist()
        self._picture.draw(canvas, (left, top, right - left, bottom - top), self.actions.tobytes(), self._paint)

    def _paint(self, sheet: Canvas) -> None:
        assert self.actions is not None
        x, y = PLACES[0, :, 0], PLACES[:, 0, 1]
        fade = np.minimum((TOP - y) / _FADE, (y - GROUND_LINE) / _FADE_LOW).clip(0, 1)[:, None]
        fade = fade * ((HALF - np.abs(x)) / _FADE).clip(0, 1)
        veil = pygame.Surface((_ACROSS, _UP), pygame.SRCALPHA)
        pygame.surfarray.pixels3d(veil)[:] = np.array(COLOURS)[self.actions].swapaxes(0, 1)
        pygame.surfarray.pixels_alpha(veil)[:] = np.round(255 * _COVER * fade**2 * (3 - 2 * fade)).astype(np.uint8).T
        half = (max(2, sheet.size[0] // 2), max(2, sheet.size[1] // 2))
        pygame.transform.scale(pygame.transform.smoothscale(veil, half), sheet.size, sheet.surface)
