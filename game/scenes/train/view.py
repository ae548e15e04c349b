"""What is seen of a run, and what there is to do with it alone: the part of Train that differs between kinds."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar

import pygame

from game.core.scene import Transition
from game.core.shelf import Collection
from game.drawing.canvas import Canvas
from game.scenes.train.charts import Beside, ChartKind
from game.scenes.train.layout import Layout, Status
from game.training.run_settings import RunKind
from game.ui.panel import Column
from game.ui.widget import Widget

if TYPE_CHECKING:
    from pathlib import Path

    from game.scenes.train.scene import TrainScene

Pointer = tuple[Widget, Callable[[], pygame.typing.RectLike]]


class View:
    """View of the runs of one kind, in a scene; what a kind does not say, it does not have.

    Attributes:
        kind: of its runs.
        charts: of the kind, the first two in sight.
        preset: with which the first run starts.
        moment: what is shown of a run, in decisions; None for now.
        fills: whether it takes the place of charts and title.
        titled: whether there is room for the title.
        page: whether it takes the place of the knobs.

    """

    kind: ClassVar[RunKind]
    charts: ClassVar[Mapping[str, ChartKind]]
    preset: ClassVar[str]
    moment: int | None = None
    fills, page, titled = False, False, True

    def __init__(self, scene: TrainScene) -> None:
        self.scene, self.run, self.context = scene, scene.run, scene.context

    @staticmethod
    def collection(user_dir: Path) -> Collection[Any]:
        """Return where runs of this kind are kept."""
        raise NotImplementedError

    # What it has come to

    def status(self) -> Status:
        """Return what the run has come to, for the title."""
        raise NotImplementedError

    @property
    def beside(self) -> Beside:
        """What is shown beside the run."""
        return Beside(self.run.earlier)

    @property
    def suggestion(self) -> str:
        """Name for the run, after its settings."""
        raise NotImplementedError

    @property
    def unfinished(self) -> str:
        """What is said of a run that was left, and can go on; empty without one."""
        raise NotImplementedError

    @property
    def worth_keeping(self) -> bool:
        """Whether there is a run without a name that has learnt."""
        raise NotImplementedError

    def caption(self) -> str:
        """Return what is said below the first chart."""
        return ""

    # Rows

    @property
    def key(self) -> Hashable:
        """What else decides which rows there are."""
        raise NotImplementedError

    def describe_page(self, column: Column) -> None:
        """Add rows in place of the knobs, if it has a `page`."""

    def describe_first(self, column: Column) -> None:
        """Add rows above all others."""

    def describe_more(self, column: Column) -> None:
        """Add what a press on *More* opens."""

    def describe_last(self, column: Column) -> None:
        """Add rows below all others, but for the foot."""

    def describe_hint(self, column: Column) -> bool:
        """Add a hint on what to do; return whether there is one."""
        return False

    def describe_foot(self, column: Column) -> None:
        """Add rows below the button that starts."""

    def pointers(self) -> list[Pointer]:
        """Return new widgets for what is seen, each with what gives its box once all is placed."""
        raise NotImplementedError

    # Time

    def follow(self, event: pygame.event.Event) -> None:
        """Follow an event, its position in points, before the widgets have seen it."""

    def follow_unused(self, event: pygame.event.Event) -> None:
        """Take an event that no widget has used."""

    def update(self) -> Transition | None:
        """Advance by 1/60 s, after the run's messages have come."""
        return None

    def back(self) -> bool:
        """Go back by one step within the view; False if there is none."""
        return False

    def clear(self) -> None:
        """Show nothing, for another run."""
        raise NotImplementedError

    # The picture

    def place(self, place: Layout) -> None:
        """Move to these boxes."""
        raise NotImplementedError

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw it, without title and charts."""
        raise NotImplementedError
