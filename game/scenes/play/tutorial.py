"""Tutorial, the first flight: one lesson at a time, written beside the craft, each complete once the player does it.

It is flown like any other challenge and never blocks the player: a lesson can be skipped, and the tutorial left. After
a crash the lesson restarts with the craft hanging in the sky, and the reason is shown. Whenever the craft waits, the
line beside it names the key that it waits for.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ai.lander.environment import LanderEnv, Outcome
from ai.lander.missions import FIRST
from game.core import texts
from game.explain.readouts import yours
from game.flight.choosers import Crew
from game.flight.flight import Flight, Recording, StickHolder
from game.flight.networks import Policy, QPolicy, sentence, who
from game.flight.outcomes import TIPPED, OutcomeCard, outcome_card
from game.input.bindings import Command, Held
from game.input.controls import Controls
from game.scenes.play.challenge import Challenge, Start, Wanted, Words
from game.scenes.play.words import falls_too_fast, leaves_at_the_top, turned

if TYPE_CHECKING:
    from game.scenes.play.flown_flight import FlownFlight

_PRAISE: Final = 40  # steps that a finished lesson stays on the screen, with a tick
_LONG: Final = 840  # steps in flight after which the network lands a rescue that does not come down
_NEAR: Final = 4.0  # metres above the pad, below which the craft should be upright
_WHY_SHOWN: Final = 240  # steps in flight that the reason for a restart stays on the screen
_SIDEWAYS: Final = 12.0  # metres from the pad that count as far
_LEAN: Final = 0.15  # rad
_UPRIGHT: Final = (0.08, 0.15)  # rad, rad/s
_SLOW, _RISING = 1.0, 0.3  # m/s down that are slow, and up from which on the craft rises instead of braking
_MANY: Final = 2  # times that a lesson is begun before its other words are tried
NETWORK, COPILOT = "network", "copilot"


@dataclass(frozen=True)
class Lesson:
    """One lesson: something to do, and how to tell that it is done.

    Attributes:
        name: key of its line in `texts.TUTORIAL`.
        done: predicate: whether the lesson's action is being done in this step of a flight.
        steps: number of steps for which it must be done, 60 per second; consecutive if `held`.
        start: height, sinking speed and tilt at which the lesson restarts after a crash, and metres beside the pad.
        by: who must have the stick; None for anybody.
        needs: whether it needs a network to hand over to, or one that can share the stick; empty for neither.
        hands_off: whether it begins with all controls released, and needs no touch.
        back: number of lessons to go back when it restarts.
        guarded: whether the co-pilot shares the stick, as far as the dial says; else it would do what is to be learnt.

    """

    name: str
    done: Callable[[Flight[Crew]], bool]
    steps: int
    start: tuple[float, float, float, float] = (17.0, 0.0, 0.0, 0.0)
    held: bool = True
    by: StickHolder | None = StickHolder.HUMAN
    needs: str = ""
    back: int = 0
    hands_off: bool = False
    guarded: bool = False


def _stands_upright(flight: Flight[Crew]) -> bool:
    env = flight.env
    return bool(env.tilt[0] < _UPRIGHT[0] and abs(env.angular_velocity[0]) < _UPRIGHT[1])


def _falls(flight: Flight[Crew]) -> bool:
    return bool(flight.env.actions[0] == 0 and flight.env.velocity[0, 1] < -0.3)


def _lands(flight: Flight[Crew]) -> bool:
    return flight.outcome is Outcome.LANDED


_ASIDE: Final = (12.0, 0.0, 0.0, 4.0)
LESSONS: Final = (
    Lesson("fire", lambda flight: bool(flight.env.actions[0] >= 3), 24, (14.0, 0.0, 0.0, 0.0), held=False),
    Lesson("fall", _falls, 50, hands_off=True),
    Lesson("brake", lambda flight: bool(-_SLOW <= flight.env.velocity[0, 1] <= _RISING), 50, (16.0, -2.0, 0.0, 0.0)),
    Lesson("lean", lambda flight: bool(flight.env.tilt[0] > _LEAN), 1),
    Lesson("upright", _stands_upright, 20, (17.0, 0.0, 0.3, 0.0)),
    Lesson("hand_over", lambda _: True, 1, by=StickHolder.NETWORK, needs=NETWORK),
    Lesson("take_back", lambda _: True, 1, needs=NETWORK, back=1),
    Lesson("land", _lands, 1, (8.0, 0.0, 0.0, 0.0)),
    Lesson("dial", lambda _: True, 1, _ASIDE, needs=COPILOT, guarded=True),
    Lesson("rescue", _lands, 1, _ASIDE, by=None, needs=COPILOT, back=1, guarded=True),
)


class Tutorial(Challenge):
    """Tutorial: the first flight.

    Attributes:
        flown: whether the last lesson was completed by a landing.
        praise: number of steps for which the last lesson is still praised.

    """

    def __init__(self) -> None:
        super().__init__(kept=False, again=True, skip=self.skip)
        self._lessons = list(LESSONS)
        self.flown = self._saved = False  # saved: whether a guard has kept the present flight from a crash
        self._begin_lesson(0)

    @property
    def lesson(self) -> Lesson:
        return self._lessons[self._number]

    def _begin_lesson(self, number: int) -> None:
        self._number, self._over = number, False
        self._flown_for = self._done_for = self.praise = self._begun = 0
        self._why = ""
        self._rule()

    def _rule(self) -> None:
        """Set the rules of the lesson. A guard is shown only to who keeps the stick."""
        guarded = self.lesson.guarded
        self.rules.guides = self.rules.holds = guarded
        self.rules.keeps_stick = guarded and not self.rules.through
        self.rules.waits = not self.lesson.hands_off

    def _end(self) -> None:
        """Let free flights follow."""
        self.rules.through, self.rules.fixed, self.rules.again, self.rules.keeps_stick = True, False, False, False

    def start(self, wanted: Wanted) -> Start:
        """Begin at the current lesson, or one before it; without a network, leave out what needs one."""
        self._leave_out(wanted.network)
        self._number -= self.lesson.back
        self._rule()
        self._begun += 1
        self._done_for = self.praise = self._flown_for = 0
        self._over = self._saved = False
        return Start(
            Recording(wanted.seed, "random", mission=FIRST.name), shares=self.lesson.guarded, place=self._place
        )

    def _place(self, flight: Flight[Any]) -> None:
        height, sinks, angle, aside = self.lesson.start
        flight.env.place(np.ones(1, bool), np.array([[aside, height, 0.0, sinks, angle, 0.0]]))
        flight.observation = flight.env.observe()
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
            settings.help = "guard" if settings.help == "off" else settings.help  # as it is taught next
        if (self.rules.through or self.flown) and not settings.tutored:
            settings.tutored = True
            flown.context.apply_settings()
        return sound

    def follow(self, flight: Flight[Crew]) -> str:
        """Check whether the lesson is done; return the sound to play if so."""
        if self.rules.through:
            return ""
        self._leave_out(flight.chooser.network)
        hand, ends = flight.chooser.hand, flight.over and not self._over
        landed = ends and flight.outcome is Outcome.LANDED and hand is StickHolder.HUMAN and not self.lesson.needs
        self._over = flight.over
        if ends and not landed:
            self._why = self._reason(flight)
        self._flown_for += 1
        self._saved |= flight.choice.overridden and (flight.chooser.guard is None or flight.chooser.guard.saves)
        if self.praise:
            self.praise -= 1
            if not self.praise:
                watched = self._watched(flight)
                self._begin_lesson(self._number + 1)
                self._why = texts.TUTORIAL_WATCHED if watched else ""
            return ""
        if self.lesson.guarded and self._flown_for == _LONG and flight.chooser.hand is StickHolder.HUMAN:
            flight.chooser.hand_over()  # kept from crashing by a co-pilot, one may hover without end
        done = (hand is (self.lesson.by or hand) and self.lesson.done(flight)) or self._watched(flight)
        self._done_for = self._done_for + 1 if done else 0 if self.lesson.held else self._done_for
        if landed:  # whoever lands need not be taught to brake any more
            self._done_for = self.lesson.steps
        if self._done_for < self.lesson.steps:
            return ""
        self.praise, self._why = _PRAISE, ""
        self.flown |= self.lesson.name == "land"
        if self._number == len(self._lessons) - 1:
            self._end()
        return "" if flight.over else "choose"  # a landing has a sound of its own

    def _watched(self, flight: Flight[Crew]) -> bool:
        """Whether the network has landed before the stick was taken back, which is as good: it was to be watched."""
        by_network = flight.chooser.hand is StickHolder.NETWORK and flight.outcome is Outcome.LANDED
        return self.lesson.name == "take_back" and by_network

    def _reason(self, flight: Flight[Crew]) -> str:
        if flight.outcome is not Outcome.LANDED:
            return outcome_card(flight.env, flight.share).reason
        by_network = flight.chooser.hand is StickHolder.NETWORK
        landed = sentence(texts.TUTORIAL_NETWORK_LANDED, who(flight.chooser.network))
        return landed if by_network else texts.TUTORIAL_LANDED_EARLY

    def skip(self) -> None:
        """Skip the lesson, and those that start with it."""
        left = self._lessons[self._number + 1 :]
        beyond = next((number for number, lesson in enumerate(left, 1) if not lesson.back), 0)
        if not beyond:
            self._end()
        self._begin_lesson(self._number + beyond)

    def ended(self, flown: FlownFlight) -> None:
        """Keep nothing."""

    def _add_to(self, flown: FlownFlight, card: OutcomeCard) -> None:
        """Make the final card: tutorial complete, or the crash of a player who flies it once more."""
        flight, card.score = flown.flight, ""
        if not card.good:
            return
        card.title, card.reason, card.advice = texts.TUTORIAL_DONE, texts.TUTORIAL_DONE_REASON, texts.TUTORIAL_NEXT
        if not self.lesson.guarded:
            return
        if card.stepped_in:
            card.title, card.reason = texts.TUTORIAL_SAVED_TITLE, texts.TUTORIAL_SAVED
        elif flight.share < 1:
            card.title, percent = texts.TUTORIAL_GOOD["land"], 100 - yours(flight.share)
            card.reason = texts.TUTORIAL_HELPED.format(who=who(flight.chooser.network), percent=percent)
        else:
            card.reason = texts.TUTORIAL_NOT_NEEDED
        card.quality = card.quality if flight.share == 1 else ""

    # In words

    def words(self, flown: FlownFlight) -> Words:
        flight, waiting = flown.flight, flown.waiting and not flown.flight.over
        said = self.sentence(flight, flown.context.controls, waiting=waiting, stuck=flown.stuck)
        line = texts.TUTORIAL_STEP.format(number=self._number + 1, count=len(self._lessons))
        asides = [self.why] if self.why and not flight.wrecked else []
        following = "" if self.rules.through else texts.TUTORIAL_SKIP
        card = partial(self._add_to, flown)
        return Words(texts.TUTORIAL_TITLE, line, sentence=said, asides=asides, next=following, card=card)

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
        env, lesson, network = flight.env, self.lesson, flight.chooser.hand is StickHolder.NETWORK
        usual, other = (*texts.TUTORIAL[lesson.name], "")[:2]
        if flight.over:
            if self._watched(flight):
                return texts.TUTORIAL_WATCHED
            return texts.TUTORIAL_GOOD[lesson.name] if self.praise else texts.TUTORIAL_AGAIN
        if waiting and lesson.guarded:
            return usual if flight.chooser.copilot and not flight.chooser.copilot.assist else texts.TUTORIAL_PATHS
        if stuck:
            return usual if lesson.hands_off else texts.TUTORIAL_LET_GO
        if waiting and lesson.name == "land":  # the lesson's own line names no key that starts the flight
            return texts.TUTORIAL_READY
        if not (network or lesson.guarded) and (urgent := self._urgent(env)):
            return urgent
        if self.praise:
            return texts.TUTORIAL_GOOD[lesson.name]
        if network:
            brought = texts.TUTORIAL_BROUGHT if self._saved else texts.TUTORIAL_LONG
            return brought if lesson.guarded else texts.TUTORIAL["take_back"][0]
        if lesson.guarded:
            return other if self._begun > _MANY or self._flown_for > _LONG else usual
        if lesson.name not in ("lean", "fall") and abs(float(env.position[0, 0])) > _SIDEWAYS:
            return texts.TUTORIAL_AWAY
        if lesson.name == "brake" and env.velocity[0, 1] > _RISING:
            return texts.TUTORIAL_RISES
        if lesson.name == "upright" and abs(turned(env)) < _UPRIGHT[0]:
            return texts.TUTORIAL_STANDS
        return other if self._begun > _MANY and other else usual

    def _urgent(self, env: LanderEnv) -> str:
        """Return an urgent warning, which precedes any lesson; empty if nothing is urgent."""
        if falls_too_fast(env):
            return texts.TUTORIAL_TURN_FIRST if env.tilt[0] > TIPPED else texts.TUTORIAL_TOO_FAST
        if leaves_at_the_top(env):
            return texts.TUTORIAL_TOO_HIGH
        if self.lesson.name == "land" and env.altitude[0] < _NEAR and env.tilt[0] > env.limits.touch_tilt / 2:
            return texts.TUTORIAL_TOO_TILTED
        return ""

    @property
    def why(self) -> str:
        """Return why the lesson restarts, until it has flown for a while; empty if it has not restarted."""
        return self._why if self._over or self._flown_for < _WHY_SHOWN else ""
