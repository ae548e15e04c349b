"""Foot of the panel of knobs: a refused value, a question that waits, or the help of the knob in focus."""

from __future__ import annotations

from typing import Final

import pygame

from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import HUMAN, INK, LABEL, MUTE, SMALL
from game.input.controls import Command, Controls
from game.panels.knob import Knob
from game.panels.knob_page import draw_advice
from game.panels.seed_knob import SeedKnob
from game.training.knob_descriptions import figure, label
from game.training.run_settings import RunSettings
from game.ui.hints import Hint, HintRow
from game.ui.widget import Widget

HEIGHT: Final = 60  # points, at the bottom of the panel
TALL: Final = 124  # where there is more to say about a knob
ANSWERS: Final = 42  # from the bottom to the top of a notice's buttons
_ABOVE: Final = 40.0  # extra height for a longer text
_NOTICE: Final = 50.0  # from the bottom to the top of a notice
_EXPLAINED: Final = 78.0  # height of the text above it, from the first baseline


def draw_foot(
    canvas: Canvas,
    box: pygame.Rect,
    run_settings: RunSettings,
    focused: Widget | None,
    controls: Controls,
    *,
    picking: bool,
    room: pygame.Rect | None = None,
) -> None:
    """Draw the most important message into the panel's box; `focused` is the panel's widget in focus.

    `room` is the box, from its first baseline to its last, for all that there is to say about a knob.
    """
    first = box.bottom - HEIGHT + 22.0
    if run_settings.problem:
        canvas.marker("triangle", (box.left + 5, first - 4), 10, canvas.palette.warn)
        place = box.left + 18, first
        draw_wrapped(canvas, run_settings.problem, place, box.width - 18, colour=canvas.palette.warn)
    elif run_settings.waiting:
        if picking:
            told = (focused and focused.help) or "\n".join(
                run_settings.run_kind.sabotages.get(run_settings.named[1], ("",))[1:]
            )
            _write_parts(canvas, told, (box.left, box.bottom - _NOTICE - _EXPLAINED), box.width)
        heading = texts.KNOBS_STARTS_ANEW
        if run_settings.named != run_settings.holds:
            heading = texts.KNOBS_STARTS_ANEW_AS.format(name=run_settings.run_kind.word(run_settings.named))
        _draw_notice(canvas, box, heading, _listed(run_settings.waiting))
    elif run_settings.put_aside:
        line = texts.KNOBS_PUT_ASIDE_LINE.format(name=run_settings.run_kind.word(run_settings.named))
        _draw_notice(canvas, box, texts.KNOBS_PUT_ASIDE, line)
    else:
        told = (focused and focused.help) or run_settings.run_kind.sentence(run_settings.named)
        if room is not None and isinstance(focused, Knob):
            draw_advice(canvas, focused.description, told, room)
        else:
            start = room.topleft if room else (box.left, first - (_ABOVE if picking else 0.0))
            _write_parts(canvas, told, start, box.width)
        if isinstance(focused, Knob | SeedKnob):
            _draw_marks(canvas, box, focused, controls)


def _draw_notice(canvas: Canvas, box: pygame.Rect, heading: str, line: str) -> None:
    canvas.outline((box.left, box.bottom - 50, box.width, 46), 8, HUMAN, 1, 0.35)
    canvas.text(heading, (box.left + 14, box.bottom - 31), size=SMALL, colour=HUMAN)
    canvas.text(line, (box.left + 14, box.bottom - 14), size=SMALL, colour=INK)


def _write_parts(canvas: Canvas, told: str, start: tuple[float, float], width: float) -> None:
    """Write paragraphs: a muted explanation, and measurements below it."""
    x, y = start
    for number, part in enumerate(told.split("\n")):
        y = draw_wrapped(canvas, part, (x, y), width, colour=INK if number else MUTE) + 6


def _draw_marks(canvas: Canvas, box: pygame.Rect, widget: Knob | SeedKnob, controls: Controls) -> None:
    """Say whether the knob takes a new run, and how to restore the preset's value."""
    baseline = box.bottom - 4
    if not widget.live:
        canvas.marker("ring", (box.left + 4, baseline - 4), 8, MUTE)
        canvas.text(texts.KNOBS_NEW_RUN, (box.left + 14, baseline), size=LABEL, colour=MUTE)
    if isinstance(widget, Knob) and widget.changed:
        key = texts.KNOBS_CLICK if controls.mouse_in_use else controls.word(Command.RETRY)
        back = texts.KNOBS_BACK_TO.format(value=figure(widget.home))
        HintRow([Hint(key, back)], (box.right, baseline), from_right=True, size=LABEL).draw(canvas)


def _listed(names: list[str]) -> str:
    """List the knobs that wait, as many as there is room for."""
    labels = list(dict.fromkeys(label(name.split(".")[0]) for name in names))
    return ", ".join(labels) if len(labels) < 3 else texts.KNOBS_MORE.format(first=labels[0], count=len(labels) - 1)
