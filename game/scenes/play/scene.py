"""Play scene: fly, hand over to the network, take back control."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Final

import pygame

from ai.flights.verification import landing_score
from game.core import texts
from game.core.scene import Pop, Push, Scene, Transition, push
from game.drawing.canvas import Canvas
from game.flight import networks
from game.flight.credit import Credit
from game.flight.difficulty import eased
from game.flight.flight import Flight, StickHolder
from game.flight.handicap import HANDS, OWN
from game.flight.logbook import Records, best_alone
from game.flight.outcomes import OutcomeCard
from game.input.controls import Command, translate
from game.panels.explained import Explained
from game.scenes.play import captions
from game.scenes.play.card import ShownCard
from game.scenes.play.challenge import Challenge, Duel
from game.scenes.play.ending import FlightEnding
from game.scenes.play.flight_controls import FlightControls
from game.scenes.play.flown_flight import FlownFlight
from game.scenes.play.head import Head
from game.scenes.play.ladder import Ladder, rung_of
from game.scenes.play.rescue_offer import RescueOffer
from game.ui.actions import Action, Run, Table, answering, hints_of
from game.ui.clipboard import give
from game.ui.context import Context
from game.ui.hints import HintRow
from game.ui.widget import OnPress

# Switching to full screen and back removes the window's focus for a moment, which must not pause the game.
_AWAY_STEPS: Final = 10
_SKIP_ALL: Final = 60  # steps that the key for what comes next is held to leave out the whole tutorial
_RELEASES: Final = (pygame.KEYUP, pygame.CONTROLLERBUTTONUP, pygame.WINDOWFOCUSLOST)
_INTERRUPTS: Final = (pygame.WINDOWFOCUSLOST, pygame.WINDOWSIZECHANGED)


class _Bare(Scene):
    """A flight without words."""

    flows = True

    def __init__(self, flight: PlayScene) -> None:
        super().__init__(flight.context)
        self._flight = flight

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw it."""
        self._flight.draw_bare(canvas)


