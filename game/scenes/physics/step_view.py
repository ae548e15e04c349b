"""Picture of a piece of a step: the bodies near a contact, and what the engine has found out about them there."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import pygame

from engine.vector import Array, right_of
from game.core import texts
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import INK, LINE, MUTE, NET, SMALL, TEXT, VIEW_SIZE, Colour
from game.scenes.physics.step_pieces import Piece, written
from game.scenes.physics.step_record import Axis, Impulse, Pair, StepRecord
from game.world.bodies import Outlines
from game.world.camera import POINTS_PER_METRE, View

_SHARE: Final = 0.42  # of the stage's height that the two bodies fill
_WIDER: Final = 2.6  # how much more is shown where all boxes are
_LARGE: Final = 60.0  # metres: a box beyond that is the floor's or a wall's
_ARROW: Final = 84.0  # points of the longest arrow
_NORMAL: Final = 46.0  # points of a normal
_HEAD: Final = 6.0
_INSIDE: Final = 44.0  # points from a contact to the letter of a body that cannot move
_LEGEND: Final = 66.0  # points below the bodies
Legend = list[tuple[Colour, float, str]]  # colour and length in points of an arrow, and what it means


class StepView:
    """View of one recorded step."""

    def __init__(self, record: StepRecord) -> None:
        self._record = record
        self._outlines = Outlines(record.exhibit.sprites)

    def draw(self, canvas: Canvas, box: pygame.FRect, piece: Piece, pair: Pair | None) -> None:
        """Draw a piece in a box, in points, as it is for a pair."""
        record, self._stage = self._record, pygame.FRect(box.left, box.top, box.width, box.height - _LEGEND)
        view = self._view(canvas.scale, pair, wide=piece.kind == "boxes")
        surface = canvas.surface
        outside = surface.get_clip()
        surface.set_clip(canvas.rect(*self._stage).clip(outside))
        self._draw_room(canvas, view)
        poses = record.after[0] if piece.kind in ("motion", "end") else record.before[0]
        self._outlines.draw(canvas, view, poses, None, held=False)
        if piece.kind == "boxes":
            self._draw_boxes(canvas, view, pair)
        legend: Legend = []
        if pair:
            if piece.kind == "axes":
                self._draw_axes(canvas, view, pair)
            if piece.kind in ("contact", "impulses"):
                self._draw_contact(canvas, view, pair, with_normal=piece.kind == "contact")
            self._draw_letters(canvas, view, pair, poses)
            if piece.impulse:
                legend += self._draw_impulse(canvas, view, piece.impulse, pair)
            if motion := self._motion(piece, pair):
                legend += self._draw_velocities(canvas, view, pair, poses, motion)
        surface.set_clip(outside)
        self._draw_legend(canvas, legend)

    def _view(self, scale: float, pair: Pair | None, *, wide: bool) -> View:
        record, stage = self._record, self._stage
        boxes = record.boxes
        if pair is None:
            low, high = np.array((-record.exhibit.width / 2, 0.0)), np.array((record.exhibit.width / 2, 8.0))
            per_metre = stage.width / record.exhibit.width
        else:
            chosen = [boxes[body] for body in pair.bodies if (boxes[body, 2:] - boxes[body, :2]).max() < _LARGE]
            moving = [boxes[body] for body in pair.bodies if record.exhibit.world.params.dynamic[body]]
            both = np.array(moving or chosen)
            low, high = both[:, :2].min(axis=0), both[:, 2:].max(axis=0)
            per_metre = stage.height * _SHARE / float((high - low).max()) / (_WIDER if wide else 1.0)
        aside = np.array((VIEW_SIZE[0] / 2 - stage.centerx, stage.centery - VIEW_SIZE[1] / 2)) / per_metre
        x, y = ((low + high) / 2 + aside).tolist()
        return View(scale, (x, y), per_metre / POINTS_PER_METRE)

    def _draw_room(self, canvas: Canvas, view: View) -> None:
        wide = self._record.exhibit.width / 2
        for start, end in (((-wide, 0), (wide, 0)), ((-wide, 0), (-wide, 50)), ((wide, 0), (wide, 50))):
            (x0, y0), (x1, y1) = view.points((start, end)).tolist()
            canvas.line((max(x0, -9), min(y0, 9e3)), (min(x1, 9e3), max(y1, -9)), MUTE, 1)

    def _draw_boxes(self, canvas: Canvas, view: View, pair: Pair | None) -> None:
        near = {body for each in self._record.pairs for body in each.bodies}
        for body, (left, low, right, high) in enumerate(self._record.boxes.tolist()):
            if right - left > _LARGE or high - low > _LARGE:
                continue
            (x, y), (end, bottom) = view.points(((left, high), (right, low))).tolist()
            followed = pair is not None and body in pair.bodies
            colour = NET if followed else MUTE if body in near else LINE
            canvas.outline((x, y, end - x, bottom - y), 0, colour)

    def _draw_axes(self, canvas: Canvas, view: View, pair: Pair) -> None:
        for number, axis in enumerate(pair.axes):
            if number != pair.chosen:
                _arrow(canvas, *self._reach(view, axis), MUTE)
        chosen = pair.axes[pair.chosen]
        start, end = self._reach(view, chosen)
        if not self._stage.collidepoint(start):  # a long face, such as the ground's
            start, end = self._reach(view, chosen, self._middle(pair))
        _arrow(canvas, start, end, NET, 2)
        canvas.text(str(pair.chosen + 1), (end[0] + 8, end[1] + 4), size=SMALL, colour=NET)

    @staticmethod
    def _reach(view: View, axis: Axis, place: Array | None = None) -> tuple[Point, Point]:
        x, y = view.points(axis.start if place is None else place).tolist()
        right, up = axis.direction.tolist()
        return (x, y), (x + _NORMAL * right, y - _NORMAL * up)

    def _draw_contact(self, canvas: Canvas, view: View, pair: Pair, *, with_normal: bool) -> None:
        contacts = self._record.contacts
        assert contacts is not None
        assert pair.contact is not None
        row = pair.contact
        for number in np.flatnonzero(contacts.valid[row]).tolist():
            x, y = view.points(contacts.points[row, number]).tolist()
            if with_normal:
                right, up = contacts.normal[row].tolist()
                _arrow(canvas, (x, y), (x + _NORMAL * right, y - _NORMAL * up), NET, 2)
            canvas.dot((x, y), 3.5, NET)
            canvas.text(str(number + 1), (x + 8, y + 15), size=SMALL, colour=NET)

    def _draw_letters(self, canvas: Canvas, view: View, pair: Pair, poses: Array) -> None:
        axis = pair.axes[pair.chosen]
        to_b = axis.direction if axis.first else -axis.direction
        for letter, body, way in zip("AB", pair.bodies, (-to_b, to_b), strict=True):
            x, y = view.points(poses[body, :2]).tolist()
            if not self._record.exhibit.world.params.dynamic[body]:  # its middle may be far away
                (x, y), (right, up) = view.points(self._middle(pair)).tolist(), way.tolist()
                x, y = x + _INSIDE * right, y - _INSIDE * up
            canvas.text(letter, (x - 14, y + 5), size=TEXT, colour=INK, align="centre")

    def _middle(self, pair: Pair) -> Array:
        """Return the middle of the points of contact, or of the face nearest to the other shape."""
        contacts = self._record.contacts
        if contacts is None or pair.contact is None:
            return pair.axes[pair.chosen].start
        row = pair.contact
        middle: Array = contacts.points[row][contacts.valid[row]].mean(axis=0)
        return middle

    def _draw_impulse(self, canvas: Canvas, view: View, impulse: Impulse, pair: Pair) -> Legend:
        """Draw the accumulated impulses on B, or on A if B cannot move; all iterations have one scale."""
        contacts, row = self._record.contacts, impulse.contact
        assert contacts is not None
        on_b = bool(self._record.exhibit.world.params.dynamic[pair.bodies[1]])
        runs = (each for each in self._record.impulses if each.contact == row)
        most = max(float(np.abs(each.after).max()) for each in runs)
        if most < 1e-9:
            return []
        size, length = _scale(most)
        normal, along = contacts.normal[row], right_of(contacts.normal[row])
        first, second, rub = (impulse.after * (length / size if on_b else -length / size)).tolist()
        for number, reach in ((0, first), (1, second)):
            if contacts.valid[row, number]:
                _arrow_from(canvas, view, contacts.points[row, number], normal * reach, NET)
        _arrow_from(canvas, view, self._middle(pair), along * rub, NET)
        return [(NET, length, texts.STEP_SCALE["impulse"].format(size=written(size), body="B" if on_b else "A"))]

    def _motion(self, piece: Piece, pair: Pair) -> tuple[Array, Array] | None:
        """Return the velocities (2, 3) of A and B before and after a piece that changes them."""
        record, bodies = self._record, list(pair.bodies)
        if piece.impulse:
            return piece.impulse.motion
        if piece.kind == "forces":
            return record.before[1][bodies], record.fallen[bodies]
        if piece.kind == "memory" and record.warm is not None:
            return record.fallen[bodies], record.warm[bodies]
        if piece.kind == "end":
            return record.before[1][bodies], record.after[1][bodies]
        return None

    def _draw_velocities(
        self, canvas: Canvas, view: View, pair: Pair, poses: Array, motion: tuple[Array, Array]
    ) -> Legend:
        record, bodies = self._record, list(pair.bodies)
        every = [record.before[1][bodies], record.fallen[bodies], record.after[1][bodies], *motion]
        most = max(float(np.hypot(each[:, 0], each[:, 1]).max()) for each in every)
        if most < 1e-4:
            return []
        size, length = _scale(most)
        for which, body in enumerate(bodies):
            if record.exhibit.world.params.dynamic[body]:
                for velocity, colour, width in zip(motion, (MUTE, INK), (3, 1.5), strict=True):
                    _arrow_from(canvas, view, poses[body, :2], velocity[which, :2] * length / size, colour, width)
        words = texts.STEP_SCALE["before"].format(size=written(size))
        return [(MUTE, length, words), (INK, 24.0, texts.STEP_SCALE["after"])]

    def _draw_legend(self, canvas: Canvas, legend: Legend) -> None:
        left, y, room = self._stage.left, self._stage.bottom + 20.0, self._stage.width - _ARROW - 12
        for colour, length, words in legend:
            _arrow(canvas, (left, y - 4), (left + length, y - 4), colour, 2)
            canvas.text(words, (left + _ARROW + 12, y), size=SMALL, colour=MUTE, room=room)
            y += 19


def _scale(most: float) -> tuple[float, float]:
    """Return a round number, at most `most`, and how long it is drawn, in points, so that `most` has full length."""
    power = 10.0 ** math.floor(math.log10(most))
    size = next(factor * power for factor in (5.0, 2.0, 1.0) if factor * power <= most * (1 + 1e-9))
    return size, _ARROW * size / most


def _arrow_from(canvas: Canvas, view: View, place: Array, reach: Array, colour: Colour, width: float = 2) -> None:
    """Draw an arrow from a place in metres, `reach` in points, y up."""
    x, y = view.points(place).tolist()
    right, up = reach.tolist()
    if math.hypot(right, up) > 1:
        _arrow(canvas, (x, y), (x + right, y - up), colour, width)


def _arrow(canvas: Canvas, start: Point, end: Point, colour: Colour, width: float = 1) -> None:
    canvas.line(start, end, colour, width)
    way = pygame.Vector2(end) - pygame.Vector2(start)
    size = min(_HEAD, way.length() / 2)
    for degrees in (150, -150):
        side = way.rotate(degrees)
        side.scale_to_length(size)
        canvas.line(end, (end[0] + side.x, end[1] + side.y), colour, width)
