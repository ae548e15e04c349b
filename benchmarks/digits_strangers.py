"""How well the shipped networks read what strangers write: slashed zeros, narrow digits, scans of few pixels.

    python -m benchmarks.digits_strangers [--each 60] [--models DIR]

Hands and scans are those of `tests.support.stranger_digits`, from which no network has learned. Scans are of the hands
of `benchmarks.hand_styles` and of templates; beside each figure stands that without normalising the stroke's width.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
from itertools import product
from pathlib import Path

import numpy as np

from ai.digits.classifier import DigitClassifier
from ai.digits.preprocessing import preprocess_strokes, stages
from benchmarks.hand_styles import HANDS, UNSEEN
from game.scenes.digits.reader import Reading, Verdict
from tests.support.digit_styles import template_strokes
from tests.support.stranger_digits import ENDS, TURNS, narrow, scan, slashed_zero

MODELS = Path(__file__).parents[1] / "models" / "digits"


def curved(strokes):
    """Return strokes of a few points as smooth ways."""
    from benchmarks.digits_hands import curve

    return [curve(np.array(stroke, float)) for stroke in strokes]


def others(rng, each):
    """Yield digits of many hands, none of them slashed, with their strokes."""
    for (digit, name), style in (HANDS | UNSEEN).items():
        for _ in range(0 if "slash" in name else each):
            manner = np.array([[rng.uniform(0.45, 0.9), 0], [-rng.normal(0.1, 0.15), 1]])
            yield digit, [stroke @ manner for stroke in curved(style)]
    for digit in range(10):
        for _ in range(5 * each):
            yield digit, template_strokes(digit, rng)


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
        readings = [Reading(one, {name: each.predict(one)[0] for name, each in networks.items()}) for one in seen]
        answers = {name: np.array([read.probabilities[name].argmax() for read in readings]) for name in networks}
        sure = np.array([read.verdict("modern") is Verdict.SURE for read in readings]) & (answers["modern"] != digit)
        shares = [f"{name} {np.mean(read == digit):.1%}" for name, read in answers.items()]
        print(f"{digit} narrow", *shares, f"sure of another digit: {sure.sum()} of {len(seen)}")


def read_scans(network, each):
    """Print how many scans *modern* reads, with and without the step that normalises the stroke's width."""
    digits = list(others(np.random.default_rng(5), max(1, each // 10)))
    meant = np.array([digit for digit, _ in digits])
    for side, pen, binary in product((12, 16, 20, 28), (0.12, 0.18, 0.25), (False, True)):
        scans = [scan(strokes, side, pen * side, binary) for _, strokes in digits]
        hits = [
            np.mean(network.predict(np.stack([stages(each, width=width).centred for each in scans])).argmax(1) == meant)
            for width in (True, False)
        ]
        print(f"{side} pixels, pen {pen * side:.1f}, {'black and white' if binary else 'grey':15}",
              f"{hits[0]:.2%}, as wide as drawn {hits[1]:.2%}")  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--each", type=int, default=60, help="drawings of each kind (default: 60)")
    parser.add_argument("--models", type=Path, default=MODELS, help="a folder of networks other than the shipped")
    chosen = parser.parse_args()
    networks = {name: DigitClassifier.load(chosen.models / name) for name in ("modern", "classic")}
    read_zeros(networks, chosen.each, np.random.default_rng(77))
    read_scans(networks["modern"], chosen.each)


if __name__ == "__main__":
    main()
