"""A flight of the player's with all that belongs to it alone: scenery, help, paths, ghost, sounds and ending."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import pygame

from ai.environment import Doubles
from ai.flights.recording import UNHURRIED
from ai.flights.verification import landing_score
from ai.lander.push import KEYS, Push
from game.audio.flight_sounds import FlightSound
from game.core import texts
from game.core.clock import TimeScale
from game.core.settings import Settings
from game.drawing.canvas import Canvas
from game.drawing.tokens import VIEW_SIZE
from game.explain.readouts import GAUGES, PILOT, at_rest, at_touch, draw_flight, flight_readouts, foot_of, yours
from game.flight.choosers import Alone, steered
from game.flight.credit import ASSISTS, Credit, eased
from game.flight.flight import Flight, StickHolder, begin
from game.flight.flight_file import Entry, Record
from game.flight.foresight import SixFutures
from game.flight.logbook import Records
from game.flight.networks import Network, sentence
from game.flight.outcomes import OutcomeCard, outcome_card
from game.scenes.play.challenge import Challenge, Wanted
from game.scenes.play.copilot_panel import CopilotPanel
from game.scenes.play.ending import FlightEnding, FlownPath
from game.scenes.play.head import Head
from game.scenes.play.help import HelpWords
from game.scenes.play.interventions import Interventions
from game.scenes.play.wind import draw_wind
from game.scenes.play.words import why_not_saved
from game.world.camera import ClearArea, View
from game.world.landscape.backdrop import EARTH, EARTH_RADIUS
from game.world.landscape.ground import begin_hills
from game.world.paths import PathPreview, draw_futures
from game.world.scenery import Scenery

if TYPE_CHECKING:
    from game.ui.context import Context

_CRAFT: Final = 1.5  # metres from the middle of a craft to its ends
_WAITING: Final = 196.0  # points at the head for the words over a craft that waits, before they are laid out
_BESIDE: Final = 3.0  # radii of the Earth that a craft that waits keeps from it
_BELOW_HEAD: Final = 0.06  # of the window's height, between the words and the craft
_LARGE: Final = 1.15  # size of words beside that on a page from which they reach far across
_CATCHES_UP: Final = 6  # steps of the network's own flight in a frame, once the player's is over
_LONGEST: Final = 3600  # steps after which its flight counts as one that does not land
_THINKS: Final = 2  # decisions of six futures that are flown in a frame


class FlownFlight:
    """One flight of the player's, made anew for every start; call `step` in every 1/60 s.

    Args:
        context: the shared services.
        records: the logbook.
        network: the one to hand over to, if it can be read; unused where the player must fly alone.
        challenge: its start and rules.
        helped: the settings of help, the player's own or those of the challenge.
        seed, spawn: of the start; `spawn` is empty for the player's own.

    Attributes:
        context, challenge, helped: as given.
        network: as given, but that it can be changed.
        flight: the flight itself.
        credit: who flies it, and whether it counts as the player's own.
        pace: the clock that slows down after a crash.
        ending: the ending, with slow motion and outcome card.
        record: the record of the flight once it is over; None before, and where none is kept.
        clear: the part of the screen in which to show the flight.
        futures: the six futures, once somebody has asked; None before.
        ahead: the ground of the flight that comes next, to be painted while this one is flown; None if unknown.
        waiting: whether the craft hangs until the pilot touches a control.
        begun: whether it has flown a step.

    """

    def __init__(
        self, context: Context, records: Records, network: Network, challenge: Challenge, helped: Settings,
        seed: int, spawn: str = "",
    ) -> None:  # fmt: skip
        self.context, self._settings, self._records = context, context.settings, records
        self.challenge, self.network, self.helped = challenge, network, helped
        self.waiting = self._held_before = True
        self.begun = False
        self.record: Record | None = None
        rules = challenge.rules
        self._policy = None if rules.alone else network.policy
        start = challenge.start(Wanted(seed, self._policy, spawn, eased(self._settings)))
        self.flight = begin(start.recording, self._policy, shares=start.shares)
        if start.place:
            start.place(self.flight)
        self.ghost, self.ahead = start.ghost, start.ahead
        self.credit = Credit(self.flight, self._settings, rules)
        self.help_words, self.interventions = HelpWords(self.helped), Interventions()
        self.copilot_panel = CopilotPanel()
        self._help()
        self.futures: SixFutures | None = None
        calm = self._settings.reduced_motion
        self.clear, self._earth = ClearArea(), EARTH
        self.scenery = Scenery(self.flight, calm, ClearArea(head=_WAITING))
        self.pace = TimeScale()
        self._heard = FlightSound(context.sound, self.flight.env)
        self.path = FlownPath(self.flight)
        self.ending = FlightEnding(self.flight, self.pace, calm)
        self._readouts = flight_readouts(self.flight.env)
        self._shadow = Flight(self.flight.recording, Alone(self._policy)) if rules.free and self._policy else None
        self.path_preview = PathPreview(self.flight, self._policy if rules.free else None)

    @property
    def helps(self) -> bool:
        """Whether a network may help in this flight."""
        return self.flight.chooser.shares and not self.credit.alone

    @property
    def stuck(self) -> bool:
        """Whether the craft hangs, and a control that is held must first be let go."""
        return self.waiting and self._held_before and not self.flight.over

    def set_calm(self, calm: bool) -> None:
        self.ending.calm = calm
        self.scenery.set_calm(calm)
        if calm:
            self.pace.hurry()

    def change_network(self, network: Network) -> None:
        """Change the network to hand over to, unless the player must fly alone."""
        self.network = network
        if not self.credit.alone:
            self._policy, self.futures = network.policy, None
            self.flight.chooser.change_network(network.policy)
            self.path_preview.ask(self._policy if self.challenge.rules.free else None)

    # Time

    def animate(self) -> None:
        """Advance by 1/60 s what moves whether or not anything flies."""
        self.help_words.shown = max(0, self.help_words.shown - 1)

    def step(self, asked: Push) -> None:
        """Advance by 1/60 s, in which the stick asks for that; the craft may wait, or slowed time make no step due."""
        self.pace.rate = self._settings.pace
        if self._waits(asked):
            self._help()
            self.think()
            if guard := self.flight.chooser.guard:
                guard.hang(self.flight, asked)
            self.path_preview.follow(waiting=True)
            return
        if self.pace.steps():
            self._fly(asked)
        self._heard.follow(self.scenery.stage.thrust[0])  # between steps too, or fire would fall silent

    def _fly(self, asked: Push) -> None:
        """Fly a step with all that belongs to it; after the end, only what still moves goes on."""
        flight, was_over = self.flight, self.flight.over
        self.begun = True
        if not was_over:  # at the end, the figures stay those of the last moment before
            self._readouts = flight_readouts(flight.env)
            self.credit.prepare()
        self._help()
        flight.step(steered(asked, flight.env.observe()) if self._settings.one_switch else asked)
        if self.ghost:
            self.ghost.step()
        if self._shadow:
            self._follow_shadow(self._shadow)
        self.path_preview.follow(waiting=False)
        if not was_over:
            self._follow_flight()
        if sound := self.challenge.stepped(self):
            self.context.sound.play(sound)
        ended = flight.over and not was_over
        if ended:
            self.challenge.ended(self)
        if flight.over:
            if flight.intact:  # it stands still
                self._readouts = at_rest(self._readouts)
            self.ending.follow()
            self._finish_card()
        self.scenery.clear = self.clear
        self.scenery.follow(ended, self.ending.shot)

    def _waits(self, asked: Push) -> bool:
        """Whether the craft still hangs; a key that began the flight itself must first be let go."""
        self._held_before &= asked != Push()
        guard = self.flight.chooser.guard
        ready = guard is None or guard.ready(self.flight)  # or nobody would keep it from harm at first
        goes = asked != Push() and ready and not self._held_before
        self.waiting &= not (goes or self.flight.chooser.hand is StickHolder.NETWORK)
        return self.waiting

    def hang(self) -> None:
        """Let a craft in flight hang where it is until the pilot's next touch: after a pause, or a lost focus."""
        if not self.flight.over:
            self.waiting = self._held_before = True

    def _help(self) -> None:
        """Set the help of the next step from the settings, and have futures flown ahead once a guardian needs them."""
        flight = self.flight
        flight.chooser.help(0.0 if self.credit.alone else ASSISTS[self.helped.help])
        if flight.chooser.guard is None and flight.chooser.shared and (ahead := self.context.ahead()):
            from game.flight.guard import Guard

            flight.chooser.guard = Guard(flight.chooser, ahead)

    def _follow_flight(self) -> None:
        flight, asks = self.flight, self._settings.show_thinking
        self.think()
        self.interventions.follow(flight)
        self.path.follow()
        self.copilot_panel.follow(flight, self.futures if asks else None)
        self.credit.follow()
        if flight.over:
            self._readouts = at_touch(self._readouts, flight.env)

    def think(self) -> None:
        """Fly the six futures of the present moment some decisions further, for whoever asks."""
        if not self._settings.show_thinking or self._policy is None or self.flight.over:
            return
        self.futures = self.futures or SixFutures(self._policy, self.flight.route)
        self.futures.follow(self.flight.env, _THINKS)
        self.copilot_panel.follow(self.flight, self.futures)

    # The end

    def reword(self) -> None:
        fresh = flight_readouts(self.flight.env)
        for name, readout in self._readouts.items():
            self._readouts[name] = replace(readout, label=fresh[name].label, what=fresh[name].what)
        self.interventions.forget()
        self.copilot_panel.follow(self.flight, self.futures)

    def make_card(self) -> OutcomeCard:
        """Return the card, to which all that follow the flight have added what they know."""
        flight, credit = self.flight, self.credit
        card = outcome_card(flight.env)
        credit.add_to(card)
        if credit.helped and not card.good:  # why it was not saved says more
            card.advice = why_not_saved(flight) or card.advice
        if add := self.challenge.words(self).card:
            add(card)
        if flight.share < 1:
            figures = [f"{100 - yours(flight.share)} %", self.interventions.counted]
            card.compared[sentence(texts.NETWORK_FLEW, credit.who)] = texts.DIAL_JOIN.join(filter(None, figures))
        return card

    def _finish_card(self) -> None:
        """Add how a ghost, or the network unseen, fares from there; until it is known, the card leaves it open."""
        card = self.ending.card
        if self._shadow and card:
            score = landing_score(self._shadow.env)
            words = texts.SCORE.format(count=score) if score else texts.CARD_NO_LANDING
            card.compared[sentence(texts.CARD_NETWORK, self.credit.who)] = words if self._shadow_ended else "…"
        if self.ghost and card:
            card.compared[self.ghost.name] = self.ghost.result(self.flight.env)

    def _follow_shadow(self, shadow: Flight[Alone]) -> None:
        """Fly the network's own flight from the same start, unseen; after the player's, some steps in a frame."""
        for _ in range(_CATCHES_UP if self.flight.over else 1):
            if not self._shadow_ended:
                shadow.step()

    @property
    def _shadow_ended(self) -> bool:
        return self._shadow is None or self._shadow.over or self._shadow.at >= _LONGEST

    def keep(self, total: int = 0) -> Entry:
        """Write the finished flight into the logbook, once, and return its line; `total` is a descent's so far."""
        if self.record:
            return self.record.entry
        credit = self.credit
        entry = self._records.keep(
            self.flight,
            time.time(),
            alone=credit.counts,
            barred=credit.bar,
            network=self.network.name if self.network.policy else "",
            course=self.challenge.name,
            medal=credit.medal,
            pace=credit.pace,
            guarded=max(0.0, self.interventions.throughout),
            total=total,
        )
        x, y, angle = self.flight.poses.now[0].tolist()
        self.record = Record(self.flight.recording, entry, (x, y, angle))
        if self._records.problem:
            self.context.note(self._records.problem)
        return entry

    # The picture

    def lay_out(self, head: Head) -> None:
        """Keep the flight clear of its words, and of what the network thinks."""
        self.clear = self._clear_of(head)
        if not self.begun:
            reading = self.context.reading()
            if reading.scale > _LARGE * reading.whole.scale:  # the words reach over the Earth's usual place
                self._earth = self.clear.earth(EARTH, EARTH_RADIUS)
            self.scenery.clear = self.clear
            self.scenery.cut()
            if abs(self.scenery.across - self._earth[0]) < _BESIDE * EARTH_RADIUS:  # behind the craft
                self._earth = VIEW_SIZE[0] - self._earth[0], self._earth[1]

    def _clear_of(self, head: Head) -> ClearArea:
        reading = self.context.reading()
        low, foot = head.write(reading, drawn=False), foot_of(reading, self._shown(whole=False))
        low += _BELOW_HEAD * reading.view.height
        right = self.copilot_panel.box(reading).left - 16 if self.panel_stands else reading.view.right
        return ClearArea.of(reading, pygame.FRect(0, low, right, foot.top - reading.message.height - low))

    @property
    def thinks(self) -> bool:
        """Whether what the network thinks is shown: in flight, and of a craft that waits."""
        return self._settings.show_thinking and self.copilot_panel.shown and not self.flight.over

    @property
    def panel_stands(self) -> bool:
        """Whether that has a panel beside the flight, too; a craft that waits has words there."""
        return self.thinks and not self.waiting and self.copilot_panel.fits(self.context.reading())

    def draw(self, canvas: Canvas, alpha: float, head: Head, *, whole: bool, low: float = 0.0) -> None:
        """Draw the world, the craft, the read-outs and the words; `whole` is for all that can be known of it.

        `low` is how far a card reaches down, in points, which the read-outs give way to.
        """
        flight, shown = self.flight, self._shown(whole=whole)
        row = 0.0 if whole else canvas.message.height
        foot = foot_of(canvas, shown).top - row
        world = canvas.above(canvas.view.bottom - foot)
        alpha = self.pace.between(alpha)
        view = self.scenery.view(world.scale, alpha).filling(world)
        self.scenery.draw_land(world, alpha, self._earth)
        if self.ahead:
            begin_hills(self.ahead, view)
        if self.ghost:
            self.ghost.draw_way(world, view)
        if flight.over:
            self.path.draw(world, view, self.interventions.moments, self.ending.retraced)
        if self.thinks and self.futures:
            draw_futures(world, view, self.futures, self.clear.head)
        else:
            self.path_preview.draw(world, view, self.scenery.clear.head)
        if self.ghost:
            self.ghost.draw(world, view, alpha)
        self.scenery.draw_craft(world, alpha, words=self.ending.shown == 0)
        pose = flight.poses.at(alpha)[0]
        if not flight.over:
            draw_wind(world, view, pose, flight.env, self._clear_of(head))
        if marks := self.challenge.words(self).marks:
            marks(world, view, alpha)
        if low < foot:
            draw_flight(canvas, self._readouts, shown, row)
        head.write(canvas)
        stands = self.thinks if whole else self.panel_stands
        if stands and self.copilot_panel.fits(canvas) and not self._behind_panel(canvas, view, pose):
            self.copilot_panel.draw(canvas, self.network.name)

    def _shown(self, *, whole: bool) -> list[str]:
        """Name the read-outs: the four that a pilot needs, and what is left of time and of a small tank; or all.

        Where both make a second line, only the one that runs out is seen, and more of the flight.
        """
        if whole:
            return [name for name in GAUGES if name != "thrust" or not set(self.flight.recording.pushes).issubset(KEYS)]
        env = self.flight.env
        limits = {"fuel": env.conditions.tank < math.inf, "time": env.limits.time < UNHURRIED / 2}
        others, canvas = [name for name, limited in limits.items() if limited], self.context.reading()
        if foot_of(canvas, [*PILOT, *others]).height > foot_of(canvas, PILOT).height:
            others = [min(others, key=lambda name: self._readouts[name].fill or 0.0)]
        return [*PILOT, *others]

    def _behind_panel(self, canvas: Canvas, view: View, pose: Doubles) -> bool:
        """Whether the craft is behind the panel, which happens only where the camera can't keep it clear."""
        place = canvas.points(canvas.whole.pixels(view.points(pose[:2]).tolist()))
        around = 2 * _CRAFT * view.pixels_per_metre / canvas.scale
        return bool(self.copilot_panel.box(canvas).inflate(around, around).collidepoint(place))
