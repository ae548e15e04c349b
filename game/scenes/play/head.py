"""Words at the head of a flight: all that is to be known while the craft waits, one sentence while it flies.

They are laid out in rows and columns for any window and any size of text: names at the left, keys at the right, and
below both, in the middle, what to do. Nothing here knows where it will stand.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import pygame

from game.core import texts
from game.drawing.canvas import Now
from game.drawing.cursor import LEADING, Cursor
from game.drawing.tokens import INK, MARGIN, MUTE, NARROW, NIGHT0, SMALL, TEXT, Colour
from game.explain.readouts import Lamp
from game.flight.networks import titled
from game.input.bindings import Command
from game.scenes.play.words import sentence, surroundings
from game.ui.hints import Hint, HintRow, flight_hints, split

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas
    from game.scenes.play.challenge import Words
    from game.scenes.play.flown_flight import FlownFlight
    from game.scenes.play.help import HelpWords

_SIDES, _TOP = 0.05, 20.0  # free at either side, of the width; and points above
_SENTENCE: Final = 18.0
_WIDEST: Final = 480.0  # points of a line of it, which ends before the Earth
_COVER: Final = 0.75  # opacity behind words: no star shines through
_MOST: Final = 0.42  # of a window's height that words take from the flight
_FEWER: Final[Sequence[dict[str, Any]]] = (
    {},
    {"aside": ()},
    {"caption": "", "name": ""},
    {"controls": ()},
    {"help": None},
)
_LINE: Final = 29.0  # from one row of keys to the next


@dataclass
class Head:
    """What is said at the head of a flight.

    Attributes:
        sentence: the one sentence; with `lamp` before it, and a mark if it warns.
        lamp: shape, colour and glow of who flies; None for none.
        caption, name: the kind of flight, and its name.
        aside: what else is to be known of it.
        hints: the keys at the right.
        controls: the keys of the craft, below the sentence.
        help: the three words of help, the keys that choose one, and what it means; None where nobody can help.
        panel: a panel at the right, which the words keep clear of; None for none.
        starry: whether stars would shine through.

    """

    sentence: str = ""
    warns: bool = False
    lamp: Lamp | None = None
    caption: str = ""
    name: str = ""
    aside: Sequence[str] = ()
    hints: Sequence[Hint] = ()
    controls: Sequence[Hint] = ()
    help: HelpWords | None = None
    keys: str = ""
    means: Now = field(default=str)
    panel: pygame.FRect | None = None
    starry: bool = False

    def write(self, canvas: Canvas, *, drawn: bool = True) -> float:
        """Write it, or only measure; return the y of its lower end, in points of `canvas.reading`."""
        laid = self._laid(canvas)
        if drawn:
            for box in laid.boxes if self.starry else ():
                canvas.rounded(box.inflate(16, 4), 8, NIGHT0, _COVER)
            _Layout(laid.head, canvas, drawn).write()
        return laid.low

    def _laid(self, canvas: Canvas) -> _Layout:
        """Lay out all words or, where that leaves too little room for the flight, fewer; the pause has all."""
        head = self
        for fewer in _FEWER:
            laid = _Layout(head := replace(head, **fewer), canvas, drawn=False)
            if laid.write() <= _MOST * canvas.view.height:
                break
        return laid

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        """Return the keys at the right, in as many rows as they need."""
        return _Layout(self, canvas, drawn=False).key_rows()

    def help_boxes(self, canvas: Canvas) -> dict[str, pygame.FRect]:
        """Return where each word of help can be pressed."""
        layout = self._laid(canvas)
        return self.help.boxes(canvas, layout.middle, layout.help_line) if self.help and layout.head.help else {}


class _Layout:
    def __init__(self, head: Head, canvas: Canvas, drawn: bool) -> None:
        self.head, self.canvas, self.drawn = head, canvas, drawn
        view = canvas.view
        self.side = max(min(MARGIN, _SIDES * view.width), 12.0)
        self.narrow = view.width < NARROW  # then keys stand above names
        self.beside = view.width - 2 * self.side if self.narrow else 0.36 * view.width  # room of names, and of keys
        self.right = head.panel.left - 16 if head.panel else view.right
        self.middle, self.help_line, self.low = (view.left + self.right) / 2, 0.0, 0.0
        self.boxes: list[pygame.FRect] = []  # of the words, in points

    def cursor(self, left: float, y: float, width: float, size: float, colour: Colour = INK) -> Cursor:
        return Cursor(left, y, width, self.canvas.scale, self.canvas if self.drawn else None, size=size, colour=colour)

    def key_rows(self) -> list[HintRow]:
        rows, right = split(self.head.hints, self.canvas, self.beside), self.canvas.view.right - self.side
        return [HintRow(row, (right, _TOP + 16 + _LINE * number), from_right=True) for number, row in enumerate(rows)]

    def write(self) -> float:
        rows = self.key_rows()
        for row in rows:
            self._place(row)
        keys = _TOP + _LINE * len(rows) if rows else 0.0
        names = self._names(keys if self.narrow else 0.0)
        # In flight there is nothing beside the sentence, or so little that both have room.
        alone = not names and (not rows or not self.narrow)
        reach = max((row.width(self.canvas) + self.side for row in rows), default=0.0) if alone else 0.0
        self.low = max(self._middle(_TOP if alone else max(keys, names) + 8, reach), keys, names)
        return self.low

    def _place(self, row: HintRow) -> None:
        first, *others = row.boxes(self.canvas)
        self.boxes.append(first.unionall(others))
        if self.drawn:
            row.draw(self.canvas)

    def _names(self, top: float) -> float:
        head = self.head
        if not (head.caption or head.name or head.aside):
            return 0.0
        cursor = self.cursor(self.canvas.view.left + self.side, max(top, _TOP), self.beside, SMALL, MUTE)
        if head.caption:
            cursor.text(head.caption)
        if head.name:
            cursor.styled(head.name, TEXT, INK)
        for words in head.aside:
            cursor.text(words)
        width = max(map(cursor.measured, (head.caption, *head.aside)))
        width = max(width, cursor.in_style(TEXT, INK).measured(head.name))
        self.boxes.append(
            pygame.FRect(cursor.left, max(top, _TOP), min(width, cursor.width), cursor.y - max(top, _TOP))
        )
        return cursor.y

    def _middle(self, top: float, beside: float) -> float:
        head, canvas, reach = self.head, self.canvas, 0.0 if self.head.panel else beside
        room = min(_WIDEST, self.right - canvas.view.left - 2 * max(self.side + 24, reach + 24))
        cursor = self.cursor(self.middle - room / 2, top, room, _SENTENCE)
        if head.sentence:
            self._write_sentence(cursor)
        if head.controls:
            row = HintRow(head.controls, (0, 0), size=TEXT)
            left = self.middle - row.width(canvas) / 2
            cursor.gap(6)
            self._place(replace(row, position=(left, cursor.y + TEXT)))
            cursor.gap(LEADING * TEXT)
        if head.help:
            cursor.gap(12)
            self.help_line = cursor.y + SMALL
            first, *others = head.help.boxes(canvas, self.middle, self.help_line).values()
            keys = canvas.text_width(head.keys, size=SMALL, weight="medium")  # which stand before the words
            self.boxes.append(first.move(-keys, 0).unionall([first, *others]))
            if self.drawn:
                head.help.draw(canvas, self.middle, self.help_line, head.means, head.keys)
            cursor.gap(LEADING * SMALL + 6)
        return cursor.y

    def _write_sentence(self, cursor: Cursor) -> None:
        head, canvas = self.head, self.canvas
        colour = canvas.palette.warn if head.warns else INK
        top, width = cursor.y, min(cursor.measured(head.sentence), cursor.width)
        cursor.styled(head.sentence, colour=colour, align="centre")
        left = cursor.left + (cursor.width - width) / 2 - 26
        self.boxes.append(pygame.FRect(left, top, width + 26, cursor.y - top))
        if self.drawn and head.lamp:
            lamp: Lamp = ("triangle", colour, 0.5) if head.warns else head.lamp
            shape, tint, glow = lamp
            spot = (left + 8, top + 0.68 * _SENTENCE)
            canvas.glow(spot, 16, tint, glow)
            canvas.marker(shape, spot, 8 if shape == "circle" else 11, tint)


def head_of(flown: FlownFlight, hints: Sequence[Hint], *, whole: bool) -> Head:
    """Return the words of a flight: all while there is time to read, which `whole` says, or the sentence."""
    flight, controls, words = flown.flight, flown.context.controls, flown.challenge.words(flown)
    free, said = flown.challenge.rules.free, words.sentence
    waits, lamp = flown.waiting and not flight.over, flown.interventions.lamp(flight)
    starry = flown.scenery.starry
    helps = flown.help_words if flown.helps and not flight.over else None
    means, chosen = partial(_means, flown), " ".join(map(controls.word, (Command.SLOWER, Command.FASTER)))
    if not (waits or whole or flight.over):
        usual = sentence(flight, flown.credit, flown.interventions.word, controls)
        sentence_now, warns = (said, False) if said else usual
        shown = helps if flown.help_words.shown else None
        panel = flown.copilot_panel.box(flown.context.reading()) if flown.panel_stands else None
        caption = words.line if words.next else ""  # how far the tutorial is
        return Head(
            sentence_now,
            warns,
            lamp,
            caption,
            hints=hints,
            help=shown,
            keys=chosen,
            means=means,
            panel=panel,
            starry=starry,
        )
    if flown.ending.shown and not whole:
        return Head(hints=hints, starry=starry)
    caption, name = words.title, words.line
    network = texts.WITH_NETWORK.format(network=titled(flown.network.name)) if whole and flight.chooser.network else ""
    if free:
        name = name or network
    elif network and flown.challenge.rules.elsewhere:
        caption = texts.DIAL_JOIN.join((caption, network))
    head = Head(said or "", caption=caption, name=name, aside=_asides(flown, words), hints=hints, starry=starry)
    if flight.over or not waits:
        return head
    opening = words.opening
    if flown.begun:
        opening = texts.TUTORIAL_LET_GO if flown.stuck else texts.WAITS_AGAIN
    keys = flight_hints(controls) if (opening or free) and said is None else []
    if flown.context.settings.one_switch:
        keys = keys[:1]  # the jets steer by themselves
    return replace(head, sentence=said or opening, lamp=lamp, controls=keys, help=helps, keys=chosen, means=means)


def _asides(flown: FlownFlight, words: Words) -> list[str]:
    flight, credit = flown.flight, flown.credit
    lines = [
        credit.header if credit.alone and not flight.over else "",
        credit.notice or words.goal,
        texts.GHOST_BESIDE.format(name=flown.ghost.name) if flown.ghost and words.goal and not flight.over else "",
        *surroundings(flight.env),
    ]
    return [line for line in lines if line]


def _means(flown: FlownFlight) -> str:
    """Say why a guardian goes by points of reward, where it does."""
    chooser = flown.flight.chooser
    problem = chooser.guard.ahead.problem if chooser.guard else texts.FUTURES_NOT_YET
    return texts.GUARDIAN_BY_VALUES.format(problem=problem) if chooser.shared and problem else ""
