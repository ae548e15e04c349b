"""Pen for drawing with keys or a gamepad."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from game.core import texts
from game.digits.pad import DrawingPad
from game.ui.virtual_pointer import VirtualPointer
from game.ui.widget import PointsManager

_PACE: Final = 4.5  # points in a step of 1/60 s: slow enough for a digit


def make_pen(manager: PointsManager, pad: Callable[[], DrawingPad]) -> VirtualPointer:
    """Return a virtual pointer that draws on the pad that `pad` returns at that moment."""
    return VirtualPointer(manager, pad().rect, lambda event: pad().handle_event(event), hold=texts.PEN_HOLD,
                   leave=texts.PEN_LEAVE, pace=_PACE)  # fmt: skip
