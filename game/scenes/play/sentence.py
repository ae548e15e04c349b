"""The one sentence of a flight: what is most urgent, what was just changed for the pilot, or who flies."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

from ai.lander.environment import PARAMS, LanderEnv
from ai.lander.sensing import near_edges
from game.core import texts
from game.flight.credit import Credit
from game.flight.flight import Flight, StickHolder
from game.flight.outcomes import TIPPED
from game.input.bindings import Command, Held
from game.input.controls import Controls
from game.panels.readouts import LITTLE_FUEL, LITTLE_TIME
from game.scenes.play.overrides import Overrides
from game.scenes.play.tutorial_lessons import falls_too_fast, leaves_at_the_top, turned

_SOON: Final = 3.0  # seconds ahead that a failure is announced


def sentence(flight: Flight, credit: Credit, overrides: Overrides, controls: Controls) -> tuple[str, bool]:
    """Return the sentence, and whether it is a warning; empty once the flight is over."""
    if flight.over:
        return "", False
    if flight.hand is StickHolder.HUMAN and not flight.safe and (words := urgent(flight.env)):
        return in_keys(words, flight.env, controls), True
    if overrides.word:
        return overrides.word, False
    if words := next(dangers(flight.env), ""):
        return words, True
    if flight.hand is StickHolder.NETWORK:
        return texts.NETWORK_FLIES_BACK.format(key=controls.word(Command.HANDOVER)), False
    return credit.header, False


def urgent(env: LanderEnv) -> str:
    """Return what a pilot must do at once, with braces for the keys; empty if nothing, or if it is being done."""
    fires = bool(env.actions[0] >= 3)
    if falls_too_fast(env):
        if env.tilt[0] > TIPPED:
            return texts.TUTORIAL_TURN_FIRST
        return "" if fires else texts.TUTORIAL_TOO_FAST
    return texts.TUTORIAL_TOO_HIGH if fires and leaves_at_the_top(env) else ""


def in_keys(words: str, env: LanderEnv, controls: Controls) -> str:
    """Put the player's keys into such words."""
    other = Held.RIGHT if turned(env) > 0 else Held.LEFT
    return words.format(main=controls.word(Held.MAIN), other=controls.word(other))


def dangers(env: LanderEnv) -> Iterator[str]:
    """Yield what is about to go wrong around the craft, the most urgent first."""
    time, conditions = float(env.time[0]), env.conditions
    start, end = conditions.outage
    if start <= time < end:
        yield texts.ENGINE_DEAD.format(seconds=end - time)
    words = {"above": texts.EDGE_ABOVE, "left": texts.EDGE_LEFT, "right": texts.EDGE_RIGHT}
    ahead = [words[edge.side].format(metres=math.ceil(edge.away)) for edge in near_edges(env) if edge.ahead]
    if ahead:
        yield texts.EDGE_ENDS.format(where=texts.AND.join(ahead))
    if 0 < start - time < _SOON:
        yield texts.ENGINE_FAILS.format(seconds=start - time)
    burnt = float(env.fuel[0])
    if burnt >= conditions.tank:
        yield texts.TANK_EMPTY
    elif conditions.tank - burnt < LITTLE_FUEL * conditions.tank:
        yield texts.TANK_LOW.format(seconds=conditions.tank - burnt)
    if env.limits.time - time < LITTLE_TIME:
        yield texts.TIME_SHORT.format(seconds=max(0.0, env.limits.time - time))


def surroundings(env: LanderEnv) -> Iterator[str]:
    """Yield what differs in this flight from one on the moon, for a craft that waits."""
    params, conditions, time = env.params, env.conditions, float(env.time[0])
    if params.gravity != PARAMS.gravity:
        yield texts.GRAVITY.format(times=params.gravity / PARAMS.gravity)
    if conditions.moves:
        speed = float(env.pad_velocity[0])
        yield (texts.PAD_RIGHT if speed > 0 else texts.PAD_LEFT).format(speed=abs(speed))
    start, _ = conditions.outage
    if _SOON <= start - time < math.inf:
        yield texts.ENGINE_FAILS.format(seconds=start - time)
    yield from dangers(env)


def wind(env: LanderEnv) -> float:
    """Return how the wind accelerates the craft to the right, in m/s²."""
    return float(env.conditions.push(env.time)[0]) / env.params.mass if env.conditions.pushes else 0.0
