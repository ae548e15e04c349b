"""Interface of a scene, and the transitions it may return."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

if TYPE_CHECKING:
    import pygame

    from game.drawing.canvas import Canvas
    from game.ui.context import Context


class Scene(Protocol):
    """One screen of the game. It returns transitions and never changes the scene stack itself."""

    def enter(self, context: Context) -> None:
        """Become the top scene, for the first time or again after a pop."""

    def exit(self) -> None:
        """Stop being the top scene; release held keys."""

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Take one window event, its position already in points."""

    def update(self) -> Transition | None:
        """Advance by exactly one physics step of 1/60 s."""

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw between the last two steps (alpha 0 to 1). Changes nothing but pixels."""


@runtime_checkable
class Lasting(Protocol):
    """Scene that holds a resource, such as a process, and releases it when it is left for good."""

    def close(self) -> None:
        """Release the resources; called after `exit`."""


@dataclass(frozen=True)
class Route:
    """Name of a scene in `game.scenes.ROUTES`, with the arguments to make it.

    Scenes use routes instead of importing each other, so a scene's module is loaded only when it is shown.
    """

    name: str
    arguments: tuple[Any, ...] = ()
    options: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Push:
    """Put a scene over this one."""

    scene: Scene | Route


@dataclass(frozen=True)
class Replace:
    """Put a scene in this one's place."""

    scene: Scene | Route


@dataclass(frozen=True)
class Pop:
    """Go back to the scene below, `levels` times."""

    levels: int = 1


@dataclass(frozen=True)
class Quit:
    """Close the game."""


Transition = Push | Replace | Pop | Quit


def push(name: str, *arguments: Any, **options: Any) -> Push:
    """Put the scene of that name over this one, made with these arguments."""
    return Push(Route(name, arguments, options))
