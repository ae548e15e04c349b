"""Scene of one step of the engine, piece by piece: boxes, axes, contact, forces, impulses, motion."""

from __future__ import annotations

from typing import Final

import numpy as np
import pygame

from engine.vector import Array
from game.core import texts
from game.drawing.canvas import Canvas, Point
from game.drawing.cursor import LEADING, Cursor
from game.drawing.tokens import INK, LINE, MUTE, NET, TEXT, Colour
from game.input.controls import Command
from game.scenes.physics.bodies import Outlines, draw_contacts
from game.scenes.physics.exhibit import Exhibit, Grip
from game.scenes.physics.step import Pair, StepRecord
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.panel import Panel
from game.ui.panel_scene import PanelScene
from game.world.camera import View

_PICTURE: Final = 400.0  # greatest height
_LOW: Final = 0.42  # of its width, the picture's height in a narrow window
_SHARE: Final = 0.42  # of the picture's height that the two bodies fill
_ALL: Final = 0.9  # of the picture that all of them fill
_LARGE: Final = 60.0  # metres: a box beyond that is the floor's or a wall's
_ARROW: Final = 84.0  # points of the longest arrow
_NORMAL: Final = 46.0  # points of a normal
_HEAD: Final = 6.0
_INSIDE: Final = 44.0  # points from a contact to the letter of a body that cannot move
_LINES: Final = 2  # of a sentence, for which there is always room


