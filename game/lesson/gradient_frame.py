"""Frame of the gradient: it flows back through the network, and an optimizer makes a step of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from itertools import pairwise
from typing import Final

import numpy as np

from ai.explain.recorder import Function
from ai.nn import OPTIMIZERS, Array
from ai.nn.optimizers import Adam, Momentum
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import FAINT, HUMAN, INK, LABEL, LINE, MUTE, NET, SMALL
from game.lesson.frame import PICTURE, SMALL_PICTURE, Explanation
from game.lesson.network_frame import NetworkFrame
from game.lesson.step import LearningStep, WeightPlace
from game.panels.figures import number, signed

_NETWORK: Final = (0.0, 26.0, 752.0, 254.0)
_BELOW: Final = 316.0  # first baseline under the network
_COLUMNS: Final = (0.0, 276.0)


class GradientFrame(NetworkFrame):
    """Frame of the gradient; the optimizer's step for one weight, which the player picks, is written out.

    Attributes:
        alone: whether this example's own share is shown, in place of the whole batch's gradient.
        weight: the weight that is picked.

    """

    def __init__(
        self, name: str, figure: str, sentence: str, functions: Sequence[Function], step: LearningStep
    ) -> None:
        super().__init__(name, figure, sentence, functions, step, _NETWORK, "gradients", step.taken.gradient)
        self.alone = False
        self.weight = next(iter(step.strongest(step.taken.gradient, 1)), None)
        self._write()

    def picks(self, weight: WeightPlace) -> Callable[[], None] | None:
        """Return what picks a weight; None for one of a dueling layer."""
        return partial(self.pick, weight) if self.step.index(weight) is not None else None

    def pick(self, weight: WeightPlace) -> None:
        """Write out the step of another weight."""
        self.weight = weight
        self._write()

    def show_alone(self, alone: bool) -> None:
        """Show this example's own share of the gradient, or the whole batch's."""
        self.alone = alone
        self.flow(self.step.taken.share if alone else self.step.taken.gradient)
        self._write()

    def _write(self) -> None:
        self.labels.clear()
        for place, (words, alone) in enumerate(zip(texts.LESSON_WHOSE, (False, True), strict=True)):
            self.label(
                words.format(count=self.step.examples), 250.0 * place, 13.0, size=SMALL,
                colour=INK if alone == self.alone else MUTE, press=partial(self.show_alone, alone), room=240.0,
            )  # fmt: skip
        self.label(texts.LESSON_PICK_WEIGHT, PICTURE.width, 13.0, size=LABEL, colour=MUTE, align="right", room=240.0)
        self._write_share()
        if self.weight is not None:
            self._write_step(self.weight)
        self.changed()

    def _write_share(self) -> None:
        """Write how the share of this example compares with the gradient of the whole batch."""
        step, (x, _), y = self.step, _COLUMNS, _BELOW
        whole, own = _length(step.taken.gradient), _length(step.taken.share)
        lengths = whole * own
        agreement = float(np.dot(step.taken.share, step.taken.gradient)) / lengths if lengths > 0 else 0.0
        self.heading(texts.LESSON_SHARE, x, y, 230.0)
        rows = [
            (texts.LESSON_LENGTH_BATCH, number(whole), texts.LESSON_LENGTH_HELP),
            (texts.LESSON_LENGTH_SHARE, number(own), texts.LESSON_SHARE_HELP),
            (texts.LESSON_AGREEMENT, f"{agreement:+.2f}".replace("-", "−"), texts.LESSON_AGREEMENT_HELP),
        ]
        if step.taken.gradient_length > 1.001 * whole:
            rows.append((texts.LESSON_CLIPPED, number(step.taken.gradient_length), texts.LESSON_CLIPPED_HELP))
        for place, (word, figure, help_) in enumerate(rows):
            self._row(x, 240.0, y + 24 + 22 * place, word, figure, Explanation((help_,)))

    def _write_step(self, weight: WeightPlace) -> None:
        """Write out the optimizer's step for one weight."""
        step, (_, x), y = self.step, _COLUMNS, _BELOW
        index = step.index(weight)
        assert index is not None
        title = texts.LESSON_STEP_OF.format(
            optimizer=texts.LESSON_OPTIMIZERS.get(step.optimizer, step.optimizer), weight=self.weight_name(weight)
        )
        self.heading(title, x, y, PICTURE.width - x)
        for place, (word, figure, help_) in enumerate(self._parts(index)):
            self._row(x, PICTURE.width - x, y + 24 + 22 * place, word, figure, Explanation((help_,)))
        if float(step.taken.gradient[index]) * float(step.taken.taken[index]) < 0:
            self.prose(texts.LESSON_UPHILL, 0, y + 24 + 22 * 4, x - 20)

    def _parts(self, index: int) -> list[tuple[str, str, str]]:
        """Return the steps from the slope of a weight to its new value: words, figure, and what it means."""
        step, words = self.step, texts.LESSON_STEP_PARTS
        slope, moved = float(step.taken.gradient[index]), -float(step.taken.taken[index])
        share = float(step.taken.share[index])
        found = [(*_said(words["slope"], share=signed(share)), signed(slope))]
        kind = OPTIMIZERS.get(step.optimizer)
        if kind is Adam and "square_sum" in step.taken.optimizer_after:
            adam = Adam()
            mean, square = ("gradient_sum", 1 - adam.beta1), ("square_sum", 1 - adam.beta2)
            for name, (kept, factor) in (("mean", mean), ("square", square)):
                before, after = (
                    factor * float(memory[kept][index])
                    for memory in (step.taken.optimizer_before, step.taken.optimizer_after)
                )
                found.append((*_said(words[name], before=number(before)), number(after)))
        elif kind is Momentum and "velocity" in step.taken.optimizer_after:
            before, after = (
                float(memory["velocity"][index]) for memory in (step.taken.optimizer_before, step.taken.optimizer_after)
            )
            found.append((*_said(words["velocity"], before=number(before)), number(after)))
        rule = words.get(f"step_{step.optimizer}", words["step_sgd"])
        found.append((*_said(rule, rate=number(step.taken.learning_rate)), signed(moved)))
        old, new = float(step.taken.values_before[index]), float(step.taken.values_after[index])
        found.append((*_said(words["value"], before=number(old)), number(new)))
        return [(word, figure, help_) for word, help_, figure in found]

    def _row(self, x: float, width: float, y: float, word: str, figure: str, explanation: Explanation) -> None:
        self.label(word, x, y, explanation=explanation, colour=MUTE, room=width - 90)
        self.label(figure, x + width, y, align="right", explanation=explanation, room=86)

    def paint(self, canvas: Canvas) -> None:
        """Paint the line under the chosen words, and one between the network and what is written."""
        chosen = self.labels[int(self.alone)].box
        canvas.line((chosen.left, 20), (chosen.right, 20), NET, 2)
        canvas.line((0, _BELOW - 18), (PICTURE.width, _BELOW - 18), LINE)

    def paint_small(self, canvas: Canvas) -> None:
        """Paint a slope, and the step down it."""
        for start, end in pairwise([_on_slope(step / 6) for step in range(7)]):
            canvas.line(start, end, MUTE, 1.5)
        (x, y), (to, down) = _on_slope(0.12), _on_slope(0.3)
        canvas.line((x, y), (to, down), NET, 2)
        canvas.dot((x, y), 2, FAINT)
        canvas.dot((to, down), 3, NET)

    def draw_live(self, canvas: Canvas) -> None:
        """Draw the network, with the picked weight in amber where its ends are shown."""
        super().draw_live(canvas)
        if self.weight is None:
            return
        columns = self.view.columns
        places = [
            np.flatnonzero(columns[column].units == unit)
            for column, unit in ((self.weight.link, self.weight.start), (self.weight.link + 1, self.weight.end))
        ]
        if all(len(place) for place in places):
            (start,), (end,) = places
            ends = self.view.centres[self.weight.link][start], self.view.centres[self.weight.link + 1][end]
            canvas.line(*ends, HUMAN, 1.5)


def _on_slope(share: float) -> tuple[float, float]:
    """Return a place on the slope in the strip, from its top on the left, 0, to its right end, 1."""
    wide, high = SMALL_PICTURE
    return 3 + (wide - 6) * share, 3 + (high - 6) * (1 - (1 - share) ** 2)


def _said(words: Sequence[str], **figures: str) -> tuple[str, str]:
    word, help_ = (text.format(**figures) for text in words)
    return word, help_


def _length(vector: Array) -> float:
    return math.sqrt(float(np.dot(vector.astype(float), vector.astype(float))))