class PlayScene(Scene):
    """One flight after another. `seed` fixes the first; further seeds come from the context's random generator.

    A `rival` flies the same starts beside the player, as a ghost named `rival_name`. A `challenge` has
    starts and rules of its own.

    Attributes:
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
        self.challenge = Duel(rival, rival_name) if rival else challenge
        self._stick = FlightControls(context.controls, context.settings)
        self.explained = Explained()
        self._away = 0  # steps since the window was left; 0 while it is in use
        self._held_next = 0  # steps for which the key for what comes next is held; 0 while it is not
        self._controls, self._settings, self._sound = context.controls, context.settings, context.sound
        self._load_network()
        if self.challenge is None and seed is None and not context.settings.tutored:
            from game.scenes.play.tutorial import Tutorial

            self.challenge = Tutorial()
        self._records = Records(context.user_dir)
        entries = self._records.entries()
        self._best, self._ladder = best_alone(entries), Ladder(context.settings, entries)
        self._offer = RescueOffer()
        self._landed_before = any(entry.landed and not entry.bar for entry in entries)
        self._best_here: dict[tuple[int, str, int], int] = {}  # scores of one's own landings by their starts
        if self._records.problem:
            context.note(self._records.problem)
        if self.challenge:
            self.challenge.recall(self._records.entries())
        self._begin(self._new_seed() if seed is None else seed)

    def enter(self) -> None:
        """Return to the paused flight, which hangs until a touch; choices made meanwhile may require a new one."""
        self.flown.set_calm(self._settings.reduced_motion)
        if self._elsewhere != self._loaded_for:
            self._load_network()
            self.flown.change_network(self.network)
        self.flown.hang()
        challenge = self.challenge
        eases = (not challenge or challenge.eases) and eased(self._settings) != self.flight.recording.easing
        other = not challenge and self._chosen() != self._begun_with
        if not (self.flown.begun or self.flight.over) and (eases or other):
            self._begin(self.flight.recording.seed)

    def exit(self) -> None:
        """Keep the flight for the return, and save the dial's setting."""
        self._stick.release()
        self.context.apply_settings()

    def retry(self) -> None:
        """Fly again from the same start."""
        self._begin(self.flight.recording.seed, self.flight.recording.spawn)

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
        if self.flown.cockpit.take(event, self._head.help_boxes(self.context.reading())):
            self._name_what_lacks()
            return None
        self._stick.take(event)
        if translate(event) is Command.UNPLUGGED and not (self.waiting or self.flight.over):
            return self.pause()
        action = answering(self.actions(), event)
        return action.run() if action else None

    def actions(self) -> Table:
        """What each key does at this moment: those of the card, once it is seen, and those of the flight."""
        explain = [Action(key, self.show_thinking) for key in (pygame.K_F1, Command.MODE)]
        if self.ending.shown == 0:
            return [*self._flight_actions(), Action(Command.CONFIRM, self.ending.hurry), *explain]
        space = [Action(pygame.K_SPACE, self._go_on)] if self.ending.shown >= 1 else []
        return [*self._card_actions(), *self._flight_actions(), Action(Command.CONFIRM, self._go_on), *space, *explain]

    def show_thinking(self) -> None:
        """Show what the network thinks, or no longer."""
        self._settings.show_thinking = not self._settings.show_thinking
        self.context.apply_settings()

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        """Return the hints of the flight, and those of the card."""
        card = self._card
        return [*self._head.hint_rows(canvas), *(card.hint_rows(canvas) if card else ())]

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

    @property
    def _runs(self) -> dict[Command, Run]:
        """What each command does, whether or not a hint names it."""
        return {
            Command.HANDOVER: self._hand_over,
            Command.CHOICES: self._choose,
            Command.NEXT: self._asking(self._begin_elsewhere),
            Command.RETRY: self._asking(self.retry),
            Command.PAUSE: Pop if self._leaves else self.pause,
        }

    def _asking(self, begin: Callable[[], None]) -> Run:
        """Return what a key for another start does: ask first, where more than the present flight would be lost."""
        challenge = self.challenge
        stake = challenge.stake if challenge and (not self.flight.over or challenge.again()) else None
        return partial(self._ask, stake, begin) if stake else begin

    def _ask(self, stake: tuple[str, str], begin: Callable[[], None]) -> Transition:
        from game.scenes.menus.dialogs import QuestionDialog

        answers = [(texts.STAKE_FLY_ON, lambda: None), (texts.STAKE_END, begin)]
        return Push(QuestionDialog(self, *stake, answers))

    def _flight_actions(self) -> list[Action]:
        runs, calm = self._runs, self.waiting or self.flight.over
        named = runs.keys() if calm else captions.IN_FLIGHT if self._controls.mouse_in_use else ()
        return captions.flight_actions(runs, self.flight, self.challenge, leaves=self._leaves, named=named)

    def _card_actions(self) -> list[Action]:
        card = self.ending.card
        if card is None:
            return []
        hint = (self.challenge or Challenge).copy_hint or texts.CODE_HINT_COPY
        copy = [Action(pygame.K_k, self._copy, hint, Command.STEP)] if self.flown.record else []
        offer = [Action(Command.HANDOVER, self._accept_help, texts.HELP_HINT)] if self._offer.made else []
        nearer = card.rung is not None and card.rung < (rung_of(self.flight) or 0)
        actions = captions.card_actions(self._go_on, self._runs, self.challenge, good=card.good, nearer=nearer)
        return [*actions, *offer, *copy]

    @property
    def takes_switch(self) -> bool:  # type: ignore[override]
        """Whether the one switch flies."""
        return not self.flight.over

    def update(self) -> Transition | None:
        """Advance by 1/60 s: fly a step, unless the craft waits or slowed time makes none due."""
        self.flown.breathe()
        self.explained.update()
        self._away += self._away > 0
        if self._away > _AWAY_STEPS and not self.flight.over:
            return self.pause()
        self._held_next += self._held_next > 0
        if self._held_next > _SKIP_ALL and self.challenge and self.challenge.next_hint:
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

    def draw_bare(self, canvas: Canvas) -> None:
        """Draw the flight without words."""
        self.flown.draw(canvas, 1.0, Head(), whole=False, low=math.inf)

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

    def _begin(self, seed: int, spawn: str = "") -> None:
        """Begin a flight, from the kind of start that `spawn` names or, if empty, from the player's rung."""
        self._stick.begin()
        if self._elsewhere != self._loaded_for:
            self._load_network()
        if self.challenge:
            self.flown = FlownFlight(self.context, seed, self.network, self.challenge)
            return
        self._begun_with = pads, hands, rung = self._chosen()
        self.flown = FlownFlight(self.context, seed, self.network, pads=pads, spawn=spawn or rung, hands=hands)

    def _follow_flight(self) -> None:
        """Save what a step has brought the player in a challenge; after the end, go on to the card or the next try."""
        challenge, ending = self.challenge, self.ending
        if challenge:
            self._remember(challenge)
        if not self.flight.over:
            return
        ending.follow()
        if challenge and challenge.again():
            if challenge.kept:
                self._write_down()
            if ending.due:
                self.retry()
        elif ending.card is None:
            self.flown.make_card(self._best)
            self._follow_end()
            if challenge is None or challenge.kept:
                self._write_down()

    def _write_down(self) -> None:
        if entry := self.flown.write_down(self._records):
            self._best = max(self._best, best_alone([entry]))

    def _follow_end(self) -> None:
        """Let the ladder and the offer of help answer the ending, on its card."""
        card = self.ending.card
        assert card is not None
        before = self._settings.rung
        card = self._compare(card)
        card = self._ladder.climb(self.flight, card)
        self.ending.card = self._offer.follow(self.flight, self.credit, card, self.flown.helped)
        if before != self._settings.rung:
            self.context.apply_settings()

    def _compare(self, card: OutcomeCard) -> OutcomeCard:
        """Return the card with other scores from the same start; the player's first landing alone has its own words."""
        recording, score = self.flight.recording, landing_score(self.flight.env)
        here = recording.seed, recording.spawn, recording.pads
        card = replace(card, compared=self.flown.compared(self._best_here.get(here, 0)))
        if not self.credit.counts or not card.good:
            return card
        self._best_here[here] = max(score, self._best_here.get(here, 0))
        if self._landed_before:
            return card
        self._landed_before = True
        self._sound.play("choose")
        return replace(card, title=texts.FIRST_LANDING, reason=texts.FIRST_LANDING_LINE)

    def _accept_help(self) -> None:
        """Turn the dial to the offered help, and try again."""
        self._offer.accept(self.flown.helped)
        self.context.apply_settings()
        self._go_on()

    def _chosen(self) -> tuple[int, str, str]:
        """Return the number of pads, the handicap and the kind of start, as chosen by the player."""
        hands, three = self._settings.hands, self._settings.three_pads
        return 3 if three else 1, hands if hands in HANDS else OWN, "random" if three else self._ladder.spawn

    @property
    def _elsewhere(self) -> bool:
        """Whether the next flight is flown where it is not as on the moon."""
        return self.challenge.elsewhere if self.challenge else self._settings.gravity != 1

    def _load_network(self) -> None:
        context, self._loaded_for = self.context, self._elsewhere
        settings = context.settings
        self.network = networks.chosen(context.models_dir, context.user_dir, settings.model, self._elsewhere)
        if self.network.problem:
            context.note(texts.NO_NETWORK.format(problem=self.network.problem))
        elif self.network.stands_in:
            context.note(self.network.stands_in)

    def _new_seed(self) -> int:
        return int(self.context.rng.integers(2**31))

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
            challenge = self.challenge or Challenge()
            give(self.context, *challenge.message(self.flown.record))

    def _go_on(self) -> Transition | None:
        """After a landing, go to a new start, or leave a challenge with only one; after a crash, retry.

        On the ladder, the same start is nearer after a crash, or as near at its foot.
        """
        card = self.ending.card
        if card is None or not card.good:
            spawn = "" if card and card.rung is not None else self.flight.recording.spawn
            self._begin(self.flight.recording.seed, spawn)
        elif self.challenge and self.challenge.fixed:
            following = self.challenge.following
            if following is None:
                return Pop()
            self.challenge = following
            self._begin(self.flight.recording.seed)
        else:
            self._begin_elsewhere()
        return None

    def _begin_elsewhere(self) -> None:
        if self.challenge:
            self.challenge.skip()
            self._remember(self.challenge)
            if self.challenge.through:
                self.challenge = None
        self._begin(self.flight.recording.seed if self.challenge and self.challenge.fixed else self._new_seed())

    def _remember(self, challenge: Challenge) -> None:
        """Save the pilot's progress in a challenge as soon as it is made."""
        if challenge.remember(self._settings):
            self.context.apply_settings()

    def _leave_challenge(self) -> Transition:
        """Leave the challenge for free flights, from the pause menu."""
        self._end_challenge()
        return Pop()

    def _end_challenge(self) -> None:
        """Go on with free flights."""
        assert self.challenge is not None
        self._held_next = 0
        self.challenge.leave()
        self._remember(self.challenge)
        self.challenge = None
        self._begin(self._new_seed())

    @property
    def _leaves(self) -> bool:
        """Whether Escape goes straight back: in a challenge that has not begun or is over, where nothing is lost."""
        challenge = self.challenge
        return challenge is not None and not challenge.under_way and (not self.flown.begun or self.flight.over)

    def pause(self) -> Transition:
        """Pause the flight."""
        self._away = 0
        return push("flight_pause", self, retry=self.retry, more=self._pause_words)

    def _pause_words(self) -> list[tuple[str, OnPress]]:
        words: list[tuple[str, OnPress]] = [
            (texts.PAUSE_NETWORK.format(name=networks.word(self.network.name)), self._open_networks)
        ]
        if self.challenge and self.challenge.next_hint:
            words.append((texts.TUTORIAL_LEAVE, self._leave_challenge))
        words.append((texts.PAUSE_CHOICES if self.challenge is None else texts.PACE, self._choose))
        return [*words, (texts.ASSISTS_OPEN, lambda: push("settings", "flights"))]

    def _choose(self) -> Transition | None:
        """Open the choices for the next flights; in a challenge, few can be changed."""
        begun, challenge = self.flown.begun, self.challenge is not None
        return push("choices", self, begun=begun, challenge=challenge, helped=self.flown.helped)

    def _open_networks(self) -> Transition:
        return push("runs", choose=self.choose_network)

    def choose_network(self, name: str) -> None:
        """Change the network to hand over to, also during a flight."""
        self._settings.model = name
        self.context.apply_settings()
        self._load_network()
        self.flown.change_network(self.network)
