"""Frames that show a network: the values that flow through it, and the gradient, of which an optimizer makes a step."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Final

import numpy as np

from ai.explain.recorder import Function
from ai.nn import Adam, Array
from game.core import texts
from game.drawing.canvas import Canvas, Point
from game.drawing.cursor import Cursor
from game.drawing.tokens import HUMAN, SMALL
from game.explain.figures import number, points, signed
from game.explain.network_plan import Show
from game.explain.network_view import NetworkView
from game.explain.tables import Line, figure_rows, table
from game.scenes.lesson.frame import Frame
from game.scenes.lesson.step import LearningStep, Weight
from game.ui.panel import Column

_HEIGHTS: Final[dict[Show, float]] = {"weights": 370.0, "activations": 370.0, "gradients": 190.0}
_TERMS: Final = 6  # products of a unit's sum that are written out one by one; the others are summed
_MOST_NAMED: Final = 12  # inputs up to which their names stand beside them
_UNNAMED: Final = (" " * 32,)  # keeps the room of a name free, for the legend below
_LEAST: Final = 300.0  # width of a column
_RANKS: Final = 24  # weights to choose from, the steepest first


class NetworkFrame(Frame):
    """Frame with a drawing of the network: values that flow forward, or the slopes that flow back."""

    show: Show = "activations"

    def __init__(
        self, words: Sequence[str], figure: str, sentence: str, functions: Sequence[Function], step: LearningStep
    ) -> None:
        super().__init__(words, figure, functions, sentence=sentence)
        self.step, self._network = step, step.network.copy()
        names = step.inputs if len(step.inputs) <= _MOST_NAMED else _UNNAMED
        self.view = NetworkView((0, 0, 700, _HEIGHTS[self.show]), names, step.outputs)
        self.view.reads_out, self.view.show, self.view.output_scale = False, self.show, step.scale
        self.flow(step.taken.gradient)

    def flow(self, gradient: Array) -> None:
        """Show a gradient (parameters,) as the one that flows back."""
        self._network.gradients[:] = gradient
        self.view.set(self._network, self.step.observation)

    def describe(self, column: Column) -> None:
        column.add(self._write_network)

    def _write_network(self, cursor: Cursor) -> None:
        cursor.gap(10)
        box = cursor.take(_HEIGHTS[self.show])
        if cursor.canvas is None:
            self.view.place(box)
        else:
            self._draw(cursor.canvas)

    def point(self, place: Point | None) -> None:
        self.view.hover(place)

    def update(self, still: bool) -> None:
        self.view.update()

    def _draw(self, canvas: Canvas) -> None:
        """Draw the network; each unit explains itself."""
        self.view.draw(canvas)
        for column, centres in enumerate(self.view.centres):
            for place, (x, y) in enumerate(centres):
                unit = int(self.view.columns[column].units[place])
                name = self.step.unit_name(column, unit)
                canvas.explain((x - 6, y - 6, 12, 12), name, partial(self.unit, column, unit))

    def _ends(self, weight: Weight) -> list[Point]:
        """Return the two ends of a link, as far as they are shown."""
        ends = ((weight.link, weight.start), (weight.link + 1, weight.end))
        return [
            self.view.centres[column][place]
            for column, unit in ends
            for place in np.flatnonzero(self.view.columns[column].units == unit)
        ]

    def unit(self, column: int, unit: int) -> str:
        """Explain a unit: its sum, and all that is made of it."""
        step = self.step
        if column == 0:
            return figure_rows((texts.LESSON_SENSED, number(float(step.given(0)[unit]))))
        link, stages, into = step.weights[column - 1], step.stages[column - 1], step.given(column - 1)
        products = into * link.weights[:, unit]
        strongest = np.argsort(-np.abs(np.nan_to_num(products)), kind="stable")[:_TERMS]
        rows = [
            (texts.LESSON_TERM.format(
                name=step.unit_name(column - 1, int(start)), value=number(float(into[start])),
                weight=number(float(link.weights[start, unit])),
            ), signed(float(products[start])))
            for start in strongest
        ]  # fmt: skip
        if others := len(products) - len(rows):
            rest = float(products.sum() - products[strongest].sum())
            rows.append((texts.LESSON_OTHERS.format(count=others), signed(rest)))
        rows.append((texts.NETWORK_VIEW_BIAS, signed(float(link.bias[unit]))))
        rows += [(texts.LESSON_STAGES.get(kind, kind), number(float(values[unit]))) for kind, values in stages]
        if column == len(step.weights) and step.scale != 1.0:
            scaled = points(float(stages[-1][1][unit]) / step.scale)
            rows.append((texts.LESSON_IN_POINTS.format(scale=f"{step.scale:g}"), scaled))
        return f"{texts.LESSON_SUM}\n{figure_rows(*rows)}"


class GradientFrame(NetworkFrame):
    """Frame of the gradient; the optimizer's step for one weight, which the player picks, is written out.

    Attributes:
        alone: whether this example's own share is shown, in place of the whole batch's gradient.
        rank: which weight is picked, by the size of its slope: 0 for the steepest.

    """

    show = "gradients"

    def __init__(self, words: Sequence[str], functions: Sequence[Function], step: LearningStep) -> None:
        length = texts.LESSON_LENGTH.format(length=number(step.taken.gradient_length))
        sentence = f"{words[1]} {texts.LESSON_DOWNHILL[step.carries_on]}"
        super().__init__(words, length, sentence, functions, step)
        self.alone, self.rank, self._steepest = False, 0, step.steepest(_RANKS)

    def describe(self, column: Column) -> None:
        whose = [words.format(count=self.step.examples) for words in texts.LESSON_WHOSE]
        column.choice("", whose, int(self.alone), self.show_alone, SMALL)
        super().describe(column)
        column.gap(8)
        if self._steepest:
            left, right = column.beside((2, 3), _LEAST)
            left.slider(texts.LESSON_PICK_WEIGHT, self.rank + 1, (1, len(self._steepest)), self._pick_rank, step=1,
                        figure=lambda rank: f"{rank:.0f}")  # fmt: skip
            left.text(self._title, size=SMALL, colour=HUMAN)
            left.text(lambda: texts.LESSON_UPHILL if self.uphill else "", size=SMALL)
            right.add(table((), self._parts))

    def _pick_rank(self, rank: float) -> None:
        self.rank = round(rank) - 1

    @property
    def weight(self) -> Weight:
        """The weight that is picked."""
        return self._steepest[self.rank]

    def show_alone(self, alone: int) -> None:
        """Show this example's own share of the gradient, or the whole batch's."""
        self.alone = bool(alone)
        self.flow(self.step.taken.share if alone else self.step.taken.gradient)

    @property
    def uphill(self) -> bool:
        """Whether the picked weight moves up its slope."""
        index, taken = self.weight.place, self.step.taken
        return float(taken.gradient[index]) * float(taken.taken[index]) < 0

    def _title(self) -> str:
        optimizer = texts.LESSON_OPTIMIZERS.get(self.step.optimizer, self.step.optimizer)
        return texts.LESSON_STEP_OF.format(optimizer=optimizer, weight=self.step.weight_name(self.weight))

    def _parts(self) -> list[Line]:
        """Return the way from the slope of the picked weight to its new value."""
        step, index, words = self.step, self.weight.place, texts.LESSON_STEP_PARTS
        taken = step.taken
        slope, share, moved, old, new = (
            float(each[index])
            for each in (taken.gradient, taken.share, -taken.taken, taken.values_before, taken.values_after)
        )
        found = [_part(words["slope"], signed(slope), share=signed(share))]
        adam = Adam()  # which keeps sums, of which its means are shares
        for name, memory, factor in (
            ("mean", "gradient_sum", 1 - adam.beta1),
            ("square", "square_sum", 1 - adam.beta2),
            ("velocity", "velocity", 1.0),
        ):
            if memory in taken.optimizer_after:
                before, after = (
                    factor * float(each[memory][index]) for each in (taken.optimizer_before, taken.optimizer_after)
                )
                found.append(_part(words[name], number(after), before=number(before)))
        rule = words.get(f"step_{step.optimizer}", words["step_sgd"])
        found.append(_part(rule, signed(moved), rate=number(taken.learning_rate)))
        found.append(_part(words["value"], number(new), before=number(old)))
        return found

    def _draw(self, canvas: Canvas) -> None:
        """Draw the network, with the picked weight in amber where its ends are shown."""
        super()._draw(canvas)
        if self._steepest and len(ends := self._ends(self.weight)) == 2:
            canvas.line(ends[0], ends[1], HUMAN, 1.5)


def _part(words: Sequence[str], figure: str, **figures: str) -> Line:
    word, help_ = (text.format(**figures) for text in words)
    return Line((word, figure), help_)
