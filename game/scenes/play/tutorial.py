"""Tutorial, the first flight: one lesson at a time, written beside the craft, each complete once the player does it.

It is flown like any other challenge and never blocks the player: a lesson can be skipped, and the tutorial left. After
a crash the lesson restarts with the craft hanging in the sky, and the reason is shown. Whenever the craft waits, the
line beside it names the key that it waits for.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from ai.lander.environment import LanderEnv, Outcome
from ai.lander.missions import FIRST
from game.core import texts
from game.core.settings import Settings
from game.flight.credit import Credit
from game.flight.flight import Flight, StickHolder
from game.flight.networks import Policy, QPolicy
from game.flight.outcomes import TIPPED, OutcomeCard, outcome_card
from game.input.bindings import Command, Held
from game.input.controls import Controls
from game.scenes.play.challenge import Challenge
from game.scenes.play.help_words import GUARDIAN, choose
from game.scenes.play.tutorial_lessons import (
    LESSONS,
    NEED_COPILOT,
    NEED_NETWORK,
    RISING,
    UPRIGHT,
    Lesson,
    falls_too_fast,
    leaves_at_the_top,
    turned,
)

_PRAISE: Final = 40  # steps that a finished lesson stays on the screen, with a tick
_LONG: Final = 840  # steps in flight after which the network lands a rescue that does not come down
_NEAR: Final = 4.0  # metres above the pad, below which the craft should be upright
_TOLD_WHY: Final = 240  # steps in flight that the reason for a restart stays on the screen
_SIDEWAYS: Final = 12.0  # metres from the pad that count as far


class Tutorial(Challenge):
    """Tutorial: the first flight.

    Attributes:
        lesson: the current lesson.
        through: whether all lessons are done or skipped.
        flown: whether the last lesson was completed by a landing.
        praise: number of steps for which the last lesson is still praised.

    """

    kept = False

    def __init__(self) -> None:
        self.title, self.next_hint = texts.TUTORIAL_TITLE, texts.TUTORIAL_SKIP
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
        self._leave_out(network)
        self._number -= self.lesson.back
        self._begun += 1
        self._done_for = self.praise = self._flown_for = 0
        self._over = False
        flight = Flight(seed, network, mission=FIRST.name, shares=self.lesson.guarded)
        flight.env.place(np.ones(1, bool), np.array([self.lesson.start]))
        flight.observation = flight.env.observe()
        flight.rest()
        return flight

    def follow(self, flight: Flight) -> str:
        """Check whether the lesson is done; return the sound to play if so."""
        if self.through:
            return ""
        self._leave_out(flight.network)
        if flight.over and not self._over:
            self._why = self._reason(flight)
        self._over = flight.over
        self._flown_for += 1
        if self.praise:
            self.praise -= 1
            if not self.praise:
                watched = self._watched(flight)
                self._begin_lesson(self._number + 1)
                self._why = texts.TUTORIAL_WATCHED if watched else ""
            return ""
        if self.lesson.guarded and self._flown_for == _LONG and flight.hand is StickHolder.HUMAN:
            flight.hand_over()  # kept from crashing by a co-pilot, one may hover without end
        done = (flight.hand is (self.lesson.by or flight.hand) and self.lesson.done(flight)) or self._watched(flight)
        self._done_for = self._done_for + 1 if done else 0 if self.lesson.held else self._done_for
        if self._done_for < self.lesson.steps:
            return ""
        self.praise, self._why = _PRAISE, ""
        self.flown |= self.lesson.name == "land"
        self.through = self._number == len(self._lessons) - 1
        return "" if flight.over else "choose"  # a landing has a sound of its own

    def _watched(self, flight: Flight) -> bool:
        """Whether the network has landed before the stick was taken back, which is as good: it was to be watched."""
        by_network = flight.hand is StickHolder.NETWORK and flight.outcome is Outcome.LANDED
        return self.lesson.name == "take_back" and by_network

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
        if self.flown and not settings.first_flown and settings.assist == 0:
            choose(settings, "guard")  # as it is taught next
        settings.tutored |= self.through or self.flown
        settings.first_flown |= self.flown
        return before != (settings.tutored, settings.first_flown)

    def dial(self, settings: Settings) -> Settings:
        """Return the dial of the lessons, on guard and at nothing: the player's own stays where it is."""
        self._help = self._help or replace(settings, assist=0.0, copilot=GUARDIAN)
        return self._help

    @property
    def holds(self) -> bool:
        """Whether the craft goes on to hang: until the dial is turned, where a lesson asks for that."""
        return self.lesson.guarded and self._help is not None and self._help.assist == 0

    @property
    def guides(self) -> bool:
        """Whether the network's path is previewed."""
        return self.lesson.guarded

    @property
    def waits(self) -> bool:
        """Whether a touch starts the flight; false for a lesson that asks for no touch."""
        return not self.lesson.hands_off

    def again(self) -> bool:
        """Whether a finished flight restarts: true unless it was the landing that the last lesson asks for."""
        return not self.through

    def card(self, card: OutcomeCard, flight: Flight, credit: Credit) -> OutcomeCard:
        """Return the final card: tutorial complete, or the crash of a player who flies it once more."""
        if not card.good:
            return replace(card, score="")
        title, reason = texts.TUTORIAL_DONE, texts.TUTORIAL_DONE_REASON
        if self.lesson.guarded:
            title = texts.TUTORIAL_SAVED_TITLE if card.stepped_in else title
            reason = texts.TUTORIAL_SAVED if card.stepped_in else texts.TUTORIAL_NOT_NEEDED
        return replace(card, title=title, reason=reason, score="", advice=texts.TUTORIAL_NEXT)

    def _begin_lesson(self, number: int) -> None:
        self._number, self._why = number, ""
        self._done_for = self.praise = self._begun = 0

    def _leave_out(self, network: Policy | None) -> None:
        """Leave out, at any point of the tutorial, the lessons that the network there is cannot take part in."""
        unable = (NEED_NETWORK if network is None else ()) + (() if isinstance(network, QPolicy) else NEED_COPILOT)
        able = [lesson for lesson in self._lessons if lesson.name not in unable]
        ahead = [lesson for lesson in self._lessons[self._number :] if lesson in able]
        self._lessons, self._number = able, able.index(ahead[0]) if ahead else len(able) - 1
        self.through |= not ahead

    def _reason(self, flight: Flight) -> str:
        """Return the reason why the lesson restarts."""
        if flight.outcome is not Outcome.LANDED:
            return outcome_card(flight.env, flight.share).reason
        if flight.hand is StickHolder.NETWORK:
            return texts.TUTORIAL_NETWORK_LANDED
        return texts.TUTORIAL_LANDED_EARLY

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
            other=right if turned(env) > 0 else left,
            inward=right if env.position[0, 0] < 0 else left,
            hand_over=controls.word(Command.HANDOVER),
            more=texts.TUTORIAL_WHEEL if controls.mouse_in_use else controls.word(Command.FASTER),
        )

    def _line(self, flight: Flight, waiting: bool, stuck: bool) -> str:
        env, lesson = flight.env, self.lesson
        told = texts.TUTORIAL[lesson.name]
        if flight.over:
            return self._line_after(flight)
        if waiting and lesson.guarded:
            return told[0] if self.holds else texts.TUTORIAL_PATHS
        if stuck:
            return told[0] if lesson.hands_off else texts.TUTORIAL_LET_GO
        if waiting and lesson.name == "land":  # the lesson's own line names no key that starts the flight
            return texts.TUTORIAL_READY
        if flight.hand is StickHolder.HUMAN and not lesson.guarded and (urgent := self._urgent(env)):
            return urgent
        if self.praise:
            return texts.TUTORIAL_GOOD[lesson.name]
        if lesson.guarded and flight.hand is StickHolder.NETWORK:
            return texts.TUTORIAL_BROUGHT
        if lesson.guarded:
            return told[1] if self._begun > 2 or self._flown_for > _LONG else told[0]
        if flight.hand is StickHolder.NETWORK:
            return texts.TUTORIAL["take_back"][0]
        if lesson.name not in ("lean", "fall") and abs(float(env.position[0, 0])) > _SIDEWAYS:
            return texts.TUTORIAL_AWAY
        if lesson.name == "brake" and env.velocity[0, 1] > RISING:
            return texts.TUTORIAL_RISES
        if lesson.name == "upright" and abs(turned(env)) < UPRIGHT[0]:
            return texts.TUTORIAL_STANDS
        return told[1] if self._begun > 2 and told[1] else told[0]

    def _line_after(self, flight: Flight) -> str:
        if self._watched(flight):
            return texts.TUTORIAL_WATCHED
        return texts.TUTORIAL_GOOD[self.lesson.name] if self.praise else texts.TUTORIAL_AGAIN

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
        return self._why if self._over or self._flown_for < _TOLD_WHY else ""

    def sentence(self, flight: Flight, controls: Controls, *, waiting: bool, stuck: bool) -> str | None:
        """Return the instruction."""
        return "" if flight.over and self.through else self.words(flight, controls, waiting=waiting, stuck=stuck)

    def asides(self, flight: Flight) -> Sequence[str]:
        """Return why the lesson restarts."""
        return [self.why] if self.why and not flight.wrecked else []
