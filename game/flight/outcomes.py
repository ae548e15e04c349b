"""Outcome of a flight in words, with the lander's own limits."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from ai.lander.environment import Cause, LanderEnv, Outcome
from ai.lander.rules import FOOT_CENTRE, FOOT_SIZE, tenths
from game.core import texts
from game.core.catalogue import capital

_LEVEL: Final = math.cos(math.radians(30))  # upward part of the unit normal of ground that still counts as level
_GOOD: Final = 0.4  # of a limit, up to which a landing is a good one
_LAST: Final = 5.0  # metres above the ground in which the advice on a hard touch would have helped
TIPPED: Final = math.radians(45)  # tilt from which on no engine can brake the fall: that came first


@dataclass
class OutcomeCard:
    """Contents of an outcome card, to which all that follow a flight add what they know.

    `figures` are label, value and unit.
    """

    good: bool
    title: str
    reason: str
    figures: tuple[tuple[str, str, str], ...]
    advice: str = ""  # one sentence
    score: str = ""
    medal: int = 0  # 3 for gold, 2, 1, 0 for none
    intact: bool = False  # whether the craft came down whole beside the pad
    climb: str = ""  # what the flight has changed on the ladder of starts, or the goal that it has reached
    compared: dict[str, str] = field(default_factory=dict)  # what others did from the same start, by their names


def outcome_card(env: LanderEnv) -> OutcomeCard:
    """Return the outcome card of a flight that has ended."""
    outcome, intact = Outcome(int(env.outcome[0])), bool(env.intact[0])
    title, reason = ending_word(outcome.name, intact=intact), texts.OUTCOMES[outcome.name][1]
    if outcome is Outcome.CRASHED:
        reason = crash_reason(env)
    elif outcome is Outcome.OUT_OF_BOUNDS:
        reason = reason.format(where=_where_left(env))
    elif outcome is Outcome.TIMED_OUT:
        reason = reason.format(limit=f"{env.limits.time:.0f}")
    advice, figures = "" if _late(env) else texts.ADVICE.get(cause_of(env).name, ""), flight_figures(env)
    if outcome is not Outcome.LANDED:
        return OutcomeCard(False, title, reason, figures, advice, intact=intact)
    met = qualities(env)
    title = texts.PERFECT if len(met) == len(texts.QUALITIES) else title
    quality = capital(texts.AND.join(texts.QUALITIES[name] for name in met))
    return OutcomeCard(True, title, f"{quality}." if met else reason, figures)


def qualities(env: LanderEnv) -> list[str]:
    """Return what was good about a landing: it was soft, centred, upright, keys of `texts.QUALITIES`."""
    speed, _, tilt = env.impact[0].tolist()
    pad = env.ground.pads[int(env.landed_on[0])]
    room = pad.width / 2 - FOOT_CENTRE[0] - FOOT_SIZE[0] / 2  # in which both feet are on it
    aside = abs(float(env.position[0, 0] - env.pad_shift[0]) - pad.x)
    met = {
        "soft": speed <= _GOOD * env.limits.touch_speed,
        "centred": aside <= _GOOD * room,
        "upright": tilt <= _GOOD * env.limits.touch_tilt,
    }
    return [name for name, good in met.items() if good]


def _where_left(env: LanderEnv) -> str:
    """Return which edge of the area a lander has crossed, in words; heights are above the pad, as in the read-out."""
    limits = env.limits
    if env.position[0, 1] > limits.ceiling:
        height = limits.ceiling - float(env.position[0, 1] - env.altitude[0])
        return texts.LEFT_AT_THE_TOP.format(height=height)
    return texts.LEFT_AT_THE_SIDE.format(width=limits.half_width)


def flight_figures(env: LanderEnv) -> tuple[tuple[str, str, str], ...]:
    """Return the figures of a flight that has ended: label, value, unit."""
    figures = [
        (texts.TIME, f"{tenths(float(env.time[0])):.1f}", "s"),
        (texts.FUEL, f"{tenths(float(env.fuel[0])):.1f}", "s"),
    ]
    if env.outcome[0] in (Outcome.LANDED, Outcome.CRASHED):
        figures.append((texts.TOUCHDOWN, f"{touch_speed(env):.1f}", "m/s"))
    away = abs(float(env.position[0, 0] - env.pad[0, 0]))
    return (*figures, (texts.FROM_MIDDLE, f"{away:.1f}", "m"))


def ending_word(outcome: str, *, intact: bool) -> str:
    """Return the title of an ending by the name of its Outcome; `intact` is for a whole craft beside the pad."""
    return texts.BESIDE_TITLE if intact else texts.OUTCOMES[outcome][0]


def cause_of(env: LanderEnv) -> Cause:
    """Return why a craft broke, the cause before its symptom: one that had tipped over could not brake any more.

    Of a hard touch beside the pad it is the limit that was exceeded, as the place breaks nothing.
    """
    cause = Cause(int(env.cause[0]))
    if cause is not Cause.NONE and _tipped(env):
        return Cause.TILTED
    if cause is not Cause.TERRAIN or env.intact[0]:
        return cause
    return next((cause for cause, (value, limit) in _exceeded(env).items() if value > limit), cause)


def _tipped(env: LanderEnv) -> bool:
    return bool(env.impact[0, 2] > TIPPED)


def _late(env: LanderEnv) -> bool:
    """Whether a craft came down too fast to be braked in the last metres, of which the advice speaks."""
    fastest = env.limits.touch_speed**2 + 2 * _LAST * env.params.main_thrust / env.params.mass
    return cause_of(env) is Cause.HARD and float(env.impact[0, 0]) ** 2 > fastest


def _exceeded(env: LanderEnv) -> dict[Cause, tuple[float, float]]:
    """Return what the craft's touches came to, and its limit, for every cause that has one."""
    (speed, slide, tilt), limits = env.impact[0].tolist(), env.limits
    return {
        Cause.HARD: (speed, limits.touch_speed),
        Cause.SLIDING: (slide, limits.slide_speed),
        Cause.TILTED: (math.degrees(tilt), math.degrees(limits.touch_tilt)),
    }


