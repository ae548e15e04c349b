"""How well the shipped networks read what strangers write: slashed zeros, narrow digits.

    python -m benchmarks.digits_strangers [--each 60]

The hands are those of `tests.support.stranger_digits`, from which no network has learned.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
from itertools import product
from pathlib import Path

import numpy as np

from ai.digits.classifier import DigitClassifier
from ai.digits.preprocessing import preprocess_strokes
from tests.support.stranger_digits import ENDS, TURNS, narrow, slashed_zero

MODELS = Path(__file__).parents[1] / "models" / "digits"


def read_zeros(networks, each, rng):
    """Print how many slashed zeros are read, by the way of the slash, and how many narrow digits."""
    for turn, ends in product(TURNS, ENDS):
        drawn = [preprocess_strokes(slashed_zero(turn, ends, rng, bool(at % 2))) for at in range(each)]
        read = [network.predict(np.stack(drawn)).argmax(axis=1) for network in networks.values()]
        print(
            f"0 {turn:8} {ends:16}",
            *(f"{name} {np.mean(each == 0):.1%}" for name, each in zip(networks, read, strict=True)),
        )
    for digit in (0, 8):
        seen = [preprocess_strokes(narrow(digit, rng)) for _ in range(5 * each)]
        answers = {name: network.predict(np.stack(seen)).argmax(axis=1) for name, network in networks.items()}
        print(f"{digit} narrow", *(f"{name} {np.mean(read == digit):.1%}" for name, read in answers.items()))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--each", type=int, default=60, help="drawings of each kind (default: 60)")
    chosen = parser.parse_args()
    networks = {name: DigitClassifier.load(MODELS / name) for name in ("modern", "classic")}
    read_zeros(networks, chosen.each, np.random.default_rng(77))


if __name__ == "__main__":
    main()
