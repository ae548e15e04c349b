"""Chapter: one question of the path, with something real and small to touch; `scene` shows it on a page that grows."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, ClassVar, NamedTuple, Protocol

import pygame

from game.core import texts
from game.core.scene import Route
from game.core.source import Mark
from game.drawing.canvas import Canvas
from game.ui.context import Context
from game.ui.panel import Column


class Code(NamedTuple):
    """A function of ours whose line does what the chapter is about."""

    function: Callable[..., Any]
    line: Mark  # what the line is found by, which is lit
    note: str  # what stands beside it: numbers of the case at hand


class Model(Protocol):
    """What is touched in a chapter, without a window."""

    def step(self) -> bool:
        """Advance by 1/60 s; return whether this has shown something."""

    def verdict(self) -> int | None:
        """Return the number of the answer that the player's own tries have shown; None while they decide nothing."""


class Chapter(ABC):
    """One chapter: a model to touch, its picture, and what a try has shown.

    Attributes:
        key: key of its texts in `texts.LEARN` and `texts.LEARN_ANSWERS`.
        door: where the same can be done freely.
        shape: height of the picture, as a share of its width.
        judged: which of the settings `verdict` is about; empty where it is about all.
        model: what is touched.
        tried: whether the player has done what the chapter is about, so that `why` has something to tell.
        changed: set when it shows something else than before, or has other controls; the scene describes them anew.

    """

    key: ClassVar[str]
    door: ClassVar[Route]
    shape: ClassVar[float] = 0.52
    judged = ""
    model: Model

    def __init__(self, context: Context) -> None:
        self.context = context
        self.tried = self.changed = False

    @property
    def words(self) -> dict[str, str]:
        """The chapter's texts by name."""
        return texts.LEARN[self.key]

    @abstractmethod
    def controls(self, column: Column) -> None:
        """Add what can be changed and pressed."""

    def below(self, column: Column) -> None:  # noqa: B027 - a picture may say it all
        """Add what stands below the picture."""

    def found(self) -> None:
        """Take note that a try has shown something."""
        self.tried = self.changed = True

    @abstractmethod
    def why(self) -> str:
        """Return what the player's own try has shown, with its numbers; asked once it is `tried`."""

    def code(self) -> Code | None:
        """Return the line of ours that did it, with the numbers of this moment; None where no line has any."""
        return None

    @abstractmethod
    def draw(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw the picture in a box, in points."""

    def update(self) -> None:
        """Advance by 1/60 s; called once the question was answered, until when the picture stands still."""
        if self.model.step():
            self.found()

    def verdict(self) -> int | None:
        """Return what the model's `verdict` says."""
        return self.model.verdict()

    def close(self) -> None:  # noqa: B027 - most hold nothing
        """Release resources such as a process."""
