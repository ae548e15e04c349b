"""Tutorial, the first flight: one lesson at a time, written beside the craft, each complete once the player does it.

It is flown like any other challenge and never blocks the player: a lesson can be skipped, and the tutorial left. After
a crash the lesson restarts with the craft hanging in the sky, and the reason is shown. Whenever the craft waits, the
line beside it names the key that it waits for.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from ai.lander.environment import LanderEnv, Outcome
from ai.lander.missions import FIRST
from game.core import texts
from game.core.settings import Settings
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, MUTE, SMALL, TEXT
from game.flight.credit import Credit
from game.flight.flight import Flight, StickHolder
from game.flight.networks import Policy
from game.flight.outcomes import OutcomeCard, outcome_card
from game.input.bindings import Command, Held
from game.input.controls import Controls
from game.play.challenge import Challenge, DrawnFlight
from game.world.camera import View

_PRAISE: Final = 40  # steps that a finished lesson stays on the screen, with a tick
_HIGH: Final = (0.0, 17.0, 0.0, 0.0, 0.0, 0.0)
_LOW: Final = (0.0, 8.0, 0.0, 0.0, 0.0, 0.0)
_MIDWAY: Final = (0.0, 14.0, 0.0, 0.0, 0.0, 0.0)  # with room above for players who fire for long
_LEANING: Final = (0.0, 17.0, 0.0, 0.0, 0.3, 0.0)
_SINKING: Final = (0.0, 16.0, 0.0, -2.0, 0.0, 0.0)
_LEAN: Final = 0.15  # rad
_UPRIGHT: Final = (0.08, 0.15)  # rad, rad/s
_SLOW: Final = 1.0  # m/s
_RISING: Final = 0.3  # m/s upwards, above which the craft rises instead of braking
_MARGIN: Final = 2.0, 1.4  # metres, and shares of the braking distance, within which braking is urgent
_NEAR: Final = 4.0  # metres above the pad, below which the craft should be upright
_TOLD_WHY: Final = 240  # steps in flight that the reason for a restart stays on the screen
_AHEAD: Final = 0.9  # seconds of look-ahead for stopping a turn
_SIDEWAYS: Final = 12.0  # metres from the pad that count as far
_TOP: Final = 3.5  # metres below the top of the area, within which to release the engine
_BESIDE: Final = 1.6  # metres from the middle of a craft to the text beside it
_EDGE: Final = 24.0
_SIZE: Final = TEXT + 2
_WHY: Final = 22.0  # from the instruction to the reason for a restart
_ROWS: Final = (104.0, 600.0)  # points, between which the text stays


@dataclass(frozen=True)
class Lesson:
    """One lesson: something to do, and how to tell that it is done.

    Attributes:
        name: key of its line in `texts.TUTORIAL`.
        done: predicate: whether the lesson's action is being done in this step of a flight.
        steps: number of steps for which it must be done, 60 per second; consecutive if `held`.
        start: state at which the lesson restarts after a crash.
        by: who must have the stick.
        hands_off: whether it begins with all controls released, and needs no touch.
        back: number of lessons to go back when it restarts.

    """

    name: str
    done: Callable[[Flight], bool]
    steps: int
    start: tuple[float, float, float, float, float, float] = _HIGH
    held: bool = True
    by: StickHolder = StickHolder.HUMAN
    back: int = 0
    hands_off: bool = False


def _fires(flight: Flight) -> bool:
    return bool(flight.env.actions[0] >= 3)


def _falls(flight: Flight) -> bool:
    return bool(flight.env.actions[0] == 0 and flight.env.velocity[0, 1] < -0.3)


def _leans(flight: Flight) -> bool:
    return bool(flight.env.tilt[0] > _LEAN)


def _stands_upright(flight: Flight) -> bool:
    env = flight.env
    return bool(env.tilt[0] < _UPRIGHT[0] and abs(env.angular_velocity[0]) < _UPRIGHT[1])


def _brakes(flight: Flight) -> bool:
    return bool(-_SLOW <= flight.env.velocity[0, 1] <= _RISING)


def _turned(env: LanderEnv) -> float:
    """Return the predicted angle of the craft, counter-clockwise in rad, far enough ahead to stop a turn in time."""
    return float(env.angle[0] + _AHEAD * env.angular_velocity[0])


def _falls_too_fast(env: LanderEnv) -> bool:
    """Return whether the craft must brake now to land softly."""
    descent, allowed = -float(env.velocity[0, 1]), env.limits.touch_speed
    if descent < allowed or env.outcome[0] != Outcome.FLYING:
        return False
    braking = env.params.main_thrust / env.params.mass - env.params.gravity
    way = (descent**2 - allowed**2) / (2 * braking)
    return bool(env.altitude[0] < _MARGIN[0] + _MARGIN[1] * way)


def _leaves_at_the_top(env: LanderEnv) -> bool:
    """Return whether the craft must stop firing now, or it leaves the area at its invisible top."""
    rise, gravity = float(env.velocity[0, 1]), env.params.gravity
    room = env.limits.ceiling - _TOP - float(env.position[0, 1])
    return rise > 0 and rise**2 / (2 * gravity) > room and env.outcome[0] == Outcome.FLYING


LESSONS: Final = (
    Lesson("fire", _fires, 24, _MIDWAY, held=False),
    Lesson("fall", _falls, 50, hands_off=True),
    Lesson("brake", _brakes, 50, _SINKING),
    Lesson("lean", _leans, 1),
    Lesson("upright", _stands_upright, 20, _LEANING),
    Lesson("hand_over", lambda _: True, 1, by=StickHolder.NETWORK),
    Lesson("take_back", lambda _: True, 1, back=1),
    Lesson("land", lambda flight: flight.outcome is Outcome.LANDED, 1, _LOW),
)


class Tutorial(Challenge):
    """Tutorial: the first flight.

    Attributes:
        lesson: the current lesson.
        through: whether all lessons are done or skipped.
        flown: whether the last lesson was completed by a landing.
        praise: number of steps for which the last lesson is still praised.

    """

    kept = False
    title, next_hint = texts.TUTORIAL_TITLE, texts.TUTORIAL_SKIP

    def __init__(self) -> None:
        self._lessons = list(LESSONS)
        self._number = self._done_for = self.praise = 0
        self._begun = 0  # number of times that the lesson was begun
        self._why = ""  # reason why the lesson restarts
        self.through = self.flown = False

    @property
    def lesson(self) -> Lesson:
        """The current lesson."""
        return self._lessons[self._number]

    @property
    def fixed(self) -> bool:  # type: ignore[override]
        """Whether there is only one start: until free flights follow."""
        return not self.through

    @property
    def line(self) -> str:  # type: ignore[override]
        """Progress through the lessons, in words."""
        return texts.TUTORIAL_STEP.format(number=self._number + 1, count=len(self._lessons))

    def flight(self, seed: int, network: Policy | None) -> Flight:
        """Begin a flight at the current lesson, or one before it; without a network, skip lessons that need one."""
        if network is None:
            self._do_without_network()
        self._number -= self.lesson.back
        self._begun += 1
        self._done_for = self.praise = self._flown_for = 0
        self._over = False
        flight = Flight(seed, network, mission=FIRST.name, shares=False)  # a co-pilot would brake the fall
        flight.env.place(np.ones(1, bool), np.array([self.lesson.start]))
        flight.observation = flight.env.observe()
        flight.rest()
        return flight

    def follow(self, flight: Flight) -> str:
        """Check whether the lesson is done; return the sound to play if so."""
        if self.through:
            return ""
        if flight.network is None:
            self._do_without_network()
        if flight.over and not self._over:
            self._why = self._reason(flight)
        self._over = flight.over
        self._flown_for += 1
        if self.praise:
            self.praise -= 1
            if not self.praise:
                self._begin_lesson(self._number + 1)
            return ""
        done = flight.hand is self.lesson.by and self.lesson.done(flight)
        self._done_for = self._done_for + 1 if done else 0 if self.lesson.held else self._done_for
        if self._done_for < self.lesson.steps:
            return ""
        self.praise = _PRAISE
        self.through = self.flown = self._number == len(self._lessons) - 1
        return "" if self.through else "choose"  # a landing has a sound of its own

    def skip(self) -> None:
        """Skip the lesson, and those that start with it."""
        left = self._lessons[self._number + 1 :]
        beyond = next((number for number, lesson in enumerate(left, 1) if not lesson.back), 0)
        self.through = not beyond
        self._begin_lesson(self._number + beyond)

    def leave(self) -> None:
        """Skip the whole tutorial."""
        self.through = True

    def remember(self, settings: Settings) -> bool:
        """Store that the tutorial is over, so that it is not offered again, and whether it was flown."""
        before = settings.tutored, settings.first_flown
        settings.tutored |= self.through
        settings.first_flown |= self.flown
        return before != (settings.tutored, settings.first_flown)

    @property
    def waits(self) -> bool:
        """Whether a touch starts the flight; false for a lesson that asks for no touch."""
        return not self.lesson.hands_off

    def again(self) -> bool:
        """Whether a finished flight restarts: true unless it was the landing that the last lesson asks for."""
        return not self.through

    def card(self, card: OutcomeCard, flight: Flight, credit: Credit) -> OutcomeCard:  # noqa: ARG002
        """Return the final card: tutorial complete, or the crash of a player who flies it once more."""
        if not card.good:
            return replace(card, score="")
        return replace(card, title=texts.TUTORIAL_DONE, reason=texts.TUTORIAL_DONE_REASON, score="")

    def _begin_lesson(self, number: int) -> None:
        self._number, self._why = number, ""
        self._done_for = self.praise = self._begun = 0

    def _do_without_network(self) -> None:
        """Skip lessons that need a network, at any point of the tutorial."""
        if len(self._lessons) < len(LESSONS):
            return
        name = self.lesson.name
        self._lessons = [lesson for lesson in LESSONS if lesson.name not in ("hand_over", "take_back")]
        self._number = next((k for k, lesson in enumerate(self._lessons) if lesson.name == name), 5)

    def _reason(self, flight: Flight) -> str:
        """Return the reason why the lesson restarts."""
        if flight.outcome is not Outcome.LANDED:
            return outcome_card(flight.env, flight.share).reason
        if flight.hand is StickHolder.NETWORK:
            return texts.TUTORIAL_NETWORK_LANDED
        return texts.TUTORIAL_LANDED_EARLY

    # The picture

    def words(self, flight: Flight, controls: Controls, *, waiting: bool = False, stuck: bool = False) -> str:
        """Return the instruction, in the key names of the device in use; `waiting` and `stuck` as in `DrawnFlight`."""
        left, right = controls.word(Held.LEFT), controls.word(Held.RIGHT)
        turn = texts.TUTORIAL_EITHER.format(left=left, right=right)
        if left == right:  # one control for both: the mouse, which turns towards its pointer, or a stick
            turn, sign = left, left
            if controls.mouse_in_use:
                left, right = (text.format(key=sign) for text in texts.TUTORIAL_POINT)
                turn = texts.TUTORIAL_POINT_EITHER.format(key=sign)
            else:
                left, right = (text.format(key=sign) for text in texts.TUTORIAL_PUSH)
        env = flight.env
        return self._line(flight, waiting, stuck).format(
            main=controls.word(Held.MAIN),
            turn=turn,
            other=right if _turned(env) > 0 else left,
            inward=right if env.position[0, 0] < 0 else left,
            hand_over=controls.word(Command.HANDOVER),
        )

    def _line(self, flight: Flight, waiting: bool, stuck: bool) -> str:
        env, lesson = flight.env, self.lesson
        told = texts.TUTORIAL[lesson.name]
        if flight.over:
            return texts.TUTORIAL_AGAIN
        if stuck:
            return told[0] if lesson.hands_off else texts.TUTORIAL_LET_GO
        if waiting and lesson.name == "land":  # the lesson's own line names no key that starts the flight
            return texts.TUTORIAL_READY
        if flight.hand is StickHolder.HUMAN and (urgent := self._urgent(env)):
            return urgent
        if self.praise:
            return texts.TUTORIAL_GOOD[lesson.name]
        if flight.hand is StickHolder.NETWORK:
            return texts.TUTORIAL["take_back"][0]
        if lesson.name not in ("lean", "fall") and abs(float(env.position[0, 0])) > _SIDEWAYS:
            return texts.TUTORIAL_AWAY
        if lesson.name == "brake" and env.velocity[0, 1] > _RISING:
            return texts.TUTORIAL_RISES
        if lesson.name == "upright" and abs(_turned(env)) < _UPRIGHT[0]:
            return texts.TUTORIAL_STANDS
        return told[1] if self._begun > 2 and told[1] else told[0]

    def _urgent(self, env: LanderEnv) -> str:
        """Return an urgent warning, which precedes any lesson; empty if nothing is urgent."""
        if _falls_too_fast(env):
            return texts.TUTORIAL_TOO_FAST
        if _leaves_at_the_top(env):
            return texts.TUTORIAL_TOO_HIGH
        if self.lesson.name == "land" and env.altitude[0] < _NEAR and env.tilt[0] > env.limits.touch_tilt / 2:
            return texts.TUTORIAL_TOO_TILTED
        return ""

    @property
    def why(self) -> str:
        """Return why the lesson restarts, until it has flown for a while; empty if it has not restarted."""
        return self._why if self._over or self._flown_for < _TOLD_WHY else ""

    def _why_beside(self, flight: Flight) -> str:
        """Return the reason written beside the craft; empty while the wreck has its own callout."""
        return "" if flight.wrecked else self.why

    def draw(self, canvas: Canvas, view: View, flight: Flight, scene: DrawnFlight) -> None:
        """Draw the instruction beside the craft, and below it the reason for a restart."""
        if flight.over and self.through:
            return
        x, y, _ = flight.poses.at(scene.alpha)[0].tolist()
        words = self.words(flight, scene.controls, waiting=scene.waiting, stuck=scene.stuck)
        praised = bool(self.praise) and words == texts.TUTORIAL_GOOD[self.lesson.name]
        tick = 22 if praised else 0
        why = self._why_beside(flight)
        width = max(canvas.text_width(words, size=_SIZE) + tick, canvas.text_width(why, size=SMALL))
        right = float(view.points((x + _BESIDE, y))[0])
        left = float(view.points((x - _BESIDE, y))[0]) - width - 28
        at = right if right + width + 28 + _EDGE < scene.clear.right else max(left, _EDGE)
        row = min(max(float(view.points((x, y))[1]), _ROWS[0]), _ROWS[1])
        canvas.panel((at, row - 18, width + 28, 36 + (_WHY if why else 0)))
        at += 14
        canvas.text(why, (at, row + 6 + _WHY), size=SMALL, colour=MUTE)
        if praised:
            canvas.marker("check", (at + 6, row), 12, canvas.palette.good)
            at += 22
        canvas.text(words, (at, row + 6), size=_SIZE, colour=canvas.palette.good if praised else INK)
