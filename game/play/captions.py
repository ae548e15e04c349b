"""Captions of a flight that is played: its title, its controls, and key hints."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import pygame

from game.cockpit import hud
from game.cockpit.ladder_mark import draw_ladder
from game.cockpit.surroundings import draw_surroundings
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, MARGIN, NET, SMALL
from game.flight.flight import Flight, StickHolder
from game.flight.handicap import OWN
from game.flight.networks import Network, titled
from game.input.controls import Command, Controls
from game.play.challenge import Challenge
from game.play.ladder import COUNT, rung_of
from game.ui.actions import Action, Run
from game.ui.hints import Hint, HintRow, flight_hints
from game.world.camera import ClearArea

_KEYS_ROOM: Final = 352.0  # points, to the right of who flies
OPENING_FOOT: Final = 290.0  # row above which the words over a waiting craft would hide it
LOWER: Final = 420.0  # where they stand then
BELOW_OPENING: Final = ClearArea(head=196.0)  # keeps the waiting craft clear of the opening text


def draw_title(
    canvas: Canvas, flight: Flight, challenge: Challenge | None, network: Network, hands: str, notice: str
) -> None:
    """Draw the title of a challenge or of a free flight, and the reason if the flight will not count."""
    if challenge:
        flown = (
            texts.WITH_NETWORK.format(network=titled(network.name)) if flight.network and challenge.elsewhere else ""
        )
        small = texts.MISSION_FLOWN.format(mission=challenge.title, flown=flown) if flown else challenge.title
        hud.draw_corner(canvas, small, challenge.line, notice or challenge.goal)
    else:
        _draw_free_title(canvas, flight, network, hands, notice)
    draw_surroundings(canvas, flight.env)


def _draw_free_title(canvas: Canvas, flight: Flight, network: Network, hands: str, notice: str) -> None:
    flown = texts.WITH_NETWORK.format(network=titled(network.name)) if flight.network else texts.ALONE
    if hands != OWN:
        flown = texts.HANDICAPS.format(hands=texts.CHOICES_HANDS_WORDS[hands])
    title = texts.THREE_PADS if flight.recording.pads > 1 else texts.FREE_FLIGHT
    rung = rung_of(flight)
    if rung is not None:
        title = texts.LADDER_TITLE.format(number=rung + 1, count=COUNT)
        draw_ladder(canvas.at(-1, -1), MARGIN + canvas.text_width(title, size=SMALL) + 12, 38, rung)
    hud.draw_corner(canvas, title, flown, notice)


def opening(flight: Flight, challenge: Challenge | None, *, begun: bool, stuck: bool, check: bool) -> str:
    """Return the words over a craft that waits: for the first touch, for the next one, or until all is let go."""
    if begun:
        return texts.TUTORIAL_LET_GO if stuck else texts.WAITS_AGAIN
    if challenge:
        return challenge.opening
    if check:
        return texts.CHECK_BEGIN
    return texts.BEGIN if rung_of(flight) is None else texts.LADDER_BEGIN


def draw_opening(canvas: Canvas, controls: Controls, words: str, forecast: bool, top: float) -> None:
    """Draw words, the controls and the legend of the dotted paths while the craft hangs and waits."""
    paths = [(texts.PATH_YOURS, HUMAN)]
    if forecast:
        paths.append((texts.PATH_NETWORK, NET))
    hud.draw_opening(canvas, flight_hints(controls), words, paths, top)


def flight_actions(
    runs: Mapping[Command, Run], flight: Flight, challenge: Challenge | None, *, leaves: bool
) -> list[Action]:
    """Return what keys do in flight, with the hints that fit the moment.

    Args:
        runs: what each command does.
        flight: the flight.
        challenge: the challenge it belongs to, if any.
        leaves: whether Escape goes straight back.

    """
    hints = {Command.PAUSE: texts.HINT_LEAVE if leaves else texts.HINT_PAUSE, Command.RETRY: texts.HINT_RETRY}
    if not challenge:
        hints[Command.CHOICES] = texts.CHOICES_HINT
    elif challenge.next_hint:
        hints[Command.NEXT] = challenge.next_hint
    if flight.network and not flight.over:
        taken = flight.hand is StickHolder.NETWORK
        hints[Command.HANDOVER] = texts.HINT_TAKE_BACK if taken else texts.HINT_HAND_OVER
    return [Action(command, run, hints.get(command, "")) for command, run in runs.items()]


def flight_row(hints: list[Hint], view: pygame.FRect) -> HintRow:
    """Return the row of hints in the upper right corner of the view."""
    return HintRow(hints, (view.right - MARGIN, view.top + 42), from_right=True, room=_KEYS_ROOM)


def card_actions(
    go_on: Run, runs: Mapping[Command, Run], challenge: Challenge | None, *, good: bool, nearer: bool = False
) -> list[Action]:
    """Return the two actions that an outcome card names: to go on, and one of the others.

    `good` is for a landing; `nearer` is whether the next try begins nearer to the pad.
    """
    fixed = challenge is not None and challenge.fixed
    again, new = (challenge.again_hint, challenge.new_hint) if challenge else ("", "")
    first = (texts.CARD_FIRST_FIXED if fixed else texts.CARD_FIRST)[good]
    first = texts.LADDER_NEARER if nearer else first
    if good:
        other, hint, first = Command.RETRY, again or texts.HINT_AGAIN, new or first
    else:
        other, hint = (Command.PAUSE, texts.HINT_LEAVE) if fixed else (Command.NEXT, new or texts.HINT_NEW)
        first = again or first
    return [Action(Command.CONFIRM, go_on, first), Action(other, runs[other], hint)]
