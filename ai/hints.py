"""Rules that look at the recent past of a training run and say what is visibly off, each with a remedy to try.

A rule is a row of `RULES`: a condition and a remedy. The words that a player reads for it belong to the game. An
`Adviser` keeps a hint from flickering: it appears once its rule has held for a while, and then stays for a while.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any, Final, NamedTuple

import numpy as np

from ai.config import Config
from ai.env import Doubles
from ai.history import History
from ai.lander import LIMITS
from ai.rewards import FEET_STEPS_PAID, RewardWeights

HOLD: Final = 2.0  # seconds of training for which a rule must hold before its hint appears
STAY: Final = 6.0  # seconds for which a hint stays at least
REST: Final = 45.0  # seconds for which one that was applied or dismissed does not come back

_FARTHEST: Final = 25.0  # metres from the pad, at the most
_FASTEST: Final = 10.0  # m/s that a lander may gain or lose in a flight
_FLIGHT: Final = 60.0 * LIMITS.time  # physics steps of the longest flight
_ENOUGH: Final = 150_000  # decisions after which the modern preset lands nearly always
_FLIGHTS: Final = 1_000  # flights after which a run with few landers should have learned something
_FAR_SPAWNS: Final = ("random", "hard", "highest")  # of which none begins near the pad
_SANE: Final = {"learning_rate": 2e-3, "final_learning_rate": 3e-4}
_PARTS: Final = ("distance", "speed", "alignment")  # of the reward, that say how close it is


@dataclass(frozen=True)
class Hint:
    """What is off, by the name of its rule.

    Attributes:
        remedy: values to try, by the name of a knob: a field of Config, or "weights.time" for a part of the reward.
        back_to: how many decisions the run had taken when it was at its best, if it should go back there.

    """

    name: str
    remedy: Mapping[str, Any] = field(default_factory=dict)
    back_to: int | None = None


class Recent:
    """A run's curves as the rules see them, with a few questions that several of them ask."""

    def __init__(
        self, history: History, config: Config, dead_share: float | None = None, clipped_share: float | None = None
    ) -> None:
        self.history, self.config = history, config
        self.dead_share, self.clipped_share = dead_share, clipped_share
        self.count = len(history.points)

    def last(self, name: str, points: int = 8) -> float:
        """Median of a column over the last points that are finite; NaN without any."""
        return _median(self.history[name][-points:])

    def is_late(self) -> bool:
        """Whether a run should be landing by now."""
        return self.last("decisions", 1) >= _ENOUGH or self.last("episodes", 1) >= _FLIGHTS

    def finite(self, name: str) -> bool:
        """Whether a column is a number of finite size at the end."""
        return bool(np.isfinite(self.history[name][-1]))

    def gained(self, name: str, share: float = 0.3) -> float:
        """How much a column rose from the first to the second half of the last share of the run."""
        decisions = self.history["decisions"]
        first, middle = np.searchsorted(decisions, decisions[-1] * np.array([1.0 - share, 1.0 - share / 2]))
        values = self.history[name]
        return _mean(values[middle:]) - _mean(values[first:middle])

    def best(self) -> float:
        """The largest share that landed, in this stage, over enough points and flights not to be chance."""
        history = self.history
        counts = (history["episodes"] >= 100) & (history["stage"] == history["stage"][-1])
        success = np.where(np.isfinite(history["success"]) & counts, history["success"], 0.0)
        if len(success) < 5:
            return 0.0
        return float(np.lib.stride_tricks.sliding_window_view(success, 5).min(axis=1).max())

    def best_moment(self) -> int | None:
        """How many decisions the run had taken at its best checkpoint; None without any."""
        checkpoints = self.history.checkpoints
        return max(checkpoints, key=lambda each: each.success).decisions if checkpoints else None


class Rule(NamedTuple):
    """One thing that can be off."""

    name: str
    holds: Callable[[Recent], bool]
    remedy: Callable[[Recent], Mapping[str, Any]] = lambda _: {}
    goes_back: bool = False


# Conditions


def _loss_explodes(run: Recent) -> bool:
    """Ten times what it was, or no number any more."""
    if not run.finite("loss"):
        return True
    before = _median(run.history["loss"][-208:-8])
    return run.count >= 60 and before > 0 and run.last("loss") > 10 * before


def _q_runs_away(run: Recent) -> bool:
    """Beyond twice what a flight could earn, or lose, at all."""
    if not run.finite("mean_q"):
        return True
    least, most = returns(run.config)
    return not 2 * least <= run.last("mean_q") <= 2 * most


