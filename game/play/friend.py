"""A friend's flight: how it comes into the game, its page, and what comes of checking its claim."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Final

import pygame

from ai.flights.recording import SharedFlight
from ai.flights.verification import is_true
from game.cockpit import hud
from game.core import texts
from game.core.scene import Push, Scene, push
from game.drawing.canvas import Canvas
from game.drawing.tokens import MARGIN, MUTE, TEXT
from game.flight import sharing
from game.flight.replay import FlightReplay
from game.ui.clipboard import pasted
from game.ui.context import Context
from game.world.camera import ClearArea

BELOW_CLAIM: Final = ClearArea(head=262.0)  # keeps the world clear of what comes of the check
_ROW: Final = 236.0  # baseline of that, under the sentence on where the chance fell
_CONTROL: Final = pygame.KMOD_CTRL | pygame.KMOD_META


def arrival(event: pygame.event.Event, scene: Scene, context: Context) -> Push | None:
    """Return the way to the page of a flight that is dropped on the window or pasted; None for all other events.

    Tells the player why a flight is refused. A text that is typed takes what is pasted, and a scene that takes files
    of its own keeps those which are no flights.
    """
    if event.type == pygame.DROPTEXT:
        return _page_of_text(context, str(event.text))
    if event.type == pygame.DROPFILE:
        path = Path(event.file)
        try:
            return _page(sharing.flight_in_file(path))
        except ValueError as error:
            if not scene.takes_files:
                context.note(texts.CODE_FILE_REFUSED.format(name=path.name, reason=error))
    elif event.type == pygame.KEYDOWN and event.key == pygame.K_v and getattr(event, "mod", 0) & _CONTROL:
        return None if scene.typing else paste(context)
    return None


def paste(context: Context) -> Push | None:
    """Return the way to the page of the flight in the clipboard; if there is none, tell the player why."""
    if text := pasted().strip():
        return _page_of_text(context, text)
    context.note(texts.CODE_PASTE_EMPTY)
    return None


def _page_of_text(context: Context, text: str) -> Push | None:
    try:
        return _page(sharing.flight_in(text))
    except ValueError as error:
        context.note(texts.CODE_PASTE_REFUSED.format(reason=error))
    return None


def _page(flight: SharedFlight) -> Push:
    return push("replay", sharing.record_of(flight, time.time()), flight)


class Claimed:
    """A friend's claim, checked by the replay that flies it again, a few steps in every frame.

    Attributes:
        line: where it was flown, and what is claimed.

    """

    def __init__(self, flight: SharedFlight, flight_replay: FlightReplay) -> None:
        self.flight, self._flight_replay = flight, flight_replay
        claim = sharing.words(flight.claim)
        self.line = texts.FRIEND_LINE.format(where=sharing.where(flight), claim=claim)

    @property
    def true(self) -> bool | None:
        """Whether the claim is true; None until the flight is flown to its end."""
        real = self._flight_replay.earned
        return None if real is None else is_true(self.flight, real)

    @property
    def words(self) -> str:
        """How far the check is, or its result."""
        real = self._flight_replay.earned
        if real is None:
            percent = 100 * self._flight_replay.reached // max(1, self._flight_replay.length)
            return texts.FRIEND_CHECKING.format(percent=percent)
        if self.true:
            return texts.FRIEND_TRUE
        why = sharing.why_wrong(self.flight, real)
        return texts.FRIEND_WRONG.format(earned=sharing.words(real), why=why)

    def draw(self, canvas: Canvas) -> None:
        """Draw the claim in the corner, and what comes of checking it below the words of the replay."""
        hud.draw_corner(canvas, texts.FRIEND_TITLE, self.line)
        canvas = canvas.at(0, -1)
        true, left = self.true, MARGIN
        colour = MUTE if true is None else canvas.palette.good if true else canvas.palette.warn
        if true is not None:
            canvas.marker("check" if true else "cross", (left + 6, _ROW - 5), 11, colour)
            left += 20
        canvas.text(self.words, (left, _ROW), size=TEXT, colour=colour)
