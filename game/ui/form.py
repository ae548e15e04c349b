"""Form: the widgets of a screen and their focus, for mouse, keyboard and gamepad alike; and scenes made of one."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Hashable, Sequence
from functools import partial
from typing import Final, TypeVar

import pygame

from game.core import texts
from game.core.scene import Pop, Scene, Transition
from game.drawing.canvas import Canvas
from game.input.controls import Command, Controls, presses_main, translate
from game.ui.actions import Action, Table, answering, hints_of
from game.ui.context import Context
from game.ui.hints import Hint, HintRow
from game.ui.widget import NOWHERE, OnPress, PointsManager, Widget

W = TypeVar("W", bound=Widget)
Direction = tuple[int, int]
UP, DOWN, LEFT, RIGHT = (0, -1), (0, 1), (-1, 0), (1, 0)
_ARROWS: Final = {Command.UP: UP, Command.DOWN: DOWN, Command.LEFT: LEFT, Command.RIGHT: RIGHT}
_MOUSE: Final = (pygame.MOUSEMOTION, pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP)
# Steps a held direction waits before it repeats, and between repeats.
_REPEAT_AFTER: Final = 24
_REPEAT_EVERY: Final = 4


class HintButton(Widget):
    """Hint, to be pressed by the mouse or the one switch: the focus passes it over, for its key does the same."""

    def __init__(self, hint: Hint) -> None:
        super().__init__(NOWHERE, hint.meaning)
        self.hint = hint

    def place(self, hint: Hint, box: pygame.FRect) -> None:
        """Stand for this hint, in a box in points."""
        self.hint, self.label, self.rect = hint, hint.meaning, pygame.Rect(box)

    def press(self) -> Transition | None:
        return self.hint.run() if self.hint.run else None

    def hover_point(self, hover_x: float, hover_y: float) -> bool:
        return bool(self.rect.collidepoint(hover_x, hover_y))


class Form:
    """Widgets of a screen, one of them in focus; added in the order of Tab.

    A scene passes on `handle_event` and `update` and returns what they return; what a widget's callback
    returns comes out of one of the two. `on_back` answers Escape, or the pad's B. A scene that has commands of
    its own looks at `typing` before it takes an event, or at `used` after it has passed the event on.

    Attributes:
        keys: the hints that can be pressed.
        used: whether a widget used the last event, or it moved the focus.

    """

    def __init__(self, context: Context, on_back: OnPress = lambda: None) -> None:
        self.manager = PointsManager()
        self.widgets: list[Widget] = []
        self.keys: list[HintButton] = []
        self._context, self.back = context, on_back
        self._index = 0
        self._held_steps = 0
        self._held_direction: Command | None = None
        self.used = self._pressed = self._acted = False

    @property
    def typing(self) -> bool:
        """Whether the focused widget takes every key and button, as a text line does."""
        return self.focused is not None and self.focused.typing

    @property
    def moves(self) -> Hint:
        return Hint(self.controls.arrows, texts.HINT_MOVE)

    @property
    def changes(self) -> Action | Hint:
        """How the focused widget is changed: by a press, or by the arrows if it cannot be pressed."""
        if self.focused is not None and self.focused.by_arrows:
            return Hint(self.controls.arrows_aside, texts.HINT_CHANGE)
        acts = self.focused is not None and self.focused.acts
        return self.confirms(texts.HINT_CHOOSE if acts else texts.HINT_CHANGE)

    def confirms(self, hint: str) -> Action:
        return Action(Command.CONFIRM, self.confirm, hint)

    def goes_back(self, hint: str) -> Action:
        return Action(Command.BACK, self.back, hint)

    @property
    def hints(self) -> list[Hint]:
        """Hints of a focused widget that takes every key; empty for any other."""
        return self.focused.hints(self.controls) if self.focused and self.typing else []

    @property
    def controls(self) -> Controls:
        return self._context.controls

    @property
    def focused(self) -> Widget | None:
        return self.widgets[self._index] if self.widgets else None

    def add(self, widget: W) -> W:
        widget.join(self.manager)
        self.widgets.append(widget)
        return widget

    def focus(self, widget: Widget) -> None:
        self._index = self.widgets.index(widget)

    def lay_keys(self, rows: Sequence[HintRow], canvas: Canvas) -> None:
        """Have the hints of these rows pressed where they stand; those of a card come before the flight's behind it."""
        found = [pair for row in reversed(rows) for pair in zip(row.hints, row.boxes(canvas), strict=True)]
        found = [(hint, box) for hint, box in found if hint.run]
        self.keys = self.keys[: len(found)] + [HintButton(hint) for hint, _ in found[len(self.keys) :]]
        for key, (hint, box) in zip(self.keys, found, strict=True):
            key.place(hint, box)

    def find(self, key: str) -> Widget | None:
        """Return the widget of a key, if there is one."""
        return next((widget for widget in self.widgets if widget.key == key), None)

    def follow(self, before: Form) -> None:
        """Take the place of a form that was described otherwise: the focus stays on its key, or near its place."""
        self.manager.mouse_position = before.manager.mouse_position
        self._held_steps, self._held_direction = before._held_steps, before._held_direction
        for widget in self.widgets:
            if same := before.find(widget.key):
                widget.follow(same)
        if before.focused and self.widgets:
            place = min(before.widgets.index(before.focused), len(self.widgets) - 1)
            self.focus(self.find(before.focused.key) or self.widgets[place])

    def handle_event(self, event: pygame.event.Event, actions: Table = ()) -> Transition | None:
        """Take one event, the mouse's in points; `actions` come after the focused widget, and before the form's own."""
        self.used = True
        return self._sounding(lambda: self._take(event, actions))

    def confirm(self, *, pointed: bool = True) -> Transition | None:
        """Press the focused widget; not `pointed`, whatever the mouse points at."""
        return self._sounding(self._press if pointed else partial(self._press, ringed=True))

    def _sounding(self, act: OnPress) -> Transition | None:
        """Do something, with the sound of its effect on the focused widget."""
        before, self._pressed, self._acted = (self.focused, _reading(self.focused)), False, False
        outcome = act()
        if outcome is None and not self._acted:  # the change to another scene has its own sound
            self._sound(*before)
        self._tell_spelling()
        return outcome

    def _press(self, *, ringed: bool = False) -> Transition | None:
        self._show_focus()
        if ringed and self.focused:
            self.focused.ringed = True
        self._pressed = True
        return self.focused.press() if self.focused else None

    def _take(self, event: pygame.event.Event, actions: Table) -> Transition | None:
        if event.type in _MOUSE:
            return self._handle_mouse(event)
        if event.type == pygame.MOUSEWHEEL:
            under = next((w for w in self.widgets if w.hover_point(*self.manager.mouse_position)), None)
            self.used = under is not None and under.scroll(event.y)
            return None
        widget = self.focused
        if widget and widget.take(event):
            return _outcome(widget)
        if action := answering(actions, event):
            outcome = action.run()
            self._acted = True  # and has made its own sounds
            return outcome
        command = translate(event)
        if command is None and presses_main(event):
            command = Command.CONFIRM
        if step := tab(event):
            self._index = (self._index + step) % max(1, len(self.widgets))
        elif command in _ARROWS:
            self._move(command)
        elif command is Command.CONFIRM and widget:
            return self._press()
        elif command in (Command.BACK, Command.PAUSE):
            return self.back()
        else:
            self.used = False
        return None

    def update(self) -> Transition | None:
        """Advance by 1/60 s: hovering, easing, and the repeat of a held direction."""
        self._repeat()
        self._show_focus()
        for widget in self.widgets:
            widget.ease(at_once=self._context.settings.reduced_motion)
        self._tell_spelling()
        return None

    def draw(self, canvas: Canvas) -> None:
        for widget in self.widgets:
            widget.paint(canvas)

    def _handle_mouse(self, event: pygame.event.Event) -> Transition | None:
        under = (key for key in self.keys if key.hover_point(*event.pos))
        if event.type == pygame.MOUSEBUTTONDOWN and event.button == 1 and (key := next(under, None)):
            outcome = key.press()
            self._acted = True  # and has made its own sounds
            return outcome
        moves = event.type == pygame.MOUSEMOTION and self.typing  # a nudge of the mouse must not end typing
        for index, widget in enumerate(self.widgets):
            if (
                widget.follows_mouse
                and widget.hover_point(*event.pos)
                and not moves
                and not any(other.held for other in self.widgets)
            ):
                self._index = index
        self._show_focus()
        self._pressed = event.type == pygame.MOUSEBUTTONUP and any(
            widget.held and widget.hover_point(*event.pos) for widget in self.widgets
        )
        self.used = self.manager.process_events(event)
        return next((outcome for widget in self.widgets if (outcome := _outcome(widget)) is not None), None)

    def _move(self, command: Command) -> None:
        if not self.widgets:
            return
        direction = _ARROWS[command]
        if not (direction[0] and self.widgets[self._index].shift(direction[0])):
            self._index = neighbour([w.box for w in self.widgets], self._index, direction)

    def _repeat(self) -> None:
        """Go on moving while a direction is held: sideways the value, up and down the focus."""
        direction = None if self.typing else self._context.controls.direction
        self._held_steps = self._held_steps + 1 if direction and direction is self._held_direction else 0
        self._held_direction = direction
        since = self._held_steps - _REPEAT_AFTER
        if since >= 0 and since % _REPEAT_EVERY == 0 and self.focused and direction:
            widget, reading, (across, _) = self.focused, _reading(self.focused), _ARROWS[direction]
            if across:
                widget.shift(across)
            elif not widget.take(pygame.event.Event(pygame.USEREVENT, command=direction)):
                self._move(direction)
            self._sound(widget, reading)

    def _sound(self, focused: Widget | None, reading: object) -> None:
        """Play the sound of an event's effect, given the focused widget and its value before the event."""
        if self.focused is not focused:
            if not self.controls.mouse_in_use:  # the mouse passes over widgets on its way
                self._context.sound.play("move")
        elif _reading(focused) != reading:
            self._context.sound.play("adjust")
        elif self._pressed and focused and type(focused).press is not Widget.press:
            self._context.sound.play("choose")

    def _tell_spelling(self) -> None:
        """Tell the controls whether a widget takes letters, so that typing gives no commands."""
        self.controls.spelling = self.typing and self.focused is not None and self.focused.spells

    def _show_focus(self) -> None:
        for index, widget in enumerate(self.widgets):
            widget.focused = index == self._index
            widget.ringed = not self._context.controls.mouse_in_use


