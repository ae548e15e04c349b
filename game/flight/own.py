"""Pilots of the player's own in the game: measured beside those that come with it, in a worker."""

from __future__ import annotations

import time
from collections.abc import Generator
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ai.files import brief
from ai.lander.environment import LanderEnv, Outcome
from ai.lander.pilots import Pilot
from ai.lander.rules import Cause
from ai.pilots.own import MeasuredPilot, OwnPilot
from ai.pilots.shelf import Measured, Shelf
from ai.training.tasks import Evaluation, flown
from game.core import texts
from game.flight import networks
from game.flight.flight_file import Entry

if TYPE_CHECKING:
    from game.ui.context import Context

STARTS: Final = 1000
GOOD: Final = 0.9  # share of them that a pilot who can fly lands
_SEED: Final = 2_000_003  # of the starts that all are measured from
RIVALS: Final = ("modern", "classic", networks.SCRIPTED)
_LONGEST: Final = 90  # characters of a problem
_MARK: Final = "/"  # before a rival's name: no file's name has it


def take(context: Context, path: Path | None) -> None:
    """Let a file be the player's pilot from now on, as they have chosen it by name; or none."""
    if context.pilot:
        context.pilot.close()
    context.pilot = OwnPilot(path) if path else None


def flying(context: Context) -> networks.Network | None:
    """Return the player's own pilot where it was the last that they chose, and say once what is wrong with it."""
    pilot = context.pilot
    if pilot is None or not pilot.chosen:
        return None
    pilot.look()
    if (words := wrong(pilot)) != pilot.reported:
        pilot.reported = words
        if words:
            context.note(words)
    return networks.Network(pilot.path.name, pilot)


def wrong(pilot: OwnPilot) -> str:
    """Say what is wrong with the file as it was saved last, and whether the last good one flies on; or nothing."""
    if not pilot.problem:
        return ""
    words = texts.PILOTS_FLIES_ON if pilot.flies_on else texts.PILOTS_WRONG
    return words.format(name=pilot.path.name, problem=brief(pilot.problem, _LONGEST))


def measure(user_dir: Path, models_dir: Path, path: Path) -> Generator[list[Any], None, None]:
    """Measure a file's pilot, then those rivals that never were, and write it down; a generator for a worker.

    Yields lists of messages: how much of it all is over, 0 to 1, and each `Measured`. Raises PilotError for what is
    wrong with the file, OSError for what cannot be written.
    """
    shelf, policies = Shelf(user_dir), networks.Policies(models_dir, user_dir)
    known = {each.name for each in shelf.measured()}
    others = [name for name in RIVALS if _MARK + name not in known and name in policies.names]
    part = 1 / (1 + len(others))
    with closing(MeasuredPilot(path)) as own:
        yield from _measured(shelf, path.stem, own, 0.0, part)
    for number, name in enumerate(others, 1):
        if policy := policies[name].policy:
            yield from _measured(shelf, _MARK + name, policy, number * part, part)


def rivals(measured: list[Measured]) -> dict[str, Measured]:
    """Return the latest measurements of the rivals, by their names."""
    return {each.name.removeprefix(_MARK): each for each in measured if each.name.startswith(_MARK)}


def own(measured: list[Measured]) -> list[Measured]:
    """Return the measurements of the player's own pilots, the latest first."""
    return [each for each in reversed(measured) if not each.name.startswith(_MARK)]


def by_hand(entries: list[Entry]) -> tuple[Measured, int] | None:
    """Return how the player's own free flights came out, and of how many; None before the first."""
    flown = [entry for entry in entries if entry.alone and not entry.course][-STARTS:]
    landings = [entry for entry in flown if entry.outcome == Outcome.LANDED.name]
    if not flown:
        return None
    many = max(1, len(landings))
    seconds, fuel = (sum(getattr(entry, name) for entry in landings) / many for name in ("seconds", "fuel"))
    return Measured("", len(landings) / len(flown), seconds, fuel), len(flown)


def _measured(shelf: Shelf, name: str, pilot: Pilot, begun: float, part: float) -> Generator[list[Any], None, None]:
    """Measure one pilot, whose flights are that part of all, after what was over before."""
    env = LanderEnv(STARTS, _SEED)
    env.reset()
    began, trial = time.time(), flown(pilot, env)
    score: Evaluation | None = None
    while score is None:
        try:
            next(trial)
            yield [begun + part * float(env.time.max()) / env.limits.time]  # the last flights take their time
        except StopIteration as done:
            score = Evaluation.of(done.value)
    crashed = np.bincount(env.cause[env.outcome == Outcome.CRASHED], minlength=len(Cause))[1:]
    others = [(env.outcome == outcome).sum() for outcome in (Outcome.OUT_OF_BOUNDS, Outcome.TIMED_OUT)]
    lost = tuple(int(count) for count in (*crashed, *others))
    result = Measured(name, score.success, score.mean_time or 0.0, score.mean_fuel or 0.0, round(began, 3), lost)
    shelf.keep(result)
    yield [begun + part, result]
