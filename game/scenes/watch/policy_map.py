"""Policy map: over the whole sky, what a network would do there.

Like the heat map of TensorFlow Playground, for flying: a grid of places is put before the network that flies, with the
tilt, turn and speed of the shown lander, and its decisions colour the sky.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pygame

from ai.agent.decision import Decision
from ai.environment import Doubles, Floats
from ai.lander.environment import LIMITS, LanderEnv
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import Colour
from game.flight.networks import Policy, decide, work_of
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
_FINER: Final = 2  # by how much it is drawn finer than it was computed
_GRIDS: Final = ((65, 29), (33, 15), (17, 8))  # places across and up: the coarser, the larger the network
_PIECE: Final = 4_700_000  # multiplications in one update: about a third of a millisecond
_LONGEST: Final = 120  # updates that one whole map should take at most; a coarser grid is used where it would not


@dataclass(frozen=True, eq=False)
class PolicyCells:
    """Decisions of a network at a grid of places, for one tilt, turn and speed.

    Attributes:
        places: metres, (rows, columns, 2); the first row is the highest.
        decision: one decision for each, row by row.

    """

    places: Doubles
    decision: Decision


class PolicyMap:
    """Policy map of the sky, computed in pieces; call `follow` once per update.

    Attributes:
        on: whether it is shown.
        cells: the latest whole map; None before the first.

    """

    def __init__(self) -> None:
        self.on = False
        self._picture = PaintCache()
        self.forget()

    def forget(self) -> None:
        """Forget all that was computed: another network flies."""
        self.cells: PolicyCells | None = None
        self._state: bytes = b""
        self._observations: Floats | None = None
        self._pieces: list[Decision] = []

    def follow(self, env: LanderEnv, slot: int, policy: Policy) -> None:
        """Compute a piece of the map for the tilt, turn and speed of a lander; nothing while it is off or up to date.

        How much is done in one update follows from the network's size alone.
        """
        if not self.on:
            return
        work = max(work_of(policy), 1)
        if self._observations is None:
            self._begin(env, slot, work)
        if self._observations is None:
            return
        first, most = sum(len(piece.action) for piece in self._pieces), max(1, _PIECE // work)
        if first == len(self._observations):  # in an update of its own: painting it takes as long as a piece
            self._finish()
            return
        self._pieces.append(decide(policy, self._observations[first : first + most]))

    def draw(self, canvas: Canvas, view: View) -> None:
        """Draw the map over the sky."""
        if not self.on or self.cells is None:
            return
        (left, top), (right, bottom) = view.points(self.cells.places[[0, -1], [0, -1]]).tolist()
        self._picture.draw(canvas, (left, top, right - left, bottom - top), self.cells, self._paint)

    def _begin(self, env: LanderEnv, slot: int, work: int) -> None:
        """Begin a new map, unless nothing has changed since the last."""
        grid = next((grid for grid in _GRIDS if grid[0] * grid[1] * work <= _LONGEST * _PIECE), _GRIDS[-1])
        state = np.array([*env.velocity[slot], env.angle[slot], env.angular_velocity[slot]]).tobytes()
        if self.cells is not None and state == self._state:
            return
        self._state, self._pieces = state, []
        self._places = grid_places(*grid)
        self._observations = env.observe_at(slot, self._places.reshape(-1, 2))

    def _finish(self) -> None:
        """Put the pieces together; they are one decision of the network, for many places."""
        assert self._observations is not None
        first = self._pieces[0]
        whole = Decision(
            self._observations,
            np.concatenate([piece.action for piece in self._pieces]),
            np.concatenate([piece.best for piece in self._pieces]),
            None if first.values is None else np.concatenate([p.values for p in self._pieces if p.values is not None]),
            first.steadiness,
            first.reward_scale,
        )
        self.cells, self._observations = PolicyCells(self._places, whole), None

    def _paint(self, sheet: Canvas) -> None:
        """Paint the map on a sheet whose corners are the outermost places; at half resolution, since it is soft."""
        assert self.cells is not None
        colours = _colours(self.cells)
        up, across = colours.shape[:2]
        x, y = np.linspace(-HALF, HALF, across), np.linspace(TOP, GROUND_LINE, up)
        fade = np.minimum((TOP - y) / _FADE, (y - GROUND_LINE) / _FADE_LOW).clip(0, 1)[:, None]
        fade = fade * ((HALF - np.abs(x)) / _FADE).clip(0, 1)
        small = pygame.surfarray.make_surface(np.round(colours).astype(np.uint8).swapaxes(0, 1))
        small = pygame.transform.box_blur(small, 1)
        veil = pygame.Surface(small.get_size(), pygame.SRCALPHA)
        veil.blit(small, (0, 0))
        pygame.surfarray.pixels_alpha(veil)[:] = np.round(255 * _COVER * fade**2 * (3 - 2 * fade)).astype(np.uint8).T
        half = (max(2, sheet.size[0] // 2), max(2, sheet.size[1] // 2))
        pygame.transform.scale(pygame.transform.smoothscale(veil, half), sheet.size, sheet.surface)


def _colours(cells: PolicyCells) -> Doubles:
    """Return the colour of every place, (rows, columns, 3), finer, with borders between the actions."""
    shape, decision = cells.places.shape[:2], cells.decision
    weights = np.eye(len(COLOURS), dtype=np.float32)[decision.action] if decision.values is None else decision.values
    fine = finer(finer(weights.reshape(*shape, -1)).swapaxes(0, 1)).swapaxes(0, 1)
    colours: Doubles = np.array(COLOURS, float)[fine.argmax(axis=-1)]
    return colours


def finer(values: Floats) -> Floats:
    """Return values (n, ...) with `_FINER` - 1 more between each two neighbours, on a straight line between them."""
    count = (len(values) - 1) * _FINER + 1
    place = np.arange(count) / np.float32(_FINER)
    left = np.minimum(place.astype(int), len(values) - 2)
    share = (place - left).astype(np.float32).reshape(-1, *[1] * (values.ndim - 1))
    between: Floats = values[left] + share * (values[left + 1] - values[left])
    return between


def grid_places(across: int, up: int) -> Doubles:
    """Return a grid of places over the sky in metres, (up, across, 2), the highest first."""
    places = np.meshgrid(np.linspace(-HALF, HALF, across), np.linspace(TOP, GROUND_LINE, up))
    return np.stack(places, axis=-1)
