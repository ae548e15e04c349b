"""The six actions, drawn alike wherever a decision is shown: each with its value, or whether the network then lands."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np

from ai.agent.decision import Decision
from ai.lander.environment import ACTION_NAMES
from game.core import texts
from game.core.catalogue import capital
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.tokens import FAINT, INK, LABEL, LINE, MUTE, NET, SMALL, TEXT, Colour
from game.explain.figures import points

# Points of reward from one end of the scale to the other, for every network and every moment. Over whole flights of
# both shipped networks 82 % (modern) and 93 % (classic) of the actions that are not the best lie within it.
SPAN: Final = 5.0
NAME: Final = 116.0  # room for names, left of the bars
ROW: Final = 23.0
FIRST: Final = 28.0  # the first row, below the first baseline
_AXIS: Final = FIRST + len(ACTION_NAMES) * ROW + 6.0  # the last baseline, below the first
HEIGHT: Final = _AXIS + 2.0
_FIGURE: Final = 52.0  # room for figures, right of the bars
_BAR: Final = 3.0
_LEAST: Final = 30.0  # points of a bar; in a narrower place, figures stand without
_LANDS: Final = {True: "lands", False: "lost", None: "unknown"}


@dataclass(frozen=True)
class QValues:
    """Q-values of one decision of one lander, in points of reward.

    Attributes:
        points: value of each action, in points of reward.
        flown: the action that is flown.

    """

    points: tuple[float, ...]
    flown: int

    @classmethod
    def of(cls, decision: Decision) -> QValues | None:
        """Return the Q-values of one lander's decision; None if it has none (a scripted pilot)."""
        if decision.points is None:
            return None
        return cls(tuple(decision.points[0].tolist()), int(decision.action[0]))

    @property
    def expected(self) -> float:
        """What it expects from here on, in points of reward: that of the best action."""
        return max(self.points) if self.readable else math.nan

    @property
    def readable(self) -> bool:
        """Whether all values are finite."""
        return all(map(math.isfinite, self.points))

    def loss(self, action: int) -> float:
        """Return the loss of an action: its value below the best, in points."""
        return self.expected - self.points[action]

    def fraction(self, loss: float) -> float:
        """Return the length of a bar, 0 to 1, for a loss in points."""
        return min(max(1.0 - loss / SPAN, 0.0), 1.0) if math.isfinite(loss) else 0.0


def draw_q_values(canvas: Canvas, values: QValues, left: float, top: float, width: float) -> None:
    """Draw the expected pay, a bar for each action on the fixed scale, and the scale, or figures alone; in points.

    `top` is the first baseline; the last is `HEIGHT` below it.
    """
    x, track, right = left + NAME, width - NAME - _FIGURE, left + width
    bars = track >= _LEAST
    end = x + track if bars else right
    canvas.text(texts.Q_EXPECTED, (left, top), size=SMALL, colour=MUTE, room=end - left - 72)
    canvas.text(points(values.expected, 1), (end, top), size=TEXT, align="right", tabular=True)
    canvas.explain((left, top - 14, width, 20), texts.EXPLAIN_EXPECTED)
    for action in range(len(ACTION_NAMES)):
        y = top + FIRST + ROW * action
        _draw_row(canvas, values, action, (left, y), width)
        canvas.explain((left, y - ROW / 2, width, ROW), texts.EXPLAIN_VALUE, partial(value_words, values, action))
    if not bars:
        return
    y = top + _AXIS
    canvas.explain((left, y - 16, width, 22), texts.EXPLAIN_ADVANTAGE.format(span=SPAN))
    canvas.line((x, y - 13), (x + track, y - 13), LINE)
    for place in (x, x + track / 2, x + track):
        canvas.line((place, y - 16), (place, y - 12), MUTE)
    for place, figure in ((x, f"−{SPAN:g}"), (x + track, "0")):
        canvas.text(figure, (place, y), size=LABEL, colour=MUTE, align="centre")
    canvas.text(texts.Q_ADVANTAGE, (left, y), size=LABEL, colour=MUTE, room=NAME - 6)
    for baseline in (top, y):
        canvas.text(texts.Q_UNIT, (right, baseline), size=LABEL, colour=MUTE, align="right", room=_FIGURE - 8)


