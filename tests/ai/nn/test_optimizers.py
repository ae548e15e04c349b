"""Optimizers against their definitions, written out one parameter at a time."""

import math
from typing import Any

import numpy as np
import pytest

from ai.nn import OPTIMIZERS, SGD, Adam, DivergenceError

STEPS = 25


def gradients():
    return np.random.default_rng(0).normal(size=(STEPS, 5))


def adam_by_the_paper(value, gradient_series, rate=0.01, beta1=0.9, beta2=0.999, epsilon=1e-8):
    m = v = 0.0
    for t, g in enumerate(gradient_series, start=1):
        m = beta1 * m + (1 - beta1) * g
        v = beta2 * v + (1 - beta2) * g * g
        value -= rate * (m / (1 - beta1**t)) / (math.sqrt(v / (1 - beta2**t)) + epsilon)
    return value


def momentum_by_hand(value, gradient_series, rate=0.01, momentum=0.9):
    velocity = 0.0
    for g in gradient_series:
        velocity = momentum * velocity + g
        value -= rate * velocity
    return value


REFERENCES = {
    "sgd": lambda value, series: value - 0.01 * sum(series),
    "momentum": momentum_by_hand,
    "adam": adam_by_the_paper,
}


@pytest.mark.parametrize("name", OPTIMIZERS)
def test_optimizers_follow_their_definition(name):
    values, series = np.linspace(-1, 1, 5), gradients()
    expected = [REFERENCES[name](value, series[:, i]) for i, value in enumerate(values)]
    optimizer = OPTIMIZERS[name](0.01)
    for gradient in series:
        assert optimizer.step(values, gradient) == pytest.approx(np.linalg.norm(gradient))
    np.testing.assert_allclose(values, expected, rtol=1e-12)


@pytest.mark.parametrize("name", OPTIMIZERS)
def test_a_state_carries_on(name):
    whole, broken_off = np.ones(5), np.ones(5)
    first, second = OPTIMIZERS[name](0.1), OPTIMIZERS[name](0.1)
    for step, gradient in enumerate(gradients()):
        first.step(whole, gradient.copy())
        if step % 5 == 0:
            state, left = second.state(), second
            second = OPTIMIZERS[name](0.1)
            second.load_state(state, broken_off)
            left.step(np.ones(5), np.ones(5))  # changes nothing of the state, which is a copy
        second.step(broken_off, gradient.copy())
    np.testing.assert_array_equal(whole, broken_off)


def test_a_damaged_state_or_one_of_another_kind_is_refused_and_changes_nothing(subtests):
    change: Any
    for change, message in [
        ({"square_sum": np.ones(4, np.float32)}, r"square_sum should hold float32 \[3\]"),
        ({"gradient_sum": np.array([0, np.nan, 0], np.float32)}, "gradient_sum holds numbers that are not finite"),
        ({"square_sum": np.array([1, -1, 1], np.float32)}, "square_sum holds numbers below 0"),
        ({"steps": np.array(-1)}, "whole number"),
        ({"steps": np.array(2.5)}, "whole number"),
        ({"velocity": np.ones(3)}, "not a state of Adam: it holds gradient_sum, square_sum, steps, velocity"),
    ]:
        with subtests.test(change=change, message=message):
            optimizer, values = Adam(), np.ones(3, np.float32)
            optimizer.step(values, np.ones(3, np.float32))
            before = optimizer.state()
            with pytest.raises(ValueError, match=message):
                optimizer.load_state(before | change, values)
            for name, array in optimizer.state().items():
                np.testing.assert_array_equal(array, before[name])
    with pytest.raises(ValueError, match="not a state of SGD"):
        SGD().load_state({}, np.ones(3))
    with pytest.raises(ValueError, match="3 parameters"):
        optimizer.step(np.ones(4), np.ones(4))


def test_a_long_gradient_is_shortened():
    values = np.zeros(2)
    assert SGD(1.0, clip=10.0).step(values, np.array([30.0, 40.0])) == pytest.approx(50.0)
    np.testing.assert_allclose(values, [-6.0, -8.0])
    assert SGD(1.0, clip=10.0).step(values, np.array([3.0, 4.0])) == pytest.approx(5.0)
    np.testing.assert_allclose(values, [-9.0, -12.0])


@pytest.mark.parametrize("name", OPTIMIZERS)
def test_what_is_not_finite_moves_nothing(name):
    optimizer, values = OPTIMIZERS[name](clip=10.0), np.ones(3)
    optimizer.step(values, np.ones(3))
    before, state = values.copy(), optimizer.state()
    for bad in math.nan, math.inf, -math.inf:
        with pytest.raises(
            DivergenceError, match=f"gradient was not finite at learning step 2; .* {optimizer.learning_rate}"
        ):
            optimizer.step(values, np.array([1.0, bad, 1.0]))
        with pytest.raises(DivergenceError, match="the cost was not finite at learning step 2"):
            optimizer.step(values, np.ones(3), cost=bad)
    np.testing.assert_array_equal(values, before)
    for key, array in optimizer.state().items():
        np.testing.assert_array_equal(array, state[key])
    optimizer, small = OPTIMIZERS[name](1e300), np.ones(3, np.float32)
    with pytest.raises(DivergenceError, match=r"step was not finite at learning step 1; .*1e\+300"):
        optimizer.step(small, np.full(3, 1e10, np.float32))
    assert (small == 1).all()
