"""What came of an experiment beside its healthy twin, from the curves of both."""

from __future__ import annotations

from typing import Final, Literal, NamedTuple

import numpy as np

from ai.training.config import Config
from ai.training.hints import RULES, RecentCurves
from ai.training.history import History

Kind = Literal["as_well", "later", "never", "runs_away"]
KINDS: Final[tuple[Kind, ...]] = ("as_well", "later", "never", "runs_away")
LANDS: Final = 0.8  # share of a hundred flights from which a run counts as one that lands
_NEVER: Final = 0.3  # share below which it does not: near the pad, some land by chance
_GRACE: Final = 1.5  # times as long as the twin took, after which it is judged
_LATER: Final = 1.25  # times as long as the twin took, from which it came later
_WORSE: Final = 0.15  # of a share that is worse than the twin's by more than chance
_RUN_AWAY: Final = ("q_runs_away", "loss_explodes")  # rules of hints


class Flown(NamedTuple):
    """Curves of a run, and the configuration it was flown with."""

    history: History
    config: Config

    @property
    def turns(self) -> float:
        """Decisions of each lander so far."""
        return float(self.history["decisions"][-1]) / self.config.num_envs if len(self.history) else 0.0

    @property
    def landed(self) -> float:
        """Share of the last hundred flights that landed; 0 before any has ended."""
        return self.landed_at(-1)

    def landed_at(self, row: int) -> float:
        """Return that share at a row of the history."""
        return float(np.nan_to_num(self.history["success"][row])) if len(self.history) else 0.0

    def landed_after(self) -> float:
        """Decisions of each lander until a hundred flights landed as `LANDS` asks; infinite if they never did."""
        reached = np.flatnonzero(self.history["success"] >= LANDS)
        return float(self.history["decisions"][reached[0]]) / self.config.num_envs if len(reached) else float("inf")


def verdict(healthy: Flown, other: Flown, *, failed: bool = False) -> Kind | None:
    """Return what came of an experiment so far; None while it is too early to say, or its twin does not land either.

    `failed` says that its training has diverged. It has run away if its mean Q-value or its loss has: see the hints.
    """
    if failed or (len(other.history) and _has_run_away(other)):
        return "runs_away"
    needed = healthy.landed_after()
    if healthy.turns < _GRACE * needed:
        return None
    if np.nan_to_num(other.history["success"]).max(initial=0.0) < _NEVER:
        return "never"
    in_time = other.landed_after() <= _LATER * needed
    return "as_well" if in_time and other.landed >= healthy.landed - _WORSE else "later"


def judged_at(healthy: Flown, other: Flown) -> float:
    """Return the decisions from which an experiment is judged; infinite while its twin does not land."""
    return _GRACE * healthy.landed_after() * other.config.num_envs


def _has_run_away(flown: Flown) -> bool:
    run = RecentCurves(flown.history, flown.config)
    return any(rule.holds(run) for rule in RULES if rule.name in _RUN_AWAY)
