"""The chapters of the path, in their order, and how far the player has come; a chapter is loaded when it is opened."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Final

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


def is_done(settings: Settings, key: str) -> bool:
    """Return whether a chapter's question was answered by a try. Damaged values in the settings count as no."""
    noted = settings.learnt.get(key)
    return isinstance(noted, dict) and noted.get("done") is True
