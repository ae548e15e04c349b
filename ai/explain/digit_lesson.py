"""Lesson of a digit network: its next learning step around one image, recorded while a copy of the run takes it."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np
import numpy.typing as npt

from ai.common.environment import Floats
from ai.digits.classifier import DigitClassifier
from ai.digits.config import DigitConfig, build_digit_network
from ai.digits.training import DigitTraining
from ai.explain.learning_step import (
    MOST_PARAMETERS,
    Line,
    Step,
    kept_by,
    line_of,
    network_functions,
    of_row,
    recorded_step,
)
from ai.explain.recorder import Function, Recorder
from ai.nn import OPTIMIZERS
from ai.nn.costs import softmax


@dataclass(frozen=True, eq=False)
class DigitLesson:
    """The learning step of a digit network that comes next, around one image of its batch.

    Attributes:
        config: settings of the run.
        taken: learning steps taken before this one.
        labels: (batch,) which digits the images of the batch are.
        image: (28, 28) as it is learned from, bent and turned, 0 to 1.
        target: (10,) what the network should have answered.
        outputs: (10,) its answer before the step, with dropout: logits, if `logits` is true.
        logits: whether probabilities are the softmax of the outputs.
        cost: of the whole batch, before the step.
        derivative: (10,) of the cost by the outputs, divided by the size of the batch already.
        probabilities_before, probabilities_after: (10,) of each digit before and after the step, without dropout.
        step: the step of the optimizer; its row is the image's.
        lines: the lines of our own code that made probabilities of the outputs, before the step.

    """

    config: DigitConfig
    taken: int
    labels: npt.NDArray[np.int64]
    image: Floats
    target: Floats
    outputs: Floats
    logits: bool
    cost: float
    derivative: Floats
    probabilities_before: Floats
    probabilities_after: Floats
    step: Step
    lines: tuple[Line, ...] = ()


def digit_functions(config: DigitConfig) -> dict[str, Function]:
    """Return the functions that a lesson of a digit network records, by their qualified names."""
    network, optimizer = build_digit_network(config, np.random.default_rng(0)), OPTIMIZERS[config.optimizer](0.1)
    return Recorder([DigitTraining.advance, *network_functions(network, optimizer), *_READING]).functions


def explain_digit(training: DigitTraining, row: int = 0) -> DigitLesson:
    """Take the next learning step of a run with a copy of it, and return all of it around image `row` of the batch.

    The run stays as it is. Raises ValueError for a run that is over, an image that the batch does not have, and a
    network that is too large; DivergenceError as the step does.
    """
    if not 0 <= row < training.config.batch_size:
        raise ValueError(f"a batch has {training.config.batch_size} images, and none of number {row}")
    if training.done:
        raise ValueError("the run is over: it takes no more learning steps")
    if training.classifier.network.values.size > MOST_PARAMETERS:
        raise ValueError(f"a network of more than {MOST_PARAMETERS:,} parameters is too large to be explained")
    twin = _twin(training)
    classifier, network = twin.classifier, twin.classifier.network
    before = network.values.copy()
    kept = kept_by(twin.optimizer, before)
    functions = [DigitTraining.advance, *network_functions(network, twin.optimizer)]
    with Recorder(functions, row) as recorder:
        twin.advance()
    step = recorded_step(recorder, network, twin.optimizer, before, kept, row)
    last = partial(recorder.last, DigitTraining.advance.__qualname__)
    labels = last("labels")
    image = of_row(last("images"), row)
    after = classifier.predict(image)[0]
    network.values = before
    with Recorder(_READING) as reading:
        probabilities = classifier.predict(image)[0]
    return DigitLesson(
        config=training.config,
        taken=training.step,
        labels=labels,
        image=image,
        target=last("targets")[row],
        outputs=last("outputs")[row],
        logits=network.cost.logits,
        cost=float(last("loss")),
        derivative=recorder.last("NeuralNetwork.backward_propagate", "output_error")[row],
        probabilities_before=probabilities,
        probabilities_after=after,
        step=step,
        lines=tuple(line_of(event, 1, 0, 0) for event in reading.events),
    )


_READING: Final = (DigitClassifier.probabilities, softmax)


def _twin(training: DigitTraining) -> DigitTraining:
    """Return a copy of a run that is about to take its next step; the images are shared."""
    twin = copy(training)
    twin.classifier = DigitClassifier(training.classifier.network.copy())
    twin.optimizer = OPTIMIZERS[training.config.optimizer](training.config.learning_rate)
    twin.optimizer.load_state(training.optimizer.state(), training.classifier.network.values)
    twin.average, twin.history = training.average.copy(), []
    twin.held_images = training.held_images[:0]  # the copy has no need to be measured
    return twin
