"""Tutorial, the first flight: one lesson at a time, written over the craft, each complete once the player does it.

It is flown like any other challenge and never blocks the player: a lesson can be skipped, and the tutorial left. After
a crash the lesson restarts with the craft hanging in the sky, and the reason is shown.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ai.lander.environment import Outcome
from ai.lander.missions import FIRST
from game.core import texts
from game.flight.choosers import Crew
from game.flight.flight import Flight, Recording, StickHolder
from game.flight.networks import Policy, QPolicy, who
from game.flight.outcomes import TIPPED, OutcomeCard, outcome_card
from game.input.bindings import Command, Held
from game.input.controls import Controls
from game.scenes.play.challenge import Challenge, Start, Wanted, Words
from game.scenes.play.words import falls_too_fast, leaves_at_the_top, turned

if TYPE_CHECKING:
    from game.scenes.play.flown_flight import FlownFlight

_PRAISE: Final = 40  # steps that a finished lesson stays on the screen, with a tick
_WHY_SHOWN: Final = 240  # steps in flight that the reason for a restart stays on the screen
_SIDEWAYS: Final = 12.0  # metres from the pad that count as far
_LEAN: Final = 0.15  # rad
_UPRIGHT: Final = (0.08, 0.15)  # rad, rad/s
_STOP: Final = 0.5  # seconds before the craft is upright, from which on its turn is to be stopped
_SLOW, _RISING = 2.0, 0.3  # m/s down that a landing allows, and up from which on the craft rises, not brakes
NETWORK, COPILOT = "network", "copilot"


@dataclass(frozen=True)
class Lesson:
    """One lesson: something to do, and how to tell that it is done.

    Attributes:
        name: key of its lines in `texts.TUTORIAL`.
        done: predicate: whether the lesson's action is being done in this step of a flight; None to land.
        steps: number of steps in a row for which it must be done, 60 per second.
        start: height, sinking speed and tilt at which the lesson restarts after a crash, and metres beside the pad.
        needs: whether it needs a network to hand over to, or one that can share the stick; empty for neither.

    """

    name: str
    done: Callable[[Flight[Crew]], bool] | None = None
    steps: int = 1
    start: tuple[float, float, float, float] = (17.0, 0.0, 0.0, 0.0)
    needs: str = ""


def _stands_upright(flight: Flight[Crew]) -> bool:
    env = flight.env
    return bool(env.tilt[0] < _UPRIGHT[0] and abs(env.angular_velocity[0]) < _UPRIGHT[1])


LESSONS: Final = (
    Lesson("fire", lambda flight: bool(flight.env.actions[0] >= 3), 24, (14.0, 0.0, 0.0, 0.0)),
    Lesson("brake", lambda flight: bool(-_SLOW <= flight.env.velocity[0, 1] <= _RISING), 90, (16.0, -2.0, 0.0, 0.0)),
    Lesson("lean", lambda flight: bool(flight.env.tilt[0] > _LEAN)),
    Lesson("upright", _stands_upright, 20, (17.0, 0.0, 0.3, 0.0)),
    Lesson("land", start=(8.0, 0.0, 0.0, 0.0)),
    Lesson("hand_over", needs=NETWORK),
    Lesson("guard", start=(12.0, 0.0, 0.0, 4.0), needs=COPILOT),
)


class Tutorial(Challenge):
    """Tutorial: the first flight.

    Attributes:
        flown: whether the player has landed.
        praise: number of steps for which the last lesson is still praised.

    """

    def __init__(self) -> None:
        super().__init__(kept=False, again=True)
        self._lessons = list(LESSONS)
        self.flown, self._side = False, 1.0  # to which it leans where a lesson restarts: left, or as the player did
        self._number, self._why = 0, ""
        self._begin()

    @property
    def lesson(self) -> Lesson:
        return self._lessons[self._number]

    def _begin(self) -> None:
        self._over = self._handed_over = self.rules.anew = False
        self._flown_for = self._done_for = self.praise = 0

    def _end(self) -> None:
        """Let free flights follow."""
        self.rules.through, self.rules.fixed, self.rules.again = True, False, False

    def start(self, wanted: Wanted) -> Start:
        """Begin at the current lesson, or after one just done; without a network, leave out what needs one."""
        self._number += bool(self.praise and not self.rules.through)
        self._leave_out(wanted.network)
        self._begin()
        recording = Recording(wanted.seed, "random", mission=FIRST.name)
        return Start(recording, shares=self.lesson.needs == COPILOT, place=self._place)

    def _place(self, flight: Flight[Any]) -> None:
        height, sinks, angle, aside = self.lesson.start
        flight.env.place(np.ones(1, bool), np.array([[aside, height, 0.0, sinks, self._side * angle, 0.0]]))
        flight.rest()

    def _leave_out(self, network: Policy | None) -> None:
        """Leave out, at any point of the tutorial, the lessons that the network there is cannot take part in."""
        unable = {NETWORK} if network is None else set()
        unable |= set() if isinstance(network, QPolicy) else {COPILOT}
        able = [lesson for lesson in self._lessons if lesson.needs not in unable]
        ahead = [lesson for lesson in self._lessons[self._number :] if lesson in able]
        self._lessons, self._number = able, able.index(ahead[0]) if ahead else len(able) - 1
        if not ahead:
            self._end()

    # Progress

    def stepped(self, flown: FlownFlight) -> str:
        """Check whether the lesson is done, and keep that the tutorial is over, so that it is not offered again."""
        sound, settings = self.follow(flown.flight), flown.context.settings
        if self.flown and not settings.first_flown:
            settings.first_flown = True
        if (self.rules.through or self.flown) and not settings.tutored:
            settings.tutored = True
            flown.context.apply_settings()
        return sound

    def follow(self, flight: Flight[Crew]) -> str:
        """Check whether the lesson is done; return the sound to play if so."""
        if self.rules.through:
            return ""
        self._leave_out(flight.chooser.network)
        if flight.over and not self._over and flight.outcome is not Outcome.LANDED:
            self._why = outcome_card(flight.env).reason
        self._over = flight.over
        self._flown_for += 1
        self._handed_over |= flight.chooser.hand is StickHolder.NETWORK
        if self.praise:
            self.praise = max(1, self.praise - 1)
            self.rules.anew = self.praise == 1  # the next lesson is read before anything falls
            return ""
        self._done_for = self._done_for + 1 if self._does(flight) else 0
        if self._done_for < (1 if flight.over else self.lesson.steps):
            return ""
        self.praise, self._why, self._side = _PRAISE, "", np.copysign(1.0, turned(flight.env, 0.0))
        self.flown |= self.lesson.name == "land"
        if self._number == len(self._lessons) - 1:
            self._end()
        return "" if flight.over else "choose"  # a landing has a sound of its own

    def _does(self, flight: Flight[Crew]) -> bool:
        """Whether the player does in this step what the lesson asks for, or has landed and need not be taught it."""
        landed, by_hand = flight.outcome is Outcome.LANDED, flight.chooser.hand is StickHolder.HUMAN
        if self.lesson.needs == COPILOT:
            return landed and flight.chooser.shared
        if self.lesson.needs == NETWORK:
            return self._handed_over and (by_hand or landed)
        return by_hand and (landed or bool(self.lesson.done and self.lesson.done(flight)))

    def skip(self) -> None:
        """Skip the lesson."""
        if self._number == len(self._lessons) - 1:
            self._end()
        else:
            self._number, self._why, self.praise = self._number + 1, "", 0

    def ended(self, flown: FlownFlight) -> None:
        """Keep nothing."""

    def _add_to(self, flown: FlownFlight, card: OutcomeCard) -> None:
        """Make the final card: tutorial complete, or the crash of a player who flies it once more."""
        card.score = ""
        if card.good:
            card.title, card.reason, card.advice = texts.TUTORIAL_DONE, texts.TUTORIAL_DONE_REASON, texts.TUTORIAL_NEXT
            if flown.interventions.moments:
                card.title, card.reason = texts.TUTORIAL_SAVED_TITLE, texts.TUTORIAL_SAVED

    # In words

    def words(self, flown: FlownFlight) -> Words:
        flight, waiting = flown.flight, flown.waiting and not flown.flight.over
        said = self.sentence(flight, flown.context.controls, waiting=waiting, stuck=flown.stuck)
        line = texts.TUTORIAL_STEP.format(number=self._number + 1, count=len(self._lessons))
        following = "" if self.rules.through else texts.TUTORIAL_SKIP
        return Words(
            texts.TUTORIAL_TITLE, line, goal="" if flight.wrecked else self.why, sentence=said, next=following,
            card=partial(self._add_to, flown),
        )  # fmt: skip

    def sentence(self, flight: Flight[Crew], controls: Controls, *, waiting: bool = False, stuck: bool = False) -> str:
        """Return the instruction, in the key names of the device in use."""
        if flight.over and self.rules.through:
            return ""
        left, right = controls.word(Held.LEFT), controls.word(Held.RIGHT)
        turn = texts.TUTORIAL_EITHER.format(left=left, right=right)
        if left == right:  # one control for both: the mouse, which turns towards its pointer, or a stick
            mouse, turn = controls.mouse_in_use, left
            left, right = (text.format(key=turn) for text in (texts.TUTORIAL_POINT if mouse else texts.TUTORIAL_PUSH))
            turn = texts.TUTORIAL_POINT_EITHER.format(key=turn) if mouse else turn
        env = flight.env
        return self._line(flight, waiting, stuck).format(
            main=controls.word(Held.MAIN),
            turn=turn,
            other=right if turned(env) > 0 else left,
            who=who(flight.chooser.network),
            inward=right if env.position[0, 0] < 0 else left,
            hand_over=controls.word(Command.HANDOVER),
            more=texts.TUTORIAL_WHEEL if controls.mouse_in_use else controls.word(Command.FASTER),
        )

    def _line(self, flight: Flight[Crew], waiting: bool, stuck: bool) -> str:
        env, name, network = flight.env, self.lesson.name, flight.chooser.hand is StickHolder.NETWORK
        usual, then = (*texts.TUTORIAL[name], "")[:2]
        if flight.over or self.praise:
            return texts.TUTORIAL_GOOD[name] if self.praise else texts.TUTORIAL_AGAIN
        if stuck:
            return texts.TUTORIAL_LET_GO
        if network:
            return texts.TUTORIAL["hand_over"][1]
        if self.lesson.needs == COPILOT:
            return then if flight.chooser.shared else usual
        if waiting and name == "land":  # the lesson's own line names no key that starts the flight
            return texts.TUTORIAL_READY
        if falls_too_fast(env):  # until it does no more: who is told once and does it is not told to stop
            return texts.TUTORIAL_TURN_FIRST if env.tilt[0] > TIPPED else texts.TUTORIAL_TOO_FAST
        if leaves_at_the_top(env):
            return texts.TUTORIAL_TOO_HIGH
        if name != "lean" and abs(float(env.position[0, 0])) > _SIDEWAYS:
            return texts.TUTORIAL_AWAY
        if name == "upright" and _stands_upright(flight):
            return texts.TUTORIAL_GOOD[name]
        if name == "upright" and turned(env, 0.0) * turned(env) < 0:  # it is turning back
            return texts.TUTORIAL_TURNS if turned(env, 0.0) * turned(env, _STOP) > 0 else then
        return texts.TUTORIAL_RISES if name == "brake" and env.velocity[0, 1] > _RISING else usual

    @property
    def why(self) -> str:
        """Return why the lesson restarts, until it has flown for a while; empty if it has not restarted."""
        return self._why if self._over or self._flown_for < _WHY_SHOWN else ""
