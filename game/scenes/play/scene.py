"""Play scene: fly, hand over to the network, take back control; one flight after another, of whatever challenge."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Final

import pygame

from game.core import texts
from game.core.scene import Pop, Push, Scene, Transition, push
from game.drawing.canvas import Canvas
from game.explain.explained import Explained
from game.flight import networks, own
from game.flight.credit import eased
from game.flight.flight import StickHolder
from game.flight.logbook import Goals, Records, ladder_rung
from game.flight.outcomes import OutcomeCard
from game.input.controls import Command, translate
from game.scenes.play.card import ShownCard
from game.scenes.play.challenge import Challenge, Race, Words
from game.scenes.play.flight_controls import FlightControls
from game.scenes.play.flown_flight import FlownFlight
from game.scenes.play.free import FreeFlight, rung_of
from game.scenes.play.head import Head, head_of
from game.scenes.play.keys import card_actions, flight_actions
from game.scenes.play.sitting import Sitting
from game.scenes.play.tutorial import Tutorial
from game.ui.actions import Action, Run, Table, answering, hints_of
from game.ui.clipboard import give
from game.ui.context import Context
from game.ui.form import Form
from game.ui.hints import HintRow
from game.world import framing

# Switching to full screen and back removes the window's focus for a moment, which must not pause the game.
_AWAY_STEPS: Final = 10
_MOST_HINTS: Final = 4  # of a card
_INTERRUPTS: Final = (pygame.WINDOWFOCUSLOST, pygame.WINDOWSIZECHANGED)


class PlayScene(Scene):
    """One flight after another. `seed` fixes the first; further seeds come from the context's random generator.

    A `rival` flies the same starts beside the player, as a ghost named `rival_name`. Without a rival or a `challenge`,
    flights are free ones; a newcomer's first is the tutorial.

    Attributes:
        challenge: what flights are flown as.
        flown: the flight on the screen, with all that belongs to it.
        flight, credit, ending: parts of that.

    """

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
        self.form, self.explained = Form(context), Explained()
        self._away = 0  # steps since the window was left
        self._records = Records(context.user_dir)
        entries = self._records.entries()
        if self._records.problem:
            context.note(self._records.problem)
        self._sitting, self._goals = Sitting(entries), Goals(entries)
        new = seed is None and not context.settings.tutored
        free = FreeFlight(context.settings, self._goals)
        usual = Race(rival, rival_name) if rival else Tutorial() if new else free
        ladder_rung(context.settings, entries)
        self._take(challenge or usual)
        self._load_network()
        self._begin_anew() if seed is None else self._begin(seed)

    def enter(self) -> None:
        """Return to the paused flight, which hangs until a touch; choices made meanwhile may require a new one."""
        self.flown.set_calm(self._settings.reduced_motion)
        self.flown.hang()
        if not (self.flown.begun or self.flight.over) and self._chosen != self._begun_with:
            self._begin(self.flight.recording.seed)

    @property
    def _chosen(self) -> tuple[object, ...]:
        """What the player has chosen for the next flight."""
        settings, rules = self._settings, self.challenge.rules
        return (settings.three_pads, settings.rung) if rules.free else (), eased(settings)

    def _take(self, challenge: Challenge) -> None:
        """Take what the next flights are flown as. Help of free flights does not follow into a challenge."""
        self.challenge = challenge
        self._helped = self._settings if challenge.rules.free else replace(self._settings, help="off")

    def reword(self) -> None:
        self.flown.reword()
        if self.ending.card:
            self.ending.card = self._make_card()

    def exit(self) -> None:
        self._stick.release()
        self.context.apply_settings()

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        self.explained.handle_event(event)
        if event.type == pygame.MOUSEBUTTONDOWN:
            canvas = self.context.reading()
            self.form.lay_keys(self.hint_rows(canvas), canvas)
            outcome = self.form.handle_event(event)
            if self.form.used:
                return outcome
        if event.type in (pygame.WINDOWFOCUSLOST, pygame.WINDOWFOCUSGAINED):
            self._away = int(event.type == pygame.WINDOWFOCUSLOST)
        if event.type in _INTERRUPTS:
            self.flown.hang()
        if self._helps and self.flown.help_words.take(event, self._head.help_boxes(self.context.reading())):
            if self.flown.helped.help != "off" and (lack := self.lack):
                self.context.note(lack)
            return None
        self._stick.take(event)
        if translate(event) is Command.UNPLUGGED and not (self.waiting or self.flight.over):
            return self.pause()
        action = answering(self.actions(), event)
        return action.run() if action else None

    @property
    def takes_switch(self) -> bool:  # type: ignore[override]
        return not self.flight.over

    def update(self) -> Transition | None:
        """Advance by 1/60 s: fly a step, unless the craft waits or slowed time makes none due."""
        self.flown.animate()
        self.explained.update()
        own.flying(self.context)
        self._away += self._away > 0
        if self._away > _AWAY_STEPS and not self.flight.over:
            return self.pause()
        asked = self._stick.read(self._across)
        self.flown.lay_out(self._head)
        self.flown.step(asked)
        rules = self.challenge.rules
        if rules.anew or (rules.again and self.ending.due):
            self.retry()
        elif self.flight.over and not rules.again and self.ending.card is None:
            self._sitting.add(self.flown)
            self.ending.card = self._make_card()
        if card := self._card:
            self.ending.whole = framing.whole(self.flown.path.places, card.clear(self.context.reading()))
        return None

    def _make_card(self) -> OutcomeCard:
        card = self.flown.make_card()
        self._sitting.add_to(card)
        return card

    @property
    def words(self) -> Words:
        """What is said of the flight."""
        return self.challenge.words(self.flown)

    @property
    def _across(self) -> float:
        """Horizontal place of the craft on the screen, in the points of the mouse."""
        reading = self.context.reading()
        return reading.points(reading.whole.pixels((self.flown.scenery.across, 0.0)))[0]

    # What keys do

    def actions(self) -> Table:
        """What each key does at this moment: those of the card, once it is seen, and those of the flight."""
        if self.ending.shown == 0:
            return [*flight_actions(self), Action(Command.CONFIRM, self.ending.hurry)]
        space = [Action(pygame.K_SPACE, self._go_on)] if self.ending.shown >= 1 else []
        return [*self._card_actions(), *flight_actions(self), Action(Command.CONFIRM, self._go_on), *space]

    def _card_actions(self) -> list[Action]:
        if self.ending.card is None:
            return []
        offer = [Action(Command.HANDOVER, self._accept_help, texts.HELP_HINT)] if self._sitting.offers else []
        seen = self.flown.record and not offer
        watch = [Action(pygame.K_t, self._watch, texts.CARD_WATCH, Command.STEP)] if seen else []
        copy = [Action(pygame.K_k, self._copy, texts.DAILY_HINT_COPY, Command.NEXT)] if self.words.result else []
        named = [*card_actions(self, self._go_on), *offer, *watch, *copy]
        if len(named) < _MOST_HINTS and all(action.key is not Command.PAUSE for action in named):
            named.append(Action(Command.PAUSE, self.runs[Command.PAUSE], self.leave_word))
        return named

    @property
    def leave_word(self) -> str:
        """What Escape does, in a word."""
        stays = texts.HINT_MENU if self.flight.over else texts.HINT_PAUSE
        return texts.HINT_LEAVE if self.leaves else stays

    @property
    def runs(self) -> dict[Command, Run]:
        """What each command does in a flight, whether or not a hint names it."""
        return {
            Command.HANDOVER: self._hand_over,
            Command.CHOICES: self.pause,
            Command.NEXT: self._asking(self._begin_elsewhere),
            Command.RETRY: self._asking(self.retry),
            Command.PAUSE: Pop if self.leaves else self.pause,
        }

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        card = self._card
        return [*self._head.hint_rows(canvas), *(card.hint_rows(canvas) if card else ())]

    def _asking(self, begin: Callable[[], None]) -> Run:
        """Return what a key for another start does: ask first, where more than the present flight would be lost."""
        return partial(self._ask, begin) if self.challenge.rules.staked else begin

    def _ask(self, begin: Callable[[], None]) -> Transition:
        from game.scenes.menus.dialogs import QuestionDialog

        answers = [(texts.STAKE_FLY_ON, lambda: None), (texts.STAKE_END, begin)]
        return Push(QuestionDialog(self, *self.words.stake, answers))

    def show_thinking(self) -> None:
        self._settings.show_thinking = not self._settings.show_thinking
        self.context.apply_settings()

    def _hand_over(self) -> None:
        if not self.flight.over and self.flight.chooser.hand_over():
            self._sound.play("to_network" if self.flight.chooser.hand is StickHolder.NETWORK else "to_human")
        elif self.flight.chooser.network is None and not self.flight.over:
            problem = texts.NO_NETWORK.format(problem=self.network.problem)
            self.context.note(texts.FLOWN_ALONE if self.credit.alone else problem)

    @property
    def lack(self) -> str:
        """Why the network, or the player's own pilot, cannot help; empty if it can, or if none is asked to."""
        if not self.flight.chooser.shares or self.flight.chooser.copilot is not None:
            return ""
        text = texts.DIAL_NEEDS if self.network.policy else texts.NO_NETWORK
        return text.format(name=self.network.name, problem=self.network.problem)

    def _copy(self) -> None:
        line = self.words.result
        give(self.context, line, texts.CODE_LINE_COPIED.format(line=line))

    def _watch(self) -> Transition | None:
        """Watch the flight that has ended; from there, it can be saved as a picture that moves, or sent to a friend."""
        return push("replay", self.flown.record)

    @property
    def _helps(self) -> bool:
        """Whether help can be chosen now, by its words."""
        return self.flown.helps and not self.flight.over

    @property
    def leaves(self) -> bool:
        """Whether Escape goes straight back: from the card of a challenge, where nothing is lost."""
        return self.ending.card is not None and not (self.challenge.rules.free or self.challenge.rules.staked)

    def pause(self) -> Transition:
        self._away = 0
        return push("flight_pause", self)

    def choose_network(self, name: str, path: Path | None = None) -> None:
        """Let another network fly, or with a `path` a file of the player's own."""
        if path:
            own.take(self.context, path)
        else:
            self._settings.model = name
            if self.context.pilot:
                self.context.pilot.chosen = False
            self.context.apply_settings()
        self._change_network()

    def _change_network(self) -> None:
        self._load_network()
        self.flown.change_network(self.network)

    # The picture

    @property
    def _card(self) -> ShownCard | None:
        ending = self.ending
        if ending.card is None or ending.shown == 0:
            return None
        hints = hints_of(self._card_actions(), self._controls)
        aside = ending.calm and self._across > self.context.reading().view.centerx  # the camera stays where it is
        return ShownCard(ending.card, hints, ending.shown, self._settings.show_hints, aside)

    @property
    def _head(self) -> Head:
        named = self._settings.show_hints or self._controls.mouse_in_use  # for the mouse, they are what it presses
        hints = hints_of(flight_actions(self), self._controls) if named else []
        return head_of(self.flown, hints, whole=False)

    def draw(self, canvas: Canvas, alpha: float) -> None:
        card = self._card
        low = card.box(canvas).bottom if card else 0.0
        self.flown.draw(canvas, alpha, self._head, whole=False, low=low)
        if card:
            card.draw(canvas)
        if not self._stick.mouse_flies:  # a mouse that flies asks for nothing
            self.explained.draw(canvas)

    # The flight

    @property
    def waiting(self) -> bool:
        return self.flown.waiting

    def _load_network(self) -> None:
        context, self._loaded_for = self.context, self.challenge.rules.elsewhere
        settings = context.settings
        shipped, mine = context.models_dir, context.user_dir
        self.network = own.flying(context) or networks.chosen(shipped, mine, settings.model, self._loaded_for)
        if problem := self.network.problem:
            context.note(problem if self.network.policy else texts.NO_NETWORK.format(problem=problem))

    def _begin(self, seed: int, spawn: str = "") -> None:
        """Begin a flight, from the kind of start that `spawn` names or, if empty, from the player's own."""
        self._stick.begin()
        if self.challenge.rules.elsewhere != self._loaded_for:
            self._load_network()
        self._begun_with = self._chosen
        self.flown = flown = FlownFlight(
            self.context, self._records, self.network, self.challenge, self._helped, seed, spawn
        )
        self.flight, self.credit, self.ending = flown.flight, flown.credit, flown.ending

    def _begin_anew(self) -> None:
        self._begin(int(self.context.rng.integers(2**31)))

    def retry(self) -> None:
        self._begin(self.flight.recording.seed, self.flight.recording.spawn)

    def _go_on(self) -> Transition | None:
        """After a landing, go to a new start, or leave a challenge with only one; after a crash, retry.

        On the ladder, the same start is nearer after a crash, or as near at its foot.
        """
        card = self.ending.card
        if card is None or not card.good:
            spawn = "" if rung_of(self.flight) is not None else self.flight.recording.spawn
            self._begin(self.flight.recording.seed, spawn)
        elif self.challenge.rules.fixed:
            if self.challenge.rules.following is None:
                return Pop()
            self._take(self.challenge.rules.following())
            self._begin(self.flight.recording.seed)
        else:
            self._begin_elsewhere()
        return None

    def _begin_elsewhere(self) -> None:
        rules = self.challenge.rules
        self.challenge.skip()
        if rules.through:
            self._end_challenge()
        else:
            self._begin(self.flight.recording.seed) if rules.fixed else self._begin_anew()

    def leave_challenge(self) -> Transition:
        self._end_challenge()
        return Pop()

    def _end_challenge(self) -> None:
        """End the tutorial, which is not offered again; free flights follow."""
        self._settings.tutored = True
        self.context.apply_settings()
        self._take(FreeFlight(self._settings, self._goals))
        self._begin_anew()

    def _accept_help(self) -> None:
        self.flown.helped.help = "guard"
        self._sitting.begin()
        self.context.apply_settings()
        self._go_on()
