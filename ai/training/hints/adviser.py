"""Choice of the one hint to show.

It appears once its rule has held for a while, and then stays for a while: a hint that flickers cannot be read.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any, Final

from ai.training.config import Config, idle
from ai.training.hints.curves import COLLAPSE, RecentCurves
from ai.training.hints.rules import RULES, HintRule
from ai.training.history import History

HOLD: Final = 2.0  # seconds of training for which a rule must hold before its hint appears
STAY: Final = 6.0  # seconds for which a hint stays at least
REST: Final = 45.0  # seconds for which one that was applied or dismissed does not come back


@dataclass(frozen=True)
class Hint:
    """Hint at a fault, by the name of its rule.

    Attributes:
        remedy: values to try, by the name of a knob: a field of Config, or "reward_weights.time" for one of its
            parts.
        back_to: how many decisions the run had taken when it was at its best, if it should go back there.

    """

    name: str
    remedy: Mapping[str, Any] = field(default_factory=dict)
    back_to: int | None = None


class Adviser:
    """Adviser that chooses the one hint to show. Times are seconds of training, as the history counts them."""

    def __init__(self, config: Config) -> None:
        self.config = config
        self.reset()

    def reset(self) -> None:
        """Forget everything: another run begins."""
        self.shown: Hint | None = None
        self._now = self._shown_since = 0.0
        self._since: dict[str, float] = {}  # when each rule that holds began to
        self._rests: dict[str, float] = {}  # until when each is quiet
        self._before: dict[str, Any] | None = None  # what the last remedy has changed

    def advise(
        self,
        history: History,
        config: Config,
        dead_share: float | None = None,
        clipped_share: float | None = None,
    ) -> Hint | None:
        """Return what to show now, if anything; call it as often as there is news.

        Where known, `dead_share` is the share of hidden units that never come alive, and
        `clipped_share` that of the gradients which were cut short.
        """
        self.config = config
        if not len(history.points):
            return None
        now = float(history["seconds"][-1])
        if now < self._now:
            self.reset()
        self._now = now
        run = RecentCurves(history, config, dead_share, clipped_share)
        # Before that, curves are those of before a change, and it is not known yet what that has brought.
        settled = run.since_change() >= 100.0 * COLLAPSE  # flights
        holding = {rule.name: rule for rule in RULES if (settled or rule.of_settings) and rule.holds(run)}
        self._since = {name: self._since.get(name, now) for name in holding}
        if self.shown is not None and now - self._shown_since < STAY:
            return self.shown
        ripe = (
            rule for name, rule in holding.items()
            if now - self._since[name] >= HOLD and now >= self._rests.get(name, 0.0)
        )  # fmt: skip
        self._show(next(ripe, None), run)
        return self.shown

    def _show(self, rule: HintRule | None, run: RecentCurves) -> None:
        if rule is None:
            self.shown = None
            return
        if self.shown is None or self.shown.name != rule.name:
            self._shown_since = self._now
        idle_now = idle(run.config, *(int(run.last(name, 1)) for name in ("decisions", "episodes")))
        remedy = {
            name: value
            for name, value in rule.remedy(run).items()
            if value != attrgetter(name)(run.config) and name not in idle_now
        }
        self.shown = Hint(rule.name, remedy, rule.back_to(run))

    def apply(self, *, went_back: bool = False) -> Mapping[str, Any]:
        """Take the remedy of the hint that is shown: the values to set. The hint goes; `undo` has the way back.

        `went_back` says that a remedy was also to return to a checkpoint, which can be undone as well.
        """
        if self.shown is None:
            return {}
        remedy = self.shown.remedy
        self._before = {name: attrgetter(name)(self.config) for name in remedy} if remedy or went_back else None
        self.dismiss()
        return remedy

    @property
    def can_undo(self) -> bool:
        """Whether a remedy was applied that can be taken back."""
        return self._before is not None

    def undo(self) -> Mapping[str, Any]:
        """Return the values that the last remedy replaced, once."""
        before, self._before = self._before, None
        return before or {}

    def dismiss(self) -> None:
        """Put the hint away; it will not come back at once."""
        if self.shown is not None:
            self._rests[self.shown.name] = self._now + REST
            self.shown = None