def touch_speed(env: LanderEnv) -> float:
    """Return how fast the craft came down, in m/s: into the ground or, against a steep side, in all."""
    into, along = env.impact[0, :2].tolist()
    return math.hypot(into, along) if struck_side(env) else into


def struck_side(env: LanderEnv) -> bool:
    """Return whether a craft has just broken on a steep side: down and across are not into and along it."""
    touches, cause = env.world.contacts, cause_of(env)
    if touches is None or cause not in (Cause.HARD, Cause.SLIDING):
        return False
    here = np.flatnonzero(touches.world == 0)
    if not len(here):
        return False
    hardest = here[np.abs(touches.approach[here]).max(axis=1).argmax()]
    return bool(abs(touches.normal[hardest, 1]) < _LEVEL)


def crash_reason(env: LanderEnv) -> str:
    """Return which limit the lander exceeded, and by how much."""
    cause = cause_of(env)
    value, limit = _exceeded(env).get(cause, (0.0, 0.0))
    if cause is Cause.TERRAIN and not env.intact[0]:
        return texts.STRUCK_ABOVE
    steep = struck_side(env)
    value = touch_speed(env) if steep else value
    if cause is Cause.TILTED and _tipped(env):
        return texts.TIPPED_OVER.format(tilt=f"{value:.0f}", speed=f"{touch_speed(env):.1f}")
    words = texts.CRASHED_SIDEWAYS if steep else texts.CAUSES[cause.name]
    shown = _beyond(value, limit, 0 if cause is Cause.TILTED else 1)
    return words.format(value=shown[0], limit=shown[1])


def _beyond(value: float, limit: float, places: int) -> tuple[str, str]:
    """Format a value and the limit it exceeds, with up to two more decimal places to tell them apart."""
    enough = next((n for n in (places, places + 1) if f"{value:.{n}f}" != f"{limit:.{n}f}"), places + 2)
    return f"{value:.{enough}f}", f"{limit:.{enough}f}"