class FormScene(Scene, ABC):
    """Scene with a form, whose keys, hints and clicks on hints all follow one table, `actions`.

    A subclass calls `build` at the end of its constructor, and whenever there are other rows than before.

    Attributes:
        form: the widgets.
        takes_tab: whether Tab is a key for the actions, instead of moving the focus.

    """

    takes_tab = False

    def __init__(self, context: Context, on_back: OnPress = Pop) -> None:
        super().__init__(context)
        self._on_back = on_back
        self.form = Form(context, on_back)

    @abstractmethod
    def add_rows(self) -> None:
        """Add all rows to the form, in panels that take the place of those before."""

    @abstractmethod
    def lay_out(self) -> None:
        """Lay the rows out for the window as it is."""

    def build(self) -> None:
        """Describe the rows anew; the focus stays where it was, or near it, and so does what is seen."""
        before, self.form = self.form, Form(self.context, self._on_back)
        self._described = self.state()
        self.add_rows()
        self.form.follow(before)
        self.lay_out()

    def state(self) -> Hashable:
        """Return what decides which rows there are; when it changes, they are described anew."""
        return self.context.settings.opened

    def unfolding(self, part: str) -> tuple[str, OnPress]:
        """Return the word that opens a part of the screen for this player, or closes it, and what does so."""
        return texts.MORE[self.context.settings.is_open(part)], partial(self.context.unfold, part)

    def reword(self) -> None:
        self.build()

    @property
    def typing(self) -> bool:  # type: ignore[override]
        """Whether the focused widget takes every key, as a text line does."""
        return self.form.typing

    def actions(self) -> Table:
        return [self.form.confirms(texts.HINT_CHOOSE), self.form.goes_back(texts.HINT_BACK)]

    @property
    def hints(self) -> list[Hint]:
        return self.form.hints or hints_of(self.actions(), self.context.controls)

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        if event.type == pygame.MOUSEBUTTONDOWN:
            self.lay_keys()
        moves = tab(event) != 0 and not self.takes_tab
        return self.form.handle_event(event, () if moves else self.actions())

    def lay_keys(self) -> None:
        """Have the hints pressed where they stand now."""
        canvas = self.context.reading()
        self.form.lay_keys(self.hint_rows(canvas), canvas)

    def update(self) -> Transition | None:
        outcome = self.form.update()
        if self.state() != self._described and not any(widget.held or widget.typing for widget in self.form.widgets):
            self.build()
        self.lay_out()
        return outcome

    def draw_hints(self, canvas: Canvas) -> None:
        for row in self.hint_rows(canvas):
            row.draw(canvas)


