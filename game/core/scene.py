"""What a scene is, and what it may ask to happen next."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

if TYPE_CHECKING:
    import pygame

    from game.drawing.canvas import Canvas
    from game.ui.context import Context


class Scene(Protocol):
    """One screen. It returns what is to happen next and never reaches for the stack itself."""

    def enter(self, context: Context) -> None:
        """Become the top of the stack, for the first time or again after a pop."""

    def exit(self) -> None:
        """Stop being the top; release what is held."""

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Take one window event, its position already in points."""

    def update(self) -> Transition | None:
        """Advance by exactly one physics step of 1/60 s."""

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw between the last two steps (alpha 0 to 1). Changes nothing but pixels."""


@runtime_checkable
class Lasting(Protocol):
    """A scene that holds more than memory, such as a process, and gives it back when it is left for good."""

    def close(self) -> None:
        """Give back what is held; `exit` has been called before."""


@dataclass(frozen=True)
class Route:
    """A scene by its name in `game.scenes.ROUTES`, and what it is made with.

    Scenes name each other so instead of importing each other: none is loaded before it is shown.
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
