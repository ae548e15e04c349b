"""What every widget is: a pygame_gui element laid out in points and drawn by our canvas.

pygame_gui settles which element the mouse meets; a `Form` adds the keyboard and the gamepad. A widget
draws itself in the window's own pixels, so nothing is laid out again when the window changes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import pygame
from pygame_gui import UIManager
from pygame_gui.core import UIElement
from pygame_gui.core.ui_appearance_theme import UIAppearanceTheme
from pygame_gui.core.utility import set_default_manager

from game.core.scene import Transition
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, MUTE, VIEW_SIZE, Colour
from game.input.controls import Controls

OnPress = Callable[[], Transition | None]
EASE: Final = 0.22  # of the way that is left, in every sixtieth of a second


class PointsManager(UIManager):
    """pygame_gui's manager, living in points: it is told where the mouse is instead of asking the window."""

    _theme: UIAppearanceTheme | None = None

    def __init__(self) -> None:
        super().__init__(VIEW_SIZE, enable_live_theme_updates=False)
        set_default_manager(None)  # the first one would be held on to for good, and with it its screen
        self.mouse_position = (-1, -1)

    def create_new_theme(self, theme_path: Any = None) -> UIAppearanceTheme:
        """Return a theme that all share: nothing is drawn by it, and to read it takes half of a frame."""
        if PointsManager._theme is None:
            PointsManager._theme = super().create_new_theme(theme_path)
        return PointsManager._theme

    def process_events(self, event: pygame.event.Event) -> bool:
        """Give a mouse event, in points, to the elements."""
        if event.type in (pygame.MOUSEMOTION, pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP):
            self.mouse_position = (int(event.pos[0]), int(event.pos[1]))
        return bool(super().process_events(event))

    def calculate_scaled_mouse_position(self, position: tuple[float, float]) -> tuple[int, int]:
        """Return a position in points as it is."""
        return int(position[0]), int(position[1])

    def _update_mouse_position(self) -> None:
        """Keep what the last event said."""


class Widget(UIElement):
    """What all widgets share: a box, a label, being pressed, being in focus.

    Attributes:
        focused: whether the form's focus is here.
        typing: whether letters are for this widget alone, and no commands.
        by_arrows: whether left and right alone change it, and to press it does nothing.
        spells: whether it is letters that are typed into it.
        warmth: 0 to 1, follows `focused` gently.
        help: a sentence about it, for a screen that shows one for what is in focus.
        ringed: whether a ring is drawn around the widget in focus; not while a mouse is in use.

    """

    spells = by_arrows = False

    def __init__(self, manager: PointsManager, box: pygame.typing.RectLike, label: str) -> None:
        super().__init__(pygame.Rect(box), manager, None, starting_height=1, layer_thickness=1)
        self.label, self.help = label, ""
        self.focused = self.typing = self.ringed = self.held = False
        self.warmth = 0.0
        self.outcome: Transition | None = None

    @property
    def box(self) -> pygame.Rect:
        """Where it is, in points."""
        return pygame.Rect(self.rect)

    def press(self) -> Transition | None:
        """Do what the widget is for."""
        return None

    def shift(self, direction: int) -> bool:  # noqa: ARG002
        """Go one step left (-1) or right (1); false if the widget has no such steps."""
        return False

    def drag(self, x: float) -> None:
        """Follow the mouse while its button is held."""

    def take(self, event: pygame.event.Event) -> bool:  # noqa: ARG002
        """Take a key or a pad's button before the form does, being in focus; false leaves it to the form."""
        return False

    def hints(self, controls: Controls) -> list[tuple[str, str]]:  # noqa: ARG002
        """Return what else can be done with it while it is `typing`: keys, and what they do."""
        return []

    def scroll(self, rows: int) -> bool:  # noqa: ARG002
        """Follow the mouse's wheel, positive towards the beginning; false if there is nothing to scroll."""
        return False

    def process_event(self, event: pygame.event.Event) -> bool:
        """Be pressed by the mouse: down and up again on the widget."""
        if event.type == pygame.MOUSEMOTION and self.held:
            self.drag(event.pos[0])
            return True
        if event.type == pygame.MOUSEBUTTONDOWN and event.button == 1 and self.hover_point(*event.pos):
            self.held = True
            self.drag(event.pos[0])
            return True
        if event.type == pygame.MOUSEBUTTONUP and event.button == 1 and self.held:
            self.held = False
            if self.hover_point(*event.pos):
                self.outcome = self.press()
            return True
        return False

    def ease(self, at_once: bool) -> None:
        """Let 1/60 s pass."""
        target = float(self.focused)
        self.warmth = target if at_once else self.warmth + (target - self.warmth) * EASE

    def paint(self, canvas: Canvas) -> None:
        """Draw the widget."""
        canvas.cover(canvas.rect(*self.box))
        if self.ringed and self.warmth > 0.02:
            canvas.outline(self.box.inflate(24, 8), 8, INK, 1, 0.4 * self.warmth)

    def tint(self) -> Colour:
        """Return the label's colour: muted, and ink as it comes into focus."""
        return mix(MUTE, INK, self.warmth)


def mix(a: Colour, b: Colour, fraction: float) -> Colour:
    """Return the colour that lies between two; in steps, so that few are ever rendered."""
    part = round(8 * min(max(fraction, 0.0), 1.0)) / 8
    red, green, blue = (round(x + (y - x) * part) for x, y in zip(a, b, strict=True))
    return red, green, blue
