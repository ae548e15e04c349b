"""Chapter: one question of the path, with something real and small to touch; `game.scenes.chapter` shows it.

A chapter has four pages: predict, try, see why, in the code. Its picture stands in `STAGE` on the first three, its
widgets in `PANEL` on the second.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, Final

import pygame

from game.core import texts
from game.core.scene import Route
from game.core.source import Mark
from game.drawing.canvas import Canvas
from game.drawing.tokens import MARGIN, VIEW_SIZE
from game.ui.actions import Table
from game.ui.context import Context
from game.ui.widget import PointsManager, Widget

STAGE: Final = pygame.FRect(448, 164, VIEW_SIZE[0] - MARGIN - 448, 452)  # where the picture is, in points
PANEL: Final = pygame.FRect(MARGIN, 304, 344, 312)  # where the widgets of the second page are
ROW: Final = 34.0  # height of a row of widgets


@dataclass(frozen=True)
class Code:
    """A function of ours to show as it runs.

    Attributes:
        function: the function whose source is shown.
        current: what the line is found by that is lit; None for none.
        notes: by what a line is found by, what stands beside it: numbers of the case at hand.

    """

    function: Callable[..., Any]
    current: Mark | None = None
    notes: Mapping[Mark, str] = field(default_factory=dict)


class Chapter(ABC):
    """One chapter; `manager` is that of the scene's form, for its widgets.

    Attributes:
        key: key of its texts in `texts.LEARN` and `texts.LEARN_ANSWERS`.
        answer: number of the answer that every try shows; None if that depends on the try.
        door: where the same can be done freely.
        tried: whether the player has done what the chapter is about, so that `why` has something to tell.
        changed: set when other widgets are to be offered; the scene asks for them again.

    """

    key: ClassVar[str]
    answer: ClassVar[int | None] = None
    door: ClassVar[Route]

    def __init__(self, context: Context, manager: PointsManager) -> None:
        self.context, self.manager = context, manager
        self.tried = self.changed = False

    @property
    def words(self) -> dict[str, str]:
        """The chapter's texts by name."""
        return texts.LEARN[self.key]

    @property
    def settled(self) -> bool:
        """Whether motion is reduced."""
        return self.context.settings.reduced_motion

    @property
    def running(self) -> bool:
        """Whether an agent learns, and `why` must wait for it."""
        return False

    def row(self, number: int, height: float = ROW) -> pygame.Rect:
        """Return the box of a row of the panel, counted from 0."""
        return pygame.Rect(PANEL.left, PANEL.top + number * ROW, PANEL.width, height)

    @abstractmethod
    def widgets(self) -> list[Widget]:
        """Return new widgets for the second page, in the order of Tab."""

    @abstractmethod
    def restart(self) -> None:
        """Begin anew, as when the chapter was opened."""

    def verdict(self) -> int | None:
        """Return the number of the answer that the player's own try has shown; None if it does not decide that."""
        return self.answer

    @abstractmethod
    def why(self, guess: int | None) -> str:
        """Return what the player's own try has shown, with its numbers, beside the guess; asked once it is `tried`."""

    @abstractmethod
    def code(self) -> Sequence[Code]:
        """Return the functions to show, with the numbers of this moment; the same functions each time."""

    @abstractmethod
    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the picture in `STAGE`; changes nothing."""

    def actions(self) -> Table:
        """Return what more keys do on the second page."""
        return ()

    def handle_event(self, event: pygame.event.Event) -> bool:  # noqa: ARG002
        """Take a mouse event over the stage, in points; return whether it was used. Not called on the last page."""
        return False

    def update(self) -> None:  # noqa: B027 - nothing moves in some chapters
        """Advance by 1/60 s; called on every page but the first, on which the picture stands still."""

    def close(self) -> None:  # noqa: B027 - most hold nothing
        """Release resources such as a process."""
