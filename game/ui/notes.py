"""Notes: short messages over any screen, placed where they hide nothing to read or press."""

from __future__ import annotations

from itertools import product
from typing import Final

import pygame

from game.drawing.canvas import LEAST, Canvas
from game.drawing.prose import wrapped
from game.drawing.tokens import FAINT, INK, SMALL, VIEW_SIZE

_STEPS_SHOWN: Final = 60 * 5
_STEPS_FADING: Final = 20
_LONGEST: Final = round(150 / LEAST)  # characters; translations are longer than the English
_WIDEST: Final = VIEW_SIZE[0] - 64.0  # points of a line; a longer message takes two
_HEIGHT: Final = 32  # of one line
_LINE: Final = 18  # from one to the next
_TOPS: Final = (68, 640, 104, 24, 600, 140, 560, 176, 520, 212, 480, 248, 440)  # where its top may be, the best first
_SHIFTS: Final = (0, -200, 200)  # horizontal shift, if there is no room in the middle
_PLACES: Final = tuple((VIEW_SIZE[0] / 2 + shift, top) for shift, top in product(_SHIFTS, _TOPS))
_COVER: Final = 0.96  # opacity of the panel, over any background


class Note:
    """Note that shows one message at a time, for five seconds.

    Attributes:
        text: the message that is shown, or was shown last.

    """

    def __init__(self) -> None:
        self.text = ""
        self._left = 0
        self._place = _PLACES[0]

    def show(self, text: str) -> None:
        """Show a message in place of the last one."""
        text = " ".join(text.split())
        if len(text) > _LONGEST:  # the end of a path or a reason matters most
            text = text[: _LONGEST // 3] + " … " + text[-_LONGEST * 2 // 3 :]
        self.text, self._left, self._place = text, _STEPS_SHOWN, _PLACES[0]

    def update(self, canvas: Canvas) -> None:
        """Advance by 1/60 s; move to where the note hides least of the last frame's words, widgets and panels."""
        self._left = max(0, self._left - 1)
        if not self._left:
            return
        covered = {place: self._covers(canvas, place) for place in _PLACES}
        if covered[self._place] > min(covered.values()):
            self._place = min(_PLACES, key=covered.__getitem__)

    def box(self, canvas: Canvas) -> pygame.FRect:
        """Return the note's panel, in points."""
        return self._box_at(canvas, self._place)

    def _box_at(self, canvas: Canvas, place: tuple[float, float]) -> pygame.FRect:
        lines = wrapped(canvas, self.text, SMALL, _WIDEST)
        width = max(canvas.text_width(line, size=SMALL) for line in lines) + 32
        view, high = canvas.view, _HEIGHT + _LINE * (len(lines) - 1)
        box = pygame.FRect(place[0] - width / 2, view.top + place[1], width, high)
        return box.clamp(view) if width < view.w else box

    def _covers(self, canvas: Canvas, at: tuple[float, float]) -> int:
        """Return the number of pixels of noted words, widgets and panels that a note at a place would hide."""
        place = canvas.rect(*self._box_at(canvas, at))
        return sum(place.clip(area).w * place.clip(area).h for area in canvas.words)

    def draw(self, canvas: Canvas) -> None:
        """Draw the message, if there is one."""
        if not self._left:
            return
        alpha = min(1.0, self._left / _STEPS_FADING)
        box = self.box(canvas)
        with canvas.unnoted():  # the note avoids the page, not itself
            canvas.panel(box, _COVER, alpha)
            canvas.outline(box, 8, FAINT, alpha=alpha)
            for number, line in enumerate(wrapped(canvas, self.text, SMALL, _WIDEST)):
                middle = (box.centerx, box.top + 20 + _LINE * number)
                canvas.text(line, middle, size=SMALL, colour=INK, align="centre", alpha=alpha)
