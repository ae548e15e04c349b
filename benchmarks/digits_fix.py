"""What fixing one misread digit costs: misread images of those held out are put right, each from the shipped network.

    python -m benchmarks.digits_fix

Prints for each how many steps it took, how sure the network is then, and what it still reads of all held out.
Neither the test images nor those held out are learnt from.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from ai.digits.classifier import DigitClassifier
from ai.digits.fix import steps_to_fix
from ai.digits.mnist import TRAIN, load_part
from ai.digits.training import SPLIT_SEED, accuracy
from game.core.assets import MODELS_DIR

HELD_OUT = 5_000


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=6, help="misread images for each network (default: 6)")
    count = parser.parse_args().count
    images, labels = load_part(TRAIN)
    order = np.random.default_rng(SPLIT_SEED).permutation(len(images))
    kept, held = order[:-HELD_OUT], order[-HELD_OUT:]
    print("network   is  was read  steps  seconds  now sure  held out: before  after")
    for name in ("classic", "modern"):
        network = DigitClassifier.load(MODELS_DIR / "digits" / name).network
        shipped = DigitClassifier(network)
        read = shipped.predict(images[held]).argmax(axis=1)
        before = accuracy(shipped, images[held], labels[held])
        for number in held[read != labels[held]][:count]:
            classifier, image, digit = DigitClassifier(network.copy()), images[number], int(labels[number])
            began, steps = time.perf_counter(), 0
            was = int(classifier.predict(image).argmax())
            rng = np.random.default_rng(digit)
            for step in steps_to_fix(classifier, image, digit, (images[kept], labels[kept]), rng):
                steps = step.step + 1
            seconds, sure = time.perf_counter() - began, float(classifier.predict(image)[0, digit])
            after = accuracy(classifier, images[held], labels[held])
            print(
                f"{name:8} {digit:>3} {was:>9} {min(steps, 60):>6} {seconds:>8.2f} {sure:>9.0%} "
                f"{before:>17.2%} {after:>6.2%}",
                flush=True,
            )


if __name__ == "__main__":
    main()
