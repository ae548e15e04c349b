"""The first flight: one thing to do at a time, told beside the craft, each done when the player has done it.

It is flown like any other course and stops nobody: a step can be skipped, the whole of it left. After a crash the
step begins again, with the craft hanging in the sky.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from ai.lander import LanderEnv, Outcome
from ai.missions import FIRST
from game import texts
from game.bindings import Command, Held
from game.controls import Controls
from game.course import Course
from game.flight import Flight, Hand
from game.hud import Card
from game.networks import Flyer
from game.render import View
from game.ui.canvas import Canvas
from game.ui.tokens import INK, TEXT, VIEW_SIZE

_PRAISE: Final = 40  # steps that a thing done stays on the screen, with a tick
_HIGH: Final = (0.0, 17.0, 0.0, 0.0, 0.0, 0.0)
_LOW: Final = (0.0, 8.0, 0.0, 0.0, 0.0, 0.0)
_LEANING: Final = (0.0, 17.0, 0.0, 0.0, 0.3, 0.0)
_SINKING: Final = (0.0, 16.0, 0.0, -2.0, 0.0, 0.0)
_LEAN: Final = 0.15  # rad
_UPRIGHT: Final = (0.08, 0.15)  # rad, rad/s
_SLOW: Final = 1.0  # m/s
_MARGIN: Final = 2.0, 1.4  # metres, and shares of the way to brake, within which that is more urgent than a lesson
_NEAR: Final = 4.0  # metres above the pad, where one had better stand upright
_BESIDE: Final = 1.6  # metres from the middle of a craft to the words beside it
_EDGE: Final = 24.0
_SIZE: Final = TEXT + 2
_ROWS: Final = (104.0, 600.0)  # points, between which the words stay


@dataclass(frozen=True)
class Lesson:
    """One thing to do.

    Attributes:
        name: of its line in `texts.TUTORIAL`.
        done: whether it is being done in this step of a flight.
        steps: how many steps it must be done, 60 a second; in a row if `held`.
        start: where it begins again after a crash.
        by: who must have the stick.
        back: how many lessons before this one to begin again with.

    """

    name: str
    done: Callable[[Flight], bool]
    steps: int
    start: tuple[float, float, float, float, float, float] = _HIGH
    held: bool = True
    by: Hand = Hand.HUMAN
    back: int = 0


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
    return bool(-_SLOW <= flight.env.velocity[0, 1] <= 0.3)


def _falls_too_fast(env: LanderEnv) -> bool:
    """Whether it is high time to brake."""
    descent, allowed = -float(env.velocity[0, 1]), env.limits.touch_speed
    if descent < allowed or env.outcome[0] != Outcome.FLYING:
        return False
    braking = env.params.main_thrust / env.params.mass - env.params.gravity
    way = (descent**2 - allowed**2) / (2 * braking)
    return bool(env.altitude[0] < _MARGIN[0] + _MARGIN[1] * way)


LESSONS: Final = (
    Lesson("fire", _fires, 24, held=False),
    Lesson("fall", _falls, 50),
    Lesson("brake", _brakes, 50, _SINKING),
    Lesson("lean", _leans, 1),
    Lesson("upright", _stands_upright, 20, _LEANING),
    Lesson("hand_over", lambda _: True, 1, by=Hand.NETWORK),
    Lesson("take_back", lambda _: True, 1, back=1),
    Lesson("land", lambda flight: flight.outcome is Outcome.LANDED, 1, _LOW),
)


class Tutorial(Course):
    """The first flight.

    Attributes:
        lesson: what is being done now.
        through: whether all of it is done, or skipped.

    """

    counts = kept = False
    title, next_hint = texts.TUTORIAL_TITLE, texts.TUTORIAL_SKIP

    def __init__(self) -> None:
        self._lessons = list(LESSONS)
        self._number = self._done_for = self._praise = 0
        self._begun = 0  # how often the lesson was
        self.through = False

    @property
    def lesson(self) -> Lesson:
        """What is being done now."""
        return self._lessons[self._number]

    @property
    def fixed(self) -> bool:  # type: ignore[override]
        """Whether there is but the one start: until free flights follow."""
        return not self.through

    @property
    def line(self) -> str:  # type: ignore[override]
        """How far it has come."""
        return texts.TUTORIAL_STEP.format(number=self._number + 1, count=len(self._lessons))

    def flight(self, seed: int, network: Flyer | None) -> Flight:
        """Begin the lesson, or one before it; without a network, those that need one are left out."""
        if network is None and len(self._lessons) == len(LESSONS):
            name = self.lesson.name
            self._lessons = [lesson for lesson in LESSONS if lesson.name not in ("hand_over", "take_back")]
            self._number = next((k for k, lesson in enumerate(self._lessons) if lesson.name == name), 5)
        self._number -= self.lesson.back
        self._begun += 1
        self._done_for = self._praise = 0
        flight = Flight(seed, network, mission=FIRST.name, shares=False)  # a fall that is braked for you is not felt
        flight.env.place(np.ones(1, bool), np.array([self.lesson.start]))
        flight.observation = flight.env.observe()
        flight.rest()
        return flight

    def follow(self, flight: Flight) -> str:
        """See whether what is asked has been done, which is heard as well."""
        if self.through:
            return ""
        if self._praise:
            self._praise -= 1
            if not self._praise:
                self._begin_lesson(self._number + 1)
            return ""
        done = flight.hand is self.lesson.by and self.lesson.done(flight)
        self._done_for = self._done_for + 1 if done else 0 if self.lesson.held else self._done_for
        if self._done_for < self.lesson.steps:
            return ""
        self._praise = _PRAISE
        self.through = self._number == len(self._lessons) - 1
        return "" if self.through else "choose"  # a landing has a sound of its own

    def skip(self) -> None:
        """Leave out the lesson, and those that begin with it."""
        left = self._lessons[self._number + 1 :]
        beyond = next((number for number, lesson in enumerate(left, 1) if not lesson.back), 0)
        self.through = not beyond
        self._begin_lesson(self._number + beyond)

    def again(self) -> bool:
        """Whether a flight that is over begins again: unless it was the landing that is asked for."""
        return not self.through

    def card(self, card: Card, flight: Flight) -> Card:  # noqa: ARG002
        """Say that this was all; of who flies it once more and crashes, say that."""
        if not card.good:
            return replace(card, score="")
        return replace(card, title=texts.TUTORIAL_DONE, reason=texts.TUTORIAL_DONE_REASON, score="")

    def _begin_lesson(self, number: int) -> None:
        self._number = number
        self._done_for = self._praise = self._begun = 0

    # The picture

    def words(self, flight: Flight, controls: Controls) -> str:
        """Return what to say now, in the words of the device in use."""
        left, right = controls.word(Held.LEFT), controls.word(Held.RIGHT)
        return self._line(flight.env, flight.hand).format(
            main=controls.word(Held.MAIN),
            turn=left if left == right else texts.TUTORIAL_EITHER.format(left=left, right=right),
            other=right if flight.env.angle[0] > 0 else left,
            hand_over=controls.word(Command.HANDOVER),
        )

    def _line(self, env: LanderEnv, hand: Hand) -> str:
        told = texts.TUTORIAL[self.lesson.name]
        if hand is Hand.HUMAN and _falls_too_fast(env):
            return texts.TUTORIAL_TOO_FAST
        if self._praise:
            return texts.TUTORIAL_GOOD[self.lesson.name]
        if hand is Hand.NETWORK:
            return texts.TUTORIAL["take_back"][0]
        if env.outcome[0] != Outcome.FLYING:
            return texts.TUTORIAL_AGAIN
        if self.lesson.name == "land" and env.altitude[0] < _NEAR and env.tilt[0] > env.limits.touch_tilt / 2:
            return texts.TUTORIAL_TOO_TILTED
        if self.lesson.name not in ("lean", "land") and abs(float(env.position[0, 0])) > 12:
            return texts.TUTORIAL_AWAY
        return told[1] if self._begun > 2 and told[1] else told[0]

    def draw(self, canvas: Canvas, view: View, flight: Flight, alpha: float, controls: Controls) -> None:
        """Write one line beside the craft."""
        if flight.over and self.through:
            return
        x, y, _ = flight.poses.at(alpha)[0].tolist()
        words = self.words(flight, controls)
        praised = bool(self._praise) and words == texts.TUTORIAL_GOOD[self.lesson.name]
        width = canvas.text_width(words, size=_SIZE) + (22 if praised else 0)
        right = float(view.points((x + _BESIDE, y))[0])
        left = float(view.points((x - _BESIDE, y))[0]) - width - 28
        at = right if right + width + 28 + _EDGE < VIEW_SIZE[0] else left
        row = min(max(float(view.points((x, y))[1]), _ROWS[0]), _ROWS[1])
        canvas.panel((at, row - 18, width + 28, 36))
        at += 14
        if praised:
            canvas.marker("check", (at + 6, row), 12, canvas.palette.good)
            at += 22
        canvas.text(words, (at, row + 6), size=_SIZE, colour=canvas.palette.good if praised else INK)
