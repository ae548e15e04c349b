"""Walk through a network's stages for one digit: from a patch of it, unit by unit, to the answer."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ai.explain.unit_sums import Place, Stage, UnitSum, receptive_field, stages
from ai.nn import ActivationLayer, ConvolutionLayer, MaxPoolingLayer
from game.core import texts

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier
    from ai.digits.preprocessing import Image


class UnitWalk:
    """One unit of each stage, each the one that feeds the next most: at first, those that lead to the answer.

    Attributes:
        stages: the network's layers with what they read and gave.
        probabilities: (10,) the answer.
        logits: whether the answer is the softmax of what the last stage gave.
        number: the stage looked at.
        places: the unit of each stage.
        channel: of the stage's input, the map in which the largest product is.
        unit: the sum of the unit looked at; None for a layer that is no sum.
        field: the pixels of the digit that this unit depends on.

    """

    def __init__(self, classifier: DigitClassifier, image: Image) -> None:
        self.stages: list[Stage] = stages(classifier.network, np.asarray(image, np.float32)[:, :, None])
        self.probabilities = classifier.predict(image)[0]
        self.logits = classifier.network.cost.logits
        self.places: list[Place] = [(0, 0, 0)] * len(self.stages)
        self.number = len(self.stages) - 1
        self.look_at(_loudest(self.stages[-1]))
        self.choose(0)

    @property
    def at_answer(self) -> bool:
        """Whether the last stage is looked at, whose outputs are the scores."""
        return self.number == len(self.stages) - 1

    @property
    def stage(self) -> Stage:
        """The stage looked at."""
        return self.stages[self.number]

    @property
    def place(self) -> Place:
        """The unit looked at."""
        return self.places[self.number]

    def look_at(self, place: Place) -> None:
        """Look at another unit of the stage, and link those before it anew."""
        self.places[self.number] = place
        for number in range(self.number, 0, -1):
            stage, before = self.stages[number], self.stages[number - 1]
            known = stage.kind != "other"
            self.places[number - 1] = stage.strongest_input(self.places[number]) if known else _loudest(before)
        self._sum_up()

    def choose(self, number: int) -> None:
        """Look at another stage."""
        self.number = number
        self._sum_up()

    def _sum_up(self) -> None:
        self.field = receptive_field(self.stages[: self.number + 1], self.place)
        self.unit: UnitSum | None = None
        self.channel = 0
        if self.stage.kind != "other":
            self.unit = self.stage.unit(self.place)
            self.channel = self.stage.strongest_input(self.place)[2]


def _loudest(stage: Stage) -> Place:
    """Return the unit of a stage with the largest output."""
    row, column, channel = map(int, np.unravel_index(int(stage.outputs.argmax()), stage.outputs.shape))
    return row, column, channel


def sentence_of(walk: UnitWalk) -> str:
    """Return what the stage looked at does, in a sentence."""
    match walk.stage.layer:
        case ConvolutionLayer(kernel=kernel):
            return texts.PATCH_SAYS["deeper" if walk.number else "convolution"].format(size=kernel)
        case MaxPoolingLayer(size=size):
            return texts.PATCH_SAYS["pooling"].format(size=size)
        case ActivationLayer(activation=activation):
            return texts.PATCH_BENDS.get(activation.name or "", texts.PATCH_BENDS["other"])
    if walk.stage.kind == "connected":
        return texts.PATCH_SAYS["connected"]
    return texts.PATCH_OTHER.format(layer=type(walk.stage.layer).__name__)
