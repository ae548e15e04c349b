"""Base class of all scenes, and the transitions they may return."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pygame

    from game.drawing.canvas import Canvas
    from game.ui.context import Context
    from game.ui.hints import HintRow


class Scene:
    """One screen of the game, built whole by its constructor. A subclass overrides what it needs.

    A scene returns transitions and never changes the scene stack itself.

    Attributes:
        context: the shared services.
        takes_files: whether files can be dropped here that are no flights.
        typing: whether a text is being typed, which then takes what is pasted.
        takes_switch: whether a press of the one switch is the scene's own now, and chooses nothing on it.

    """

    takes_files = typing = takes_switch = False

    def __init__(self, context: Context) -> None:
        self.context = context

    def enter(self) -> None:
        """Become the top scene again, after those above it have been left; the constructor does so the first time."""

    def reword(self) -> None:
        """Make anew what is kept of texts, for the player has chosen another language."""

    def exit(self) -> None:
        """Stop being the top scene, until `enter` or for good; release held keys."""

    def close(self) -> None:
        """Release resources such as a process; called once, after `exit`, when the scene is left for good."""

    def handle_event(self, event: pygame.event.Event) -> Transition | None:  # noqa: ARG002
        """Take one window event, its position already in points."""
        return None

    def update(self) -> Transition | None:
        """Advance by exactly one physics step of 1/60 s."""
        return None

    def pause(self) -> Transition | None:
        """Pause, because a player has held the one switch for long while `takes_switch`."""
        return None

    def hint_rows(self, canvas: Canvas) -> Sequence[HintRow]:  # noqa: ARG002
        """Return the rows of key hints, laid out as on that canvas; a click on a hint does what its key does."""
        return ()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw between the last two steps (alpha 0 to 1). Changes nothing but pixels."""

    def draw_on(self, canvas: Canvas, alpha: float) -> None:
        """Draw into the whole window."""
        self.draw(canvas.reading, alpha)


@dataclass(frozen=True)
class Route:
    """Name of a scene in `game.scenes.ROUTES`, with the arguments it takes besides the context.

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
