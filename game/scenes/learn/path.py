"""The chapters of the path, in their order, and how far the player has come; a chapter is loaded when it is opened."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from game.core import texts

if TYPE_CHECKING:
    from game.core.settings import Settings
    from game.scenes.learn.chapter import Chapter

PAGES: Final = ("predict", "try", "why", "code")
_MOST_ANSWERS: Final = 4


class Entry(NamedTuple):
    """Where a chapter is, "module.Class" in this package, and the minutes that it takes."""

    place: str
    minutes: int


# By the key of each chapter's texts in `texts.LEARN`.
PATH: Final[dict[str, Entry]] = {
    "neuron": Entry("neuron.NeuronChapter", 3),
    "plane": Entry("plane.PlaneChapter", 3),
    "downhill": Entry("downhill.DownhillChapter", 4),
    "backwards": Entry("backwards.BackwardsChapter", 3),
    "pay": Entry("pay.PayChapter", 5),
    "moment": Entry("moment.MomentChapter", 4),
    "choice": Entry("moment.ChoiceChapter", 3),
    "target": Entry("duels.TargetChapter", 3),
    "memory": Entry("memory.MemoryChapter", 4),
    "daring": Entry("duels.DaringChapter", 3),
    "own": Entry("own.OwnChapter", 5),
}
FIRST: Final = next(iter(PATH))


def chapter_type(key: str) -> type[Chapter]:
    """Return the class of a chapter."""
    module, _, name = PATH[key].place.partition(".")
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
        return self._number(key, "guess", _MOST_ANSWERS)

    def answer(self, key: str) -> str:
        """Return the words of the answer that was given; empty before."""
        guess = self.guess(key)
        return dict(enumerate(texts.LEARN_ANSWERS[key])).get(guess, "") if guess is not None else ""

    def page(self, key: str) -> int:
        """Return the page, an index of `PAGES`, on which a chapter was left; 0 before it was opened."""
        return self._number(key, "page", len(PAGES)) or 0

    def state(self, key: str) -> int:
        """Return 2 for a chapter that was tried and its "see why" read, 1 for one that was opened, else 0."""
        return 2 if self._value(key, "done") is True else int(isinstance(self._settings.learnt.get(key), dict))

    def done(self, key: str) -> bool:
        """Return whether a chapter was tried and its "see why" read."""
        return self.state(key) == 2

    def note(self, key: str, **values: int | bool) -> None:
        """Note a `guess`, a `page` or that a chapter is `done`."""
        before = self._settings.learnt.get(key)
        self._settings.learnt[key] = {**(before if isinstance(before, dict) else {}), **values}

    def _number(self, key: str, name: str, most: int) -> int | None:
        value = self._value(key, name)
        return value if type(value) is int and 0 <= value < most else None

    def _value(self, key: str, name: str) -> Any:
        chapter = self._settings.learnt.get(key)
        return chapter.get(name) if isinstance(chapter, dict) else None