class PhysicsStepScene(PanelScene):
    """One step of an exhibit, recorded on a copy of it; the exhibit itself stays as it is.

    Attributes:
        record: the step.
        pair: the shapes that are followed through it; None if none is near another.
        pieces: what happens to them, one after the other.
        piece: what is shown of that.

    """

    def __init__(self, context: Context, exhibit: Exhibit, grip: Grip | None = None) -> None:
        super().__init__(context)
        self.record = StepRecord(exhibit, grip)
        self._outlines = Outlines(self.record.exhibit.drawn)
        self.piece = "boxes"
        self._follow(max(self.record.pairs, key=self._push, default=None))

    def _push(self, pair: Pair) -> float:
        """Return the impulse between two shapes, -1 if they do not touch."""
        contacts = self.record.contacts
        return -1.0 if contacts is None or pair.contact is None else float(contacts.impulse[pair.contact, :2].sum())

    def describe(self, panel: Panel) -> None:
        panel.aside(texts.STEP_TITLE)
        words = [texts.STEP_PIECES[piece][0] for piece in self.pieces]
        self._tabs = panel.choice("", words, self.pieces.index(self.piece), self._turn_to)
        panel.add(self._write_sentence)
        panel.picture(lambda width: min(_PICTURE, _LOW * width), self._draw_picture)
        panel.aside(lambda: texts.STEP_ARROWS if self.record.motion(self.piece) and self.pair else "")
        if len(self.record.pairs) > 1:
            panel.words([(texts.STEP_OTHER, self._other_pair)])

    def _follow(self, pair: Pair | None) -> None:
        self.pair, self.pieces = pair, self.record.pieces(pair)
        if self.piece not in self.pieces:
            self.piece = "boxes"
        self.build()

    def _turn_to(self, index: int) -> None:
        self.piece = self.pieces[index]

    def _other_pair(self) -> None:
        """Follow another pair that touches; if none does, another that is near."""
        pairs = [pair for pair in self.record.pairs if pair.contact is not None] or self.record.pairs
        if self.pair in pairs:
            self._follow(pairs[(pairs.index(self.pair) + 1) % len(pairs)])

    def actions(self) -> Table:
        return [
            Action(Command.STEP, lambda: self._tabs.choose(self._tabs.index + 1), texts.HINT_NEXT_PIECE),
            self.form.goes_back(texts.HINT_BACK),
        ]

    def _write_sentence(self, cursor: Cursor) -> None:
        """Write what happens, in plain words; what stands below stays where it is."""
        below = cursor.y + _LINES * LEADING * TEXT
        cursor.text(self.record.sentence(self.piece, self.pair))
        cursor.y = max(cursor.y, below)

    # The picture: the bodies near a contact, and what the engine has found out about them there

    def _draw_picture(self, canvas: Canvas, box: pygame.FRect) -> None:
        record, pair, piece = self.record, self.pair, self.piece
        view = self._view(canvas.scale, box)
        poses = record.after[0] if piece == "motion" else record.before[0]
        with canvas.clipped(box):
            self._draw_walls(canvas, view)
            self._outlines.draw(canvas, view, poses)
            if piece == "boxes":
                self._draw_boxes(canvas, view)
            if pair is None:
                return
            if piece == "axes":
                self._draw_axes(canvas, view, box, pair)
            elif piece == "contact":
                self._draw_contact(canvas, view, pair)
            elif piece == "impulses":
                draw_contacts(canvas, view, record.exhibit.world, record.exhibit.gravity)
            for letter, body, way in zip("AB", pair.bodies, (-pair.to_b, pair.to_b), strict=True):
                x, y = view.points(poses[body, :2]).tolist()
                if not record.can_move(body):  # its middle may be far away
                    (x, y), (right, up) = view.points(self._middle(pair)).tolist(), way.tolist()
                    x, y = x + _INSIDE * right, y - _INSIDE * up
                canvas.text(letter, (x - 14, y + 5), size=TEXT, colour=INK, align="centre")
            self._draw_motion(canvas, view, poses, pair)

    def _view(self, scale: float, box: pygame.FRect) -> View:
        record, pair, boxes = self.record, self.pair, self.record.boxes
        if pair is None:
            per_metre = box.width / record.exhibit.width  # with the ground at its lower edge
            return View.within(box, scale, (0.0, 0.48 * box.height / per_metre), per_metre)
        whole = self.piece == "boxes"
        bodies = range(len(boxes)) if whole else pair.bodies
        small = [body for body in bodies if (boxes[body, 2:] - boxes[body, :2]).max() < _LARGE]
        both = boxes[[body for body in small if record.can_move(body)] or small]
        low, high = both[:, :2].min(axis=0), both[:, 2:].max(axis=0)
        room = _ALL * np.array(box.size) if whole else np.full(2, _SHARE * box.height)
        return View.within(box, scale, (low + high) / 2, float((room / (high - low)).min()))

    def _draw_walls(self, canvas: Canvas, view: View) -> None:
        wide = self.record.exhibit.width / 2
        for start, end in (((-wide, 0), (wide, 0)), ((-wide, 0), (-wide, 50)), ((wide, 0), (wide, 50))):
            (x0, y0), (x1, y1) = view.points((start, end)).tolist()
            canvas.line((max(x0, -9), min(y0, 9e3)), (min(x1, 9e3), max(y1, -9)), MUTE, 1)

    def _draw_boxes(self, canvas: Canvas, view: View) -> None:
        near = {body for each in self.record.pairs for body in each.bodies}
        for body, (left, low, right, high) in enumerate(self.record.boxes.tolist()):
            if right - left > _LARGE or high - low > _LARGE:
                continue
            (x, y), (end, bottom) = view.points(((left, high), (right, low))).tolist()
            followed = self.pair is not None and body in self.pair.bodies
            colour = NET if followed else MUTE if body in near else LINE
            canvas.outline((x, y, end - x, bottom - y), 0, colour)

    def _draw_axes(self, canvas: Canvas, view: View, box: pygame.FRect, pair: Pair) -> None:
        for number, (place, direction) in enumerate(pair.axes):
            if number != pair.chosen:
                _draw_arrow(canvas, view, place, _NORMAL * direction, MUTE, 1)
        start, direction = pair.axes[pair.chosen]
        # The middle of a long face, such as the ground's, is not in the picture.
        seen = box.collidepoint(view.points(start).tolist())
        _draw_arrow(canvas, view, start if seen else self._middle(pair), _NORMAL * direction, NET)

    def _draw_contact(self, canvas: Canvas, view: View, pair: Pair) -> None:
        contacts, row = self.record.contacts, pair.contact
        assert contacts is not None
        for place in contacts.points[row][contacts.valid[row]]:
            _draw_arrow(canvas, view, place, _NORMAL * contacts.normal[row], NET)
            canvas.dot(view.points(place).tolist(), 3.5, NET)

    def _middle(self, pair: Pair) -> Array:
        """Return the middle of the points of contact, or of the face nearest to the other shape."""
        contacts = self.record.contacts
        if contacts is None or pair.contact is None:
            return pair.axes[pair.chosen][0]
        middle: Array = contacts.points[pair.contact][contacts.valid[pair.contact]].mean(axis=0)
        return middle

    def _draw_motion(self, canvas: Canvas, view: View, poses: Array, pair: Pair) -> None:
        """Draw the velocities of both bodies before and after a piece, on one scale for all pieces."""
        record, bodies = self.record, [body for body in pair.bodies if self.record.can_move(body)]
        every = np.concatenate([each[bodies, :2] for each in (record.before[1], record.fallen, record.after[1])])
        scale = _ARROW / max(float(np.hypot(*every.T).max(initial=0.0)), 1e-4)
        for velocities, colour, width in zip(record.motion(self.piece) or (), (MUTE, INK), (3, 1.5), strict=False):
            for body in bodies:
                _draw_arrow(canvas, view, poses[body, :2], scale * velocities[body, :2], colour, width)


def _draw_arrow(canvas: Canvas, view: View, place: Array, reach: Array, colour: Colour, width: float = 2) -> None:
    """Draw an arrow from a place in metres, `reach` in points, y up."""
    start, way = pygame.Vector2(view.points(place).tolist()), pygame.Vector2(reach[0], -reach[1])
    if way.length() <= 1:
        return
    end = start + way
    canvas.line(_point(start), _point(end), colour, width)
    for degrees in (150, -150):
        side = way.rotate(degrees)
        side.scale_to_length(min(_HEAD, way.length() / 2))
        canvas.line(_point(end), _point(end + side), colour, width)


def _point(vector: pygame.Vector2) -> Point:
    return vector.x, vector.y
