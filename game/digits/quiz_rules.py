"""Quiz rules, without a screen: the network reads the player's digits, the player reads strangers' digits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np
import numpy.typing as npt

from ai.digits.classifier import DIGITS

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier, Image

ROUNDS: Final = 10  # alternating: one drawn by the player, one read by the player
_LOOKED_AT: Final = 300  # number of strangers' digits from which the hardest to read are chosen


@dataclass
class QuizRound:
    """One round of the quiz.

    Attributes:
        kind: whether the player draws and the network reads, or the player reads.
        digit: the digit to draw, or the one that a stranger meant.
        image: (28, 28), the image to read; None until it is drawn.
        answer: the digit read by the network or the player, whoever reads; None until then.
        probabilities: (10,), the network's output for the image.

    """

    kind: Literal["draw", "read"]
    digit: int
    image: Image | None = None
    answer: int | None = None
    probabilities: npt.NDArray[np.float32] | None = None

    @property
    def right(self) -> bool:
        """Whether the answer is right."""
        return self.answer == self.digit


class QuizGame:
    """A quiz of ten rounds. Strangers' digits come from `images` and `labels`; without them, all rounds are drawn.

    Attributes:
        rounds: all of them.
        place: index of the current round; ROUNDS when the quiz is over.

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
                self.rounds.append(QuizRound("read", digit, image, probabilities=classifier.predict(image)[0]))
            else:
                self.rounds.append(QuizRound("draw", int(wanted[number])))

    @property
    def round(self) -> QuizRound | None:
        """The current round; None when all are over."""
        return self.rounds[self.place] if self.place < len(self.rounds) else None

    def submit(self, image: Image) -> None:
        """Let the network read what the player has drawn."""
        current = self.round
        if current and current.kind == "draw" and current.answer is None:
            current.image, current.probabilities = image, self.classifier.predict(image)[0]
            current.answer = int(current.probabilities.argmax())

    def read(self, digit: int) -> None:
        """Enter the digit that the player reads."""
        current = self.round
        if current and current.kind == "read" and current.answer is None:
            current.answer = digit

    def go_on(self) -> None:
        """Advance to the next round, once this one is answered."""
        if self.round and self.round.answer is not None:
            self.place += 1

    def score(self, kind: Literal["draw", "read"]) -> tuple[int, int]:
        """Return the numbers of right answers and of all answers in rounds of a kind."""
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
    """Return the images, out of a random sample, of which the network is least sure, and their labels."""
    if not len(images):
        return []
    chosen = rng.choice(len(images), min(_LOOKED_AT, len(images)), replace=False)
    hardest = chosen[classifier.predict(images[chosen]).max(axis=1).argsort(kind="stable")[:count]]
    return [(images[number], int(labels[number])) for number in rng.permutation(hardest)]
