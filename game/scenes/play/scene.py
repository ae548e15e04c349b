"""Play scene: fly, hand over to the network, take back control; one flight after another, of whatever challenge."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Final

import pygame

from ai.flights.verification import landing_score
from ai.lander.environment import Outcome
from game.core import texts
from game.core.scene import Pop, Push, Scene, Transition, push
from game.drawing.canvas import Canvas
from game.flight import networks, own
from game.flight.credit import Credit, eased
from game.flight.flight import Flight, StickHolder
from game.flight.flight_file import Record
from game.flight.logbook import Records, best_alone
from game.flight.outcomes import OutcomeCard
from game.flight.replay import FlightReplay
from game.input.controls import Command, translate
from game.panels.explained import Explained
from game.scenes.play.card import ShownCard
from game.scenes.play.challenge import Challenge, ContinuedFlight, Duel, against, dated
from game.scenes.play.descent import Descent
from game.scenes.play.ending import FlightEnding
from game.scenes.play.flight_controls import FlightControls
from game.scenes.play.flown_flight import FlownFlight
from game.scenes.play.free import FreeFlight, rung_of
from game.scenes.play.head import Head
from game.scenes.play.help import choose
from game.scenes.play.tutorial import Tutorial
from game.ui.actions import Action, Run, Table, answering, hints_of
from game.ui.clipboard import give
from game.ui.context import Context
from game.ui.hints import HintRow
from game.ui.widget import OnPress

CRASHES: Final = 3  # in a row, after which help is offered
# Switching to full screen and back removes the window's focus for a moment, which must not pause the game.
_AWAY_STEPS: Final = 10
_SKIP_ALL: Final = 60  # steps that the key for what comes next is held to leave out the whole tutorial
_RELEASES: Final = (pygame.KEYUP, pygame.CONTROLLERBUTTONUP, pygame.WINDOWFOCUSLOST)
_INTERRUPTS: Final = (pygame.WINDOWFOCUSLOST, pygame.WINDOWSIZECHANGED)
_IN_FLIGHT: Final = (Command.HANDOVER, Command.PAUSE)  # keys that are named while the craft flies, for the mouse


class _Bare(Scene):
    """A flight without words, for a picture behind other scenes."""

    flows = True

    def __init__(self, flight: PlayScene) -> None:
        super().__init__(flight.context)
        self._flown = flight.flown

    def draw(self, canvas: Canvas, alpha: float) -> None:
        self._flown.draw(canvas, 1.0, Head(), whole=False, low=math.inf)


class PlayScene(Scene):
    """One flight after another. `seed` fixes the first; further seeds come from the context's random generator.

    A `rival` flies the same starts beside the player, as a ghost named `rival_name`. Without a rival or a `challenge`,
    flights are free ones; a newcomer's first is the tutorial.

    Attributes:
        challenge: what flights are flown as.
        flown: the flight on the screen, with all that belongs to it.

    """

    flows = True

    def __init__(
        self,
        context: Context,
        seed: int | None = None,
        rival: networks.Policy | None = None,
        rival_name: str = "",
        challenge: Challenge | None = None,
    ) -> None:
        super().__init__(context)
        self._controls, self._settings, self._sound = context.controls, context.settings, context.sound
        self._stick = FlightControls(context.controls, context.settings)
        self.explained = Explained()
        self._away = 0  # steps since the window was left; 0 while it is in use
        self._held_next = 0  # steps for which the key for what comes next is held; 0 while it is not
        self._records = Records(context.user_dir)
        entries = self._records.entries()
        if self._records.problem:
            context.note(self._records.problem)
        self._best, self._crashes, self._offered = best_alone(entries), 0, False
        self._landed_before = any(entry.landed and not entry.bar for entry in entries)
        self._best_here: dict[tuple[int, str, int], int] = {}  # scores of one's own landings by their starts
        newcomer = seed is None and not context.settings.tutored
        usual = Duel(rival, rival_name) if rival else Tutorial() if newcomer else FreeFlight(context.settings)
        self.challenge = challenge or usual
        self.challenge.recall(entries)
        self._load_network()
        self._begin(self._new_seed() if seed is None else seed)

    def enter(self) -> None:
        """Return to the paused flight, which hangs until a touch; choices made meanwhile may require a new one."""
        self.flown.set_calm(self._settings.reduced_motion)
        if self._elsewhere != self._loaded_for:
            self._load_network()
            self.flown.change_network(self.network)
        self.flown.hang()
        other = self.challenge.eases and eased(self._settings) != self.flight.recording.easing
        if not (self.flown.begun or self.flight.over) and (other or self.challenge.chosen() != self._begun_with):
            self._begin(self.flight.recording.seed)

    def exit(self) -> None:
        """Keep the flight for the return, and save the dial's setting."""
        self._stick.release()
        self.context.apply_settings()

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Handle explanations, handover, retry, pause and the choice of help."""
        self.explained.handle_event(event)
        if event.type in _RELEASES:
            self._held_next = 0
        elif translate(event) is Command.NEXT:
            self._held_next = 1
        if event.type in (pygame.WINDOWFOCUSLOST, pygame.WINDOWFOCUSGAINED):
            self._away = int(event.type == pygame.WINDOWFOCUSLOST)
        if event.type in _INTERRUPTS:
            self.flown.hang()
        if self.flown.helps and self.flown.help_words.take(event, self._head.help_boxes(self.context.reading())):
            self._name_what_lacks()
            return None
        self._stick.take(event)
        if translate(event) is Command.UNPLUGGED and not (self.waiting or self.flight.over):
            return self.pause()
        action = answering(self.actions(), event)
        return action.run() if action else None

    @property
    def takes_switch(self) -> bool:  # type: ignore[override]
        """Whether the one switch flies."""
        return not self.flight.over

    def update(self) -> Transition | None:
        """Advance by 1/60 s: fly a step, unless the craft waits or slowed time makes none due."""
        self.flown.breathe()
        self.explained.update()
        own.flying(self.context)
        self._away += self._away > 0
        if self._away > _AWAY_STEPS and not self.flight.over:
            return self.pause()
        self._held_next += self._held_next > 0
        if self._held_next > _SKIP_ALL and self.challenge.next_hint:
            self._end_challenge()
        action, shares = self._stick.read(self._across)
        self.flown.lay_out(self._head)
        due = self.flown.due(action)
        if self.waiting:
            return None
        if due:
            self.flown.prepare()
            self.flight.step(action, shares)
            self.flown.follow()
            self._follow_flight()
        self.flown.sound()
        return None

    @property
    def _across(self) -> float:
        """Horizontal place of the craft on the screen, in the points of the mouse."""
        reading = self.context.reading()
        return reading.points(reading.whole.pixels((self.flown.scenery.across, 0.0)))[0]

    # What keys do

    def actions(self) -> Table:
        """What each key does at this moment: those of the card, once it is seen, and those of the flight."""
        explain = [Action(key, self.show_thinking) for key in (pygame.K_F1, Command.MODE)]
        if self.ending.shown == 0:
            return [*self._flight_actions(), Action(Command.CONFIRM, self.ending.hurry), *explain]
        space = [Action(pygame.K_SPACE, self._go_on)] if self.ending.shown >= 1 else []
        return [*self._card_actions(), *self._flight_actions(), Action(Command.CONFIRM, self._go_on), *space, *explain]

    def _flight_actions(self) -> list[Action]:
        challenge, flight, leaves = self.challenge, self.flight, self._leaves
        taken = flight.hand is StickHolder.NETWORK
        hands = (texts.HINT_TAKE_BACK if taken else texts.HINT_HAND_OVER) if flight.network and not flight.over else ""
        table: list[tuple[Command, Run, str]] = [
            (Command.HANDOVER, self._hand_over, hands),
            (Command.CHOICES, self._choose, texts.CHOICES_HINT if challenge.free else ""),
            (Command.NEXT, self._asking(self._begin_elsewhere), "" if challenge.through else challenge.next_hint),
            (Command.RETRY, self._asking(self.retry), texts.HINT_RETRY),
            (Command.PAUSE, Pop if leaves else self.pause, texts.HINT_LEAVE if leaves else texts.HINT_PAUSE),
        ]
        calm, named = self.waiting or flight.over, _IN_FLIGHT if self._controls.mouse_in_use else ()
        return [Action(command, run, hint if calm or command in named else "") for command, run, hint in table]

    def _card_actions(self) -> list[Action]:
        """Return what an outcome card names: to go on, one of the others, and what is offered."""
        card, challenge = self.ending.card, self.challenge
        if card is None:
            return []
        again, new = challenge.again_hint, challenge.new_hint
        first = (texts.CARD_FIRST_FIXED if challenge.fixed else texts.CARD_FIRST)[card.good]
        if card.rung is not None and card.rung < (rung_of(self.flight) or 0):
            first = texts.LADDER_NEARER
        if card.good:
            first, other = new or first, Action(Command.RETRY, self._asking(self.retry), again or texts.HINT_AGAIN)
        elif challenge.fixed:
            first, other = again or first, Action(Command.PAUSE, Pop if self._leaves else self.pause, texts.HINT_LEAVE)
        else:
            elsewhere = self._asking(self._begin_elsewhere)
            first, other = again or first, Action(Command.NEXT, elsewhere, new or texts.HINT_NEW)
        offer = [Action(Command.HANDOVER, self._accept_help, texts.HELP_HINT)] if self._offered else []
        hint = challenge.copy_hint or texts.CODE_HINT_COPY
        copy = [Action(pygame.K_k, self._copy, hint, Command.STEP)] if self.flown.record else []
        return [Action(Command.CONFIRM, self._go_on, first), other, *offer, *copy]

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        """Return the hints of the flight, and those of the card."""
        card = self._card
        return [*self._head.hint_rows(canvas), *(card.hint_rows(canvas) if card else ())]

    def _asking(self, begin: Callable[[], None]) -> Run:
        """Return what a key for another start does: ask first, where more than the present flight would be lost."""
        stake = self.challenge.stake
        return partial(self._ask, stake, begin) if stake else begin

    def _ask(self, stake: tuple[str, str], begin: Callable[[], None]) -> Transition:
        from game.scenes.menus.dialogs import QuestionDialog

        answers = [(texts.STAKE_FLY_ON, lambda: None), (texts.STAKE_END, begin)]
        return Push(QuestionDialog(self, *stake, answers))

    def show_thinking(self) -> None:
        """Show what the network thinks, or no longer."""
        self._settings.show_thinking = not self._settings.show_thinking
        self.context.apply_settings()

    def _hand_over(self) -> None:
        if self.flight.hand_over():
            self._sound.play("to_network" if self.flight.hand is StickHolder.NETWORK else "to_human")
        elif self.flight.network is None and not self.flight.over:
            problem = texts.NO_NETWORK.format(problem=self.network.problem)
            self.context.note(texts.FLOWN_ALONE if self.credit.alone else problem)

    def _name_what_lacks(self) -> None:
        """Tell the player why the dial has no effect, where it has none."""
        if self.flown.helped.assist > 0 and self.flight.shares and self.flight.copilot is None:
            network = self.network
            text = texts.DIAL_NEEDS if network.policy else texts.NO_NETWORK
            self.context.note(text.format(name=network.name, problem=network.problem))

    def _copy(self) -> None:
        """Copy what tells a friend of the flight that is over."""
        if self.flown.record:
            give(self.context, *self.challenge.message(self.flown.record))

    @property
    def _leaves(self) -> bool:
        """Whether Escape goes straight back: in a challenge that has not begun or is over, where nothing is lost."""
        challenge = self.challenge
        return not (challenge.free or challenge.stake) and (not self.flown.begun or self.flight.over)

    def pause(self) -> Transition:
        """Pause the flight."""
        self._away = 0
        return push("flight_pause", self, retry=self.retry, more=self._pause_words)

    def _pause_words(self) -> list[tuple[str, OnPress]]:
        name = networks.word(self.network.name)
        words: list[tuple[str, OnPress]] = [
            (texts.PAUSE_NETWORK.format(name=name), lambda: push("runs", choose=self.choose_network)),
            (texts.PILOTS_OPEN, lambda: push("pilots", self._choose_own)),
        ]
        if self.challenge.next_hint:
            words.append((texts.TUTORIAL_LEAVE, self._leave_challenge))
        words.append((texts.PAUSE_CHOICES if self.challenge.free else texts.PACE, self._choose))
        return [*words, (texts.ASSISTS_OPEN, lambda: push("settings", "flights"))]

    def _choose(self) -> Transition | None:
        """Open the choices for the next flights; in a challenge, few can be changed."""
        return push("choices", self, begun=self.flown.begun, free=self.challenge.free, helped=self.flown.helped)

    def choose_network(self, name: str) -> None:
        """Change the network to hand over to, also during a flight."""
        self._settings.model = name
        if self.context.pilot:
            self.context.pilot.chosen = False
        self.context.apply_settings()
        self._load_network()
        self.flown.change_network(self.network)

    def _choose_own(self, path: Path | None) -> None:
        own.take(self.context, path)
        self._load_network()
        self.flown.change_network(self.network)

    # The picture

    @property
    def _card(self) -> ShownCard | None:
        hints = hints_of(self._card_actions(), self._controls) if self.ending.shown else []
        return self.ending.shown_card(hints, self.flown.rival, advise=self._settings.show_hints)

    @property
    def _head(self) -> Head:
        """The words at the head."""
        named = self._settings.show_hints or self._controls.mouse_in_use  # for the mouse, they are what it presses
        hints = hints_of(self._flight_actions(), self._controls) if named else []
        return self.flown.head(hints, whole=False)

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the flight and, at the end, the card."""
        card = self._card
        low = card.box(canvas).bottom if card else 0.0
        self.flown.draw(canvas, alpha, self._head, whole=False, low=low)
        if card:
            card.draw(canvas)
        if not self._stick.mouse_flies:  # a mouse that flies asks for nothing
            self.explained.draw(canvas)

    @property
    def bare(self) -> Scene:
        """This flight as a scene without words, for a picture behind other ones."""
        return _Bare(self)

    def draw_whole(self, canvas: Canvas) -> None:
        """Draw the flight while it is paused, with all that can be known of it but the words at the head."""
        self.flown.draw(canvas, 1.0, Head(), whole=True)

    def titles(self) -> Head:
        """Return the words at the head while it is paused."""
        return self.flown.head((), whole=True)

    # The flight

    @property
    def flight(self) -> Flight:
        """The flight on the screen."""
        return self.flown.flight

    @property
    def credit(self) -> Credit:
        """Who flies it, and whether it counts as the player's own."""
        return self.flown.credit

    @property
    def ending(self) -> FlightEnding:
        """Its ending, with slow motion and outcome card."""
        return self.flown.ending

    @property
    def waiting(self) -> bool:
        """Whether the craft still hangs until the pilot's first touch."""
        return self.flown.waiting

    @property
    def _elsewhere(self) -> bool:
        """Whether the next flight is flown where it is not as on the moon."""
        return self.challenge.elsewhere or (self.challenge.free and self._settings.gravity != 1)

    def _load_network(self) -> None:
        context, self._loaded_for = self.context, self._elsewhere
        settings = context.settings
        self.network = own.flying(context) or networks.chosen(
            context.models_dir, context.user_dir, settings.model, self._elsewhere
        )
        if self.network.problem:
            context.note(texts.NO_NETWORK.format(problem=self.network.problem))
        elif self.network.stands_in:
            context.note(self.network.stands_in)

    def _new_seed(self) -> int:
        return int(self.context.rng.integers(2**31))

    def _begin(self, seed: int, spawn: str = "") -> None:
        """Begin a flight, from the kind of start that `spawn` names or, if empty, from the player's own."""
        self._stick.begin()
        if self._elsewhere != self._loaded_for:
            self._load_network()
        self._begun_with = self.challenge.chosen()
        self.flown = FlownFlight(self.context, seed, self.network, self.challenge, spawn)

    def retry(self) -> None:
        """Fly again from the same start."""
        self._begin(self.flight.recording.seed, self.flight.recording.spawn)

    def _go_on(self) -> Transition | None:
        """After a landing, go to a new start, or leave a challenge with only one; after a crash, retry.

        On the ladder, the same start is nearer after a crash, or as near at its foot.
        """
        card = self.ending.card
        if card is None or not card.good:
            spawn = "" if card and card.rung is not None else self.flight.recording.spawn
            self._begin(self.flight.recording.seed, spawn)
        elif self.challenge.fixed:
            following = self.challenge.following()
            if following is None:
                return Pop()
            self.challenge = following
            self._begin(self.flight.recording.seed)
        else:
            self._begin_elsewhere()
        return None

    def _begin_elsewhere(self) -> None:
        self.challenge.skip()
        self._remember()
        if self.challenge.through:
            self._end_challenge()
        else:
            self._begin(self.flight.recording.seed if self.challenge.fixed else self._new_seed())

    def _leave_challenge(self) -> Transition:
        """Leave the challenge for free flights, from the pause menu."""
        self._end_challenge()
        return Pop()

    def _end_challenge(self) -> None:
        """Go on with free flights."""
        self._held_next = 0
        self.challenge.leave()
        self._remember()
        self.challenge = FreeFlight(self._settings)
        self.challenge.recall(self._records.entries())
        self._begin(self._new_seed())

    # The end of a flight

    def _follow_flight(self) -> None:
        """Save what a step has brought the player in a challenge; after the end, go on to the card or the next try."""
        self._remember()
        if not self.flight.over:
            return
        challenge, ending = self.challenge, self.ending
        ending.follow()
        if challenge.again():
            self._write_down()
            if ending.due:
                self.retry()
        elif ending.card is None:
            card = self.flown.make_card(self._best)
            ending.card = self._offer_help(self._compare(card))
            self._remember()
            self._write_down()

    def _remember(self) -> None:
        """Save the pilot's progress in a challenge as soon as it is made."""
        if self.challenge.remember(self._settings):
            self.context.apply_settings()

    def _write_down(self) -> None:
        if self.challenge.kept and (entry := self.flown.write_down(self._records)):
            self._best = max(self._best, best_alone([entry]))

    def _compare(self, card: OutcomeCard) -> OutcomeCard:
        """Return the card with other scores from the same start; the player's first landing alone has its own words."""
        recording, score = self.flight.recording, landing_score(self.flight.env)
        here = recording.seed, recording.spawn, recording.pads
        card = replace(card, compared=self.flown.compared(self._best_here.get(here, 0)))
        if not (self.credit.counts and card.good and self.challenge.kept):
            return card
        self._best_here[here] = max(score, self._best_here.get(here, 0))
        if self._landed_before:
            return card
        self._landed_before = True
        self._sound.play("choose")
        return replace(card, title=texts.FIRST_LANDING, reason=texts.FIRST_LANDING_LINE)

    def _offer_help(self, card: OutcomeCard) -> OutcomeCard:
        """Count the crashes in a row; return the card, which offers help once it is time and there is help."""
        landed = self.flight.outcome is Outcome.LANDED
        self._crashes = 0 if landed else self._crashes + (not self.flight.intact)
        there = self.flight.copilot is not None and not self.credit.alone
        self._offered = self._crashes >= CRASHES and there and self.flown.helped.assist == 0
        return replace(card, advice=texts.HELP_OFFER) if self._offered else card

    def _accept_help(self) -> None:
        """Turn the dial to the offered help, and try again."""
        choose(self.flown.helped, "guard")
        self._crashes, self._offered = 0, False
        self.context.apply_settings()
        self._go_on()


# Flights that other screens lead to, by their routes


def tutorial(context: Context) -> PlayScene:
    """Fly the first flight, again if need be."""
    return PlayScene(context, 0, challenge=Tutorial())


def descent(context: Context) -> PlayScene:
    """Fly from pad to pad."""
    return PlayScene(context, challenge=Descent())


def race(context: Context, record: Record, rival: str = "") -> PlayScene:
    """Race against a recorded flight."""
    return PlayScene(context, record.recording.seed, challenge=against(record, rival))


def fly_on(context: Context, record: Record, flight_replay: FlightReplay, rival: str = "") -> PlayScene:
    """Fly on from a replay's present moment, beside the recorded flight as a ghost."""
    challenge = ContinuedFlight(flight_replay, rival or dated(record))
    return PlayScene(context, record.recording.seed, challenge=challenge)
