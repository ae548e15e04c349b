"""Lesson of a digit network: its next learning step around one image, recorded while a copy of the run takes it."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from ai.digits.classifier import DigitClassifier
from ai.digits.config import DigitConfig
from ai.digits.training import DigitTraining
from ai.environment import Floats
from ai.explain.learning_step import Step, of_row, recorded_step, shown_lines
from ai.explain.recorder import Function, Line, Recorder
from ai.nn import OPTIMIZERS, NeuralNetwork
from ai.nn.costs import softmax


@dataclass(frozen=True, eq=False)
class DigitLesson:
    """The learning step of a digit network that comes next, around one image of its batch."""

    config: DigitConfig  # of the run
    taken: int  # learning steps taken before this one
    labels: npt.NDArray[np.int64]  # (batch,) which digits the images of the batch are
    image: Floats  # (28, 28) as it is learned from, bent and turned, 0 to 1
    target: Floats  # (10,) what the network should have answered
    outputs: Floats  # (10,) its answer before the step, with dropout: logits, if `logits` is true
    logits: bool  # whether probabilities are the softmax of the outputs
    cost: float  # of the whole batch, before the step
    derivative: Floats  # (10,) of the cost by the outputs, divided by the size of the batch already
    probabilities_before: Floats  # (10,) of each digit before the step, without dropout
    probabilities_after: Floats
    step: Step  # of the optimizer; its row is the image's
    lines: tuple[Line, ...] = ()  # of our own code, which made probabilities of the outputs, before the step


def explain_digit(training: DigitTraining, row: int = 0) -> DigitLesson:
    """Take the next learning step of a run with a copy of it, and return all of it around image `row` of the batch.

    The run stays as it is. Raises ValueError for a run that is over, an image that the batch does not have, and a
    network that is too large; DivergenceError as the step does.
    """
    if not 0 <= row < training.config.batch_size:
        raise ValueError(f"a batch has {training.config.batch_size} images, and none of number {row}")
    if training.done:
        raise ValueError("the run is over: it takes no more learning steps")
    twin = _twin(training)
    classifier, network = twin.classifier, twin.classifier.network
    recorder, step = recorded_step(twin.advance, network, twin.optimizer, (DigitTraining.advance,), row)
    taken = recorder.call(DigitTraining.advance).values
    image = of_row(taken["images"], row)
    after = classifier.predict(image)[0]
    network.values = step.values_before
    with Recorder(_READING) as reading:
        probabilities = classifier.predict(image)[0]
    return DigitLesson(
        config=training.config,
        taken=training.step,
        labels=taken["labels"],
        image=image,
        target=taken["targets"][row],
        outputs=taken["outputs"][row],
        logits=network.cost.logits,
        cost=float(taken["loss"]),
        derivative=recorder.call(NeuralNetwork.backward_propagate).arguments["output_error"][row],
        probabilities_before=probabilities,
        probabilities_after=after,
        step=step,
        lines=shown_lines(reading),
    )


_READING: Final[tuple[Function, ...]] = (DigitClassifier.probabilities, softmax)


def _twin(training: DigitTraining) -> DigitTraining:
    """Return a copy of a run that is about to take its next step; the images are shared."""
    twin = copy(training)
    twin.classifier = DigitClassifier(training.classifier.network.copy())
    twin.optimizer = OPTIMIZERS[training.config.optimizer](training.config.learning_rate)
    twin.optimizer.load_state(training.optimizer.state(), training.classifier.network.values)
    twin.average, twin.history = training.average.copy(), []
    twin.held_images = training.held_images[:0]  # the copy has no need to be measured
    return twin