def _dead_units(run: Recent) -> bool:
    """More than half of the units give 0 whatever they are shown: then nothing can change them any more."""
    return run.config.activation == "relu" and (run.dead_share or 0.0) > 0.5


def _collapsed(run: Recent) -> bool:
    best = run.best()
    return best >= 0.6 and run.last("success", 12) <= best - 0.4


def _crashes(run: Recent) -> bool:
    return run.is_late() and run.last("crashed") + run.last("out_of_bounds") >= 0.85 and run.last("landed") <= 0.1


def _hovers(run: Recent) -> bool:
    return run.is_late() and run.last("timed_out") >= 0.5 and run.last("landed") <= 0.3


def _plateau(run: Recent) -> bool:
    late = run.is_late() and run.last("decisions", 1) >= 1.5 * _ENOUGH
    return late and 0.05 < run.last("success") < 0.85 and abs(run.gained("success")) < 0.04


def _overfed(run: Recent) -> bool:
    """Each memory is learned from some hundred times: `classic` does so 64 times, `modern` 8 times."""
    config = run.config
    return config.updates * config.batch_size > 500 * config.num_envs


def _clipped(run: Recent) -> bool:
    """Most gradients are shortened to one length: then how wrong an estimate is no longer counts."""
    return (run.clipped_share or 0.0) > 0.6


def returns(config: Config) -> tuple[float, float]:
    """Return the least and the most that a flight could earn, as the network sees it."""
    weights = config.weights
    shaped = 10 * weights.distance * _FARTHEST + 10 * weights.speed * _FASTEST + weights.alignment
    steady = weights.tilt + weights.engine + weights.switch + weights.time  # at every physics step
    lost = min(0.0, steady) * _FLIGHT - abs(shaped) - abs(weights.terminal)
    won = max(0.0, steady) * _FLIGHT + abs(shaped) + abs(weights.terminal) + abs(weights.feet) * FEET_STEPS_PAID
    return config.reward_scale * lost, config.reward_scale * won


# Remedies


def _slower(factor: float) -> Callable[[Recent], Mapping[str, Any]]:
    """Lower the learning rate, and what it falls to if that is higher."""

    def remedy(run: Recent) -> Mapping[str, Any]:
        rate = max(1e-5, float(f"{run.config.learning_rate / factor:.1g}"))
        lower = {"learning_rate": rate}
        return lower | {"final_learning_rate": rate} if run.config.final_learning_rate > rate else lower

    return remedy


def _calm_q(run: Recent) -> Mapping[str, Any]:
    if not run.config.double:
        return {"double": True}
    if run.config.target_rate > 0.05 and run.config.target_every < 50:
        return {"target_rate": 0.005}
    return _slower(10)(run)


def _for_crashes(run: Recent) -> Mapping[str, Any]:
    config = run.config
    if config.learning_rate > 0.01:
        return _SANE
    if config.optimizer == "sgd" and config.learning_rate < 0.02:
        return {"optimizer": "adam"}
    return _for_short_sight(config)


def _for_dead_units(run: Recent) -> Mapping[str, Any]:
    leaky = {"activation": "leaky_relu"}
    return _SANE | leaky if run.config.learning_rate > 0.01 else leaky


def _for_short_sight(config: Config) -> Mapping[str, Any]:
    return {"discount": 0.985} if config.discount < 0.96 else {}


def _for_hovering(run: Recent) -> Mapping[str, Any]:
    config, paid = run.config, RewardWeights()
    if not any(getattr(config.weights, part) for part in _PARTS):
        return {f"weights.{part}": getattr(paid, part) for part in _PARTS}
    if config.epsilon_end < 0.02:
        return {"epsilon_end": 0.05}
    if config.random_main > 0.4:
        return {"random_main": 0.3}
    if config.spawn in _FAR_SPAWNS:
        return {"spawn": "practice"}
    if config.weights.time > paid.time:
        return {"weights.time": paid.time}
    return _for_short_sight(config) or {"weights.time": round(1.5 * config.weights.time, 3)}


def _for_plateau(run: Recent) -> Mapping[str, Any]:
    config = run.config
    if config.n_step < 3:
        return {"n_step": 10}
    return _for_short_sight(config) or (_slower(3)(run) if config.learning_rate > 1e-4 else {})


