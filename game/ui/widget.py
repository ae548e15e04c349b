"""Base class of the widgets: a pygame_gui element laid out in points and drawn on our canvas.

pygame_gui decides which element the mouse hits; a `Form` adds the keyboard and the gamepad. A widget
draws itself in the window's own pixels, so nothing is laid out again when the window changes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

import pygame
from pygame_gui import UIManager
from pygame_gui.core import UIElement
from pygame_gui.core.layered_gui_group import GUISprite
from pygame_gui.core.ui_appearance_theme import UIAppearanceTheme
from pygame_gui.core.utility import set_default_manager

from game.core.scene import Transition
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, INK, VIEW_SIZE, Colour
from game.input.controls import Controls
from game.ui.hints import Hint

if TYPE_CHECKING:
    from game.drawing.cursor import Cursor

OnPress = Callable[[], Transition | None]
NOWHERE: Final = (0, 0, 1, 1)  # where a row is until it is laid out
EASE: Final = 0.22  # share of the remaining difference, per sixtieth of a second


class PointsManager(UIManager):
    """pygame_gui's manager in points: it takes the mouse's position from events instead of asking the window."""

    _theme: UIAppearanceTheme | None = None
    _loader: Any = None  # one that has begun starts no five threads anew for nothing to load

    def __init__(self) -> None:
        super().__init__(VIEW_SIZE, enable_live_theme_updates=False, resource_loader=PointsManager._loader)
        PointsManager._loader = self.resource_loader
        set_default_manager(None)  # pygame_gui would keep the first manager, and with it a whole screen, in memory
        self.mouse_position = (-1, -1)

    def create_new_theme(self, theme_path: Any = None) -> UIAppearanceTheme:
        """Return one theme for all managers: nothing is drawn with it, and reading it takes half of a frame."""
        if PointsManager._theme is None:
            PointsManager._theme = super().create_new_theme(theme_path)
        return PointsManager._theme

    def process_events(self, event: pygame.event.Event) -> bool:
        """Pass a mouse event, its position in points, to the elements."""
        if event.type in (pygame.MOUSEMOTION, pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP):
            self.mouse_position = (int(event.pos[0]), int(event.pos[1]))
        return bool(super().process_events(event))


class Widget(UIElement):
    """Base widget with a box, a label, a press and the focus.

    Attributes:
        key: by which a form finds it, however its rows are described; its label, unless something else is set.
        focused: whether the form's focus is here.
        typing: whether this widget takes every key and button, so that none gives a command.
        by_arrows: whether only left and right change it, and a press does nothing.
        acts: whether a press chooses it, as a button, and changes no value of its own.
        spells: whether text is typed into it.
        follows_mouse: whether the focus comes to it with the mouse; not to a picture that only keys need the focus for.
        warmth: 0 to 1, follows `focused` smoothly.
        ringed: whether the focus ring is drawn; not while a mouse is in use.

    """

    spells = by_arrows = acts = False
    follows_mouse = True

    def __init__(self, box: pygame.typing.RectLike, label: str) -> None:
        GUISprite.__init__(self)  # which has a place already before it joins a form
        self.rect = self.relative_rect = pygame.Rect(box)
        self.label, self._key = label, ""
        self.focused = self.typing = self.ringed = self.held = False
        self.warmth = 0.0
        self.outcome: Transition | None = None
        self._joined = False

    def join(self, manager: PointsManager) -> None:
        """Become one of a form's elements, once, when it is added there."""
        if not self._joined:
            self._joined = True
            super().__init__(self.rect, manager, None, starting_height=1, layer_thickness=1)

    @property
    def key(self) -> str:
        return self._key or self.label

    @key.setter
    def key(self, key: str) -> None:
        self._key = key

    @property
    def box(self) -> pygame.Rect:
        return pygame.Rect(self.rect)

    def press(self) -> Transition | None:
        return None

    def shift(self, direction: int) -> bool:  # noqa: ARG002
        """Go one step left (-1) or right (1); false if the widget has no such steps."""
        return False

    def advance(self) -> None:
        """Change by one step for a player with one switch, and begin anew after the last."""
        self.shift(1)

    def drag(self, x: float) -> None:
        """Follow the mouse while its button is held."""

    def take(self, event: pygame.event.Event) -> bool:  # noqa: ARG002
        """Handle a key or gamepad button before the form does, while in focus; false leaves it to the form."""
        return False

    def hints(self, controls: Controls) -> list[Hint]:  # noqa: ARG002
        """Return the hints while it is `typing`."""
        return []

    def scroll(self, rows: int) -> bool:  # noqa: ARG002
        """Scroll by the mouse's wheel, positive towards the beginning; false if it cannot scroll."""
        return False

    def process_event(self, event: pygame.event.Event) -> bool:
        """Handle a mouse event: a click, down and up on the widget, presses it."""
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
        """Advance the animation by 1/60 s, or finish it `at_once`."""
        target = float(self.focused)
        self.warmth = target if at_once else self.warmth + (target - self.warmth) * EASE

    def follow(self, before: Widget) -> None:
        """Take the place of the widget that had its key."""
        self.warmth = before.warmth

    def paint(self, canvas: Canvas) -> None:
        if self.ringed and self.warmth > 0.02:
            canvas.outline(self.box.inflate(24, 8), 8, INK, 1, 0.4 * self.warmth)


class RowWidget(Widget):
    """Widget that is a row of a panel, and has no place of its own.

    Attributes:
        pad: points above and below what it says.
        reach: how far from the left its ring reaches, in points; 0 for the whole column.
        what: what it is, for whoever asks, where several stand on a line.
        seen: the part of its panel that is not scrolled away.

    """

    pad, reach, what = 8.0, 0.0, ""
    seen: pygame.FRect | None = None

    def lay(self, cursor: Cursor) -> None:
        top = cursor.y
        if cursor.canvas and self.ringed and self.warmth > 0.02:
            ring = pygame.Rect(self.box.topleft, (round(self.reach) or self.box.width, self.box.height))
            colour, strength = (HUMAN, 0.9) if self.typing else (INK, 0.4)
            cursor.canvas.outline(ring.inflate(24, 2), 8, colour, 1, strength * self.warmth)
        cursor.gap(self.pad)
        self.write(cursor)
        cursor.gap(self.pad)
        if cursor.canvas is None:
            self.seen = cursor.seen
            left, above = round(cursor.left), round(top)  # rows that touch, touch in whole points as well
            box = pygame.Rect(left, above, round(cursor.width), round(cursor.y) - above)
            self.rect = self.relative_rect = box

    def write(self, cursor: Cursor) -> None:
        raise NotImplementedError

    def hover_point(self, hover_x: float, hover_y: float) -> bool:
        return bool(self.rect.collidepoint(hover_x, hover_y)) and (
            self.seen is None or self.seen.collidepoint(hover_x, hover_y)
        )

    def paint(self, canvas: Canvas) -> None:
        """Do nothing: the panel paints it."""


def mix(a: Colour, b: Colour, fraction: float) -> Colour:
    """Return a mix of two colours, in steps so that few texts need to be rendered."""
    part = round(8 * min(max(fraction, 0.0), 1.0)) / 8
    red, green, blue = (round(x + (y - x) * part) for x, y in zip(a, b, strict=True))
    return red, green, blue
