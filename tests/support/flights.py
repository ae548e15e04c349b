"""Flights as tests fly them: to the end, by the scripted pilot."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any

from ai.flights.recording import Recording
from ai.lander.pilots import ScriptedPilot
from game.core.settings import Settings
from game.flight.choosers import Crew
from game.flight.credit import Credit
from game.flight.flight import Flight, begin
from game.flight.flight_file import Record
from game.flight.logbook import Records
from game.flight.outcomes import OutcomeCard, outcome_card
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from tests.support.driver import Driver

NOON = 1_700_000_000.0


def begun(seed: int, network: Any = None, spawn: str = "random", *, shares: bool = True, **start: Any) -> Flight[Crew]:
    """A flight that a person flies, from the start of that seed."""
    return begin(Recording(seed, spawn, **start), network, shares=shares)


def concluded(challenge: Any, flight: Flight[Crew], card: OutcomeCard | None = None, **card_with: Any) -> OutcomeCard:
    """The card of a flight that has ended and is flown as that challenge, with what it adds."""
    card = card or replace(outcome_card(flight.env), **card_with)
    rest = {"keep": lambda *_: None, "context": SimpleNamespace(apply_settings=lambda: None)}
    flown = SimpleNamespace(flight=flight, credit=Credit(flight, Settings(), challenge.rules), **rest)
    challenge.ended(flown)
    if add := challenge.words(flown).card:
        add(card)
    return card


def actions(flight: Any) -> list[int]:
    """What was pushed in every step of a flight, or of a record."""
    return [push.action for push in flight.recording.pushes]


def fly_out(flight: Flight) -> Flight:
    """Let a flight go on to its end with nothing pressed."""
    while not flight.over:
        flight.step()
    return flight


def scripted(seed: int = 3, *, by_hand: int = 0, pads: int = 1, mission: str = "") -> Flight:
    """The scripted pilot's flight to its end, after the person has coasted for so many steps."""
    flight = begun(seed, ScriptedPilot(), pads=pads, mission=mission)
    for _ in range(by_hand):
        flight.step()
    flight.chooser.hand_over()
    return fly_out(flight)


@cache
def landed() -> Flight:
    """A landing of the scripted pilot, flown once: for tests that keep it or look at it, and change nothing."""
    return scripted()


def kept(context: Context, flight: Flight, when: float = NOON, **more: object) -> Record:
    """The record of a flight, written into the player's folder and read again."""
    records = Records(context.user_dir)
    return records.read(records.keep(flight, when, **more).file)


def challenge_of(driver: Driver) -> Any:
    """What the flight on the screen is flown as."""
    return play(driver).challenge


def play(driver: Driver) -> PlayScene:
    """The flight that is on the screen."""
    assert isinstance(driver.top, PlayScene)
    return driver.top
