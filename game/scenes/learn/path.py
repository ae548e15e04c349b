"""The chapters of the path, in their order, and how far the player has come; a chapter is loaded when it is opened."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

from game.core import texts

if TYPE_CHECKING:
    from game.core.settings import Settings
    from game.scenes.learn.chapter import Chapter

# Where each chapter is, "module.Class" in this package, by the key of its texts in `texts.LEARN`.
PATH: Final = {
    "neuron": "neuron.NeuronChapter",
    "plane": "plane.PlaneChapter",
    "downhill": "downhill.DownhillChapter",
    "backwards": "backwards.BackwardsChapter",
    "pay": "pay.PayChapter",
    "choice": "choice.ChoiceChapter",
    "target": "runs.TargetChapter",
    "memory": "memory.MemoryChapter",
    "daring": "runs.DaringChapter",
}
FIRST: Final = next(iter(PATH))


def chapter_type(key: str) -> type[Chapter]:
    """Return the class of a chapter."""
    module, _, name = PATH[key].partition(".")
    chapter: type[Chapter] = getattr(import_module(f"game.scenes.learn.{module}"), name)
    return chapter


def following(key: str) -> str | None:
    """Return the key of the chapter after this one; None after the last."""
    keys = list(PATH)
    return next(iter(keys[keys.index(key) + 1 :]), None)


class Progress:
    """What the player has done on the path. Damaged values in the settings count as nothing done.

    The caller saves the settings after a change.
    """

    def __init__(self, settings: Settings) -> None:
        self._settings = settings

    def guess(self, key: str) -> int | None:
        """Return the number of the answer that was given in a chapter; None before."""
        guess, answers = self._of(key).get("guess"), list(filter(None, texts.LEARN_ANSWERS[key]))
        return guess if type(guess) is int and 0 <= guess < len(answers) else None

    def answer(self, key: str) -> str:
        """Return the words of the answer that was given; empty before."""
        guess = self.guess(key)
        return "" if guess is None else str(texts.LEARN_ANSWERS[key][guess])

    def state(self, key: str) -> int:
        """Return 2 for a chapter that is done, 1 for one that was opened, else 0."""
        return 2 if self._of(key).get("done") is True else int(isinstance(self._settings.learnt.get(key), dict))

    def done(self, key: str) -> bool:
        """Return whether a chapter's question was answered by a try."""
        return self.state(key) == 2

    def note(self, key: str, **values: int | bool) -> None:
        """Note that a chapter was opened, and a `guess`, or that it is `done`."""
        self._settings.learnt[key] = {**self._of(key), **values}

    def _of(self, key: str) -> dict[str, Any]:
        noted = self._settings.learnt.get(key)
        return noted if isinstance(noted, dict) else {}
