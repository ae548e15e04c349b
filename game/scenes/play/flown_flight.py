"""A flight of the player's with all that belongs to it alone: scenery, help, paths, ghost, sounds and ending."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import pygame

from ai.environment import Doubles
from ai.flights.verification import landing_score
from ai.lander.push import KEYS, Push
from game.audio.flight_sounds import FlightSound
from game.core import texts
from game.core.clock import TimeScale
from game.drawing.canvas import Canvas
from game.explain.landings import Landings
from game.explain.readouts import GAUGES, PILOT, at_touch, draw_flight, flight_readouts, foot_of
from game.flight.choosers import Alone
from game.flight.credit import ASSISTS, Credit, eased
from game.flight.flight import Flight, StickHolder
from game.flight.flight_file import Entry, Record
from game.flight.foresight import LastChance, SixFutures
from game.flight.logbook import Records
from game.flight.networks import Network
from game.flight.outcomes import OutcomeCard, outcome_card
from game.scenes.play.challenge import Challenge
from game.scenes.play.copilot_panel import CopilotPanel
from game.scenes.play.ending import FlightEnding, FlownPath
from game.scenes.play.free import rung_of
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
_BELOW_HEAD: Final = 44.0  # and between the words and the craft
_LARGE: Final = 1.15  # size of words beside that on a page from which they reach far across
_SEARCH: Final = 6  # decisions in a frame, in the search for what would have saved a lost flight
_THINKS: Final = 2  # decisions of six futures that are flown in a frame


class FlownFlight:
    """One flight of the player's, made anew for every start; around every step, call `prepare` and `follow`.

    Args:
        context: the shared services.
        seed: seed of the start.
        network: the one to hand over to, if it can be read; unused where the player must fly alone.
        challenge: its start and rules.
        spawn: kind of start; empty for the player's own.

    Attributes:
        context, challenge, network: as given, but that the network can be changed.
        flight: the flight itself.
        credit: who flies it, and whether it counts as the player's own.
        pace: the clock that slows down after a crash.
        ending: the ending, with slow motion and outcome card.
        record: the record of the flight once it is over; None before, and where none is kept.
        helped: the settings of help, the player's own or those of the challenge.
        clear: the part of the screen in which to show the flight.
        futures: the six futures, once somebody has asked; None before.
        waiting: whether the craft hangs until the pilot touches a control.
        begun: whether it has flown a step.
        best: the score to beat in free flights, and the player's best from this start before; 0 for none.
        age: steps of 1/60 s since it was first shown, whether or not it flies.

    """

    def __init__(self, context: Context, seed: int, network: Network, challenge: Challenge, spawn: str = "") -> None:
        self.context, self._settings = context, context.settings
        self.challenge, self.network = challenge, network
        self.waiting = self._held_before = True
        self.begun = self._was_over = False  # was: before its latest step
        self.age, self._looked = 0, -1  # step of the moment whose six futures are known, or are being flown
        self.record: Record | None = None
        self.best = (0, 0)
        self._policy = None if challenge.alone else network.policy
        if challenge.eases:
            challenge.easing = eased(self._settings)
        self.flight = challenge.flight(seed, self._policy, spawn)
        self.credit = Credit(self.flight, self._settings, challenge)
        self.helped = challenge.dial(self._settings)
        self.help_words, self.interventions = HelpWords(self.helped), Interventions()
        self.copilot_panel = CopilotPanel()
        self._help()
        self._last_chance: LastChance | None = None
        self.futures: SixFutures | None = None
        self.ghost = challenge.ghost(seed, self._policy)
        calm = self._settings.reduced_motion
        self.clear, self._earth = ClearArea(), EARTH
        self.scenery = Scenery(self.flight, calm, ClearArea(head=_WAITING))
        self.pace = TimeScale()
        self._heard = FlightSound(context.sound, self.flight.env, self.pace)
        self.path = FlownPath(self.flight)
        self.ending = FlightEnding(self.flight, self.pace, calm)
        self._readouts = flight_readouts(self.flight.env)
        self._network_here = self._shadow() if challenge.shadows and self._policy else None
        self.path_preview = PathPreview(self.flight, self._policy if challenge.guides else None)

    def _shadow(self) -> Flight[Alone]:
        """Return the network's own flight from the same start, flown unseen: the card tells its score."""
        assert self._policy is not None
        return Flight(self.flight.recording, Alone(self._policy))

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
            self._policy = network.policy
            self.flight.chooser.change_network(network.policy)
            self.path_preview.ask(self._policy if self.challenge.guides else None)

    # Time

    def animate(self) -> None:
        """Advance by 1/60 s what moves whether or not anything flies."""
        self.age += 1
        self.scenery.animate()
        self.help_words.shown = max(0, self.help_words.shown - 1)

    def due(self, asked: Push) -> bool:
        """Count 1/60 s; return whether a step is due: the craft may wait, or slowed time make none due."""
        self.pace.rate = self._settings.pace
        if self._waits(asked):
            self._help()
            if self.flight.chooser.guard:
                self.flight.chooser.guard.hang(self.flight, asked)
            self.path_preview.follow(waiting=True)
            return False
        return bool(self.pace.steps())

    def _waits(self, asked: Push) -> bool:
        """Whether the craft still hangs; a key that began the flight itself must first be let go."""
        self._held_before &= asked != Push()
        touched, guard = asked != Push() or not self.challenge.waits, self.flight.chooser.guard
        ready = guard is None or guard.ready(self.flight)  # or nobody would keep it from harm at first
        goes = touched and ready and not (self._held_before or self.challenge.holds)
        if goes or self.flight.chooser.hand is StickHolder.NETWORK:
            self.waiting = False
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

    def prepare(self) -> None:
        """Make ready for the flight's next step; after the end, only what still moves goes on."""
        self._was_over, self.begun = self.flight.over, True
        if not self._was_over:  # at the end, the figures stay those of the last moment before
            self._readouts = flight_readouts(self.flight.env)
            self.credit.prepare()
        self._help()

    def follow(self) -> None:
        flight = self.flight
        if self.ghost:
            self.ghost.step()
        if self._network_here:
            self._network_here.step()
        self.path_preview.follow(waiting=False)
        if not self._was_over:
            self._follow_flight()
        self.scenery.clear = self.clear
        if flight.wrecked and self._last_chance:
            self._last_chance.look(_SEARCH)
        self.scenery.follow(flight.over and not self._was_over, self.ending.shot)
        if sample := self.challenge.follow(flight):
            self.context.sound.play(sample)

    def _follow_flight(self) -> None:
        flight, asks = self.flight, self._settings.show_thinking
        if asks:
            self.think(_THINKS)
        self.interventions.follow(flight)
        self.path.follow()
        self.copilot_panel.follow(flight, self.futures if asks else None)
        self.credit.follow()
        if self.credit.helped and self._policy:  # to tell what would have saved it if it is lost
            self._last_chance = self._last_chance or LastChance(self._policy, flight.route)
            self._last_chance.note(flight.env)
        if flight.over:
            self._readouts = at_touch(self._readouts, flight.env)
            self.challenge.note_end(flight, self.credit)

    def sound(self) -> None:
        """Let the flight be heard; call it in every 1/60 s, between steps too, or fire would fall silent."""
        self._heard.follow(self.scenery.stage.thrust[0])

    def think(self, decisions: int) -> None:
        """Fly the six futures of the present moment some decisions further, for whoever asks."""
        step = self.flight.at
        if self._policy is None or self.flight.over:
            return
        self.futures = self.futures or SixFutures(self._policy, self.flight.route)
        if not self.futures.under_way and self._looked != step:
            self.futures.begin(self.flight.env)
            self._looked = step
        self.futures.follow(decisions)
        self.copilot_panel.follow(self.flight, self.futures)

    # The end

    def reword(self) -> None:
        fresh = flight_readouts(self.flight.env)
        for name, readout in self._readouts.items():
            self._readouts[name] = replace(readout, label=fresh[name].label, what=fresh[name].what)
        self.interventions.forget()
        self.copilot_panel.forget()
        self.copilot_panel.follow(self.flight, self.futures)

    def make_card(self) -> OutcomeCard:
        """Return the outcome card."""
        flight, credit, ending = self.flight, self.credit, self.ending
        ending.whole = self.scenery.shot_of(self.path.places)
        unranked = rung_of(flight) is not None or self.challenge.name
        card = outcome_card(flight.env, flight.share)
        card = replace(
            card, score=credit.score(0 if unranked else self.best[0]), reason=credit.reason(card.reason),
            assists=credit.assists, who=credit.who, place=self.path.clear_place(ending.whole.view(1.0)),
            compared=self._compared(self.best[1]),
        )  # fmt: skip
        if credit.helped:
            chance = None if card.good else self._last_chance
            while chance and not chance.known:
                chance.look(_SEARCH)
            bare = "" if card.good else why_not_saved(flight, chance)
            watched, times = self.interventions.watched(flight), len(self.interventions.moments)
            advice = "" if bare else card.advice  # why it was not saved says more
            card = replace(card, stepped_in=times, watched=watched, bare=bare, advice=advice)
        return self.challenge.card(card, flight, credit)

    def _compared(self, best: int) -> tuple[tuple[str, str], ...]:
        """Return other scores from the same start: the player's `best` before, 0 for none, and the network's."""
        rows = [(texts.CARD_BEST_HERE, texts.SCORE.format(count=best))] if best else []
        if shadow := self._network_here:
            while not shadow.over:
                shadow.step()
            score = landing_score(shadow.env)
            words = texts.SCORE.format(count=score) if score else texts.CARD_NO_LANDING
            rows.append((texts.CARD_NETWORK.format(who=self.credit.who), words))
        return tuple(rows)

    def write_down(self, records: Records) -> Entry | None:
        """Record the finished flight, and return its line; None if that was done before; report what failed."""
        if self.record:
            return None
        credit, challenge = self.credit, self.challenge
        entry = records.keep(
            self.flight,
            time.time(),
            alone=credit.counts,
            barred=credit.bar,
            network=self.network.name if self.network.policy else "",
            course=challenge.name,
            medal=credit.medal,
            pace=credit.pace,
            guarded=max(0.0, self.interventions.throughout),
            total=challenge.total,
        )
        x, y, angle = self.flight.poses.now[0].tolist()
        self.record = Record(self.flight.recording, entry, (x, y, angle))
        if message := challenge.written(entry) or records.problem:
            self.context.note(message)
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

    def _clear_of(self, head: Head) -> ClearArea:
        reading = self.context.reading()
        low, foot = head.write(reading, drawn=False) + _BELOW_HEAD, foot_of(reading, self._shown(whole=False))
        right = self.copilot_panel.box(reading).left - 16 if self.thinks else reading.view.right
        return ClearArea.of(reading, pygame.FRect(0, low, right, foot.top - low))

    @property
    def thinks(self) -> bool:
        """Whether what the network thinks is shown in flight."""
        flies = not (self.waiting or self.flight.over)
        return self._settings.show_thinking and self.copilot_panel.shown and flies

    def draw(self, canvas: Canvas, alpha: float, head: Head, *, whole: bool, low: float = 0.0) -> None:
        """Draw the world, the craft, the read-outs and the words; `whole` is for all that can be known of it.

        `low` is how far a card reaches down, in points, which the read-outs give way to.
        """
        flight, shown = self.flight, self._shown(whole=whole)
        foot = foot_of(canvas, shown).top
        world = canvas.above(canvas.view.bottom - foot)
        alpha = self.pace.between(alpha)
        view = self.scenery.view(world.scale, alpha).filling(world)
        self.scenery.draw_land(world, alpha, self._earth)
        if self.challenge.ahead:
            begin_hills(self.challenge.ahead, view)
        if self.ghost:
            self.ghost.draw_way(world, view)
        if flight.over:
            self.path.draw(world, view, self.interventions.moments)
        thinks = self.thinks or (whole and self.copilot_panel.shown)
        if thinks and self.futures:
            draw_futures(world, view, self.futures, self.clear.head)
        else:
            self.path_preview.draw(world, view, self.scenery.clear.head, self._coasting)
        if self.ghost:
            self.ghost.draw(world, view, alpha)
        self.scenery.draw_craft(world, alpha, words=self.ending.shown == 0)
        pose = flight.poses.at(alpha)[0]
        if not flight.over:
            draw_wind(world, view, pose, flight.env, self._clear_of(head))
        self.challenge.draw(world, view, self, alpha)
        if low < foot:
            draw_flight(canvas, self._readouts, shown)
        head.write(canvas)
        if thinks and not self._behind_panel(canvas, view, pose):
            self.copilot_panel.draw(canvas, flight.share if self.begun else None, self.network.name)

    @property
    def _coasting(self) -> tuple[float, bool] | None:
        """A guardian's future of coasting, for the mark on the path; None without one, or if nobody asks."""
        values = self.copilot_panel.values
        shown = self._settings.show_thinking and self.copilot_panel.shown
        return values.coasting if shown and isinstance(values, Landings) else None

    def _shown(self, *, whole: bool) -> list[str]:
        """Name the read-outs: the four that a pilot needs, and what is left of a tank that is small; or all."""
        if whole:
            return [name for name in GAUGES if name != "thrust" or not set(self.flight.recording.pushes).issubset(KEYS)]
        return [*PILOT, *(["fuel"] if self.flight.env.conditions.tank < math.inf else [])]

    def _behind_panel(self, canvas: Canvas, view: View, pose: Doubles) -> bool:
        """Whether the craft is behind the panel, which happens only where the camera can't keep it clear."""
        place = canvas.points(canvas.whole.pixels(view.points(pose[:2]).tolist()))
        around = 2 * _CRAFT * view.pixels_per_metre / canvas.scale
        return bool(self.copilot_panel.box(canvas).inflate(around, around).collidepoint(place))
