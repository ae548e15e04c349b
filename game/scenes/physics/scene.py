"""Physics gallery: exhibits to watch, to grab, to slow down and to step through."""

from __future__ import annotations

from functools import partial
from typing import Final

import pygame

from engine import Body
from engine.vector import Array
from game.core import texts
from game.core.clock import TimeScale
from game.core.scene import Transition, push
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import FAINT, HUMAN, INK, MUTE, NIGHT0, SMALL
from game.explain.explained import Explained
from game.input.controls import Command
from game.scenes.physics.bodies import Outlines, draw_contacts, draw_grip
from game.scenes.physics.exhibit import BELOW, CLEAR, Grip
from game.scenes.physics.exhibits import EXHIBITS
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.panel import Column, Panel
from game.ui.panel_scene import PanelScene
from game.ui.playback import Playback
from game.ui.virtual_pointer import PictureRow
from game.ui.widget import OnPress
from game.world.camera import View

GRAVITIES: Final = (1.62, 9.81)
_MORE: Final = "physics"  # name in the settings of what stays open
_LEAST: Final = 300.0  # points of a column
_REACH: Final = 8.0  # points by which the mouse may miss a body


class PhysicsScene(PanelScene):
    """Physics gallery, one exhibit at a time.

    Attributes:
        chosen: name of the exhibit.
        values: values of the quantities, by exhibit and name, as far as they have been changed.

    """

    def __init__(self, context: Context, exhibit: str = "stack") -> None:
        super().__init__(context, self._pause)
        self.chosen, self._gravity = exhibit, 0
        self._clock = TimeScale()
        self.playback = Playback(self._clock, (1.0,), self._step)
        self.values: dict[str, dict[str, float]] = {}
        self.contacts_drawn = False
        self.grip: Grip | None = None
        self.explained = Explained()
        self._mouse = (-1.0, -1.0)
        self._show()

    def exit(self) -> None:
        self.grip = None

    # The exhibit

    def restart(self) -> None:
        self.exhibit = EXHIBITS[self.chosen](GRAVITIES[self._gravity], self.values.get(self.chosen))
        self.grip = None
        self._outlines = Outlines(self.exhibit.drawn)
        self._poses = self._poses_before = self.exhibit.poses
        self._clock.begin()

    def _show(self) -> None:
        self.restart()
        self.build()

    def _choose(self, index: int) -> None:
        self.chosen = list(EXHIBITS)[index]
        self._show()

    def _choose_gravity(self, index: int) -> None:
        self._gravity = index
        self._show()

    def _change(self, name: str, value: float) -> None:
        self.values.setdefault(self.chosen, {})[name] = value
        self.restart()

    def show_contacts(self, drawn: bool) -> None:
        self.contacts_drawn = drawn

    def update(self) -> Transition | None:
        for _ in range(self.playback.steps()):
            self._step()
        self.explained.update()
        return super().update()

    def _step(self) -> None:
        self.exhibit.step(self.grip)
        self._poses_before, self._poses = self._poses, self.exhibit.poses

    # Keys

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        if self.explained.handle_event(event):
            return None
        if event.type == pygame.WINDOWFOCUSLOST:
            self.grip = None
        return super().handle_event(event)

    def actions(self) -> Table:
        stop, step, *_ = self.playback.actions("")
        return [
            stop,
            step,
            Action(Command.RETRY, self.restart, texts.HINT_RESTART_EXHIBIT),
            self.explained.action(),
            Action(Command.PAUSE, self._pause, texts.HINT_PAUSE),
        ]

    def _pause(self) -> Transition:
        return push("pause", self, retry=self.restart)

    # Rows

    def describe(self, panel: Panel) -> None:
        words = [texts.EXHIBITS[name][0] for name in EXHIBITS]
        panel.choice(texts.PHYSICS_TITLE, words, list(EXHIBITS).index(self.chosen), self._choose)
        panel.gap()
        left, right = panel.beside((9, 4), least=_LEAST, apart=40.0)
        left.text(texts.EXHIBITS[self.chosen][1])
        left.text(self._said, size=SMALL, colour=MUTE, tabular=True)
        left.gap()
        self.room_row = left.widget(PictureRow(texts.POINTER, self._height, self._point, hold=texts.POINTER_GRIP))
        left.add(self._write_legend)
        self._describe_bench(right)

    def _describe_bench(self, column: Column) -> None:
        what = texts.EXPLAIN_PHYSICS
        for quantity in self.exhibit.quantities:
            label, figure = texts.QUANTITIES[quantity.name]
            value, change = self.exhibit.values[quantity.name], partial(self._change, quantity.name)
            shown = partial(_filled, figure)
            column.slider(label, value, quantity.limits, change, step=quantity.step, figure=shown)
        words: list[tuple[str, OnPress]] = [
            (texts.PHYSICS_STEP, lambda: push("physics_step", self.exhibit, self.grip)),
            self.unfolding(_MORE),
        ]
        self._inside, _ = column.words(words)
        if self.context.settings.is_open(_MORE):
            column.gap()
            column.choice("", texts.PHYSICS_GRAVITIES, self._gravity, self._choose_gravity, SMALL)
            column.toggle(texts.PHYSICS_CONTACTS, self.contacts_drawn, self.show_contacts)
            column.explain(what["contacts"])

    def _said(self) -> str:
        said = texts.EXHIBITS[self.chosen][2].format(**self.exhibit.figures())
        return f"{said} {texts.EXHIBIT_TOUCHED}" if self.exhibit.touched else said

    # The room

    def _height(self, width: float) -> float:
        return (CLEAR + BELOW) * width

    def view(self, scale: float) -> View:
        """Return how the exhibit's metres lie on the canvas."""
        box, wide = self.room_row.picture, self.exhibit.width
        middle = (CLEAR - BELOW) / 2 * wide
        return View.within(box, scale, (0.0, middle), box.width / wide)

    def _point(self, event: pygame.event.Event) -> None:
        self._mouse = event.pos
        if event.type == pygame.MOUSEBUTTONDOWN and (body := self._body_at(_REACH)):
            self.grip = Grip(body, self.view(1.0).metres(self._mouse))
        elif event.type == pygame.MOUSEBUTTONUP:
            self.grip = None
        if self.grip:
            self.grip.target = self.view(1.0).metres(self._mouse)

    def _body_at(self, reach: float) -> Body | None:
        view = self.view(1.0)
        return self._outlines.body_at(self._poses, view.metres(self._mouse), reach / view.pixels_per_metre)

    def _lit(self) -> int | None:
        """Index of the body that is gripped, or that the mouse or the virtual pointer points at."""
        pointed = self.context.controls.mouse_in_use or self.room_row.typing
        if not self.grip and not (pointed and self.room_row.hover_point(*self._mouse)):
            return None
        body = self.grip.body if self.grip else self._body_at(0.0)
        return body.index if body else None

    def _draw_room(self, canvas: Canvas, poses: Array) -> None:
        box, view = self.room_row.picture, self.view(canvas.scale)
        with canvas.clipped(box):
            _, ground = view.point(0.0, 0.0)
            canvas.fill(canvas.rect(box.left, ground, box.width, box.bottom - ground), NIGHT0, 0.55)
            canvas.line((box.left, ground), (box.right, ground), MUTE)
            for rule in self.exhibit.rules:
                start, end = view.points(rule).tolist()
                canvas.line(tuple(start), tuple(end), FAINT)
            self._outlines.draw(canvas, view, poses, self._lit(), held=self.grip is not None)
            if self.contacts_drawn:
                draw_contacts(canvas, view, self.exhibit.world, self.exhibit.gravity)
            for label in self.exhibit.labels():
                label.draw(canvas, view, poses)
        if self.grip:
            x, y = view.points(self.grip.place(poses[self.grip.body.index])).tolist()
            draw_grip(canvas, (x, y), self._mouse)

    def _write_legend(self, cursor: Cursor) -> None:
        """Write whether time is stopped, or else how to take hold of a body."""
        controls = self.context.controls
        keys = self.form.focused is self.room_row and not controls.mouse_in_use
        held = texts.PHYSICS_HAND.format(key=controls.word(Command.CONFIRM)) if keys else texts.PHYSICS_DRAG
        words, colour = (texts.PHYSICS_STOPPED, INK) if self.playback.stopped else (held, HUMAN)
        cursor.styled(words, SMALL, colour)

    def draw_behind(self, canvas: Canvas, alpha: float) -> None:
        super().draw_behind(canvas, alpha)
        between = self.playback.between(alpha)
        with canvas.clipped(self.panel.box):
            self._draw_room(canvas, self._poses_before + between * (self._poses - self._poses_before))

    def draw(self, canvas: Canvas, alpha: float) -> None:
        super().draw(canvas, alpha)
        canvas.explain(self._inside.box, texts.EXPLAIN_PHYSICS["inside"])
        self.explained.draw(canvas)


def _filled(figure: str, value: float) -> str:
    return figure.format(value=value)
