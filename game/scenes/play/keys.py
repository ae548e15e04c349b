"""What the keys of a flight that is played do, with the hints that fit the moment."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Final

import pygame

from game.core import texts
from game.flight.flight import StickHolder
from game.input.controls import Command
from game.scenes.play.free import rung_of
from game.ui.actions import Action, Run

if TYPE_CHECKING:
    from game.scenes.play.scene import PlayScene

_IN_FLIGHT: Final = (Command.HANDOVER, Command.PAUSE)  # keys that are named while the craft flies, for the mouse


def flight_actions(scene: PlayScene) -> list[Action]:
    """Return what keys do in flight."""
    words, flight = scene.words, scene.flight
    taken = flight.chooser.hand is StickHolder.NETWORK
    hints = {
        Command.HANDOVER: texts.HINT_TAKE_BACK if taken else texts.HINT_HAND_OVER,
        Command.NEXT: words.next,
        Command.RETRY: texts.HINT_RETRY if scene.flown.begun else "",
        Command.PAUSE: scene.leave_word,
    }
    if flight.over or not flight.chooser.network:
        hints[Command.HANDOVER] = ""
    named: Iterable[Command] = hints if scene.waiting else ()
    if not (scene.waiting or flight.over) and scene.context.controls.mouse_in_use:
        named = _IN_FLIGHT
    table = [Action(command, run, hints[command] if command in named else "") for command, run in scene.runs.items()]
    asks = named is _IN_FLIGHT or (scene.waiting and not words.next)
    thinks = texts.HINT_THINKS if asks and flight.chooser.network and not taken else ""
    shows = Action(pygame.K_F1, scene.show_thinking, thinks, Command.MODE)
    mode = scene.context.controls.keys.codes(Command.MODE)  # its button is that of F1
    return [*table, shows, *(Action(code, scene.show_thinking) for code in mode)]


def card_actions(scene: PlayScene, go_on: Run) -> list[Action]:
    """Return the two actions that an outcome card names: to go on, and one of the others."""
    card, rules = scene.ending.card, scene.challenge.rules
    assert card is not None
    first = (texts.CARD_FIRST_FIXED if rules.fixed else texts.CARD_FIRST)[card.good]
    if rules.free and scene.context.settings.rung < (rung_of(scene.flight) or 0):
        first = texts.LADDER_NEARER
    if card.good:
        first = texts.MISSION_NEXT if rules.following else first
        other, hint = Command.RETRY, texts.HINT_AGAIN
    else:
        other, hint = (Command.PAUSE, texts.HINT_LEAVE) if rules.fixed else (Command.NEXT, texts.HINT_NEW)
    return [Action(Command.CONFIRM, go_on, first), Action(other, scene.runs[other], hint)]
