"""Play: fly, hand the stick to the network, take it back."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Final

import numpy as np
import pygame

from game import framing, hud, networks, texts
from game.clock import STEP
from game.cockpit.cockpit import Cockpit
from game.cockpit.hands import HANDS, OWN
from game.cockpit.skill import Skill
from game.cockpit.surroundings import draw_surroundings
from game.context import Context
from game.controls import Command, translate
from game.course import Course, Duel
from game.difficulty import Difficulty
from game.flight import Flight, Hand
from game.forecast import Drift, Forecast
from game.records import Records
from game.render import Camera
from game.scene import Pop, Push, Transition
from game.sounds.flight import FlightSound
from game.ui.canvas import Canvas
from game.ui.hints import draw_hints, flight_hints
from game.ui.tokens import HUMAN, MARGIN, NET, VIEW_SIZE
from game.ui.widgets import OnPress
from game.world.backdrop import landscape
from game.world.ground import draw_ground
from game.world.looks import look_of
from game.world.paths import draw_dotted
from game.world.stage import Stage

_CARD_AFTER: Final = 45  # steps from the end of a flight to its card
_CARD_RISE: Final = 16
# Going to full screen and back takes the window's focus away for a moment: that is no reason to pause.
_AWAY_STEPS: Final = 10


class Play:
    """One flight after another. `seed` fixes the first; the others are drawn from the context's chance.

    A `rival` flies the same starts beside the player, as a ghost that goes by `rival_name`. Any other `course` is
    flown as it is, too.

    Attributes:
        flight: the flight on the screen.
        waiting: whether it still hangs in the sky for the pilot's first touch.

    """

    def __init__(
        self,
        seed: int | None = None,
        rival: networks.Flyer | None = None,
        rival_name: str = "",
        course: Course | None = None,
    ) -> None:
        self._seed = seed
        self._course = Duel(rival, rival_name) if rival else course
        self._context: Context | None = None
        self.flight: Flight
        self.waiting, self._let_go = True, False
        self._hands = OWN
        self._time = 0.0
        self._away = 0  # steps since the window was left; 0 while it is in use
        self._steps = self._since_end = 0
        self._card: hud.Card | None = None

    def enter(self, context: Context) -> None:
        """Begin the first flight, or go on with the one that was paused, as far as choices made there let it."""
        if self._context is not None:
            if self.waiting and not self._course and self._chosen() != (self.flight.recording.pads, self._hands):
                self.retry()
            return
        self._context = context
        self._controls, self._settings, self._sound = context.controls, context.settings, context.sound
        self._load_network()
        if self._course is None and self._seed is None and not context.settings.tutored:
            from game.tutorial import Tutorial

            self._course, context.settings.tutored = Tutorial(), True
        self._records = Records(context.user_dir)
        self._skill = Skill(self._records.entries())
        if self._records.problem:
            context.note(self._records.problem)
        self._begin(self._new_seed() if self._seed is None else self._seed)

    def exit(self) -> None:
        """Keep the flight for the way back, and what the dial was turned to."""
        assert self._context is not None
        self._context.apply_settings()

    def retry(self) -> None:
        """Fly again from the same start."""
        self._begin(self.flight.recording.seed)

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Hand over, begin again, pause."""
        if event.type in (pygame.WINDOWFOCUSLOST, pygame.WINDOWFOCUSGAINED):
            self._away = int(event.type == pygame.WINDOWFOCUSLOST)
        if self._cockpit.take(event):
            self._name_what_lacks()
            return None
        match translate(event):
            case Command.PAUSE:
                return Pop() if self._leaves else self._pause()
            case Command.UNPLUGGED if not (self.waiting or self.flight.over):
                return self._pause()
            case Command.HANDOVER:
                self._hand_over()
            case Command.CHOICES:
                return self._choose()
            case Command.RETRY:
                self.retry()
            case Command.NEXT:
                self._begin_elsewhere()
            case Command.CONFIRM if self._card_shown > 0:
                return self._go_on()
            case _ if self._card_shown >= 1 and _is_space(event):
                return self._go_on()
        return None

    def update(self) -> Transition | None:
        """Fly one step of 1/60 s."""
        self._let_pass()
        self._cockpit.ease()
        if self._away > _AWAY_STEPS and not self.flight.over:
            return self._pause()
        if self._waits():
            self._look_ahead()
            return None
        flight = self.flight
        was_over = flight.over
        if not was_over:  # at the end, the figures stay those of the last moment before
            self._readouts = hud.flight_readouts(flight.env)
        self._cockpit.help()
        self._difficulty.heed()
        flight.step(self._controls.action)
        if self._ghost:
            self._ghost.step()
        self._look_ahead()
        ended = np.array([flight.over and not was_over])
        if not was_over:
            self._cockpit.follow()
        self._stage.follow(np.array([flight.flown_by is Hand.NETWORK]), ended)
        self._heard.follow(self._stage.thrust[0])
        if not self._settings.reduced_motion:
            framing.follow(self._camera, flight.env)
        self._steps += 1
        if self._course:
            self._course.follow(flight)
        if flight.over:
            self._since_end += 1
            if self._course and self._course.again():
                if self._since_end > _CARD_AFTER:
                    self.retry()
            elif self._card is None:
                self._finish()
        return None

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the world, the craft, the read-outs and, at the end, the card."""
        view = self._camera.view(canvas.scale, alpha)
        flight, env = self.flight, self.flight.env
        pose = flight.poses.at(alpha)[0]
        landscape(canvas.surface.get_size(), self._settings.reduced_motion, look_of(flight.recording.mission)).draw(
            canvas, self._camera, self._time, alpha
        )
        draw_ground(canvas, view, env.ground, self._time, float(env.pad_shift[0]))
        self._cockpit.draw_behind(canvas)
        if flight.over:
            self._cockpit.track.draw(canvas, view)
        if not flight.over:
            draw_dotted(canvas, view, self._drift.path, HUMAN)
        if self._forecast and not flight.over:
            draw_dotted(canvas, view, self._forecast.path, NET)
        if self._ghost:
            self._ghost.draw(canvas, view, alpha)
        self._stage.draw_lander(canvas, view, pose)
        self._stage.draw_dust(canvas, view, alpha)
        self._cockpit.draw_beside(canvas, view, pose)
        if self._course:
            self._course.draw(canvas, view, flight, alpha, self._controls)
        self._draw_hud(canvas)
        if self._card is not None and self._card_shown > 0:
            rival = self._ghost.row(env) if self._ghost else None
            hud.draw_card(canvas, self._card, self._card_keys(), self._card_shown, self._settings.show_hints, rival)

    # The flight

    def _let_pass(self) -> None:
        """Let 1/60 s pass for what moves whether or not anything flies."""
        if not self._settings.reduced_motion:
            self._time += STEP
        self._away += self._away > 0

    def _look_ahead(self) -> None:
        """Predict where the craft goes if nobody touches anything, and where the network would take it."""
        if self.flight.over:
            return
        if not self.waiting:
            self._drift.follow()
        if self._forecast:
            self._forecast.follow(self.flight.env)

    def _waits(self) -> bool:
        """Whether the craft still hangs; a key that began the flight itself must first be let go."""
        action = self._controls.action
        self._let_go = self._let_go or not action
        if self.flight.hand is Hand.NETWORK or (action and self._let_go):
            self.waiting = False
        return self.waiting

    def _begin(self, seed: int) -> None:
        self.waiting, self._let_go = True, False
        course = self._course
        pads, self._hands = (1, OWN) if course else self._chosen()
        check = self._settings.check_flights and self._skill.check_due and not course
        if check:
            self._hands = OWN
        network = None if check else self._network.flyer
        self.flight = course.flight(seed, network) if course else Flight(seed, network, pads=pads, hands=self._hands)
        self._difficulty = Difficulty(self._settings, self.flight, free=not course)
        self._cockpit = Cockpit(self.flight, self._settings, alone=check)
        self._ghost = course.ghost(seed, network) if course else None
        reduced = self._settings.reduced_motion
        # Decoration has a chance of its own: what flies must not depend on what is drawn.
        self._stage = Stage(self.flight.env, np.random.default_rng(seed), reduced)
        self._heard = FlightSound(self._sound, self.flight.env)
        self._camera = Camera()
        if not reduced:
            self._camera.cut(framing.framed(self.flight.env))
        self._readouts = hud.flight_readouts(self.flight.env)
        self._card = None
        self._drift = Drift(self.flight.env)
        self._forecast = None if check else self._new_forecast()
        self._steps = self._since_end = 0

    def _finish(self) -> None:
        """Write a flight down that has just ended, and make its card."""
        assert self._context is not None
        practice = self._difficulty.practice
        self._card = self._cockpit.card(0 if practice else self._skill.best, self._camera.view(1.0))
        course, alone = self._course, self._cockpit.alone(self._hands) and not practice
        if course:
            self._card = course.card(self._card, self.flight)
            if not course.kept:
                return
        if practice:
            self._card = replace(self._card, score=self._difficulty.words)
        told = "" if course or practice else self._cockpit.keep_lesson(self._context.user_dir, self._hands)
        entry = self._records.keep(
            self.flight,
            time.time(),
            alone=alone and (course is None or course.counts),
            network=self._network.name if self._network.flyer else "",
            course=course.name if course else "",
            medal=course.medal(self.flight) if course and not practice else 0,
            pace=self._difficulty.slowest,
        )
        self._skill.add(entry)
        if told or self._records.problem:
            self._context.note(told or self._records.problem)

    def _new_forecast(self) -> Forecast | None:
        ahead = None if self._course else self._network.flyer  # beside a ghost, one blue path is enough
        return Forecast(ahead, self.flight.env.ground) if ahead else None

    def _chosen(self) -> tuple[int, str]:
        """Return how many pads there are, and what hands fly, as the player wants it."""
        hands = self._settings.hands
        return 3 if self._settings.three_pads else 1, hands if hands in HANDS else OWN

    def _load_network(self) -> None:
        assert self._context is not None
        context = self._context
        self._network = networks.chosen(context.models_dir, context.user_dir, context.settings.model)
        if self._network.problem:
            context.note(texts.NO_NETWORK.format(problem=self._network.problem))

    def _new_seed(self) -> int:
        assert self._context is not None
        return int(self._context.rng.integers(2**31))

    def _hand_over(self) -> None:
        if self.flight.hand_over():
            self._sound.play("to_network" if self.flight.hand is Hand.NETWORK else "to_human")
        elif self.flight.network is None and self._network.flyer is None and self._context is not None:
            self._context.note(texts.NO_NETWORK.format(problem=self._network.problem))

    def _name_what_lacks(self) -> None:
        """Say why turning the dial does nothing, where it does nothing."""
        assert self._context is not None
        if self._settings.assist > 0 and self.flight.copilot is None:
            network = self._network
            text = texts.DIAL_NEEDS if network.flyer else texts.NO_NETWORK
            self._context.note(text.format(name=network.name, problem=network.problem))

    def _go_on(self) -> Transition | None:
        """After a landing to a new start, or back from a course that has no other; after a crash to the same one."""
        if self._card is None or not self._card.good:
            self.retry()
        elif self._course and self._course.fixed:
            return Pop()
        else:
            self._begin_elsewhere()
        return None

    def _begin_elsewhere(self) -> None:
        if self._course:
            self._course.skip()
            if self._course.through:
                self._course = None
        self._begin(self.flight.recording.seed if self._course and self._course.fixed else self._new_seed())

    @property
    def _leaves(self) -> bool:
        """Whether Escape goes straight back: from a course that has not begun or is over, nothing is lost."""
        return self._course is not None and (self.waiting or self.flight.over)

    def _pause(self) -> Transition:
        from game.scenes.pause import Pause

        self._away = 0
        return Push(Pause(self, retry=self.retry, more=self._pause_words))

    def _pause_words(self) -> list[tuple[str, OnPress]]:
        words: list[tuple[str, OnPress]] = [(texts.PAUSE_NETWORK.format(name=self._network.name), self._open_networks)]
        return [*words, (texts.PAUSE_CHOICES if self._course is None else texts.PAUSE_PACE, self._choose)]

    def _choose(self) -> Transition | None:
        """Let the player choose how the next flights are flown; a course is flown as it is, but for its pace."""
        from game.scenes.choices import ChoicesScene

        return Push(ChoicesScene(self, self._skill, begun=not self.waiting, course=self._course is not None))

    def _open_networks(self) -> Transition:
        from game.scenes.runs import Runs

        return Push(Runs(choose=self._choose_network))

    def _choose_network(self, name: str) -> None:
        """Let another network be the one to hand over to, in the midst of a flight too."""
        assert self._context is not None
        self._settings.model = name
        self._context.apply_settings()
        self._load_network()
        self.flight.change_network(self._network.flyer)
        self._forecast = self._new_forecast()

    # The picture

    @property
    def _card_shown(self) -> float:
        """How far the card has come in, 0 to 1."""
        since = self._since_end - _CARD_AFTER
        if since <= 0:
            return 0.0
        return 1.0 if self._settings.reduced_motion else 1 - (1 - min(1.0, since / _CARD_RISE)) ** 3

    def _draw_hud(self, canvas: Canvas) -> None:
        self._cockpit.draw_top(canvas)
        if self._course:
            goal = self._difficulty.words or self._course.goal
            hud.draw_corner(canvas, self._course.title, self._course.line, goal)
            draw_surroundings(canvas, self.flight.env)
        else:
            network = self._network
            flown = texts.WITH_NETWORK.format(name=network.name) if self.flight.network else texts.ALONE
            if self._hands != OWN:
                flown = texts.OTHER_HANDS.format(hands=texts.CHOICES_HANDS_WORDS[self._hands])
            title = texts.THREE_PADS if self.flight.recording.pads > 1 else texts.FREE_FLIGHT
            hud.draw_corner(canvas, title, flown, self._difficulty.words)
        hud.draw_readouts(canvas, self._readouts)
        if self.waiting and not (self._course and not self._course.opening):
            self._draw_opening(canvas)
        if self._settings.show_hints:
            self._draw_hints(canvas)

    def _draw_opening(self, canvas: Canvas) -> None:
        line, paths = texts.BEGIN, [(texts.PATH_YOURS, HUMAN)]
        if self._course:
            line = self._course.opening
        if self._forecast:
            paths.append((texts.PATH_NETWORK, NET))
        hud.draw_opening(canvas, flight_hints(self._controls), line, paths)

    def _draw_hints(self, canvas: Canvas) -> None:
        word = self._controls.word
        hints = [(word(Command.PAUSE), texts.HINT_LEAVE if self._leaves else texts.HINT_PAUSE)]
        if not self._course:
            hints.insert(0, (word(Command.CHOICES), texts.CHOICES_HINT))
        elif self._course.next_hint:
            hints.insert(0, (word(Command.NEXT), self._course.next_hint))
        if self.flight.network:
            taken = self.flight.hand is Hand.NETWORK
            hints.insert(0, (word(Command.HANDOVER), texts.HINT_TAKE_BACK if taken else texts.HINT_HAND_OVER))
        draw_hints(canvas, hints, (VIEW_SIZE[0] - MARGIN, 42), from_right=True)

    def _card_keys(self) -> list[tuple[str, str]]:
        assert self._card is not None
        good, word = self._card.good, self._controls.word
        if self._course and self._course.fixed:
            first = texts.CARD_FIRST_FIXED[good]
            other = (Command.RETRY, texts.HINT_AGAIN) if good else (Command.PAUSE, texts.HINT_LEAVE)
        else:
            first = texts.CARD_FIRST[good]
            other = (Command.RETRY, texts.HINT_AGAIN) if good else (Command.NEXT, texts.HINT_NEW)
        return [(word(Command.CONFIRM), first), (word(other[0]), other[1])]


def _is_space(event: pygame.event.Event) -> bool:
    return bool(event.type == pygame.KEYDOWN and event.key == pygame.K_SPACE)
