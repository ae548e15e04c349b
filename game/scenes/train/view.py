# ruff: noqa: B027 - what a kind does not say, it does not have
"""What is seen of a run, and what there is to do with it alone: the part of Train that differs between kinds."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

import pygame

from game.core import texts
from game.core.scene import Transition
from game.core.shelf import Collection
from game.drawing.canvas import Canvas
from game.scenes.train.charts import Beside, ChartKind
from game.scenes.train.layout import Layout, Status
from game.training.run_kind import RunKind
from game.ui.panel import Column
from game.ui.widget import Widget

if TYPE_CHECKING:
    from pathlib import Path

    from game.scenes.train.scene import TrainScene

Pointer = tuple[Widget, Callable[[], pygame.typing.RectLike]]


class View(ABC):
    """View of the runs of one kind, in a scene.

    Attributes:
        kind: of its runs.
        charts: of the kind.
        preset: with which the first run starts.
        moment: what is shown of a run, in decisions; None for now.
        fills: whether it takes the place of charts and title.
        titled: whether there is room for the title.
        page: which page takes the place of the knobs; nothing true for none.
        first: names of the few knobs.
        unfinished: what is said of a run that was left, and can go on; empty without one.
        worth_keeping: whether there is a run without a name that has learnt.
        key: what else decides which rows there are.

    """

    kind: ClassVar[RunKind]
    charts: ClassVar[Mapping[str, ChartKind]]
    preset: ClassVar[str]
    moment: int | None = None
    fills, titled = False, True
    page: Hashable = False
    unfinished: str
    worth_keeping: bool
    key: Hashable

    def __init__(self, scene: TrainScene) -> None:
        self.scene, self.run, self.context = scene, scene.run, scene.context

    @staticmethod
    @abstractmethod
    def collection(user_dir: Path) -> Collection[Any]:
        """Return where runs of this kind are kept."""

    @property
    def first(self) -> Sequence[str]:
        return self.kind.first

    @property
    def beside(self) -> Beside | None:
        """What is shown beside the run."""
        return Beside(texts.TRAIN_BEFORE, self.run.earlier) if self.run.earlier else None

    @abstractmethod
    def status(self) -> Status:
        """Return what the run has come to, for the title."""

    def caption(self) -> str:
        """Return what is said below the first chart."""
        return ""

    # Rows

    def describe_page(self, column: Column) -> None:
        """Add rows in place of the knobs, if it has a `page`."""

    def describe_first(self, column: Column) -> None:
        """Add rows above all others."""

    def describe_more(self, column: Column) -> None:
        """Add what a press on *More* opens."""

    def describe_hint(self, column: Column) -> bool:
        """Add a hint on what to do; return whether there is one."""
        return False

    @abstractmethod
    def describe_foot(self, column: Column) -> None:
        """Add rows below the button that starts."""

    @abstractmethod
    def pointers(self) -> list[Pointer]:
        """Return new widgets for what is seen, each with what gives its box once all is placed."""

    # Events and time

    def follow(self, event: pygame.event.Event) -> None:
        """Follow an event, its position in points, before the widgets have seen it."""

    def follow_unused(self, event: pygame.event.Event) -> None:
        """Take an event that no widget has used."""

    @abstractmethod
    def update(self) -> Transition | None:
        """Advance by 1/60 s, after the run's messages have come."""

    def back(self) -> bool:
        """Go back by one step within the view; False if there is none."""
        return False

    @abstractmethod
    def clear(self) -> None:
        """Show nothing, for another run."""

    # The picture

    @abstractmethod
    def place(self, place: Layout) -> None:
        """Move to these boxes."""

    @abstractmethod
    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw it, without title and charts."""
