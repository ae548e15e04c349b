"""Q-value panel: the value of each action in points of reward, drawn alike wherever a decision is shown."""

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
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, MUTE, NET, SMALL
from game.panels.action_rows import AXIS, NAME, ROW, ActionRow, ActionRows

# Points of reward from one end of the scale to the other, for every network and every moment. Over whole flights of
# both shipped networks 82% (modern) and 93% (classic) of the actions that are not the best lie within it.
SPAN: Final = 5.0
HEIGHT: Final = 174.0  # from the first baseline to the last
_DIMMED: Final = (0.5, 0.12)  # words and bar of an action that the co-pilot does not let pass


@dataclass(frozen=True)
class QValues:
    """Q-values of one decision of one lander, in points of reward.

    Attributes:
        points: value of each action, in points of reward.
        flown: the action that is flown.
        asked: the action that the pilot asked for; None without a pilot.
        feasible: the actions that the co-pilot would have let the pilot fly.
        allowed: largest loss of a feasible action, in points below the best; None where another rule holds.

    """

    points: tuple[float, ...]
    flown: int
    asked: int | None = None
    feasible: tuple[bool, ...] = (True,) * len(ACTION_NAMES)
    allowed: float | None = None

    @classmethod
    def of(cls, decision: Decision) -> QValues | None:
        """Return the Q-values of one lander's decision; None if it has none (a scripted pilot)."""
        if decision.points is None:
            return None
        return cls(tuple(decision.points[0].tolist()), int(decision.action[0]))

    @property
    def expected(self) -> float:
        """The expected score from here on, in points of reward: that of the best action."""
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
    """Draw the expected score, a bar for each action on the fixed scale, and the scale; in points.

    `top` is the first baseline; the last is `HEIGHT` below it.
    """
    rows, points = ActionRows(canvas, left, top, width), signed(values.expected)
    rows.draw_heading(texts.Q_EXPECTED, points, texts.Q_UNIT)
    box = (left, top - 14, width, 20)
    canvas.explain(box, texts.EXPLAIN_EXPECTED, lambda: texts.EXPLAIN_EXPECTED_NOW.format(points=points))
    for action in range(len(ACTION_NAMES)):
        rows.draw_row(action, _row(values, action), _DIMMED)
        canvas.explain(rows.box(action), texts.EXPLAIN_VALUE, partial(value_words, values, action))
    canvas.explain((left, top + AXIS - 16, width, 22), texts.EXPLAIN_ADVANTAGE.format(span=SPAN))
    rows.draw_scale(f"−{SPAN:g}", "0")
    rows.draw_scale_names(texts.Q_ADVANTAGE, texts.Q_UNIT)
    if values.allowed is not None and values.allowed < SPAN:
        x, y = rows.draw_limit(values.fraction(values.allowed))
        canvas.explain((x - 8, y - 18, 16, 14), texts.EXPLAIN_COPILOT_ALLOWED)


def _row(values: QValues, action: int) -> ActionRow:
    loss = values.loss(action)
    figure = texts.Q_BEST if loss == 0 else behind(loss)
    flown, asked = action == values.flown, action == values.asked
    return ActionRow(values.fraction(loss), figure, flown, asked, values.feasible[action], beyond=loss > SPAN)


def draw_actions(canvas: Canvas, flown: int, left: float, top: float) -> None:
    """Draw which action is flown, for a pilot without Q-values; `top` is the first baseline."""
    for action, name in enumerate(ACTION_NAMES):
        y, here = top + ROW * action, action == flown
        canvas.text(texts.said(name), (left, y), size=SMALL, colour=INK if here else MUTE, room=NAME - 20)
        if here:
            canvas.marker("triangle", (left + NAME - 8, y - 4), 6, NET)
            canvas.text(texts.DECISION_SCRIPTED_FLOWN, (left + NAME, y), size=SMALL, colour=MUTE)


def decision_words(decision: Decision) -> Sequence[str]:
    """Explain in two lines why a network that decides alone flies one lander's action."""
    if decision.points is None:
        return texts.Q_WEIGHS_NOTHING, ""
    if not np.isfinite(decision.points).all():
        return texts.VALUES_DAMAGED
    if not decision.kept[0]:
        return texts.Q_BEST_FLOWN, ""
    kept, best = (texts.said(ACTION_NAMES[int(action[0])]) for action in (decision.action, decision.best))
    names = {"kept": kept.capitalize(), "best": best}
    return [line.format(margin=f"{decision.margin:.3g}", **names) for line in texts.Q_KEPT]


def value_words(values: QValues, action: int) -> str:
    """Say what the value of an action means now."""
    name = texts.said(ACTION_NAMES[action]).capitalize()
    if not values.readable:
        return texts.EXPLAIN_VALUE_NONE.format(name=name)
    loss, points = values.loss(action), signed(values.points[action])
    best = texts.EXPLAIN_VALUE_BEST.format(name=name, points=points)
    said = [texts.EXPLAIN_VALUE_LESS.format(name=name, points=points, loss=behind(loss).lstrip("−")) if loss else best]
    if loss > SPAN:
        said.append(texts.EXPLAIN_VALUE_OUTSIDE)
    if action == values.flown:
        said.append(texts.EXPLAIN_VALUE_FLOWN)
    return " ".join(said)


def signed(points: float) -> str:
    """Format points of reward with their sign; a dash if not finite."""
    return f"{points:+.1f}".replace("-", "−") if math.isfinite(points) else "–"


def behind(loss: float) -> str:
    """Format the loss of an action, in as many digits as tell it from zero."""
    if not math.isfinite(loss):
        return "–"
    figure = f"{loss:.{1 if loss >= 0.95 else 2}f}"
    return figure if float(figure) == 0 else f"−{figure}"
