"""Outcome of a flight in words, with the lander's own limits."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ai.lander.environment import Cause, LanderEnv, Outcome
from ai.lander.rules import tenths
from game.core import texts


@dataclass(frozen=True)
class OutcomeCard:
    """Contents of an outcome card: good or not, the reason, figures as label, value, unit, and advice.

    For a shared flight, `stepped_in` is how often the co-pilot intervened. `medal` is 3 for gold, 2, 1, 0 for none.
    `ring` is whether it was landed together with the network. `left` is the card's left edge.
    """

    good: bool
    title: str
    reason: str
    figures: tuple[tuple[str, str, str], ...]
    human: float
    advice: str = ""
    score: str = ""
    medal: int = 0
    ring: bool = False
    stepped_in: int | None = None
    left: float = 400.0


@dataclass(frozen=True)
class RivalOutcome:
    """Outcome of a rival from the same start; a figure it does not have is left out."""

    name: str
    result: str
    figures: dict[str, tuple[str, str]]  # value and unit by label


def outcome_card(env: LanderEnv, human: float, slot: int = 0) -> OutcomeCard:
    """Return the outcome card of a flight that has ended; `human` is the person's share of the steps, 0 to 1."""
    outcome = Outcome(int(env.outcome[slot]))
    title, reason = texts.OUTCOMES[outcome.name]
    if outcome is Outcome.CRASHED:
        reason = crash_reason(env, slot)
    elif outcome is Outcome.OUT_OF_BOUNDS:
        reason = reason.format(where=_where_left(env, slot))
    elif outcome is Outcome.TIMED_OUT:
        reason = reason.format(limit=f"{env.limits.time:.0f}")
    advice = texts.ADVICE.get(Cause(int(env.cause[slot])).name, "")
    return OutcomeCard(outcome is Outcome.LANDED, title, reason, flight_figures(env, slot), human, advice)


def _where_left(env: LanderEnv, slot: int) -> str:
    """Return which edge of the area a lander has crossed, in words; heights are above the pad, as in the read-out."""
    limits = env.limits
    if env.position[slot, 1] > limits.ceiling:
        height = limits.ceiling - float(env.position[slot, 1] - env.altitude[slot])
        return texts.LEFT_AT_THE_TOP.format(height=height)
    return texts.LEFT_AT_THE_SIDE.format(width=limits.half_width)


def flight_figures(env: LanderEnv, slot: int = 0) -> tuple[tuple[str, str, str], ...]:
    """Return the figures of a flight that has ended: label, value, unit."""
    figures = [
        (texts.TIME, f"{tenths(float(env.time[slot])):.1f}", "s"),
        (texts.FUEL, f"{tenths(float(env.fuel[slot])):.1f}", "s"),
    ]
    if env.outcome[slot] in (Outcome.LANDED, Outcome.CRASHED):
        figures.append((texts.TOUCHDOWN, f"{float(env.impact[slot, 0]):.1f}", "m/s"))
    away = abs(float(env.position[slot, 0] - env.pad[slot, 0]))
    return (*figures, (texts.FROM_MIDDLE, f"{away:.1f}", "m"))


def landing_score(env: LanderEnv, slot: int = 0) -> int:
    """Return the score of a landing: up to 100 times its pad's factor, less for a hard touch or off the middle."""
    number = int(env.landed_on[slot])
    if number < 0:
        return 0
    pad = env.ground.pads[number]
    hard = min(1.0, float(env.impact[slot, 0]) / env.limits.touch_speed)
    aside = min(1.0, abs(float(env.position[slot, 0] - env.pad_shift[slot]) - pad.x) / (pad.width / 2))
    return pad.factor * round(100 - 40 * hard - 30 * aside)


def crash_reason(env: LanderEnv, slot: int = 0) -> str:
    """Return which limit the lander exceeded, and by how much."""
    cause = Cause(int(env.cause[slot]))
    speed, slide, tilt = env.impact[slot].tolist()
    limits = env.limits
    value, limit = {
        Cause.HARD: _beyond(speed, limits.touch_speed),
        Cause.SLIDING: _beyond(slide, limits.slide_speed),
        Cause.TILTED: _beyond(math.degrees(tilt), math.degrees(limits.touch_tilt), 0),
    }.get(cause, ("", ""))
    return texts.CAUSES[cause.name].format(value=value, limit=limit)


def _beyond(value: float, limit: float, places: int = 1) -> tuple[str, str]:
    """Format a value and the limit it exceeds, with up to two more decimal places to tell them apart."""
    enough = next((n for n in (places, places + 1) if f"{value:.{n}f}" != f"{limit:.{n}f}"), places + 2)
    return f"{value:.{enough}f}", f"{limit:.{enough}f}"