def _less_random(run: Recent) -> Mapping[str, Any]:
    config = run.config
    if config.epsilon_end > 0.2:
        return {"epsilon_end": 0.05}
    return {"epsilon_decisions": 40_000} if config.epsilon_decisions else {"epsilon_decay": 0.995}


def _more_memory(run: Recent) -> Mapping[str, Any]:
    return {"replay_size": max(10_000, 100 * run.config.batch_size)}


def _longer(run: Recent) -> Mapping[str, Any]:
    """Let gradients be longer; where they already may be, let the steps be shorter."""
    clip = run.config.gradient_clip
    return {"gradient_clip": 10.0} if clip < 10.0 else _slower(3)(run)


# The most severe first.
RULES: Final = (
    Rule("loss_explodes", _loss_explodes, _slower(10)),
    Rule("q_runs_away", _q_runs_away, _calm_q),
    Rule("dead_units", _dead_units, _for_dead_units),
    Rule("collapsed", _collapsed, _slower(3), goes_back=True),
    Rule("crashes", _crashes, _for_crashes),
    Rule("hovers", _hovers, _for_hovering),
    Rule("small_memory", lambda run: run.config.replay_size < 8 * run.config.batch_size, _more_memory),
    Rule("overfed", _overfed, lambda _: {"num_envs": 256}),
    Rule("random", lambda run: run.is_late() and run.last("epsilon") > 0.3, _less_random),
    Rule("clipped", _clipped, _longer),
    Rule("plateau", _plateau, _for_plateau),
)


class Adviser:
    """Chooses the one hint that is shown. Times are seconds of training, as the history counts them."""

    def __init__(self, config: Config) -> None:
        self.config = config
        self.reset()

    def reset(self) -> None:
        """Forget everything: another run begins."""
        self.shown: Hint | None = None
        self._now = self._shown_since = 0.0
        self._since: dict[str, float] = {}  # when each rule that holds began to
        self._rests: dict[str, float] = {}  # until when each is quiet
        self._before: dict[str, Any] = {}  # what the last remedy has changed

    def advise(
        self,
        history: History,
        config: Config,
        dead_share: float | None = None,
        clipped_share: float | None = None,
    ) -> Hint | None:
        """Return what to show now, if anything; call it as often as there is news.

        Where somebody has counted them, `dead_share` is the share of hidden units that never come alive, and
        `clipped_share` that of the gradients which were cut short.
        """
        self.config = config
        if not len(history.points):
            return None
        now = float(history["seconds"][-1])
        if now < self._now:
            self.reset()
        self._now = now
        run = Recent(history, config, dead_share, clipped_share)
        holding = {rule.name: rule for rule in RULES if rule.holds(run)}
        self._since = {name: self._since.get(name, now) for name in holding}
        if self.shown is not None and now - self._shown_since < STAY:
            return self.shown
        ripe = [
            rule for name, rule in holding.items()
            if now - self._since[name] >= HOLD and now >= self._rests.get(name, 0.0)
        ]  # fmt: skip
        self._show(ripe[0] if ripe else None, run)
        return self.shown

    def _show(self, rule: Rule | None, run: Recent) -> None:
        if rule is None:
            self.shown = None
            return
        if self.shown is None or self.shown.name != rule.name:
            self._shown_since = self._now
        remedy = {name: value for name, value in rule.remedy(run).items() if value != attrgetter(name)(run.config)}
        self.shown = Hint(rule.name, remedy, run.best_moment() if rule.goes_back else None)

    def apply(self) -> Mapping[str, Any]:
        """Take the remedy of the hint that is shown: the values to set. The hint goes; `undo` has the way back."""
        if self.shown is None:
            return {}
        remedy = self.shown.remedy
        self._before = {name: attrgetter(name)(self.config) for name in remedy}
        self.dismiss()
        return remedy

    @property
    def can_undo(self) -> bool:
        """Whether a remedy was applied that can be taken back."""
        return bool(self._before)

    def undo(self) -> Mapping[str, Any]:
        """Return the values that the last remedy replaced, once."""
        before, self._before = self._before, {}
        return before

    def dismiss(self) -> None:
        """Put the hint away; it will not come back at once."""
        if self.shown is not None:
            self._rests[self.shown.name] = self._now + REST
            self.shown = None


def _finite(values: Doubles) -> Doubles:
    return values[np.isfinite(values)]


def _median(values: Doubles) -> float:
    values = _finite(values)
    return float(np.median(values)) if len(values) else float("nan")


def _mean(values: Doubles) -> float:
    values = _finite(values)
    return float(values.mean()) if len(values) else float("nan")
