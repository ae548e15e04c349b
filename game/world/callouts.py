"""Words in the world: the contact light and the cause of a crash beside the craft, score factors above pads."""

from __future__ import annotations

import math
from typing import Any, Final

import pygame

from ai.environment import Doubles
from ai.lander.environment import LanderEnv, Outcome
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, NIGHT0, SMALL
from game.flight.flight import Flight
from game.flight.outcomes import crash_reason
from game.world.camera import ClearArea, View

_ABOVE: Final = 2.0  # metres from the middle of a craft to the words
_BELOW: Final = 10.0  # points of their cover below the baseline
_EDGE: Final = 24.0  # points that words keep from the edges of the view, and from the read-outs
_COVER: Final = 0.9  # opacity: the path behind the words is hardly seen
_HEAD, _FOOT = 96.0, 120.0  # points that words keep from the upper edge, and from the lower one
_OVER_DECK: Final = (0.75, 8.0)  # metres and points between a deck and the factor above it
_UNDER_DECK: Final = (0.2, 22.0)  # and below a deck, where something else stands above it
_TALL: Final = 17.0
_CAPITAL: Final = 0.72  # height of a figure, in shares of its size
_PLAIN: Final = 0.5  # opacity of a pad that is not aimed at
_NEAR, _FAR = 2.2, 4.4  # metres from the craft within which a factor has gone, and from which it is whole
_SHADE: Final = 0.62  # behind a factor, over paths and the dawn


def draw_words(canvas: Canvas, view: View, env: LanderEnv, pose: Doubles) -> None:
    """Write above the craft at a pose that both feet are down on a pad, or why it crashed."""
    crashed, whole = env.outcome[0] == Outcome.CRASHED, bool(env.intact[0])
    if crashed:
        text = texts.BESIDE_TITLE if whole else crash_reason(env)
    elif env.feet_down[0].all() and env.ground.ends[env.touched[0]]:
        text = texts.CONTACT_LIGHT
    else:
        return
    place, canvas = canvas.pixels(view.point(float(pose[0]), float(pose[1]) + _ABOVE)), canvas.reading
    x, y = canvas.points(place)
    width = canvas.text_width(text, size=SMALL, weight="medium") + 22
    seen = canvas.view
    x = min(max(x, seen.left + _EDGE + width / 2), seen.right - _EDGE - width / 2)
    y = min(max(y - _BELOW, seen.top + _HEAD), seen.bottom - _FOOT)
    canvas.panel((x - width / 2 - 12, y - 20, width + 24, 20 + _BELOW), _COVER)
    if crashed and not whole:
        canvas.marker("cross", (x - width / 2 + 4, y - 5), 10, canvas.palette.warn)
    else:
        canvas.glow((x - width / 2 + 4, y - 4), 13, INK, 0.9)
        canvas.dot((x - width / 2 + 4, y - 4), 3.5, INK)
    canvas.text(text, (x - width / 2 + 22, y), size=SMALL, weight="medium", colour=INK)


def draw_factors(canvas: Canvas, view: View, flight: Flight[Any], craft: Doubles, clear: ClearArea) -> None:
    """Write the score factors of several pads above them, or below where words stand, until the flight is over.

    That of the pad which is aimed at is brightest; one that the craft at (x, y) nears gives way.
    """
    env = flight.env
    pads = [(number, pad) for number, pad in enumerate(env.ground.pads) if pad.factor]
    if flight.over or len(pads) < 2:  # the card says what was earned, and may stand there
        return
    shift, metre = float(env.pad_shift[0]), view.pixels_per_metre / view.scale
    large = canvas.type / canvas.scale  # points of the world for one of text
    for number, pad in pads:
        x, deck = view.point(pad.x + shift, pad.top)
        word = f"×{pad.factor}"
        width, rise = canvas.text_width(word, size=_TALL, weight="medium"), _CAPITAL * _TALL * large
        row = deck - _OVER_DECK[0] * metre - _OVER_DECK[1] * large
        box = pygame.FRect(x - width / 2, row - rise, width, rise).inflate(14 * large, 12 * large)
        if box.top < clear.head or box.right > clear.right:
            lower = deck + _UNDER_DECK[0] * metre + _UNDER_DECK[1] * large - row
            box, row = box.move(0, lower), row + lower
        away = math.dist(view.points(craft[:2]).tolist(), box.center) / metre
        seen = min(max((away - _NEAR) / (_FAR - _NEAR), 0.0), 1.0)
        if seen > 0:
            canvas.pill(box, NIGHT0, _SHADE * seen)
            bright = seen * (1.0 if number == env.target[0] else _PLAIN)
            canvas.text(word, (x, row), size=_TALL, colour=INK, weight="medium", align="centre", alpha=bright)
