"""Activation maximisation: an image that climbs the gradient of a network's answer towards a digit."""

from __future__ import annotations

from typing import Final

import numpy as np

from ai.digits.classifier import DIGITS, DigitClassifier
from ai.digits.preprocessing import SIDE, Image
from ai.nn import Array
from ai.nn.costs import softmax

STEPS: Final = 150
STEP: Final = 0.15  # how far the pixel that changes most is moved, at first
_INK: Final = 312.0  # pixels of ink at the most: nearly three times what a digit of MNIST has
_LAST: Final = 0.2  # of the step, at the end
_SHIFT: Final = 1  # pixels at the most, to and fro
_SOFT, _SMOOTH = 0.07, 0.7  # how far each step blurs what is there, and what is added
_NOISE: Final = 0.1


class ActivationMaximisation:
    """Activation maximisation of one image towards a digit, a step at a time.

    Gradient ascent on the input (Erhan et al. 2009, Simonyan et al. 2014), from noise. Left to itself it finds what no
    person would read. It is regularised: its ink is limited, blurred, and moved to and fro, so that only strokes stay
    that mean the same wherever they are (Yosinski et al. 2015, Mordvintsev et al. 2015). Raises ValueError for a digit
    outside 0 to 9.
    `image` is (28, 28), 0 to 1; `probabilities` (10,) what the network reads in it after `step` steps.
    """

    def __init__(self, classifier: DigitClassifier, digit: int, rng: np.random.Generator) -> None:
        if digit not in range(DIGITS):
            raise ValueError(f"a digit is a number from 0 to 9, not {digit!r}")
        self.classifier, self.digit = classifier, digit
        self._rng = rng
        self.step = 0
        self.image: Image = np.asarray(_NOISE * rng.random((SIDE, SIDE)), np.float32)
        self.probabilities = classifier.predict(self.image)[0]

    @property
    def done(self) -> bool:
        """Whether all steps have been taken."""
        return self.step >= STEPS

    def advance(self) -> None:
        """Take one step, and let the network read the image anew."""
        down, across = self._rng.integers(-_SHIFT, _SHIFT + 1, 2).tolist()
        moved = np.roll(self.image, (down, across), axis=(0, 1))
        gradient = _blurred(np.roll(self.gradient(moved), (-down, -across), axis=(0, 1)), _SMOOTH)
        gradient /= max(float(np.abs(gradient).max()), 1e-12)
        length = STEP * (1 - (1 - _LAST) * self.step / STEPS)
        image = _blurred(self.image, _SOFT) + length * gradient
        self.image = _with_ink(image, _INK)
        self.step += 1
        self.probabilities = self.classifier.predict(self.image)[0]

    def gradient(self, image: Image) -> Image:
        """Return the gradient (28, 28) towards the digit: of cross-entropy, or of its lead over the other outputs."""
        classifier, network = self.classifier, self.classifier.network
        shaped = classifier.shaped(image)
        error: Array = np.eye(1, DIGITS, self.digit, dtype=np.float32)
        if network.cost.logits:
            error -= softmax(network.predict(shaped))
        else:
            error -= (1 - error) / (DIGITS - 1)
        return network.input_gradient(shaped, error).reshape(SIDE, SIDE)


def _with_ink(image: Image, most: float) -> Image:
    """Return the nearest image within 0 to 1 that has no more than so many pixels of ink, by bisection."""
    low, high = 0.0, max(float(image.max()), 0.0)
    if np.clip(image, 0, 1).sum() <= most:
        return np.clip(image, 0, 1)
    for _ in range(16):
        middle = (low + high) / 2
        low, high = (middle, high) if np.clip(image - middle, 0, 1).sum() > most else (low, middle)
    inked: Image = np.clip(image - high, 0, 1)
    return inked


def _blurred(image: Image, strength: float) -> Image:
    """Return an image mixed with what surrounds each pixel: 1 2 1 along each axis."""
    padded = np.pad(image, 1)
    rows = 0.25 * padded[:-2] + 0.5 * padded[1:-1] + 0.25 * padded[2:]
    soft = 0.25 * rows[:, :-2] + 0.5 * rows[:, 1:-1] + 0.25 * rows[:, 2:]
    return np.asarray(image + strength * (soft - image), np.float32)
