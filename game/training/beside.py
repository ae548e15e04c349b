"""Earlier runs that are shown beside the current one."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count

import numpy as np

from ai.training.history import History


@dataclass(frozen=True)
class EarlierRun:
    """Earlier run shown beside the current one; its line style stays the same as others come and go."""

    name: str
    run: History
    style: int  # number for game.ui.curves.run_style; 0 is the current run's


def put_beside(runs: list[EarlierRun], name: str, run: History) -> None:
    """Add an earlier run, in place of one of its name, with the first line style that is free.

    One that has no curve yet, as no flight has ended, is left out.
    """
    if not np.isfinite(run["success" if "success" in run.columns else "loss"]).any():
        return
    run.checkpoints.clear()  # only its curves are shown, and there may be many such runs
    runs[:] = [each for each in runs if each.name != name]
    taken = {each.style for each in runs}
    runs.insert(0, EarlierRun(name, run, next(style for style in count(1) if style not in taken)))


def take_away(runs: list[EarlierRun], style: int) -> None:
    """Take away the earlier run of a line style; the others keep theirs."""
    runs[:] = [each for each in runs if each.style != style]
