"""Frame of the network: the values that flow through it, the gradient, and the optimizer's step for one weight."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Final

import numpy as np

from ai.agent.network import make_optimizer
from ai.explain.agent_lesson import Lesson
from ai.explain.learning_step import backward_functions, forward_functions
from ai.nn import Adam
from game.core import texts
from game.drawing.canvas import Canvas, Point
from game.drawing.cursor import Cursor
from game.drawing.tokens import HUMAN, SMALL
from game.explain.figures import number, points, signed
from game.explain.network_view import NetworkView
from game.explain.tables import Line, figure_rows, table
from game.scenes.lesson.flight import said_action
from game.scenes.lesson.frame import Frame
from game.scenes.lesson.step import LearningStep, Weight
from game.ui.panel import Column

_FORWARD, _BACK = 340.0, 190.0  # heights: a step is written below the way back
_TERMS: Final = 6  # products of a unit's sum that are written out one by one; the others are summed
_LEAST: Final = 300.0  # width of a column


class NetworkFrame(Frame):
    """Frame of the way forward and back: the values that flow through the network, then the slopes that flow back.

    Attributes:
        back: which of the ways is shown: 0 the values, 1 the slopes of the whole batch, 2 those of this memory alone.

    """

    def __init__(self, lesson: Lesson, step: LearningStep) -> None:
        words, action = texts.LESSON_FRAMES["network"], int(lesson.cell.action)
        self._value = points(float(lesson.predicted[action]) / step.scale)
        functions = (*forward_functions(step.network), *backward_functions(step.network, make_optimizer(lesson.config)))
        sentence = words[1].format(action=said_action(action), value=self._value)
        if (best := int(lesson.predicted.argmax())) != action:
            higher = points(float(lesson.predicted[best]) / step.scale)
            sentence = f"{sentence} {texts.LESSON_NOT_THE_BEST.format(action=said_action(best), value=higher)}"
        super().__init__(words, f"{texts.LESSON_LENGTH.format(length=number(step.taken.gradient_length))}", functions,
                         sentence=sentence)  # fmt: skip
        self.step, self.back, self._network = step, 0, step.network.copy()
        self.view = NetworkView((0, 0, 700, _FORWARD), step.inputs, step.outputs)
        self.view.reads_out, self.view.output_scale = False, step.scale
        self.weight = step.steepest()
        self.turn(0)

    def turn(self, back: int) -> None:
        """Show the values, or one of the two gradients."""
        taken = self.step.taken
        self.back, self.view.show = back, "gradients" if back else "activations"
        self.changed = True
        self._network.gradients[:] = taken.share if back == 2 else taken.gradient
        self.view.set(self._network, self.step.observation)

    def describe(self, column: Column) -> None:
        ways = [words.format(count=self.step.examples) for words in texts.LESSON_WAYS]
        column.choice("", ways, self.back, self.turn, SMALL)
        column.add(self._write_network)
        if self.back and self.weight:
            column.gap(8)
            left, right = column.beside((2, 3), _LEAST)
            left.text(texts.LESSON_DOWNHILL[self.step.carries_on], size=SMALL)
            left.text(self._title(), size=SMALL, colour=HUMAN)
            left.text(texts.LESSON_UPHILL if self.uphill else "", size=SMALL)
            right.add(table((), self._parts))

    def _write_network(self, cursor: Cursor) -> None:
        cursor.gap(10)
        box = cursor.take(_BACK if self.back else _FORWARD)
        if cursor.canvas is None:
            self.view.place(box)
        else:
            self._draw(cursor.canvas)

    def point(self, place: Point | None) -> None:
        self.view.hover(place)

    def update(self, still: bool) -> None:
        self.view.update()

    def _draw(self, canvas: Canvas) -> None:
        """Draw the network; each unit explains itself, and the steepest weight is amber where its ends are shown."""
        self.view.draw(canvas)
        if self.back and self.weight and len(ends := self._ends(self.weight)) == 2:
            canvas.line(ends[0], ends[1], HUMAN, 1.5)
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
        if column == len(step.weights):
            scaled = points(float(stages[-1][1][unit]) / step.scale)
            rows.append((texts.LESSON_IN_POINTS.format(scale=f"{step.scale:g}"), scaled))
        return f"{texts.LESSON_SUM}\n{figure_rows(*rows)}"

    @property
    def uphill(self) -> bool:
        """Whether the steepest weight moves up its slope."""
        assert self.weight is not None, "without one nothing is asked"
        index, taken = self.weight.place, self.step.taken
        return float(taken.gradient[index]) * float(taken.taken[index]) < 0

    def _title(self) -> str:
        assert self.weight is not None, "without one nothing is asked"
        optimizer = texts.LESSON_OPTIMIZERS.get(self.step.optimizer, self.step.optimizer)
        return texts.LESSON_STEP_OF.format(optimizer=optimizer, weight=self.step.weight_name(self.weight))

    def _parts(self) -> list[Line]:
        """Return the way from the slope of the steepest weight to its new value."""
        assert self.weight is not None, "without one nothing is asked"
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


def _part(words: Sequence[str], figure: str, **figures: str) -> Line:
    word, help_ = (text.format(**figures) for text in words)
    return Line((word, figure), help_)
