"""Lesson of a digit network: its step is the one that the run takes next, bit for bit."""

from dataclasses import replace

import numpy as np
import pytest

from ai.digits.config import DIGIT_PRESETS
from ai.digits.training import DigitTraining
from ai.explain.digit_lesson import explain_digit
from ai.training.digit_session import DigitSession
from ai.training.messages import Refused


@pytest.fixture(scope="module")
def data():
    rng = np.random.default_rng(0)
    return rng.random((60, 28, 28), np.float32), rng.integers(10, size=60).astype(np.uint8)


@pytest.fixture(params=["modern", "classic"])
def training(request, data):
    config = replace(DIGIT_PRESETS[request.param], batch_size=4, held_out=12)
    training = DigitTraining(config, 1, data)
    for _ in range(3):
        training.advance()
    return training


def test_the_step_is_the_one_the_run_takes_next(training):
    lesson = explain_digit(training, 3)
    before = training.classifier.network.values.copy()
    np.testing.assert_array_equal(lesson.step.values_before, before)
    progress = training.advance()
    network = training.classifier.network
    np.testing.assert_array_equal(lesson.step.values_after, network.values)
    np.testing.assert_array_equal(lesson.step.gradient, network.gradients)
    np.testing.assert_array_equal(lesson.step.taken, training.optimizer.scratch)
    assert lesson.cost == progress.loss
    assert lesson.taken == training.step - 1


def test_image_answer_and_target_belong_together(training):
    lesson = explain_digit(training, 3)
    assert lesson.image.shape == (28, 28)
    assert int(lesson.target.argmax()) == lesson.labels[3]
    np.testing.assert_array_equal(lesson.step.activations[-1], lesson.outputs)
    cost = training.classifier.network.cost
    expected = cost.derivative(lesson.outputs[None], lesson.target[None])[0] / 4
    np.testing.assert_allclose(lesson.derivative, expected, rtol=1e-4, atol=1e-8)
    np.testing.assert_allclose(lesson.probabilities_before, training.classifier.predict(lesson.image)[0], rtol=1e-6)
    ran = {line.function for line in (*lesson.step.lines, *lesson.lines)}
    assert {"DigitTraining.advance", "Optimizer.step", "DigitClassifier.probabilities"} <= ran


def test_the_shares_of_all_images_add_up_to_the_gradient(training):
    steps = [explain_digit(training, row).step for row in range(training.config.batch_size)]
    np.testing.assert_allclose(sum(step.share for step in steps), steps[0].gradient, rtol=1e-3, atol=2e-6)


def test_the_run_is_as_before(training):
    network = training.classifier.network
    before, state, average = network.values.copy(), training.optimizer.state(), training.average.copy()
    history, step = list(training.history), training.step
    explain_digit(training, 2)
    np.testing.assert_array_equal(network.values, before)
    np.testing.assert_array_equal(training.average, average)
    for name, kept in training.optimizer.state().items():
        np.testing.assert_array_equal(kept, state[name])
    assert (training.history, training.step) == (history, step)


def test_a_live_run_answers_and_refuses(data):
    session = DigitSession.live(replace(DIGIT_PRESETS["classic"], batch_size=8, held_out=12), 1, data=data)
    for _ in range(4):
        next(session)
    (lesson,) = session.send(("explain", 3))
    assert lesson.step.row == 3
    (refused,) = session.send(("explain", 8))
    assert isinstance(refused, Refused)
    assert "none of number 8" in refused.problem
