"""Notes of everything that is written on the screen, on sheets that are painted once as well, with its place."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import pygame

from game.drawing import typeface
from game.drawing.canvas import PAGE, Canvas
from game.drawing.tokens import TEXT, TITLE

if TYPE_CHECKING:  # benchmarks do without it
    import pytest

# A capital's height and what hangs below the line, in sizes of the type: where ink is.
ABOVE, BELOW = 0.72, 0.2
_SEEN = 0.05  # alpha from which something is seen
_EXACT = 1.06  # letters have whole pixels, so a text that was fitted may still be a little wider than its room


@dataclass
class Note:
    """A text, the box of its ink in points, and the width and the box that it must keep to."""

    text: str
    box: pygame.FRect
    room: float = math.inf
    within: pygame.FRect = field(default_factory=PAGE.copy)
    code: bool = False  # whether it is a piece of our own code, which is the same in every language


@dataclass
class Page:
    """What stands on one canvas."""

    notes: list[Note] = field(default_factory=list)
    panels: list[pygame.FRect] = field(default_factory=list)


def words_written(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return a list to which every text is added that is drawn from now on."""
    words: list[str] = []
    text = Canvas.text

    def noted(canvas: Canvas, string: str, *more: Any, **options: Any) -> pygame.FRect:
        words.append(string)
        return text(canvas, string, *more, **options)

    monkeypatch.setattr(Canvas, "text", noted)
    return words


class Written:
    """Takes notes of every canvas, from now on; `patch` sets an attribute, as `setattr` does."""

    def __init__(self, patch: Callable[[object, str, object], None]) -> None:
        # A canvas is kept beside its page: another one could be given its number once it is gone.
        self._pages: dict[int, tuple[Canvas, Page]] = {}
        text, panel, sheet, lay = Canvas.text, Canvas.panel, Canvas.sheet, Canvas.lay

        def noted_text(canvas: Canvas, string: str, position: tuple[float, float], **more: Any) -> pygame.FRect:
            box = text(canvas, string, position, **more)
            if string.strip() and more.get("alpha", 1.0) > _SEEN:
                code = more.get("weight") == "code"
                size = box.height * TEXT / sum(typeface.extent(TEXT, "regular"))
                top, height = position[1] - ABOVE * size, ABOVE * size + BELOW * min(size, TITLE)
                ink = seen(canvas, pygame.FRect(box.x, top, box.width, height))
                if ink.height > 1:
                    room = more.get("room", math.inf) * canvas.scale / canvas.whole.scale
                    self.page(canvas).notes.append(
                        Note(string, on_whole(canvas, ink), room, canvas.whole.view.copy(), code)
                    )
            return box

        def noted_panel(canvas: Canvas, rect: pygame.typing.RectLike, *more: Any) -> None:
            panel(canvas, rect, *more)
            self.page(canvas).panels.append(on_whole(canvas, pygame.FRect(rect)))

        def noted_sheet(canvas: Canvas, *given: Any) -> Canvas:
            made = sheet(canvas, *given)
            self.turn(made)
            return made

        def noted_lay(canvas: Canvas, laid: Canvas, x: float, y: float) -> None:
            lay(canvas, laid, x, y)
            page, size = self.page(canvas), (laid.size[0] / laid.scale, laid.size[1] / laid.scale)
            for note in self.page(laid).notes:
                within = pygame.FRect((0, 0), size) if note.within == laid.view else note.within
                if (ink := seen(canvas, note.box.move(x, y))).height > 1:
                    box, within = on_whole(canvas, ink), on_whole(canvas, within.move(x, y))
                    room = note.room * canvas.scale / canvas.whole.scale  # as the box, in the whole window's points
                    page.notes.append(replace(note, box=box, room=room, within=within))
            page.panels += [on_whole(canvas, each.move(x, y)) for each in self.page(laid).panels]

        for name, method in (("text", noted_text), ("panel", noted_panel), ("sheet", noted_sheet), ("lay", noted_lay)):
            patch(Canvas, name, method)

    def page(self, canvas: Canvas) -> Page:
        """Return what stands on a canvas, or on the one of which it is the page."""
        whole = canvas.whole
        return self._pages.setdefault(id(whole), (whole, Page()))[1]

    def turn(self, canvas: Canvas) -> Page:
        """Forget what stands on a canvas, and return the empty page."""
        self._pages[id(canvas)] = canvas, Page()
        return self.page(canvas)


def seen(canvas: Canvas, box: pygame.FRect) -> pygame.FRect:
    """Return as much of a box as is not scrolled away."""
    clip = canvas.surface.get_clip()
    left, top = canvas.points(clip.topleft)
    return box.clip(pygame.FRect(left, top, clip.width / canvas.scale, clip.height / canvas.scale))


def on_whole(canvas: Canvas, box: pygame.FRect) -> pygame.FRect:
    """Return a box in the points of the whole window's canvas; where text flows, a point has another size."""
    if canvas.whole is canvas:
        return box
    (left, top), share = canvas.whole.points(canvas.pixels(box.topleft)), canvas.scale / canvas.whole.scale
    return pygame.FRect(left, top, box.width * share, box.height * share)


def misplaced(page: Page, view: pygame.FRect = PAGE) -> Iterator[tuple[str, str]]:
    """Yield each text that leaves its place or meets another, and where it goes."""
    for number, note in enumerate(page.notes):
        ends = note.box.midleft, note.box.midright
        around = [panel for panel in page.panels if any(map(panel.collidepoint, ends))]
        if note.within == view and not view.contains(note.box):
            yield note.text, "leaves the view"
        elif not note.within.inflate(2, 2).contains(note.box):
            yield note.text, "is cut off"
        elif around and not any(panel.inflate(2, 2).contains(note.box) for panel in around):
            yield note.text, "leaves its panel"
        if note.box.width > _EXACT * note.room + 1:
            yield note.text, f"is wider than its room of {note.room:.0f} points"
        if note.text.endswith("…"):
            yield note.text, "is cut short"
        for other in page.notes[number + 1 :]:
            if other.text != note.text and note.box.inflate(-2, -2).colliderect(other.box.inflate(-2, -2)):
                yield note.text, f"meets {other.text}"
