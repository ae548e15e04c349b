"""Pilots of the player's own in the game, and how one is measured in a worker."""

from __future__ import annotations

import time
from collections.abc import Generator
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ai.files.reading import brief
from ai.lander.environment import LanderEnv
from ai.pilots.folder import Measured, PilotFolder
from ai.pilots.own import MeasuredPilot, OwnPilot
from ai.training.tasks import flown
from game.core import texts
from game.flight import networks

if TYPE_CHECKING:
    from game.ui.context import Context

STARTS: Final = 1000
GOOD: Final = 0.9  # share of them that a pilot who can fly lands
_SEED: Final = 2_000_003  # of the starts that all are measured from
_LONGEST: Final = 90  # characters of a problem


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


def measure(user_dir: Path, path: Path) -> Generator[list[Any], None, None]:
    """Measure a file's pilot, and write it down; a generator for a worker.

    Yields lists of messages: how much of it is over, 0 to 1. Raises PilotError for what is wrong with the file, OSError
    for what cannot be written.
    """
    began, env = time.time(), LanderEnv(STARTS, _SEED)
    env.reset()
    with closing(MeasuredPilot(path)) as pilot:
        trial, score = flown(pilot, env), None
        while score is None:
            try:
                next(trial)
                yield [float(env.time.max()) / env.limits.time]  # the last flights take their time
            except StopIteration as done:
                score = done.value
    result = Measured(path.stem, score.success, score.mean_time or 0.0, score.mean_fuel or 0.0, round(began, 3))
    PilotFolder(user_dir).keep(result)
    yield [1.0]
