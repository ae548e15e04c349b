"""Why a flight ended, in words: quoted from the lander's own limits."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ai.lander.environment import Cause, LanderEnv, Outcome
from ai.lander.rules import tenths
from game.core import texts


@dataclass(frozen=True)
class Card:
    """How a flight ended: good or not, why, its figures as label, value, unit, and what to do better.

    Of a shared flight, `stepped_in` is how often the co-pilot did. `medal` is 3 for gold, 2, 1, and 0 for none.
    `left` is where the card stands.
    """

    good: bool
    title: str
    reason: str
    figures: tuple[tuple[str, str, str], ...]
    human: float
    advice: str = ""
    score: str = ""
    medal: int = 0
    stepped_in: int | None = None
    left: float = 400.0


@dataclass(frozen=True)
class Rival:
    """What became of another one from the same start; a figure it does not have is left out."""

    name: str
    result: str
    figures: dict[str, tuple[str, str]]  # value and unit by label


def outcome_card(env: LanderEnv, human: float, slot: int = 0) -> Card:
    """Return the card of a flight that has ended; `human` is the person's share of it."""
    outcome = Outcome(int(env.outcome[slot]))
    title, reason = texts.OUTCOMES[outcome.name]
    if outcome is Outcome.CRASHED:
        reason = crash_reason(env, slot)
    elif outcome is Outcome.OUT_OF_BOUNDS:
        reason = reason.format(where=_where_left(env, slot))
    elif outcome is Outcome.TIMED_OUT:
        reason = reason.format(limit=f"{env.limits.time:.0f}")
    advice = texts.ADVICE.get(Cause(int(env.cause[slot])).name, "")
    return Card(outcome is Outcome.LANDED, title, reason, flight_figures(env, slot), human, advice)


def _where_left(env: LanderEnv, slot: int) -> str:
    """Say which edge of the area a lander has crossed; heights are above the pad, as the read-out has them."""
    limits = env.limits
    if env.position[slot, 1] > limits.ceiling:
        height = limits.ceiling - float(env.position[slot, 1] - env.altitude[slot])
        return texts.LEFT_AT_THE_TOP.format(height=height)
    return texts.LEFT_AT_THE_SIDE.format(width=limits.half_width)


def flight_figures(env: LanderEnv, slot: int = 0) -> tuple[tuple[str, str, str], ...]:
    """Return the figures of a flight that has ended: label, value, unit."""
    figures = [(texts.TIME, f"{tenths(float(env.time[slot])):.1f}", "s"),
               (texts.FUEL, f"{tenths(float(env.fuel[slot])):.1f}", "s")]  # fmt: skip
    if env.outcome[slot] in (Outcome.LANDED, Outcome.CRASHED):
        figures.append((texts.TOUCHDOWN, f"{float(env.impact[slot, 0]):.1f}", "m/s"))
    away = abs(float(env.position[slot, 0] - env.pad[slot, 0]))
    return (*figures, (texts.FROM_MIDDLE, f"{away:.1f}", "m"))


def landing_score(env: LanderEnv, slot: int = 0) -> int:
    """Points of a landing, 100 at most times the factor of its pad: fewer for a hard touch and off the middle."""
    number = int(env.landed_on[slot])
    if number < 0:
        return 0
    pad = env.ground.pads[number]
    hard = min(1.0, float(env.impact[slot, 0]) / env.limits.touch_speed)
    aside = min(1.0, abs(float(env.position[slot, 0] - env.pad_shift[slot]) - pad.x) / (pad.width / 2))
    return pad.factor * round(100 - 40 * hard - 30 * aside)


def crash_reason(env: LanderEnv, slot: int = 0) -> str:
    """Name what broke the lander, and by how much."""
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
    """Write a value and the limit that it is beyond, with as many places as tell them apart: two more at most."""
    enough = next((n for n in (places, places + 1) if f"{value:.{n}f}" != f"{limit:.{n}f}"), places + 2)
    return f"{value:.{enough}f}", f"{limit:.{enough}f}"
