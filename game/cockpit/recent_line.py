"""Line of the last eight seconds: who flew, where the co-pilot stepped in, and how the chance to be saved went."""

from __future__ import annotations

from collections import deque
from itertools import groupby
from typing import Final

from game.cockpit.chance_meter import depth
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.tokens import FAINT, HUMAN, NET, NIGHT0, VIEW_SIZE, Colour
from game.flight.flight import DECISION_STEPS, Flight, StickHolder
from game.world.paths import draw_stretch

_SAMPLES: Final = 120  # decisions on the line, eight seconds
_STRIP: Final = (VIEW_SIZE[0] / 2 - 90, 77.0, 180.0)  # left, middle, width
_TOP, _HEIGHT = 71.0, 20.0  # of the chance's curve: at 100 of 100, and from there to 0
_BARS: Final = 94.0  # row of the bars below it
_THICK: Final = 7.0
_YOURS, _HANDED, _CHANGED = range(3)
_LOOKS: Final[tuple[tuple[Colour, float], ...]] = ((HUMAN, 0.8), (NET, 0.8), (NET, 1.0))


class RecentLine:
    """Line of one flight's last seconds; call `follow` once after every step."""

    def __init__(self) -> None:
        self._kinds: deque[int] = deque(maxlen=_SAMPLES)
        self._chances: deque[float | None] = deque(maxlen=_SAMPLES)
        self._now = _YOURS

    def follow(self, flight: Flight, chance: float | None) -> None:
        """Note a step, and the chance to be saved, if it is known."""
        if flight.overridden:
            self._now = _CHANGED
        if len(flight.recording.actions) % DECISION_STEPS == 0 and not flight.over:
            yours = flight.flown_by is StickHolder.HUMAN
            self._kinds.append(_CHANGED if self._now == _CHANGED else _YOURS if yours else _HANDED)
            self._chances.append(chance)
            self._now = _YOURS

    def draw(self, canvas: Canvas, required: float | None) -> None:
        """Draw the line; it falls with the chance to be saved, and a bar marks where the co-pilot stepped in."""
        left, middle, width = _STRIP
        if required is not None:
            y = _TOP + _HEIGHT * depth(required)
            canvas.line((left, y), (left + width, y), FAINT, alpha=0.9)
        step = width / _SAMPLES
        x = left + width - step * len(self._kinds)
        for (kind, known), run in groupby(zip(self._kinds, self._chances, strict=True), key=_alike):
            chances = [chance for _, chance in run if chance is not None or not known]
            length, (colour, alpha) = step * len(chances), _LOOKS[kind]
            if known:
                _draw_curve(canvas, x, step, [depth(chance) for chance in chances if chance is not None], colour, alpha)
            if not known or kind == _CHANGED:
                row, high = (_BARS, 2.5) if known else (middle, _THICK if kind == _CHANGED else 1.0)
                canvas.fill(canvas.rect(x, row - high / 2, max(length, 1.0), high), colour, alpha)
            x += length
        canvas.explain((left, _TOP - 4, width, _BARS - _TOP + 8), texts.EXPLAIN_RECENT[required is not None])


def _alike(sample: tuple[int, float | None]) -> tuple[int, bool]:
    return sample[0], sample[1] is not None


def _draw_curve(canvas: Canvas, x: float, step: float, depths: list[float], colour: Colour, alpha: float) -> None:
    """Draw a stretch of the curve, and its link to the next sample."""
    scale = canvas.scale
    places = [((x + step * number) * scale, (_TOP + _HEIGHT * deep) * scale) for number, deep in enumerate(depths)]
    draw_stretch(canvas.surface, mix(NIGHT0, colour, alpha), [*places, (places[-1][0] + step * scale, places[-1][1])])
