"""Quiz rules, without a screen: the network reads the player's digits, the player reads those of other people."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np
import numpy.typing as npt

from ai.digits.classifier import DIGITS
from ai.digits.mnist import bright

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier
    from ai.digits.mnist import Pixels
    from ai.digits.preprocessing import Image

ROUNDS: Final = 10  # alternating: one drawn by the player, one read by the player
_LOOKED_AT: Final = 300  # number of other people's digits from which the hardest to read are chosen
_AT_ONCE: Final = 4  # of them, in one frame


@dataclass
class QuizRound:
    """One round of the quiz.

    Attributes:
        kind: whether the player draws and the network reads, or the player reads.
        digit: the digit to draw, or the one that its writer meant, once their image is found.
        image: (28, 28), the image to read; None until it is drawn, or found.
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
    """A quiz of ten rounds. Digits to read come from `images`, 0 to 255, and `labels`; without, all are drawn.

    Attributes:
        rounds: all of them.
        place: index of the current round; ROUNDS when the quiz is over.

    """

    def __init__(
        self,
        classifier: DigitClassifier,
        images: Pixels,
        labels: npt.NDArray[Any],
        rng: np.random.Generator,
    ) -> None:
        self.classifier = classifier
        self.place = 0
        wanted = rng.permutation(DIGITS)
        self.rounds = [QuizRound("draw", int(digit)) for digit in wanted]
        to_read = self.rounds[1::2][: len(images)]
        for each in to_read:
            each.kind = "read"
        sample = rng.choice(len(images), _LOOKED_AT, replace=False) if len(images) > _LOOKED_AT else slice(None)
        order = rng.permutation(len(to_read))
        self._looking = self._find(to_read, images[sample], labels[sample], order)

    def look(self) -> bool:
        """Look for digits that are hard to read, a few at a time; return whether there are more to look at.

        The first is read after the player has drawn one, and all together take longer than a frame may last.
        """
        return next(self._looking, False)

    def _find(
        self, rounds: Sequence[QuizRound], images: Pixels, labels: npt.NDArray[Any], order: npt.NDArray[np.intp]
    ) -> Iterator[bool]:
        """Give rounds the images of which the network is least sure, in that order; yield whether it goes on."""
        parts = [slice(first, first + _AT_ONCE) for first in range(0, len(images), _AT_ONCE)]
        surest = np.zeros(len(images), np.float32)
        for part in parts:
            surest[part] = self.classifier.predict(bright(images[part])).max(axis=1)
            yield True
        hardest = surest.argsort(kind="stable")[: len(order)]
        for each, number in zip(rounds, hardest[order].tolist(), strict=True):
            each.image, each.digit = bright(images[number]), int(labels[number])
            each.probabilities = self.classifier.predict(each.image)[0]

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
            while self.round and self.round.image is None and self.round.kind == "read":
                self.look()

    def score(self, kind: Literal["draw", "read"]) -> tuple[int, int]:
        """Return the numbers of right answers and of all answers in rounds of a kind."""
        answered = [each for each in self.rounds if each.kind == kind and each.answer is not None]
        return sum(each.right for each in answered), len(answered)

    @property
    def lead(self) -> int:
        """1 if the player reads better, -1 if the network does, 0 if they are even."""
        (you, asked), (net, drawn) = self.score("read"), self.score("draw")
        return int(np.sign(you * drawn - net * asked))
