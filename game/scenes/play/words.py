"""Words of a flight: its one sentence, the dangers around it, and what a co-pilot has changed, and why."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from ai.lander.environment import ACTION_NAMES, PARAMS, LanderEnv, Outcome
from ai.lander.sensing import near_edges
from game.core import texts
from game.flight import networks
from game.flight.choosers import Crew
from game.flight.credit import Credit
from game.flight.flight import Flight, StickHolder
from game.flight.outcomes import TIPPED
from game.input.bindings import Command, Held
from game.input.controls import Controls

if TYPE_CHECKING:
    from ai.copilot.copilot import SharedDecision

_FLOWN_BY, _WARNED, _CHANGED, _AT_ONCE = range(4)  # how urgent sentences are
_SOON: Final = 3.0  # seconds ahead that a failure is announced
_MARGIN: Final = 2.0, 1.4  # metres, and shares of the braking distance, within which braking is urgent
_AHEAD: Final = 0.9  # seconds of look-ahead for stopping a turn
_TOP: Final = 3.5  # metres below the top of the area, within which to release the engine


# What the pilot must know


def sentence(flight: Flight[Crew], credit: Credit, changed: str, controls: Controls) -> tuple[str, bool]:
    """Return the most urgent sentence of a flight, and whether it is a warning; `changed` is what help has changed."""
    if flight.over:
        return "", False
    by_hand = flight.chooser.hand is StickHolder.HUMAN
    said = [(_WARNED, words) for words in dangers(flight.env)][:1]
    if by_hand and not flight.chooser.safe and (words := urgent(flight.env)):
        other = Held.RIGHT if turned(flight.env) > 0 else Held.LEFT
        said.append((_AT_ONCE, words.format(main=controls.word(Held.MAIN), other=controls.word(other))))
    if changed:
        said.append((_CHANGED, changed))
    flies = credit.header
    if not by_hand:
        flies = networks.sentence(texts.NETWORK_FLIES_BACK, credit.who, key=controls.word(Command.HANDOVER))
    elif flight.chooser.copilot and not (flight.chooser.shared or credit.alone):
        flies = texts.YOU_FLY_HELP.format(key=controls.word(Command.FASTER))
    said.append((_FLOWN_BY, flies))
    urgency, words = max(said)
    return words, urgency in (_AT_ONCE, _WARNED)


def turned(env: LanderEnv, ahead: float = _AHEAD) -> float:
    """Return the predicted angle of the craft, counter-clockwise in rad, far enough ahead to stop a turn in time."""
    return math.remainder(env.angle[0], math.tau) + ahead * float(env.angular_velocity[0])


def falls_too_fast(env: LanderEnv) -> bool:
    """Return whether the craft must brake now to land softly."""
    descent, allowed = -float(env.velocity[0, 1]), env.limits.touch_speed
    if descent < allowed or env.outcome[0] != Outcome.FLYING:
        return False
    braking = env.params.main_thrust / env.params.mass - env.params.gravity
    way = (descent**2 - allowed**2) / (2 * braking)
    return bool(env.altitude[0] < _MARGIN[0] + _MARGIN[1] * way)


def leaves_at_the_top(env: LanderEnv) -> bool:
    """Return whether the craft must stop firing now, or it leaves the area at its invisible top."""
    rise, gravity = float(env.velocity[0, 1]), env.params.gravity
    room = env.limits.ceiling - _TOP - float(env.position[0, 1])
    return rise > 0 and rise**2 / (2 * gravity) > room and env.outcome[0] == Outcome.FLYING


def urgent(env: LanderEnv) -> str:
    """Return what a pilot must do at once, with braces for the keys; empty if nothing, or if it is being done."""
    fires = bool(env.actions[0] >= 3)
    if falls_too_fast(env):
        if env.tilt[0] > TIPPED:
            return texts.TUTORIAL_TURN_FIRST
        return "" if fires else texts.TUTORIAL_TOO_FAST
    return texts.TUTORIAL_TOO_HIGH if fires and leaves_at_the_top(env) else ""


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
    if env.fuel[0] >= conditions.tank:
        yield texts.TANK_EMPTY


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


# What a co-pilot does


def changed_by(decision: SharedDecision) -> str:
    """Say in one sentence what a guardian has just changed; empty where it has changed nothing, or only waits."""
    from ai.copilot.futures import DECISION_STEPS
    from ai.copilot.guardian import decisions_of
    from ai.lander.push import KEYS
    from engine import DT

    assert decision.known is not None
    known = decision.known[0]
    if not decision.overridden[0]:
        lost = all(key in known for key in KEYS) and not any(future.plan for future in known.values())
        return texts.GUARDIAN_LOST if lost else ""
    future, seconds = known.get(decision.asked[0]), decisions_of(decision.assist) * DECISION_STEPS * DT
    if future is None:
        return ""
    after = "lost" if future.plan is None else "lands" if future.passes else "briefly"
    name = texts.said(ACTION_NAMES[int(decision.pilot[0])])
    return texts.GUARDIAN_SAVED[after].format(asked=name, seconds=f"{seconds:.1f}")


def why_not_saved(flight: Flight[Crew]) -> str:
    """Say of a helped flight that was lost why it was not saved; empty if that is not known."""
    guard = flight.chooser.guard
    if guard and guard.bare is not None:
        return texts.GUARDIAN_BARE.format(since=f"{guard.bare:.1f}")
    by_values = flight.chooser.copilot and (guard is None or guard.ahead.problem)
    return texts.NOT_SAVED_BY_VALUES if by_values else ""
