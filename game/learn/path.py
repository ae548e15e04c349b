"""The chapters of the path, in their order; the module of a chapter is loaded when it is first opened."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from game.learn.chapter import Chapter


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
    "choice": Entry("choice.ChoiceChapter", 3),
    "target": Entry("target.TargetChapter", 3),
    "memory": Entry("memory.MemoryChapter", 4),
    "daring": Entry("daring.DaringChapter", 3),
    "own": Entry("own.OwnChapter", 5),
}
FIRST: Final = next(iter(PATH))


def chapter_type(key: str) -> type[Chapter]:
    """Return the class of a chapter."""
    module, _, name = PATH[key].place.partition(".")
    chapter: type[Chapter] = getattr(import_module(f"game.learn.{module}"), name)
    return chapter


def following(key: str) -> str | None:
    """Return the key of the chapter after this one; None after the last."""
    keys = list(PATH)
    return next(iter(keys[keys.index(key) + 1 :]), None)
