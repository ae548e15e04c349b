"""Flights between friends: how one gets out of the clipboard or a file into the game."""

from __future__ import annotations

import time
from pathlib import Path

import pygame

from ai.flights.recording import ClaimedFlight
from game.core import texts
from game.core.scene import Push, Scene, push
from game.flight import codes
from game.input.controls import copies_or_pastes
from game.ui.clipboard import pasted
from game.ui.context import Context


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
            return _page(codes.flight_in_file(path))
        except ValueError as error:
            if not scene.takes_files:
                context.note(texts.CODE_FILE_REFUSED.format(name=path.name, reason=error))
    elif copies_or_pastes(event) == "v":
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
        return _page(codes.flight_in(text))
    except ValueError as error:
        context.note(texts.CODE_PASTE_REFUSED.format(reason=error))
    return None


def _page(flight: ClaimedFlight) -> Push:
    return push("replay", codes.record_of(flight, time.time()), flight)