def _reading(widget: Widget | None) -> object:
    """Return the value, or the index, of a widget; None if it has neither."""
    return getattr(widget, "value", getattr(widget, "index", None))


def _outcome(widget: Widget) -> Transition | None:
    """Return the transition a widget's callback has returned, and clear it."""
    outcome, widget.outcome = widget.outcome, None
    return outcome


def tab(event: pygame.event.Event) -> int:
    """Return how far Tab moves the focus: 1, with Shift -1; 0 for any other event."""
    if event.type != pygame.KEYDOWN or event.key != pygame.K_TAB:
        return 0
    return -1 if getattr(event, "mod", 0) & pygame.KMOD_SHIFT else 1


def neighbour(boxes: Sequence[pygame.Rect], current: int, direction: Direction) -> int:
    """Return the index of the nearest box in a direction; up and down wrap around.

    Distances up and down are between edges, so that of two columns side by side the first one comes first. The lower
    end of a column leads to the next box in order, which is the first one of the next column.

    A sideways distance counts double, so that a column is followed to its end before another is entered; left and right
    leave a row only at its end.
    """
    here = boxes[current]

    def ahead(box: pygame.Rect) -> float:
        if direction[1]:
            return box.top - here.bottom + 1 if direction[1] > 0 else here.top - box.bottom + 1
        return direction[0] * (box.centerx - here.centerx)

    def aside(box: pygame.Rect) -> float:
        if direction[0]:
            return max(box.top - here.bottom, here.top - box.bottom, 0)
        return max(box.left - here.right, here.left - box.right, 0)

    def level(box: pygame.Rect) -> bool:  # rows that only touch are two
        return box.top < here.bottom and here.top < box.bottom

    def beyond(box: pygame.Rect) -> bool:
        return box.left >= here.right if direction[0] > 0 else box.right <= here.left

    others = [index for index in range(len(boxes)) if index != current]
    forward = [index for index in others if ahead(boxes[index]) > 0]
    if direction[0]:
        row = [index for index in forward if level(boxes[index])]
        apart = [index for index in forward if beyond(boxes[index])]  # one below the fold may lie under this one
        forward = [index for index in row if index in apart] or row or apart
    if forward:
        return min(forward, key=lambda index: ahead(boxes[index]) + 2 * aside(boxes[index]))
    return (current + direction[1]) % len(boxes) if direction[1] else current
