"""Hints: rules that find visible faults in the recent past of a training run, and the choice of the one to show.

There is a rule only for what the remedy brought runs back from: `benchmarks.remedies` has tried each. The words that a
player reads for a rule belong to the game.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any, Final, NamedTuple

from ai.training.config import Config
from ai.training.curves import COLLAPSE, RATES, TOO_HIGH, Curves, rate_too_high
from ai.training.history import History

HOLD: Final = 2.0  # seconds of training for which a rule must hold before its hint appears
STAY: Final = 6.0  # seconds for which a hint stays at least: one that flickers cannot be read
REST: Final = 45.0  # seconds for which one that was answered does not come back
_SANE: Final = {"adam": (2e-3, 3e-4), "momentum": (1e-4, 1e-4), "sgd": (1e-3, 1e-3)}  # RATES, by the optimizer
_TARGET_STEPS: Final = 8_000  # gradient steps after which a target should be nearly where the network is


class HintRule(NamedTuple):
    """Rule for one fault, and its remedy.

    One `of_settings` needs no curves: it holds as soon as a setting is changed.
    """

    name: str
    holds: Callable[[Curves], bool]
    remedy: Callable[[Curves], Mapping[str, Any]] = lambda _: {}
    back_to: Callable[[Curves], int | None] = lambda _: None
    of_settings: bool = False


# Conditions


def _target_stands(run: Curves) -> bool:
    """Whether the target network lags far behind, and with it the targets, and the flights where it flies them."""
    config = run.config
    in_use = config.target_judges or config.fly_target
    return in_use and config.target_update_interval / config.tau > _TARGET_STEPS


def _crashes(run: Curves) -> bool:
    return run.is_late() and run.last("crashed") + run.last("out_of_bounds") >= 0.85 and run.last("success_rate") <= 0.1


def _overfed(run: Curves) -> bool:
    """Whether each memory is learned from some hundred times: 64 times by `classic`, 8 times by `modern`."""
    config = run.config
    return config.gradient_steps * config.batch_size > 500 * config.num_envs and not run.last("success_rate") >= 0.6


# Remedies


def _sane_rates(run: Curves) -> Mapping[str, Any]:
    sane = zip(RATES, _SANE[run.config.optimizer], strict=True)
    return {name: rate for name, rate in sane if getattr(run.config, name) > 10 * rate}


def _before_damage(run: Curves) -> int | None:
    """Return the moment before a rate was last turned too high, or the beginning."""

    def too_high(rate: object) -> bool:
        return isinstance(rate, float) and rate > TOO_HIGH[run.config.optimizer]

    changes = (each for each in run.history.setting_changes if each.name in RATES)
    turned = [each.decisions for each in changes if too_high(each.after) and not too_high(each.before)]
    checkpoint = run.history.checkpoint_at(turned[-1] if turned else 0)
    return checkpoint.decisions if checkpoint else None


def _as_before(run: Curves) -> Mapping[str, Any]:
    return {each.name: each.before for each in run.blamed()}


def _before(name: str) -> Callable[[Curves], int | None]:
    """Return what finds the moment before a change that is to blame, if its name begins so: its traces would stay."""

    def back_to(run: Curves) -> int | None:
        turned = [each.decisions for each in run.blamed() if each.name.startswith(name)]
        checkpoint = run.history.checkpoint_at(min(turned)) if turned else None
        return checkpoint.decisions if checkpoint else None

    return back_to


def _for_crashes(run: Curves) -> Mapping[str, Any]:
    slow = run.config.optimizer == "sgd" and run.config.learning_rate < 0.02
    return {"optimizer": "adam"} if slow else {}


def _less_random(run: Curves) -> Mapping[str, Any]:
    config = run.config
    if config.epsilon_end > 0.2:
        return {"epsilon_end": 0.05}
    by_flights = config.epsilon_decay < 1.0 and not config.epsilon_decisions
    return {"epsilon_decay": 0.995} if by_flights else {"epsilon_decisions": 40_000}


def _more_memory(run: Curves) -> Mapping[str, Any]:
    return {"replay_size": max(10_000, 100 * run.config.batch_size)}


def _nearer_target(run: Curves) -> Mapping[str, Any]:
    return {"target_update_interval": 50} if run.config.tau > 0.5 else {"target_update_interval": 1, "tau": 0.005}


def _fewer_steps(run: Curves) -> Mapping[str, Any]:
    """Take fewer steps where there are many, or let more landers feed them."""
    config = run.config
    enough = 500 * config.num_envs // config.batch_size
    return {"gradient_steps": enough} if config.gradient_steps > 16 and enough else {"num_envs": 256}


# The most severe first.
RULES: Final = (
    HintRule("rate_too_high", lambda run: rate_too_high(run.config, int(run.last("decisions", 1))), _sane_rates,
             _before_damage, of_settings=True),
    HintRule("changed", lambda run: bool(_as_before(run)), _as_before, _before("reward_weights.")),
    HintRule("target_stands", _target_stands, _nearer_target, of_settings=True),
    HintRule("crashes", lambda run: _crashes(run) and run.best() < 0.6, _for_crashes),  # "still": never landed
    HintRule("small_memory", lambda run: run.config.replay_size < 8 * run.config.batch_size, _more_memory,
             of_settings=True),
    HintRule("overfed", _overfed, _fewer_steps, of_settings=True),
    HintRule("random", lambda run: run.is_late() and run.last("epsilon") > 0.3, _less_random),
)  # fmt: skip


@dataclass(frozen=True)
class Hint:
    """Hint at a fault, by the name of its rule."""

    name: str
    remedy: Mapping[str, Any] = field(default_factory=dict)  # values to try, by names such as "reward_weights.time"
    back_to: int | None = None  # decisions of the run at the moment that it should go back to


class Adviser:
    """Adviser that chooses the one hint to show. Times are seconds of training, as the history counts them."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Forget everything: another run begins."""
        self.shown: Hint | None = None
        self._now = self._shown_since = 0.0
        self._since: dict[str, float] = {}  # when each rule that holds began to
        self._rests: dict[str, float] = {}  # until when each is quiet

    def advise(self, history: History, config: Config) -> Hint | None:
        """Return what to show now, if anything; call it as often as there is news."""
        if not len(history.points):
            return None
        now = float(history["seconds"][-1])
        if now < self._now:
            self.reset()
        self._now = now
        run = Curves(history, config)
        # Before that, curves are those of before a change, and it is not known yet what that has brought.
        steady = run.since_change() >= 100.0 * COLLAPSE  # flights
        holding = {rule.name: rule for rule in RULES if (steady or rule.of_settings) and rule.holds(run)}
        self._since = {name: self._since.get(name, now) for name in holding}
        if self.shown is not None and now - self._shown_since < STAY:
            return self.shown
        ripe = (
            rule for name, rule in holding.items()
            if now - self._since[name] >= HOLD and now >= self._rests.get(name, 0.0)
        )  # fmt: skip
        self._show(next(ripe, None), run)
        return self.shown

    def _show(self, rule: HintRule | None, run: Curves) -> None:
        if rule is None:
            self.shown = None
            return
        if self.shown is None or self.shown.name != rule.name:
            self._shown_since = self._now
        remedy = {name: value for name, value in rule.remedy(run).items() if value != attrgetter(name)(run.config)}
        self.shown = Hint(rule.name, remedy, rule.back_to(run))

    def dismiss(self) -> None:
        """Put the hint away; it will not come back at once."""
        if self.shown is not None:
            self._rests[self.shown.name] = self._now + REST
            self.shown = None
