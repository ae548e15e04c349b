"""Camera framing of a flight: the craft, and the pads that it can still reach."""

from __future__ import annotations

from typing import Final

import numpy as np

from ai.environment import Doubles
from ai.lander.environment import LanderEnv
from ai.lander.sensing import NEAR, near_edges
from game.world.camera import GROUND_LINE, POINTS_PER_METRE, Camera, CameraTarget, ClearArea

ALL: Final = ClearArea()
_AROUND: Final = 2.2  # metres beside a craft, and above it
_BESIDE: Final = 1.6  # metres beside a pad
_BEYOND: Final = 0.4  # metres above the upper edge of the area
_ROCK, _FAR = 6.0, 15.0  # metres shown beside the goal of a leg, for the rock there, to one so far away
_LEAD: Final = 0.6  # seconds: how far ahead of a craft the camera looks
# Of several pads, only those count that a craft at that height can still reach.
_REACH: Final = (6.0, 2.2)  # metres to the side at the height of the ground, and more for every metre above it
_FADE: Final = 3.0  # metres over which a pad out of reach stops counting


def framed(env: LanderEnv, clear: ClearArea = ALL) -> CameraTarget:
    """Return the closest shot that fits the craft, the way ahead of it, and its pads into the clear screen."""
    x, y = env.position[0].tolist()
    ahead_x, ahead_y = (env.position[0] + _LEAD * env.velocity[0]).tolist()
    left, right = min(x, ahead_x) - _AROUND, max(x, ahead_x) + _AROUND
    for edges, weight in _pads(env, x, y):
        left += weight * (min(left, edges[0] - _BESIDE) - left)
        right += weight * (max(right, edges[1] + _BESIDE) - right)
    top = max(y, ahead_y) + _AROUND
    for edge in near_edges(env):  # what is left up to an edge of the area comes into view as the craft comes near
        near = min(1.0, 1.6 * (1 - edge.away / NEAR))
        weight = near * near * (3 - 2 * near)  # eases in and out
        left += weight * (min(left, edge.place - _AROUND) - left) * (edge.side == "left")
        right += weight * (max(right, edge.place + _AROUND) - right) * (edge.side == "right")
        top += weight * (max(top, edge.place + _BEYOND) - top) * (edge.side == "above")
    return CameraTarget.around(left, right, top, clear)


def whole(path: Doubles, clear: ClearArea) -> CameraTarget:
    """Return a shot of the whole path (k, 2) of a finished flight in the clear screen, no nearer than at rest."""
    (left, _), (right, top) = (path.min(axis=0) - _AROUND).tolist(), (path.max(axis=0) + _AROUND).tolist()
    spare = max(0.0, (clear.right - clear.left) / POINTS_PER_METRE - (right - left)) / 2
    return CameraTarget.around(left - spare, right + spare, top, clear)


def follow(camera: Camera, env: LanderEnv, clear: ClearArea = ALL) -> None:
    """Move a camera with a flight, for one step."""
    x, y = env.position[0].tolist()
    camera.follow(framed(env, clear), (x, y))


def _pads(env: LanderEnv, x: float, y: float) -> list[tuple[tuple[float, float], float]]:
    """Return both edges of every pad and its weight in the framing, 0 to 1.

    A single pad has weight 1, as has the goal of a leg, which is its first pad.
    """
    shift = float(env.pad_shift[0])
    pads = env.ground.pads
    near, wider = _REACH
    rows = []
    first = len(pads) == 1 or not env.ground.ends.all()
    for number, pad in enumerate(pads):
        beyond = abs(pad.x + shift - x) - (near + wider * max(0.0, y - GROUND_LINE))
        weight = 1.0 if first and number == 0 else float(np.clip(1 - beyond / _FADE, 0.0, 1.0))
        more = _ROCK * min(1.0, abs(pad.x - x) / _FAR) if first and number == 0 and len(pads) > 1 else 0.0
        rows.append(((pad.left + shift - more, pad.right + shift + more), weight))
    return rows
