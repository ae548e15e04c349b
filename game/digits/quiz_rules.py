"""The quiz as a game without a screen: who reads better, a network that reads you, or you who read strangers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np
import numpy.typing as npt

from ai.digits.classifier import DIGITS

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier, Image

ROUNDS: Final = 10  # in turns: one that is drawn, one that is read
_LOOKED_AT: Final = 300  # strangers' digits, of which the hardest to read are asked


@dataclass
class Round:
    """One question.

    Attributes:
        kind: whether the player draws and the network reads, or the player reads.
        digit: what is to be drawn, or what a stranger meant.
        image: (28, 28) what is read; None until it is drawn.
        answer: what whose turn it is has read; None until then.
        probabilities: (10,) what the network makes of the image.

    """

    kind: Literal["draw", "read"]
    digit: int
    image: Image | None = None
    answer: int | None = None
    probabilities: npt.NDArray[np.float32] | None = None

    @property
    def right(self) -> bool:
        """Whether it was read as what it is."""
        return self.answer == self.digit


class Contest:
    """A quiz of ten rounds. Strangers' digits are taken from `images` and `labels`; without any, all is drawn.

    Attributes:
        rounds: all of them.
        place: the number of the one that goes on; ROUNDS when it is over.

    """

    def __init__(
        self,
        classifier: DigitClassifier,
        images: npt.NDArray[np.float32],
        labels: npt.NDArray[Any],
        rng: np.random.Generator,
    ) -> None:
        self.classifier = classifier
        self.place = 0
        wanted = rng.permutation(DIGITS)
        strangers = _hardest(classifier, images, labels, rng, ROUNDS // 2)
        self.rounds = []
        for number in range(ROUNDS):
            if number % 2 and strangers:
                image, digit = strangers.pop()
                self.rounds.append(Round("read", digit, image, probabilities=classifier.predict(image)[0]))
            else:
                self.rounds.append(Round("draw", int(wanted[number])))

    @property
    def round(self) -> Round | None:
        """The round that goes on; None when all are over."""
        return self.rounds[self.place] if self.place < len(self.rounds) else None

    def submit(self, image: Image) -> None:
        """Let the network read what the player has drawn."""
        current = self.round
        if current and current.kind == "draw" and current.answer is None:
            current.image, current.probabilities = image, self.classifier.predict(image)[0]
            current.answer = int(current.probabilities.argmax())

    def read(self, digit: int) -> None:
        """Say what the player reads."""
        current = self.round
        if current and current.kind == "read" and current.answer is None:
            current.answer = digit

    def go_on(self) -> None:
        """Go to the next round, once this one is answered."""
        if self.round and self.round.answer is not None:
            self.place += 1

    def score(self, kind: Literal["draw", "read"]) -> tuple[int, int]:
        """Return how many rounds of a kind were read rightly, and how many were answered."""
        answered = [each for each in self.rounds if each.kind == kind and each.answer is not None]
        return sum(each.right for each in answered), len(answered)

    @property
    def lead(self) -> int:
        """1 if the player reads better, -1 if the network does, 0 if they are even."""
        (you, asked), (net, drawn) = self.score("read"), self.score("draw")
        return int(np.sign(you * drawn - net * asked))


def _hardest(
    classifier: DigitClassifier,
    images: npt.NDArray[np.float32],
    labels: npt.NDArray[Any],
    rng: np.random.Generator,
    count: int,
) -> list[tuple[Image, int]]:
    """Return the images of which the network is least sure, out of some, and what they are."""
    if not len(images):
        return []
    chosen = rng.choice(len(images), min(_LOOKED_AT, len(images)), replace=False)
    hardest = chosen[classifier.predict(images[chosen]).max(axis=1).argsort(kind="stable")[:count]]
    return [(images[number], int(labels[number])) for number in rng.permutation(hardest)]
