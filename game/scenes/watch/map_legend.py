"""Legend of the policy map: what its colours mean, in names of actions or in points."""

from __future__ import annotations

from typing import Final

import numpy as np
import pygame

from ai.lander.environment import ACTION_NAMES
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import INK, LABEL, MARGIN, MUTE, SMALL
from game.panels.q_values import signed
from game.scenes.watch.watched import Watched
from game.world.policy_map import ACTION, COLOURS, OFF, score_colours

_LEFT, _TOP, _ROW = float(MARGIN), 226.0, 17.0
_SWATCH: Final = (14.0, 8.0)
_BAR: Final = (150.0, 6.0)
_ROOM: Final = 230.0
_BARS: Final = PaintCache(1)


def draw_legend(canvas: Canvas, world: Watched, flown: int) -> None:
    """Draw what the colours of the sky mean; the action `flown` now by the shown lander stands out."""
    policy_map = world.policy_map
    if policy_map.kind == OFF:
        return
    canvas = canvas.at(-1, -1)
    actions = policy_map.kind == ACTION
    title, what = texts.MAP_TITLES[policy_map.kind - 1], texts.EXPLAIN_MAP[policy_map.kind - 1]
    canvas.text(title, (_LEFT, _TOP), size=SMALL, room=_ROOM)
    canvas.text(texts.MAP_SAME, (_LEFT, _TOP + _ROW), size=LABEL, colour=MUTE, room=_ROOM)
    bottom = _draw_actions(canvas, flown) if actions else _draw_scale(canvas, policy_map.scale)
    box = (_LEFT - 4, _TOP - 14, _ROOM, bottom - _TOP + 20)
    canvas.explain(box, what, lambda: texts.EXPLAIN_MAP_NOW)


def _draw_actions(canvas: Canvas, flown: int) -> float:
    y = _TOP + 2.6 * _ROW
    for action, (name, colour) in enumerate(zip(ACTION_NAMES, COLOURS, strict=True)):
        canvas.rounded((_LEFT, y - _SWATCH[1], *_SWATCH), 2, colour)
        tone = INK if action == flown else MUTE
        canvas.text(texts.said(name), (_LEFT + _SWATCH[0] + 8, y), size=SMALL, colour=tone, room=_ROOM - 30)
        y += _ROW
    return y - _ROW


def _draw_scale(canvas: Canvas, scale: tuple[float, float] | None) -> float:
    y = _TOP + 2.2 * _ROW
    _BARS.draw(canvas, (_LEFT, y, *_BAR), "scores", _paint_scale)
    if scale is not None:
        for share, align in ((0.0, "left"), (0.5, "centre"), (1.0, "right")):
            points = scale[0] + share * (scale[1] - scale[0])
            place = (_LEFT + share * _BAR[0], y + 21)
            canvas.text(signed(points).removesuffix(".0"), place, size=LABEL, colour=MUTE, align=align, tabular=True)  # type: ignore[arg-type]
    canvas.text(texts.Q_UNIT, (_LEFT + _BAR[0] + 14, y + 21), size=LABEL, colour=MUTE)
    return y + 21


def _paint_scale(sheet: Canvas) -> None:
    width, height = sheet.size
    row = np.round(score_colours(np.linspace(0.0, 1.0, width))).astype(np.uint8)
    sheet.surface.blit(pygame.surfarray.make_surface(np.repeat(row[:, None], height, axis=1)), (0, 0))
