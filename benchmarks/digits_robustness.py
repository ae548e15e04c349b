"""How well the shipped networks read digits that come from other pens than MNIST's.

    python -m benchmarks.digits_robustness

Two sets that took no part in any choice: test images of MNIST, enlarged and set aside of the middle of a canvas;
and digits of templates in several styles, slanted and wavy, of any size and with pens of any width.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
from pathlib import Path

import numpy as np

from ai.digits.classifier import DigitClassifier
from ai.digits.mnist import load_part
from ai.digits.preprocessing import _resample, preprocess
from ai.digits.strokes import draw_strokes
from ai.digits.training import accuracy
from tests.support.digit_styles import template_strokes

MODELS = Path(__file__).parents[1] / "models" / "digits"
ROUND_TRIPS, TEMPLATES_EACH = 2000, 60


def drawn(digit, rng, size=520):
    """Return a canvas with such a digit, drawn by a pen of a random width."""
    return draw_strokes(template_strokes(digit, rng, size), (size, size), rng.uniform(0.015, 0.07) * size)


def aside(image):
    canvas = np.zeros((280, 280), np.float32)
    canvas[5:257, 19:271] = _resample(image, (14, 14), 28 / 252, 252)
    return canvas


def main():
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    images, labels = (part[:ROUND_TRIPS] for part in load_part("test"))
    rng = np.random.default_rng(5)
    digits = np.repeat(np.arange(10, dtype=np.uint8), TEMPLATES_EACH)
    sets = {
        "test images as they are": (images, labels),
        "enlarged, preprocessed": (np.stack([preprocess(aside(image)) for image in images]), labels),
        "templates": (np.stack([preprocess(drawn(digit, rng)) for digit in digits]), digits),
    }
    difference = np.abs(sets["enlarged, preprocessed"][0] - images).mean()
    print(f"mean absolute difference of enlarged and preprocessed images from themselves: {difference:.3f}")
    for name in ("classic", "modern"):
        classifier = DigitClassifier.load(MODELS / name)
        for what, (shown, meant) in sets.items():
            print(f"{name:8} {what:24} {accuracy(classifier, shown, meant):.2%}")


if __name__ == "__main__":
    main()