def _draw_row(canvas: Canvas, values: QValues, action: int, place: tuple[float, float], width: float) -> None:
    """Draw an action: its name, its bar, and how far it is behind the best."""
    (left, y), loss = place, values.loss(action)
    x, track, colour = left + NAME, width - NAME - _FIGURE, _draw_name(canvas, action, values.flown, left, y)
    figure = texts.Q_BEST if loss == 0 else behind(loss)
    canvas.text(figure, (left + width, y + 4), size=SMALL, colour=colour, align="right", tabular=True)
    if track < _LEAST:
        return
    tone = NET if action == values.flown else mix(FAINT, NET, 0.45)
    canvas.bar((x, y - 1, track, _BAR), values.fraction(loss), tone)
    if loss > SPAN:  # it lies beyond the left end of the scale
        canvas.line((x + 5, y - 4), (x, y), MUTE, 1.5)
        canvas.line((x, y), (x + 5, y + 4), MUTE, 1.5)


def draw_actions(canvas: Canvas, flown: int, left: float, top: float) -> None:
    """Draw which action is flown, for a pilot without Q-values; `top` is the first baseline."""
    for action in range(len(ACTION_NAMES)):
        _draw_name(canvas, action, flown, left, top + ROW * action - 4)
    canvas.text(texts.DECISION_SCRIPTED_FLOWN, (left + NAME, top + ROW * flown), size=SMALL, colour=MUTE)


def draw_landings(
    canvas: Canvas, lands: Sequence[bool | None], flown: int, left: float, top: float, width: float
) -> None:
    """Draw for each action whether the network then `lands`, None where that is not known yet; as `draw_q_values`."""
    for action, after in enumerate(lands):
        y = top + FIRST + ROW * action
        colour = _draw_name(canvas, action, flown, left, y)
        said, room = texts.LANDINGS[_LANDS[after]], width - NAME - 20
        canvas.text(said, (left + width, y + 4), size=SMALL, colour=NET if after else colour, align="right", room=room)
        canvas.explain((left, y - ROW / 2, width, ROW), texts.EXPLAIN_LANDING)


def _draw_name(canvas: Canvas, action: int, flown: int, left: float, y: float) -> Colour:
    """Draw an action's name, with a mark beside it if it is `flown`; return the colour of what is said of it."""
    colour = INK if action == flown else MUTE
    canvas.text(texts.said(ACTION_NAMES[action]), (left, y + 4), size=SMALL, colour=colour, room=NAME - 20)
    if action == flown:
        canvas.marker("triangle", (left + NAME - 8, y), 6, NET)
    return colour


def decision_words(decision: Decision) -> Sequence[str]:
    """Explain in two lines why a network that decides alone flies one lander's action."""
    if decision.points is None:
        return texts.Q_WEIGHS_NOTHING, ""
    if not np.isfinite(decision.points).all():
        return texts.VALUES_DAMAGED
    if not decision.kept[0]:
        return texts.Q_BEST_FLOWN, ""
    kept, best = (texts.said(ACTION_NAMES[int(action[0])]) for action in (decision.action, decision.best))
    names = {"kept": capital(kept), "best": best}
    return [line.format(margin=f"{decision.margin:.3g}", **names) for line in texts.Q_KEPT]


def value_words(values: QValues, action: int) -> str:
    """Say what the value of an action is now."""
    name = capital(texts.said(ACTION_NAMES[action]))
    return texts.EXPLAIN_VALUE_NOW.format(name=name, points=points(values.points[action], 1))


def behind(loss: float) -> str:
    """Format the loss of an action, in as many digits as tell it from zero."""
    if not math.isfinite(loss):
        return "–"
    figure = f"{loss:.{1 if loss >= 0.95 else 2}f}"
    return figure if float(figure) == 0 else f"−{figure}"
