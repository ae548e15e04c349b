"""Rows of the six actions: a name, a bar and a figure each, below a heading and above a scale.

Values of actions and chances after them are drawn alike, so that one can be read like the other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from ai.lander.environment import ACTION_NAMES
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.tokens import FAINT, HUMAN, INK, LABEL, LINE, MUTE, NET, SMALL, TEXT

NAME: Final = 96.0  # room for names, left of the bars
FIGURE: Final = 52.0  # and for figures, right of them
ROW: Final = 23.0
_FIRST: Final = 28.0  # the first bar, below the first baseline
AXIS: Final = _FIRST + len(ACTION_NAMES) * ROW + 6.0  # the last baseline, below the first
_BAR: Final = 3.0


@dataclass(frozen=True)
class ActionRow:
    """Row of one action.

    Attributes:
        fraction: length of its bar, 0 to 1.
        figure: what is written at its end.
        flown, asked: whether this action is flown, and whether the pilot asked for it.
        allowed: whether the co-pilot lets it pass.
        beyond: whether it lies beyond the left end of the scale.

    """

    fraction: float
    figure: str
    flown: bool
    asked: bool
    allowed: bool
    beyond: bool = False


@dataclass(frozen=True)
class ActionRows:
    """Place of six rows: `top` is the first baseline, that of the heading."""

    canvas: Canvas
    left: float
    top: float
    width: float

    @property
    def bars(self) -> tuple[float, float]:
        """Left end and length of the bars."""
        return self.left + NAME, self.width - NAME - FIGURE

    def box(self, action: int) -> tuple[float, float, float, float]:
        """Return the rectangle of an action's row."""
        return self.left, self.top + _FIRST + ROW * (action - 0.5), self.width, ROW

    def draw_heading(self, words: str, figure: str, unit: str) -> None:
        """Write the line above the rows."""
        x, track = self.bars
        self.canvas.text(words, (self.left, self.top), size=SMALL, colour=MUTE, room=self.width - FIGURE - 72)
        self.canvas.text(figure, (x + track, self.top), size=TEXT, align="right", tabular=True)
        self._draw_unit(unit, self.top)

    def draw_row(self, action: int, row: ActionRow, dimmed: tuple[float, float]) -> None:
        """Draw a row; `dimmed` is the opacity of words, and the strength of a bar, that the co-pilot does not let pass.

        Both run from 0 to 1.
        """
        canvas, (x, track), y = self.canvas, self.bars, self.top + _FIRST + ROW * action
        colour = INK if row.flown else MUTE
        alpha = 1.0 if row.allowed or row.flown else dimmed[0]
        name = texts.said(ACTION_NAMES[action])
        canvas.text(name, (self.left, y + 4), size=SMALL, colour=colour, alpha=alpha, room=NAME - 20)
        tone = NET if row.flown else mix(FAINT, NET, 0.45 if row.allowed else dimmed[1])
        canvas.bar((x, y - 1, track, _BAR), row.fraction, tone)
        if row.flown:
            canvas.marker("triangle", (x - 8, y), 6, NET)
        if row.beyond:
            canvas.line((x + 5, y - 4), (x, y), MUTE, 1.5)
            canvas.line((x, y), (x + 5, y + 4), MUTE, 1.5)
        if row.asked:
            canvas.dot((x + row.fraction * track, y), 4, HUMAN)
        place = (self.left + self.width, y + 4)
        canvas.text(row.figure, place, size=SMALL, colour=colour, align="right", tabular=True, alpha=alpha)

    def draw_scale(self, least: str, most: str) -> None:
        """Draw the scale below the rows."""
        canvas, (x, track), y = self.canvas, self.bars, self.top + AXIS
        canvas.line((x, y - 13), (x + track, y - 13), LINE)
        for place in (x, x + track / 2, x + track):
            canvas.line((place, y - 16), (place, y - 12), MUTE)
        canvas.text(least, (x, y), size=LABEL, colour=MUTE, align="centre")
        canvas.text(most, (x + track, y), size=LABEL, colour=MUTE, align="centre")

    def draw_scale_names(self, words: str, unit: str) -> None:
        """Say what the scale is of, and its unit."""
        self.canvas.text(words, (self.left, self.top + AXIS), size=LABEL, colour=MUTE, room=NAME - 6)
        self._draw_unit(unit, self.top + AXIS)

    def draw_limit(self, fraction: float) -> tuple[float, float]:
        """Draw the line that bars must reach; return the tip of its mark."""
        (x, track), y = self.bars, self.top + _FIRST
        x += fraction * track
        self.canvas.line((x, y - 9), (x, y + 5 * ROW + 9), MUTE)
        self.canvas.marker("triangle_down", (x, y - 11), 6, INK, 0.8)
        return x, y

    def _draw_unit(self, unit: str, y: float) -> None:
        place = (self.left + self.width, y)
        self.canvas.text(unit, place, size=LABEL, colour=MUTE, align="right", room=FIGURE - 8)
