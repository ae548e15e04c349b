"""The classes of all scenes, and a player's folder in which there is something to be seen."""

from __future__ import annotations

import importlib
import pkgutil
import time
from functools import cache
from inspect import isabstract, isclass
from shutil import copytree

import game.scenes
from ai.lander.pilots import ScriptedPilot
from game.core.scene import Scene
from game.flight.days import Attempt, Days
from game.flight.flight import Flight
from game.flight.logbook import Records
from game.ui.context import Context
from tests.support.flights import begun

FLIGHTS = 2


def scene_types() -> list[type[Scene]]:
    """Return the classes of all scenes there are, in the modules of `game.scenes`."""
    found = []
    for module in pkgutil.walk_packages(game.scenes.__path__, "game.scenes."):
        for each in vars(importlib.import_module(module.name)).values():
            here = isclass(each) and each.__module__ == module.name
            if here and not each.__name__.startswith("_") and issubclass(each, Scene) and not isabstract(each):
                found.append(each)
    return found


def stock(context: Context) -> None:
    """Put a few flights and a network of their own into the player's folder, as far as they are not there."""
    records = Records(context.user_dir)
    if not (days := Days(context.user_dir)).attempts:
        days.note(Attempt("2026-11-22", "LANDED", 84))
        days.note(Attempt("2026-11-20", "CRASHED"))
        days.note(Attempt("2026-11-17"))
    for seed in range(FLIGHTS - len(records.kept())):
        records.keep(flown(seed), time.time(), alone=True)
    own = context.user_dir / "models" / "mine"
    if not own.exists():
        copytree(context.models_dir / "lander" / "modern", own)


@cache
def flown(seed: int) -> Flight:
    """The scripted pilot's flight, flown once: nobody changes it."""
    flight = begun(seed, ScriptedPilot())
    flight.chooser.hand_over()
    while not flight.over:
        flight.step()
    return flight
