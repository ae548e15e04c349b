"""Physics gallery scene: exhibits to watch, grab with the mouse, slow down and step through."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np
import pygame

from engine.vector import Array
from game.core import texts
from game.core.clock import TimeScale
from game.core.scene import Transition, push
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.figures import write_figures
from game.drawing.sky import NightSky
from game.drawing.tokens import FAINT, HUMAN, INK, MARGIN, MUTE, NIGHT0, SMALL, TEXT, VIEW_SIZE
from game.input.controls import Command
from game.panels import readouts
from game.panels.explained import Explained
from game.scenes.physics.bench import LEFT, Bench
from game.scenes.physics.exhibits import EXHIBITS
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.form_scene import FormScene
from game.ui.hints import HintRow
from game.ui.playback import LABEL_WIDTH, Playback
from game.ui.virtual_pointer import VirtualPointer
from game.ui.widgets import Choice
from game.world.bodies import Outlines, draw_contacts, draw_force_scale, draw_grip
from game.world.camera import POINTS_PER_METRE, WORLD_WIDTH, View
from game.world.grip import Grip

GRAVITIES: Final = (1.62, 9.81)
SPEEDS: Final = (0.25, 0.5, 1.0)
_GROUND: Final = 604.0  # row of y = 0, in points from the top
_TABS: Final = (MARGIN, 50.0)
_ROWS: Final = (MARGIN, 640.0, 25.0)  # left and top of the first row of choices, and how far to the next
_ROW_HEIGHT: Final = 17.0
_GAP: Final = 24.0
_ROOM: Final = (16.0, 152.0, VIEW_SIZE[0] - 32.0, 444.0)
_COLUMNS: Final = (758.0, 880.0, 1002.0, 1124.0)
_REACH: Final = 8.0  # points by which the mouse may miss a body
_HINTS: Final = 960.0
_HEAD: Final = _ROOM[1]  # bodies that fly higher pass behind the controls
_ROOM_LEFT: Final = LEFT - MARGIN - 24.0  # points for the sentences beside the sliders
_SCALE: Final = (330.0, 702.0)  # left end of the forces' legend, on its baseline
_SLEEP: Final = (330.0, 677.0)  # left end of the sentence on sleeping bodies, on its baseline
_SMOOTHING: Final = 0.05


class PhysicsScene(FormScene):
    """Physics gallery, one exhibit at a time; `now` is the clock in seconds that times its steps."""

    def __init__(self, context: Context, exhibit: str = "stack", now: Callable[[], float] = time.perf_counter) -> None:
        super().__init__(context)
        self._names = list(EXHIBITS)
        self._chosen = self._names.index(exhibit)
        self._now = now
        self._gravity, self._clock = 0, TimeScale()
        self.playback = Playback(self._clock, SPEEDS, self._step)
        self._mouse = (-1.0, -1.0)
        self.contacts_drawn = False
        self.grip: Grip | None = None
        self.explained = Explained()
        self._sky = NightSky(np.random.default_rng(7), ember=0.35, stars=90)
        words = [texts.EXHIBITS[name][0] for name in self._names]
        manager = self.form.manager
        tabs = pygame.Rect(*_TABS, math.ceil(_width(words, TEXT)), 24)
        self._tabs = self.form.add(Choice(manager, tabs, "", words, self._chosen, self._choose_exhibit))
        self.bench = Bench(self.form, self.restart, self._open_step, now)
        self._hand = self.form.add(VirtualPointer(manager, _ROOM, self._point, hold=texts.POINTER_GRIP))
        self._gravities: list[Choice] = []  # one, or none where there is no gravity
        speeds = self.playback.row(manager, _row_box(1, self.playback.words))
        contacts = self._row(2, texts.PHYSICS_CONTACTS, texts.PHYSICS_CONTACTS_WORDS, 0, self._show_contacts)
        self._speeds, self._contacts = self.form.add(speeds), self.form.add(contacts)
        self.restart()

    def enter(self) -> None:
        """Lay the plot out anew: the size of text may have changed."""
        self.bench.renew()

    def exit(self) -> None:
        """Release the gripped body."""
        self.grip = None

    def restart(self) -> None:
        """Rebuild the exhibit."""
        self.exhibit = EXHIBITS[self.chosen](GRAVITIES[self._gravity], self.bench.values_of(self.chosen))
        self.bench.show(self.exhibit)
        self._outlines = Outlines(self.exhibit.sprites)
        self._poses = self._poses_before = self.exhibit.poses
        self._clock.begin()
        self.step_time = 0.0
        self.grip = None
        self._offer_gravity()

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Explain on, grip a body, or pass the event to the actions and the widgets."""
        if self.explained.handle_event(event):
            return None
        if event.type in (pygame.MOUSEMOTION, pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP) and self._point(event):
            return None
        if event.type == pygame.WINDOWFOCUSLOST:
            self.grip = None
        return super().handle_event(event)

    def actions(self) -> Table:
        """Stop and step; show another exhibit, or its contacts; begin anew; explain; pause."""
        stop, step, *speeds = self.playback.actions(texts.HINT_STEP)
        return [
            stop,
            step,
            Action(Command.NEXT, lambda: self._turn(1), texts.HINT_NEXT_EXHIBIT),
            Action(Command.CHOICES, lambda: self._contacts.choose(1 - self._contacts.index), texts.HINT_CONTACTS),
            Action(Command.MODE, self.bench.toggle, texts.HINT_LAW),
            Action(Command.RETRY, self.restart, texts.HINT_RESTART_EXHIBIT),
            replace(self.explained.action(), gamepad=None),  # its button draws the contacts
            Action(Command.PAUSE, self._pause, texts.HINT_PAUSE),
            Action(Command.PREVIOUS, lambda: self._turn(-1)),
            *speeds,
        ]

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        """Return the hints in the upper right corner."""
        return [HintRow(self.hints, (VIEW_SIZE[0] - MARGIN, 38), from_right=True, room=_HINTS)]

    def _turn(self, direction: int) -> None:
        self._tabs.choose((self._chosen + direction) % len(self._names))

    def update(self) -> Transition | None:
        """Take as many steps as the chosen speed makes due."""
        for _ in range(self.playback.steps() if self.bench.measuring is None else 0):
            self._step()
        self.bench.update()
        self.explained.update()
        return self.form.update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the exhibit and the text around it."""
        between = self.playback.between(alpha)
        poses = self._poses_before + between * (self._poses - self._poses_before)
        view = self.view(canvas.scale)
        self._sky.draw(canvas)
        self._draw_ground(canvas, view)
        lit = self.grip.body.index if self.grip else self._hovered()
        asleep = self.exhibit.world.asleep[0]
        self._outlines.draw(canvas, view, poses, lit, held=self.grip is not None, asleep=asleep)
        if self.contacts_drawn:
            draw_contacts(canvas, view, self.exhibit.world, self._weight)
        for label in self.exhibit.labels():
            label.draw(canvas, view, poses, self.bench.panel.box if self.bench.panel else None)
        if self.grip:
            place = self.grip.place(poses[self.grip.body.index])
            x, y = view.points(place).tolist()
            draw_grip(canvas, (x, y), self._mouse)
        self._draw_head(canvas)
        self._draw_words(canvas)
        self.explained.draw(canvas)

    # The world

    def _step(self) -> None:
        before = self._now()
        self.exhibit.step(self.grip)
        spent = self._now() - before
        self.step_time += (spent - self.step_time) * (_SMOOTHING if self.step_time else 1.0)
        self._poses_before, self._poses = self._poses, self.exhibit.poses

    @property
    def _weight(self) -> float:
        """Weight of a kilogram, in newtons; the moon's where there is no gravity."""
        return self.exhibit.gravity or GRAVITIES[0]

    @property
    def chosen(self) -> str:
        """Name of the exhibit."""
        return self._names[self._chosen]

    def view(self, scale: float) -> View:
        """Return how the exhibit's metres lie on the canvas."""
        zoom = WORLD_WIDTH / self.exhibit.width
        return View(scale, (0.0, (_GROUND - VIEW_SIZE[1] / 2) / (POINTS_PER_METRE * zoom)), zoom)

    def _covered(self, point: tuple[float, float]) -> bool:
        """Whether the plot or the controls lie over a point."""
        return point[1] < _HEAD or self.bench.covers(point)

    def _place(self, point: tuple[float, float]) -> Array:
        return self.view(1.0).metres(point)

    def _hovered(self) -> int | None:
        """Index of the body under the mouse, if that is in use, or under the virtual pointer."""
        if not self.context.controls.mouse_in_use and not self._hand.typing:
            return None
        if self._covered(self._mouse):
            return None
        body = self._outlines.body_at(self._poses, self._place(self._mouse), 0.0)
        return body.index if body else None

    def _point(self, event: pygame.event.Event) -> bool:
        """Grip, pull or release a body; return False if the event means something else."""
        self._mouse = (float(event.pos[0]), float(event.pos[1]))
        self.bench.hover(self._mouse)
        if self.grip:
            self.grip.target = self._place(self._mouse)
            if event.type == pygame.MOUSEBUTTONUP and event.button == 1:
                self.grip = None
            return True
        if event.type != pygame.MOUSEBUTTONDOWN or event.button != 1 or self._covered(self._mouse):
            return False
        if any(widget.hover_point(*event.pos) for widget in self.form.widgets if widget is not self._hand):
            return False
        place = self._place(self._mouse)
        reach = _REACH * self.exhibit.width / VIEW_SIZE[0]
        body = self._outlines.body_at(self._poses, place, reach)
        if body:
            self.grip = Grip(body, place)
        return body is not None

    def _open_step(self) -> Transition:
        return push("physics_step", self.exhibit, self.grip)

    def _pause(self) -> Transition:
        return push("pause", self, retry=self.restart)

    # Choices

    def _offer_gravity(self) -> None:
        """Add a row of gravities, unless the exhibit is weightless."""
        if bool(self._gravities) is not self.exhibit.weightless:
            return
        row = partial(self._row, 0, texts.PHYSICS_GRAVITY, texts.PHYSICS_GRAVITIES, self._gravity, self._choose_gravity)
        offered = [] if self.exhibit.weightless else [row()]
        self.form.replace([*self._gravities, self._speeds], [*offered, self._speeds])
        self._gravities = offered

    def _row(self, row: int, label: str, words: Sequence[str], index: int, chosen: Callable[[int], None]) -> Choice:
        box, manager = _row_box(row, words), self.form.manager
        return Choice(manager, box, label, words, index, chosen, label_width=LABEL_WIDTH, size=SMALL)

    def _choose_exhibit(self, index: int) -> None:
        self._chosen = index
        self.restart()

    def _choose_gravity(self, index: int) -> None:
        self._gravity = index
        self.restart()

    def _show_contacts(self, index: int) -> None:
        self.contacts_drawn = bool(index)

    # The picture

    def _draw_ground(self, canvas: Canvas, view: View) -> None:
        whole, seen = canvas.whole, canvas.whole.view
        whole.fill(whole.rect(seen.left, _GROUND, seen.width, seen.bottom - _GROUND), NIGHT0, 0.55)
        whole.line((seen.left, _GROUND), (seen.right, _GROUND), MUTE, 1)
        for start, end in self.exhibit.rules:
            (left, y), (right, _) = view.points((start, end)).tolist()
            canvas.line((left, y), (right, y), FAINT, 1)

    @staticmethod
    def _draw_head(canvas: Canvas) -> None:
        """Draw the ground of the controls, behind which bodies fly on."""
        whole, seen = canvas.whole, canvas.whole.view
        whole.fill(whole.rect(seen.left, seen.top, seen.width, _HEAD - seen.top), NIGHT0, 0.9)

    def _draw_words(self, canvas: Canvas) -> None:
        canvas.text(texts.PHYSICS_TITLE, (MARGIN, 38), size=SMALL, colour=MUTE)
        _, law, live = texts.EXHIBITS[self.chosen]
        canvas.text(law, (MARGIN, 112), size=TEXT, room=_ROOM_LEFT)
        sentence = live[self.exhibit.state].format(**self.exhibit.figures())
        write_figures(canvas, sentence, (MARGIN, 136), size=SMALL + 1, room=_ROOM_LEFT)
        if self.exhibit.weightless:
            x, y, _ = _ROWS
            for part, left in ((texts.PHYSICS_GRAVITY, x), (texts.PHYSICS_WEIGHTLESS, x + LABEL_WIDTH)):
                canvas.text(part, (left, y + _ROW_HEIGHT // 2 + 0.36 * SMALL), size=SMALL, colour=MUTE)
        readouts.draw_readouts(canvas, self._readouts(), _COLUMNS)
        if self.contacts_drawn:
            draw_force_scale(canvas, _SCALE, self._weight, _COLUMNS[0] - _SCALE[0] - 16)
        if self.exhibit.world.asleep.any():
            canvas.text(texts.PHYSICS_ASLEEP, _SLEEP, size=SMALL, colour=MUTE, room=_COLUMNS[0] - _SLEEP[0] - 16)
        self.bench.draw(canvas)
        self.form.draw(canvas)
        self.draw_hints(canvas)
        self._draw_state(canvas)
        for widget, what in ((self._tabs, law), *self.bench.explained, (self._speeds, texts.EXPLAIN_PHYSICS["speed"]),
                             (self._contacts, texts.EXPLAIN_PHYSICS["contacts"])):  # fmt: skip
            canvas.explain(widget.box, what)

    def _draw_state(self, canvas: Canvas) -> None:
        """Draw on the right that time is stopped, or else how to grab bodies."""
        right, controls = VIEW_SIZE[0] - MARGIN, self.context.controls
        keys = self._hand.focused and not controls.mouse_in_use
        drag = texts.PHYSICS_HAND.format(key=controls.word(Command.CONFIRM)) if keys else texts.PHYSICS_DRAG
        text = texts.PHYSICS_STOPPED if self.playback.stopped else "" if self._hand.typing else drag
        colour = INK if self.playback.stopped else HUMAN
        canvas.text(text, (right, 62), size=SMALL, colour=colour, align="right", room=right - self._tabs.box.right - 16)

    def _readouts(self) -> list[readouts.Readout]:
        exhibit, what = self.exhibit, texts.EXPLAIN_PHYSICS
        contacts = str(exhibit.contact_count) if exhibit.steps else "–"
        return [
            readouts.Readout(texts.BODIES, str(len(exhibit.bodies)), "", what=what["bodies"]),
            readouts.Readout(texts.CONTACT_POINTS, contacts, "", what=what["points"]),
            readouts.Readout(texts.KINETIC_ENERGY, f"{exhibit.kinetic_energy:.1f}", "J", what=what["energy"]),
            readouts.Readout(texts.STEP_TIME, f"{1e3 * self.step_time:.1f}", "ms", what=what["step"]),
        ]


def _width(words: Sequence[str], size: float) -> float:
    """Return the width of a row of words, in points."""
    return sum(typeface.width(word, size, "regular") + _GAP for word in words) - _GAP


def _row_box(row: int, words: Sequence[str]) -> pygame.Rect:
    x, y, pitch = _ROWS
    return pygame.Rect(x, y + row * pitch, math.ceil(LABEL_WIDTH + _width(words, SMALL)), _ROW_HEIGHT)
