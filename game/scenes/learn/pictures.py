"""What the chapters' pictures have in common: flights in a box, curves."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final

import numpy as np
import pygame

from ai.environment import Bools, Doubles
from ai.lander.environment import PARAMS, LanderEnv
from engine import DT
from game.drawing.canvas import Canvas
from game.drawing.tokens import FAINT, LABEL, LINE, MUTE, Colour
from game.world import lander as art
from game.world.camera import View
from game.world.craft import draw_craft, draw_crowd, draw_fires
from game.world.landscape.pad import draw_pad

HEAD: Final = 1.3  # metres from a lander's middle to above its antenna
_MOST: Final = 150  # points of a curve that are drawn


def draw_ground(canvas: Canvas, box: pygame.FRect, view: View) -> None:
    """Draw the plain from one side of a box to the other, and the pad."""
    ((_, ground),) = view.points([(0.0, PARAMS.ground)]).tolist()
    canvas.line((box.left, ground), (box.right, ground), FAINT)
    draw_pad(canvas, view, (0.0, PARAMS.pad_top), PARAMS.pad_width)


def draw_landers(
    canvas: Canvas, box: pygame.FRect, view: View, poses: Doubles, burning: Bools, flicker: int, size: float = 1.0
) -> None:
    """Draw landers at poses (n, 3), some with their fires; a mark at the edge for each that the top would cut."""
    heads = view.points(poses[:, :2] + (0.0, HEAD * size))
    above = heads[:, 1] < box.top
    draw_fires(canvas, view, poses[burning & ~above], flicker, size)
    draw_crowd(canvas, view, poses[~above], size)
    for x in heads[above, 0].tolist():
        canvas.marker("triangle", (x, box.top + 8), 8, MUTE)


def draw_lander(canvas: Canvas, view: View, env: LanderEnv) -> None:
    """Draw a single lander in its environment, with its fires."""
    fired = int(env.fired[0])
    thrust = np.array([fired >= 3, fired % 3 == 2, fired % 3 == 1], float)
    pose = np.array([*env.position[0], env.angle[0]])
    draw_craft(canvas, view, art.LANDER, pose, thrust, 1.0, round(float(env.time[0]) / DT))


def draw_curve(canvas: Canvas, box: pygame.FRect, heights: Doubles, colour: Colour, length: int) -> None:
    """Draw a curve of heights, 0 to 1, over `length` decisions; NaN leaves a gap."""
    places = [
        (box.left + box.width * at / length, box.bottom - box.height * float(heights[at]))
        for at in range(0, len(heights), max(1, length // _MOST))
        if np.isfinite(heights[at])
    ]
    for a, b in pairwise(places):
        canvas.line(a, b, colour, 2)


def draw_axis(canvas: Canvas, box: pygame.FRect, ticks: Sequence[tuple[float, str]]) -> None:
    """Draw hairlines at heights, 0 to 1, of a chart, each with its word on the left."""
    for height, word in ticks:
        y = box.bottom - box.height * height
        canvas.line((box.left, y), (box.right, y), LINE)
        canvas.text(word, (box.left - 6, y + 4), size=LABEL, colour=MUTE, align="right", tabular=True)
