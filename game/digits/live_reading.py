"""Live reading of a drawing by the chosen network and another to compare it with, a part of the work per frame."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from pathlib import Path

from ai.digits.preprocessing import redrawn
from game.digits.pad import DrawingPad
from game.digits.reader import Explanation, Numbers, Reader, Switches, Verdict
from game.training.digit_models import NAMES


class LiveReading:
    """Reading of what is drawn on a pad, kept up to date.

    Args:
        pad: what is drawn on.
        chosen: name of the network that is explained.
        on_read: called after each reading.

    Attributes:
        reader: the networks that could be loaded.
        switches: the preprocessing steps that are on.
        reading: the latest reading.
        why: explanation of the chosen network's answer; None if it could not be loaded.

    """

    def __init__(self, pad: DrawingPad, chosen: str, on_read: Callable[[], None]) -> None:
        self._pad, self.chosen, self._on_read = pad, chosen, on_read
        self.reader, self.switches = Reader(), Switches()
        self._seen = -1  # revision of the drawing that was read last
        self._looking: Iterator[None] = iter(())
        self.why: Explanation | None = None

    @property
    def known(self) -> bool:
        """Whether the chosen network could be loaded."""
        return self.chosen in self.reader.classifiers

    @property
    def other(self) -> str:
        """Name of the network to compare with: Modern, or Classic beside Modern; empty if it can't be loaded."""
        return next((name for name in NAMES if name != self.chosen and name in self.reader.classifiers), "")

    @property
    def pair(self) -> list[str]:
        """Names of both networks, as far as they could be loaded."""
        return [name for name in (self.chosen, self.other) if name in self.reader.classifiers]

    @property
    def probabilities(self) -> Numbers | None:
        """The chosen network's probabilities (10,); None while nothing is drawn, or it can't be loaded."""
        self.catch_up()
        return None if self.reading.verdict(self.chosen) is Verdict.EMPTY else self.reading.probabilities[self.chosen]

    @property
    def sources(self) -> dict[str, Path]:
        """Folders of both networks."""
        return {name: self.reader.sources[name] for name in self.pair}

    def bars(self, digit: int) -> tuple[tuple[float, float], bool]:
        """Return both networks' probabilities for a digit, and whether it is the chosen one's answer."""
        drawn = bool(self.reading.stages.centred.any())
        values = [self.reading.probabilities.get(name) for name in (self.chosen, self.other)]
        one, other = (float(value[digit]) if drawn and value is not None else 0.0 for value in values)
        return (one, other), drawn and values[0] is not None and int(values[0].argmax()) == digit

    def update(self) -> None:
        """Read the drawing if it has changed, a part per frame."""
        if next(self._looking, True) and self._seen != self._pad.revision:
            self._looking = self._look()
            next(self._looking)

    def catch_up(self) -> None:
        """Finish reading the current drawing."""
        if self._seen != self._pad.revision:
            self._looking = self._look()
        deque(self._looking, maxlen=0)

    def anew(self) -> None:
        """Read the current drawing again, by networks or with switches that have changed."""
        self._seen = -1
        self.catch_up()

    def _look(self) -> Iterator[None]:
        """Preprocess the drawing, read it with both networks, and explain the chosen one's answer.

        A generator that does a part at a time: while the pen moves, all of it would take too long for one frame.
        """
        self._seen = self._pad.revision
        strokes = redrawn(self._pad.strokes)
        yield
        seen = self.switches.prepare(strokes, self._pad.ink)
        self.reading = self.reader.read(seen, self.pair)
        self._on_read()
        yield
        known = self.chosen in self.reading.probabilities
        self.why = self.reader.explain(self.chosen, seen.centred) if known else None
        yield
