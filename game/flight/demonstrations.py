"""Demonstrations for a network: the player's own good landings, from where they took the stick."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path
from typing import Final

from ai.files import take
from ai.flights.recording import AS_IT_IS
from ai.flights.verification import landing_score
from game.flight.flight import Flight, StickHolder

FILE_NAME: Final = "demonstrations.json"
_LEAST_STEPS: Final = 60  # flown by hand to the end, to count as a takeover
_LEAST_SCORE: Final = 60  # score before the pad's factor


def add_demonstration(flight: Flight, folder: Path) -> bool:
    """Add a flight that is over to the player's demonstrations; false if it does not qualify.

    Raises OSError or ValueError if the file can't be read or written; it is then left unchanged.
    """
    from ai.training.demonstrations import Demonstration, read, takeover, write

    env, recording = flight.env, flight.recording
    pad = int(env.landed_on[0])
    if recording.shares or recording.easing != AS_IT_IS:  # not what a network's six actions can repeat, or its own pad
        return False
    if pad < 0 or landing_score(env) < _LEAST_SCORE * env.ground.pads[pad].factor:
        return False
    begins = takeover([hand is StickHolder.HUMAN for hand in recording.hands])
    if len(recording.hands) - begins < _LEAST_STEPS:
        return False
    ground = recording.seed if recording.pads > 1 else None
    lesson = Demonstration(recording.seed, tuple(recording.actions), recording.spawn, begins, ground, pad)
    with take(folder / f".{FILE_NAME}.lock", 1.0) or nullcontext():  # another window may add to it as well
        write(folder / FILE_NAME, [*read(folder / FILE_NAME), lesson])
    return True


def count_demonstrations(folder: Path) -> int:
    """Return the number of the player's demonstrations; 0 if the file can't be read."""
    from ai.training.demonstrations import read

    try:
        return len(read(folder / FILE_NAME))
    except (OSError, ValueError):
        return 0
