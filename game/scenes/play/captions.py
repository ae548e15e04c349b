"""Captions of a flight that is played: its title, and what its keys do."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Final

from game.core import texts
from game.flight.flight import Flight, StickHolder
from game.flight.handicap import OWN
from game.flight.networks import Network, titled
from game.input.controls import Command
from game.scenes.play.challenge import Challenge
from game.scenes.play.ladder import COUNT, rung_of
from game.ui.actions import Action, Run

IN_FLIGHT: Final = (Command.HANDOVER, Command.PAUSE)  # keys that are named while the craft flies, for the mouse


def title(flight: Flight, challenge: Challenge | None, network: Network, hands: str, *, whole: bool) -> tuple[str, str]:
    """Return the kind of a flight, and its name or who can take over; `whole` is for all that can be said of it."""
    if challenge:
        named = whole and flight.network and challenge.elsewhere
        flown = texts.WITH_NETWORK.format(network=titled(network.name)) if named else ""
        return texts.DIAL_JOIN.join(filter(None, (challenge.title, flown))), challenge.line
    helper = texts.WITH_NETWORK.format(network=titled(network.name)) if whole else ""  # Tab hands over: a key says so
    flown = helper if flight.network else texts.ALONE
    if hands != OWN:
        flown = texts.HANDICAPS.format(hands=texts.CHOICES_HANDS_WORDS[hands])
    rung = rung_of(flight)
    if rung is not None:
        return texts.LADDER_TITLE.format(number=rung + 1, count=COUNT), flown
    return texts.THREE_PADS if flight.recording.pads > 1 else texts.FREE_FLIGHT, flown


def opening(flight: Flight, challenge: Challenge | None, *, begun: bool, stuck: bool) -> str:
    """Return the words over a craft that waits: for the first touch, for the next one, or until all is let go."""
    if begun:
        return texts.TUTORIAL_LET_GO if stuck else texts.WAITS_AGAIN
    if challenge:
        return challenge.opening
    return texts.BEGIN if rung_of(flight) is None else texts.LADDER_BEGIN


def flight_actions(
    runs: Mapping[Command, Run],
    flight: Flight,
    challenge: Challenge | None,
    *,
    leaves: bool,
    named: Collection[Command],
) -> list[Action]:
    """Return what keys do in flight, with the hints that fit the moment.

    Args:
        runs: what each command does.
        flight: the flight.
        challenge: the challenge it belongs to, if any.
        leaves: whether Escape goes straight back.
        named: the keys that may be named.

    """
    hints = {Command.PAUSE: texts.HINT_LEAVE if leaves else texts.HINT_PAUSE, Command.RETRY: texts.HINT_RETRY}
    if not challenge:
        hints[Command.CHOICES] = texts.CHOICES_HINT
    elif not challenge.through:
        hints[Command.NEXT] = challenge.next_hint
    if flight.network and not flight.over:
        taken = flight.hand is StickHolder.NETWORK
        hints[Command.HANDOVER] = texts.HINT_TAKE_BACK if taken else texts.HINT_HAND_OVER
    return [Action(command, run, hints.get(command, "") if command in named else "") for command, run in runs.items()]


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
