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
    `left` is the card's left edge. `intact` is whether the craft came down whole beside the pad.
    `rung` is the place on the ladder of starts, None off it, and `climb` what the flight has changed there.
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
    intact: bool = False
    rung: int | None = None
    climb: str = ""


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
    intact = bool(env.intact[slot])
    if intact:
        title, reason = texts.BESIDE_TITLE, crash_reason(env, slot)
    elif outcome is Outcome.CRASHED:
        reason = crash_reason(env, slot)
    elif outcome is Outcome.OUT_OF_BOUNDS:
        reason = reason.format(where=_where_left(env, slot))
    elif outcome is Outcome.TIMED_OUT:
        reason = reason.format(limit=f"{env.limits.time:.0f}")
    advice = texts.ADVICE.get(cause_of(env, slot).name, "")
    figures = flight_figures(env, slot)
    return OutcomeCard(outcome is Outcome.LANDED, title, reason, figures, human, advice, intact=intact)


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


def ending_word(outcome: str, *, intact: bool) -> str:
    """Return the title of an ending by the name of its Outcome; `intact` is for a whole craft beside the pad."""
    return texts.BESIDE_TITLE if intact else texts.OUTCOMES[outcome][0]


def cause_of(env: LanderEnv, slot: int = 0) -> Cause:
    """Return why a craft broke: of a hard touch beside the pad the limit it exceeded, as the place breaks nothing."""
    cause = Cause(int(env.cause[slot]))
    if cause is not Cause.TERRAIN or env.intact[slot]:
        return cause
    return next(cause for cause, (value, limit) in _exceeded(env, slot).items() if value > limit)


def _exceeded(env: LanderEnv, slot: int) -> dict[Cause, tuple[float, float]]:
    """Return what the craft's touches came to, and its limit, for every cause that has one."""
    (speed, slide, tilt), limits = env.impact[slot].tolist(), env.limits
    return {
        Cause.HARD: (speed, limits.touch_speed),
        Cause.SLIDING: (slide, limits.slide_speed),
        Cause.TILTED: (math.degrees(tilt), math.degrees(limits.touch_tilt)),
    }


def crash_reason(env: LanderEnv, slot: int = 0) -> str:
    """Return which limit the lander exceeded, and by how much."""
    cause, limits = cause_of(env, slot), _exceeded(env, slot)
    value, limit = _beyond(*limits[cause], 0 if cause is Cause.TILTED else 1) if cause in limits else ("", "")
    return texts.CAUSES[cause.name].format(value=value, limit=limit)


def _beyond(value: float, limit: float, places: int = 1) -> tuple[str, str]:
    """Format a value and the limit it exceeds, with up to two more decimal places to tell them apart."""
    enough = next((n for n in (places, places + 1) if f"{value:.{n}f}" != f"{limit:.{n}f}"), places + 2)
    return f"{value:.{enough}f}", f"{limit:.{enough}f}"
