"""Walk through a network's stages for one digit: from a patch of it, unit by unit, to the answer."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ai.explain.unit_sums import Box, Place, Stage, UnitSum, receptive_field, stages
from ai.nn import ActivationLayer, ConvolutionLayer, MaxPoolingLayer
from game.core import texts

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier
    from ai.digits.preprocessing import Image


class UnitWalk:
    """One unit of each stage, linked by the largest products: what feeds a unit most, and what it feeds most.

    Attributes:
        stages: the network's layers with what they read and gave.
        probabilities: (10,) the answer.
        number: the stage looked at; `len(stages)` is the answer.
        places: the unit of each stage; None where the chain is broken, because no unit reads the one before.
        channel: of the stage's input, the map that is looked at.
        unit: the sum of the unit looked at; None at the answer, and for a layer that is no sum.
        field: the pixels of the digit that this unit depends on.

    """

    def __init__(self, classifier: DigitClassifier, image: Image) -> None:
        self.stages: list[Stage] = stages(classifier.network, np.asarray(image, np.float32)[:, :, None])
        self.probabilities = classifier.predict(image)[0]
        self.logits = classifier.network.cost.logits
        self.places: list[Place | None] = [None] * len(self.stages)
        self.channel = 0
        self.unit: UnitSum | None = None
        self.field: Box = (0, 0, 0, 0)
        self.number = len(self.stages)
        self.look_at(self._loudest(self.number - 1))  # so that the chain is the one that leads to the answer
        self.choose(0)

    @property
    def at_answer(self) -> bool:
        """Whether the answer is looked at."""
        return self.number == len(self.stages)

    @property
    def stage(self) -> Stage:
        """The stage looked at; at the answer, the last one."""
        return self.stages[min(self.number, len(self.stages) - 1)]

    @property
    def place(self) -> Place:
        """The unit looked at."""
        place = self.places[min(self.number, len(self.stages) - 1)]
        assert place is not None, "the stage looked at has one"
        return place

    def value(self, number: int) -> float | None:
        """Return what the unit of a stage gave, or at the answer its probability; None beyond a broken chain."""
        place = self.places[min(number, len(self.stages) - 1)]
        if place is None:
            return None
        if number < len(self.stages):
            return float(self.stages[number].outputs[place])
        return float(self.probabilities[place[2]]) if place[2] < len(self.probabilities) else None

    def look_at(self, place: Place) -> None:
        """Look at another unit of the stage, and link those before and after it anew."""
        at = min(self.number, len(self.stages) - 1)
        self.places = [None] * len(self.stages)
        self.places[at] = place
        for number in range(at, 0, -1):
            later = self.places[number]
            if later is None or self.stages[number].kind == "other":
                break
            self.places[number - 1] = self.stages[number].strongest_input(later)
        for number in range(at + 1, len(self.stages)):
            before = self.places[number - 1]
            self.places[number] = None if before is None else self.stages[number].strongest_reader(before)
        self._sum_up()

    def choose(self, number: int) -> None:
        """Look at another stage: at the unit of the chain there, or at its loudest where the chain is broken."""
        self.number = min(max(number, 0), len(self.stages))
        at = min(self.number, len(self.stages) - 1)
        if self.places[at] is None:
            self.look_at(self._loudest(at))
        self._sum_up()

    def look_into(self, channel: int) -> None:
        """Look at another map of the stage's input; of a layer without sums, at the unit of that map."""
        if 0 <= channel < self.stage.inputs.shape[2]:
            self.channel = channel
            if self.stage.kind in ("pooling", "activation"):
                self.look_at((*self.place[:2], channel))

    def _sum_up(self) -> None:
        """Write the unit's sum out, and look at the input's map through which the way leads."""
        self.field = receptive_field(self.stages[: self.number + 1], self.place)
        self.unit = unit = None if self.stage.kind == "other" or self.at_answer else self.stage.unit(self.place)
        if unit is None:
            self.channel = min(self.channel, self.stage.inputs.shape[2] - 1)
        elif unit.weights is None:
            self.channel = self.place[2]
        else:  # the map in which the number stands that was looked at before
            before = self.places[self.number - 1] if self.number else None
            self.channel = int(np.abs(unit.products.sum(axis=(0, 1))).argmax()) if before is None else before[2]

    def _loudest(self, number: int) -> Place:
        """Return the unit of a stage with the largest output."""
        outputs = self.stages[number].outputs
        row, column, channel = map(int, np.unravel_index(int(outputs.argmax()), outputs.shape))
        return row, column, channel


def sentence_of(walk: UnitWalk) -> str:
    """Return what the stage looked at does, in a sentence."""
    if walk.at_answer:
        return texts.PATCH_SAYS["answer"]
    match walk.stage.layer:
        case ConvolutionLayer(kernel=kernel):
            return texts.PATCH_SAYS["deeper" if walk.number else "convolution"].format(size=kernel)
        case MaxPoolingLayer(size=size):
            return texts.PATCH_SAYS["pooling"].format(size=size)
        case ActivationLayer(activation=activation):
            return texts.PATCH_BENDS.get(activation.name or "", texts.PATCH_BENDS["other"])
    return texts.PATCH_SAYS[walk.stage.kind]
