"""Diagnosis of a training run: rules that find visible faults in its recent past, each with a remedy to try.

A rule is a row of `RULES`: a condition and a remedy. The words that a player reads for it belong to the game. An
`Adviser` keeps a hint from flickering: it appears once its rule has held for a while, and then stays for a while.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any, Final, NamedTuple

import numpy as np

from ai.agent.config import Config
from ai.agent.schedule import idle, learning_rate
from ai.common.environment import Doubles
from ai.lander.environment import LIMITS
from ai.lander.rewards import FEET_STEPS_PAID, RewardWeights
from ai.training.history import REVERTED, History

HOLD: Final = 2.0  # seconds of training for which a rule must hold before its hint appears
STAY: Final = 6.0  # seconds for which a hint stays at least
REST: Final = 45.0  # seconds for which one that was applied or dismissed does not come back

_FARTHEST: Final = 25.0  # metres from the pad, at the most
_FASTEST: Final = 10.0  # m/s that a lander may gain or lose in a flight
_FLIGHT: Final = 60.0 * LIMITS.time  # physics steps of the longest flight
_ENOUGH: Final = 150_000  # decisions after which the modern preset lands nearly always
_FLIGHTS: Final = 1_000  # flights after which a run with few landers should have learned something
_FAR_SPAWNS: Final = ("random", "hard", "highest")  # of which none begins near the pad
_RATES: Final = ("learning_rate", "final_learning_rate")
# Rates above which no step is sensible, and sane ones, by the optimizer. Modern still learns at 0.03, not at 0.1;
# classic's values have diverged at 0.1.
_TOO_HIGH: Final = {"adam": 0.05, "momentum": 0.01, "sgd": 0.05}
_SANE: Final = {"adam": (2e-3, 3e-4), "momentum": (1e-4, 1e-4), "sgd": (1e-3, 1e-3)}
_TARGET_STEPS: Final = 8_000  # learning steps after which a target should be nearly where the network is
_COLLAPSE: Final = 3  # times a hundred flights for which a share must have been there, and must have gone
_PARTS: Final = ("distance", "speed", "alignment")  # of the reward, that say how close it is


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


class RecentCurves:
    """Recent curves of a run, with the questions about them that several rules ask."""

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

    def gained(self, name: str, share: float = 0.3) -> float:
        """Return how much a column rose from the first to the second half of the last share of the run."""
        decisions = self.history["decisions"]
        first, middle = np.searchsorted(decisions, decisions[-1] * np.array([1.0 - share, 1.0 - share / 2]))
        values = self.history[name]
        return _mean(values[middle:]) - _mean(values[first:middle])

    def by_hundreds(self) -> Doubles:
        """Return the share that landed of each successive hundred flights of this stage: none counts twice."""
        history = self.history
        here = (history["stage"] == history["stage"][-1]) & np.isfinite(history["success"])
        episodes, success = history["episodes"][here], history["success"][here]
        if not len(episodes):
            return np.empty(0)
        ends = np.arange(episodes[-1], max(episodes[0], 100.0) - 1.0, -100.0)[::-1]
        shares: Doubles = success[np.searchsorted(episodes, ends)]
        return shares

    def best(self) -> float:
        """Return the largest share that landed, in this stage, over so many flights that it is not chance."""
        shares = self.by_hundreds()
        if len(shares) < _COLLAPSE:
            return 0.0
        return float(np.lib.stride_tricks.sliding_window_view(shares, _COLLAPSE).min(axis=1).max())

    def damaged_at(self) -> int | None:
        """Return when steps that were far too long began, in decisions; None if none since it last went back."""
        config, began = self.config, None
        changes = [each for each in self.history.alterations if each.name in (*_RATES, REVERTED)]
        since = self.history["decisions"][-1]
        for each in [*reversed(changes), None]:
            if _rate_too_high(config, int(since)):
                began = 0 if each is None else each.decisions
            if each is None or each.name == REVERTED:
                break
            since = each.decisions
            with suppress(ValueError):  # a file may say what no knob can be
                config = config.changed(**{each.name: each.before})
        return began

    def best_moment(self) -> int | None:
        """Return how many decisions the run had taken at its best checkpoint; None without any."""
        checkpoints = self.history.checkpoints
        return max(checkpoints, key=lambda each: each.success).decisions if checkpoints else None


class HintRule(NamedTuple):
    """Rule for one fault; `back_to` is the moment to go back to, in decisions."""

    name: str
    holds: Callable[[RecentCurves], bool]
    remedy: Callable[[RecentCurves], Mapping[str, Any]] = lambda _: {}
    back_to: Callable[[RecentCurves], int | None] = lambda _: None


# Conditions


def _rate_too_high(config: Config, decisions: int) -> bool:
    return learning_rate(config, decisions) > _TOO_HIGH[config.optimizer]


def _damaged(run: RecentCurves) -> bool:
    """Whether steps were far too long at some time, and the network still shows the damage."""
    if run.damaged_at() is None or run.last("landed") > 0.5:
        return False
    return any(sign(run) for sign in (_loss_explodes, _q_runs_away, _dead_units, _collapsed, _crashes, _hovers))


def _loss_explodes(run: RecentCurves) -> bool:
    """Whether the loss is ten times what it was, or infinite; NaN means that it is not known."""
    if np.isinf(run.history["loss"][-1]):
        return True
    before = _median(run.history["loss"][-208:-8])
    return run.count >= 60 and before > 0 and run.last("loss") > 10 * before


def _q_runs_away(run: RecentCurves) -> bool:
    """Whether the mean Q-value is beyond twice what a flight could earn or lose."""
    if np.isinf(run.history["mean_q"][-1]):
        return True
    least, most = returns(run.config)
    return run.last("mean_q") < 2 * least or run.last("mean_q") > 2 * most


def _target_stands(run: RecentCurves) -> bool:
    """Whether the target network lags far behind, and with it the targets, and the flights where it flies them."""
    return run.config.target_update_interval / run.config.tau > _TARGET_STEPS


def _short_sight(run: RecentCurves) -> bool:
    """Whether the discount makes a reward a second later, after fifteen decisions, count for little."""
    return run.is_late() and run.config.discount < 0.96 and run.last("landed") < 0.6


def _no_guide(run: RecentCurves) -> bool:
    """Whether no part of the reward tells a lander on its way that it comes closer."""
    return (
        run.is_late()
        and run.last("landed") < 0.6
        and not any(getattr(run.config.reward_weights, part) for part in _PARTS)
    )


def _dead_units(run: RecentCurves) -> bool:
    """Whether more than half of the units give 0 for every input: then they can no longer learn."""
    return run.config.activation == "relu" and (run.dead_share or 0.0) > 0.5


def _collapsed(run: RecentCurves) -> bool:
    best = run.best()
    return best >= 0.6 and bool(run.by_hundreds()[-_COLLAPSE:].max() <= best - 0.4)


def _crashes(run: RecentCurves) -> bool:
    return run.is_late() and run.last("crashed") + run.last("out_of_bounds") >= 0.85 and run.last("landed") <= 0.1


def _hovers(run: RecentCurves) -> bool:
    return run.is_late() and run.last("timed_out") >= 0.5 and run.last("landed") <= 0.3


def _plateau(run: RecentCurves) -> bool:
    late = run.is_late() and run.last("decisions", 1) >= 1.5 * _ENOUGH
    return late and 0.05 < run.last("success") < 0.85 and abs(run.gained("success")) < 0.04


def _overfed(run: RecentCurves) -> bool:
    """Whether each memory is learned from some hundred times: 64 times by `classic`, 8 times by `modern`."""
    config = run.config
    return config.gradient_steps * config.batch_size > 500 * config.num_envs


def _clipped(run: RecentCurves) -> bool:
    """Whether most gradients are clipped to one length: then the size of an error no longer counts."""
    return (run.clipped_share or 0.0) > 0.6


def returns(config: Config) -> tuple[float, float]:
    """Return the least and the most that a flight could earn, as the network sees it."""
    weights = config.reward_weights
    shaped = 10 * weights.distance * _FARTHEST + 10 * weights.speed * _FASTEST + weights.alignment
    steady = weights.tilt + weights.engine + weights.switch + weights.time  # at every physics step
    lost = min(0.0, steady) * _FLIGHT - abs(shaped) - abs(weights.terminal)
    won = max(0.0, steady) * _FLIGHT + abs(shaped) + abs(weights.terminal) + abs(weights.feet) * FEET_STEPS_PAID
    return config.reward_scale * lost, config.reward_scale * won


# Remedies


def _sane_rates(run: RecentCurves) -> Mapping[str, Any]:
    sane = zip(_RATES, _SANE[run.config.optimizer], strict=True)
    return {name: rate for name, rate in sane if getattr(run.config, name) > 10 * rate}


def _before_damage(run: RecentCurves) -> int | None:
    checkpoint = run.history.checkpoint_at(run.damaged_at() or 0)
    return checkpoint.decisions if checkpoint else None


def _slower(factor: float) -> Callable[[RecentCurves], Mapping[str, Any]]:
    """Lower the learning rate, and what it falls to if that is higher."""

    def remedy(run: RecentCurves) -> Mapping[str, Any]:
        rate = max(1e-5, float(f"{run.config.learning_rate / factor:.1g}"))
        lower = {"learning_rate": rate}
        return lower | {"final_learning_rate": rate} if run.config.final_learning_rate > rate else lower

    return remedy


def _calm_q(run: RecentCurves) -> Mapping[str, Any]:
    if not run.config.double:
        return {"double": True}
    if run.config.tau > 0.05 and run.config.target_update_interval < 50:
        return {"tau": 0.005}
    return _slower(10)(run)


def _for_crashes(run: RecentCurves) -> Mapping[str, Any]:
    config = run.config
    if config.optimizer == "sgd" and config.learning_rate < 0.02:
        return {"optimizer": "adam"}
    return {}


def _for_short_sight(config: Config) -> Mapping[str, Any]:
    return {"discount": 0.985} if config.discount < 0.96 else {}


def _for_hovering(run: RecentCurves) -> Mapping[str, Any]:
    config, paid = run.config, RewardWeights()
    if config.epsilon_end < 0.02:
        return {"epsilon_end": 0.05}
    if config.random_main > 0.4:
        return {"random_main": 0.3}
    if config.spawn in _FAR_SPAWNS:
        return {"spawn": "practice"}
    if config.reward_weights.time > paid.time:
        return {"reward_weights.time": paid.time}
    return _for_short_sight(config) or {"reward_weights.time": round(1.5 * config.reward_weights.time, 3)}


def _usual_guide(_: RecentCurves) -> Mapping[str, Any]:
    return {f"reward_weights.{part}": getattr(RewardWeights(), part) for part in _PARTS}


def _for_plateau(run: RecentCurves) -> Mapping[str, Any]:
    config = run.config
    if config.n_step < 3:
        return {"n_step": 10}
    return _for_short_sight(config) or (_slower(3)(run) if config.learning_rate > 1e-4 else {})


def _less_random(run: RecentCurves) -> Mapping[str, Any]:
    config = run.config
    if config.epsilon_end > 0.2:
        return {"epsilon_end": 0.05}
    if config.epsilon_decay == 1.0 and not config.epsilon_decisions:
        return {"epsilon_decisions": 40_000}
    return {"epsilon_decisions": 40_000} if config.epsilon_decisions else {"epsilon_decay": 0.995}


def _more_memory(run: RecentCurves) -> Mapping[str, Any]:
    return {"replay_size": max(10_000, 100 * run.config.batch_size)}


def _nearer_target(run: RecentCurves) -> Mapping[str, Any]:
    return {"target_update_interval": 50} if run.config.tau > 0.5 else {"target_update_interval": 1, "tau": 0.005}


def _fewer_steps(run: RecentCurves) -> Mapping[str, Any]:
    """Take fewer steps where there are many, or let more landers feed them."""
    config = run.config
    enough = 500 * config.num_envs // config.batch_size
    return {"gradient_steps": enough} if config.gradient_steps > 12 and enough else {"num_envs": 256}


def _longer(run: RecentCurves) -> Mapping[str, Any]:
    """Let gradients be longer; where they already may be, let the steps be shorter."""
    clip = run.config.gradient_clip
    return {"gradient_clip": 10.0} if clip < 10.0 else _slower(3)(run)


# The most severe first.
RULES: Final = (
    HintRule("rate_too_high", lambda run: _rate_too_high(run.config, int(run.last("decisions", 1))), _sane_rates,
         _before_damage),
    HintRule("damaged", _damaged, back_to=_before_damage),
    HintRule("loss_explodes", _loss_explodes, _slower(10)),
    HintRule("q_runs_away", _q_runs_away, _calm_q),
    HintRule("dead_units", _dead_units, lambda _: {"activation": "leaky_relu"}),
    HintRule("collapsed", _collapsed, _slower(3), RecentCurves.best_moment),
    HintRule("target_stands", _target_stands, _nearer_target),
    HintRule("short_sight", _short_sight, lambda _: {"discount": 0.985}),
    HintRule("no_guide", _no_guide, _usual_guide),
    HintRule("crashes", _crashes, _for_crashes),
    HintRule("hovers", _hovers, _for_hovering),
    HintRule("small_memory", lambda run: run.config.replay_size < 8 * run.config.batch_size, _more_memory),
    HintRule("overfed", _overfed, _fewer_steps),
    HintRule("random", lambda run: run.is_late() and run.last("epsilon") > 0.3, _less_random),
    HintRule("clipped", _clipped, _longer),
    HintRule("plateau", _plateau, _for_plateau),
)  # fmt: skip


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

    def _show(self, rule: HintRule | None, run: RecentCurves) -> None:
        if rule is None:
            self.shown = None
            return
        if self.shown is None or self.shown.name != rule.name:
            self._shown_since = self._now
        idle_now = idle(run.config, *(int(run.last(name, 1)) for name in ("decisions", "episodes")))
        remedy = {
            name: value for name, value in rule.remedy(run).items()
            if value != attrgetter(name)(run.config) and name not in idle_now
        }  # fmt: skip
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


def _finite(values: Doubles) -> Doubles:
    return values[np.isfinite(values)]


def _median(values: Doubles) -> float:
    values = _finite(values)
    return float(np.median(values)) if len(values) else float("nan")


def _mean(values: Doubles) -> float:
    values = _finite(values)
    return float(values.mean()) if len(values) else float("nan")
