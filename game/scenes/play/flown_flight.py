"""A flight of the player's with all that belongs to it alone: scenery, cockpit, paths, ghost, sounds and ending."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from ai.environment import Doubles
from ai.flights.verification import landing_score
from ai.lander.environment import Outcome
from game.audio.flight_sounds import FlightSound
from game.core import texts
from game.core.pace import SlowMotion
from game.drawing.canvas import Canvas
from game.drawing.tokens import VIEW_SIZE
from game.flight import networks
from game.flight.credit import Credit
from game.flight.difficulty import Difficulty, eased
from game.flight.flight import Flight, StickHolder
from game.flight.flight_file import Entry, Record
from game.flight.handicap import OWN
from game.flight.last_chance import LastChance
from game.flight.logbook import Records
from game.flight.networks import Network, Policy
from game.flight.six_futures import SixFutures
from game.panels.readouts import GAUGES, PILOT, READOUTS, at_touch, draw_flight, flight_readouts
from game.scenes.play import captions
from game.scenes.play.card import PLACES
from game.scenes.play.challenge import Challenge, DrawnFlight
from game.scenes.play.cockpit import Cockpit
from game.scenes.play.ending import FlightEnding
from game.scenes.play.ghost import Ghost
from game.scenes.play.head import Head, path_words
from game.scenes.play.ladder import rung_of
from game.scenes.play.sentence import sentence, surroundings
from game.ui.hints import Hint, flight_hints
from game.world.camera import ClearArea, View
from game.world.landscape.backdrop import EARTH, EARTH_RADIUS
from game.world.landscape.ground import begin_hills
from game.world.path_preview import PathPreview, draw_futures
from game.world.scenery import Scenery

if TYPE_CHECKING:
    from game.ui.context import Context


_CRAFT: Final = 1.5  # metres from the middle of a craft to its ends
_WAITING: Final = 196.0  # points at the head for the words over a craft that waits, before they are laid out
_BELOW_HEAD: Final = 44.0  # and between the words and the craft
_LARGE: Final = 1.15  # size of words beside that on a page from which they reach far across
_SEARCH: Final = 6  # decisions in a frame, in the search for what would have saved a lost flight


class FlownFlight:
    """One flight of the player's, made anew for every start; around every step, call `prepare` and `follow`.

    Args:
        context: the shared services.
        seed: seed of the start.
        network: the one to hand over to, if it can be read; unused where the player must fly alone.
        challenge: its start and rules; None for a free flight.
        pads: number of landing pads of a free flight.
        spawn: kind of start of a free flight.
        hands: handicap of a free flight, a name of `game.flight.handicap.HANDS`.

    Attributes:
        flight: the flight itself.
        credit: who flies it, and whether it counts as the player's own.
        difficulty: its changes of gravity, and its assists.
        pace: the clock that slows down after a crash.
        ending: the ending, with slow motion and outcome card.
        record: the record of the flight once it is over; None before, and where none is kept.
        helped: the settings of help, the player's own or those of the challenge.
        clear: the part of the screen in which to show the flight.
        futures: the six futures, once somebody has asked; None before.
        waiting: whether the craft hangs until the pilot touches a control.
        begun: whether it has flown a step.

    """

    def __init__(
        self,
        context: Context,
        seed: int,
        network: Network,
        challenge: Challenge | None = None,
        *,
        pads: int = 1,
        spawn: str = "random",
        hands: str = OWN,
    ) -> None:
        self._context, self._settings = context, context.settings
        self.challenge, self.hands = challenge, hands
        self.waiting = self._held_before = True
        self._age = 0
        self.record: Record | None = None
        self.begun = False
        self._was_over = False  # whether the flight was over before its latest step
        alone = challenge is not None and challenge.alone
        self._network, self._policy = network, None if alone else network.policy
        self.flight = self._begin(seed, spawn, pads)
        self.difficulty = Difficulty(self._settings, self.flight, free=not challenge)
        self.credit = Credit(self.flight, self.difficulty, challenge, hands)
        self.helped = challenge.dial(self._settings) if challenge else self._settings
        self.cockpit = Cockpit(self.flight, self.helped, self.credit)
        self._last_chance: LastChance | None = None
        self.futures: SixFutures | None = None
        self._looked = -1  # step of the moment whose six futures are known, or are being flown
        self.ghost = challenge.ghost(seed, self._policy) if challenge else None
        calm = self._settings.reduced_motion
        self.clear, self._earth = ClearArea(), EARTH
        self.scenery = Scenery(self.flight, calm, ClearArea(head=_WAITING))
        self.pace = SlowMotion()
        self._heard = FlightSound(context.sound, self.flight.env, self.pace)
        self.ending = FlightEnding(self.flight, self.pace, calm)
        self._readouts = flight_readouts(self.flight.env)
        self._network_here = self._shadow()
        self.path_preview = PathPreview(self.flight, self._guide)

    def _begin(self, seed: int, spawn: str, pads: int) -> Flight:
        """Return the flight at its start, eased as the player has chosen, where that may be."""
        easing, challenge = eased(self._settings), self.challenge
        if challenge is None:
            return Flight(seed, self._policy, spawn, pads=pads, hands=self.hands, easing=easing)
        if challenge.eases:
            challenge.easing = easing
        return challenge.flight(seed, self._policy)

    def _shadow(self) -> Flight | None:
        """Return the network's own flight from the same start, flown unseen: the card tells its score."""
        if self._policy is None or self.challenge:
            return None
        recording = self.flight.recording
        shadow = Flight(recording.seed, self._policy, recording.spawn, pads=recording.pads, easing=recording.easing)
        shadow.hand_over()
        return shadow

    def _guard(self) -> None:
        """Let futures be flown ahead, once the flight is shared with a guardian."""
        flight = self.flight
        if flight.guard is None and flight.shared and (ahead := self._context.ahead()):
            from game.flight.guard import Guard

            flight.guard = Guard(flight, ahead)

    @property
    def _guide(self) -> Policy | None:
        """The network whose path is previewed; None where none is."""
        return None if self.challenge and not self.challenge.guides else self._policy

    @property
    def rival(self) -> Ghost | None:
        """The ghost that the card compares the flight with."""
        return self.ghost if self.challenge and self.challenge.compares else None

    @property
    def stuck(self) -> bool:
        """Whether the craft hangs, and a control that is held must first be let go."""
        return self.waiting and self._held_before and not self.flight.over

    def set_calm(self, calm: bool) -> None:
        """Set whether motion is reduced."""
        self.scenery.calm = self.ending.calm = calm
        if calm:
            self.pace.hurry()

    def change_network(self, network: Network) -> None:
        """Change the network to hand over to, unless the player must fly alone."""
        self._network = network
        if not self.credit.alone:
            self._policy = network.policy
            self.flight.change_network(network.policy)
            self.path_preview.ask(self._guide)

    # Time

    def breathe(self) -> None:
        """Advance by 1/60 s what moves whether or not anything flies."""
        self._age += 1
        self.scenery.breathe()
        self.cockpit.breathe()

    def due(self, action: int) -> bool:
        """Count 1/60 s; return whether a step is due: the craft may wait, or slowed time make none due."""
        self.pace.rate = self._settings.pace
        if self._waits(action):
            self.cockpit.help()
            self._guard()
            if self.flight.guard:
                self.flight.guard.hang(action)
            self.path_preview.follow(waiting=True)
            return False
        return bool(self.pace.steps())

    def sound(self) -> None:
        """Let the flight be heard; call it in every 1/60 s, between steps too, or fire would fall silent."""
        self._heard.follow(self.scenery.stage.thrust[0])

    def _waits(self, action: int) -> bool:
        """Whether the craft still hangs; a key that began the flight itself must first be let go."""
        self._held_before = self._held_before and bool(action)
        touched = bool(action) or (self.challenge is not None and not self.challenge.waits)
        holds = self.challenge is not None and self.challenge.holds
        guard = self.flight.guard
        ready = guard is None or guard.ready  # or nobody would keep it from harm at first
        if self.flight.hand is StickHolder.NETWORK or (touched and not self._held_before and not holds and ready):
            self.waiting = False
        return self.waiting

    def hang(self) -> None:
        """Let a craft in flight hang where it is until the pilot's next touch: after a pause, or a lost focus."""
        if not self.flight.over:
            self.waiting = self._held_before = True

    def prepare(self) -> None:
        """Make ready for the flight's next step; after the end, only what still moves goes on."""
        self._was_over, self.begun = self.flight.over, True
        if not self._was_over:  # at the end, the figures stay those of the last moment before
            self._readouts = flight_readouts(self.flight.env)
            self.difficulty.heed()
        self.cockpit.help()
        self._guard()

    def follow(self) -> None:
        """Follow the flight's step."""
        flight = self.flight
        if self.ghost:
            self.ghost.step()
        if self._network_here:
            self._network_here.step(0)
        self.path_preview.follow(waiting=False)
        if not self._was_over:
            if self._settings.show_thinking:
                self.think(2)
            self.cockpit.follow(self.futures if self._settings.show_thinking else None)
            self._note_chance()
            if flight.over:
                self._readouts = at_touch(self._readouts, flight.env)
            if flight.over and self.challenge:
                self.challenge.settle(flight, self.credit)
        self.scenery.clear = self.clear
        if flight.over and self._last_chance and flight.wrecked:
            self._last_chance.look(_SEARCH)
        self.scenery.follow(flight.over and not self._was_over, self.ending.shot)
        if self.challenge and (told := self.challenge.follow(flight)):
            self._context.sound.play(told)

    # The end

    def compared(self, best: int) -> tuple[tuple[str, str], ...]:
        """Return other scores from the same start: the player's `best` before, 0 for none, and the network's."""
        rows = [(texts.CARD_BEST_HERE, texts.SCORE.format(count=best))] if best else []
        if shadow := self._network_here:
            while not shadow.over:
                shadow.step(0)
            score = landing_score(shadow.env)
            rows.append((texts.CARD_NETWORK, texts.SCORE.format(count=score) if score else texts.CARD_NO_LANDING))
        return tuple(rows)

    def make_card(self, best: int) -> None:
        """Make the outcome card of the finished flight; `best` is the score to beat in free flights."""
        chance = self._last_chance if self.credit.helped else None
        while chance and not (chance.known or self.flight.outcome is Outcome.LANDED):
            chance.look(_SEARCH)
        ending, cockpit, challenge = self.ending, self.cockpit, self.challenge
        ending.whole = self.scenery.shot_of(cockpit.track.path)
        unranked = rung_of(self.flight) is not None or (challenge and challenge.name)
        card = cockpit.card(0 if unranked else best, chance)
        card = replace(card, place=cockpit.track.beside(PLACES, ending.whole.view(1.0)))
        ending.card = challenge.card(card, self.flight, self.credit) if challenge else card

    def write_down(self, records: Records) -> Entry | None:
        """Record the finished flight, and return its line; None if that was done before.

        It is saved as a demonstration if wished, and failures are reported.
        """
        if self.record:
            return None
        context, credit, challenge = self._context, self.credit, self.challenge
        told = (
            ""
            if challenge or credit.bar == "practice"
            else self.cockpit.add_demonstration(context.user_dir, self.hands)
        )
        entry = records.keep(
            self.flight,
            time.time(),
            alone=credit.counts,
            barred=credit.bar,
            network=self._network.name if self._network.policy else "",
            course=challenge.name if challenge else "",
            medal=credit.medal,
            pace=credit.pace,
            guarded=max(0.0, self.cockpit.rescues.throughout),
            total=challenge.total if challenge else 0,
        )
        x, y, angle = self.flight.poses.now[0].tolist()
        self.record = Record(self.flight.recording, entry, (x, y, angle))
        told = told or (challenge.written(entry) if challenge else "")
        if told or records.problem:
            context.note(told or records.problem)
        return entry

    def _note_chance(self) -> None:
        """Keep moments of a helped flight, to tell what would have saved it if it is lost."""
        if self.credit.helped and self._policy is not None:
            self._last_chance = self._last_chance or LastChance(self._policy, self.flight.route)
            self._last_chance.note(self.flight.env)

    def think(self, decisions: int) -> None:
        """Fly the six futures of the present moment some decisions further, for whoever asks."""
        step = len(self.flight.recording.actions)
        if self._policy is None or self.flight.over:
            return
        if self.futures is None:
            self.futures = SixFutures(self._policy, self.flight.route)
        if not self.futures.under_way and self._looked != step:
            self.futures.begin(self.flight.env)
            self._looked = step
        self.futures.follow(decisions)
        self.cockpit.copilot_panel.follow(self.flight, self.futures)

    # The picture

    def head(self, hints: Sequence[Hint], *, whole: bool) -> Head:
        """Return the words at the head: all while there is time to read, which `whole` says, or the sentence."""
        flight, challenge, controls, cockpit = self.flight, self.challenge, self._context.controls, self.cockpit
        waits, stuck = self.waiting and not flight.over, self.stuck
        told = challenge.sentence(flight, controls, waiting=waits, stuck=stuck) if challenge else None
        helps = cockpit.help_words if cockpit.helps and not flight.over else None
        if not (waits or whole or flight.over):
            words, warns = told or sentence(flight, self.credit, cockpit.overrides, controls), False
            if isinstance(words, tuple):
                words, warns = words
            shown = helps if cockpit.help_words.shown else None
            return Head(words, warns, cockpit.lamp(), hints=hints, help=shown, means=cockpit.means)
        caption, name = captions.title(flight, challenge, self._network, self.hands, whole=whole)
        goal = challenge.goal if challenge else ""
        without = challenge is not None and challenge.kept and helps is not None and self.helped.assist == 0
        apart = texts.HELP_NOT_HERE if without and self._settings.assist > 0 and not self.begun else ""
        aside = [
            apart,
            self.credit.header if self.credit.alone and not flight.over else "",
            self.credit.notice or goal,
            *surroundings(flight.env),
            *(challenge.asides(flight) if challenge else ()),
        ]
        head = Head(caption=caption, name=name, rung=rung_of(flight), aside=list(filter(None, aside)), hints=hints)
        if flight.over:
            return Head(hints=hints) if self.ending.shown else replace(head, sentence=told or "")
        if not waits:
            return replace(head, sentence=self.credit.header, lamp=cockpit.lamp())
        opening = captions.opening(flight, challenge, begun=self.begun, stuck=stuck)
        keys = flight_hints(controls) if opening and told is None else ()
        paths = (
            path_words(texts.PATH_YOURS, texts.PATH_NETWORK if self.path_preview.asks else "")
            if keys and not challenge
            else ()
        )
        return replace(
            head, sentence=told or opening, lamp=cockpit.lamp(), controls=keys, paths=paths, help=helps,
            means=cockpit.means,
        )  # fmt: skip

    def lay_out(self, head: Head) -> None:
        """Keep the flight clear of its words, and of what the network thinks."""
        self.clear = self._clear_of(head)
        if not self.begun:
            reading = self._context.reading()
            if reading.scale > _LARGE * reading.whole.scale:  # the words reach over the Earth's usual place
                self._earth = EARTH[0], max(EARTH[1], self.clear.head - _BELOW_HEAD + 1.3 * EARTH_RADIUS)
            self.scenery.clear = self.clear
            self.scenery.cut()

    def _clear_of(self, head: Head) -> ClearArea:
        reading = self._context.reading()
        scale, view = reading.whole.scale, reading.whole.view
        low = head.write(reading, drawn=False) * reading.scale / scale + _BELOW_HEAD + min(view.top, 0.0)
        right = float(VIEW_SIZE[0])
        if self.thinks:
            right = min(right, (self.cockpit.panel_box(reading).left - 16) * reading.scale / scale + view.left)
        return ClearArea(right=max(right, 0.4 * VIEW_SIZE[0]), head=max(low, ClearArea.head))

    @property
    def thinks(self) -> bool:
        """Whether what the network thinks is shown in flight."""
        flies = not (self.waiting or self.flight.over)
        return self._settings.show_thinking and self.cockpit.copilot_panel.shown and flies

    def moment(self, alpha: float) -> DrawnFlight:
        """Return the moment that a challenge draws over, once the fraction `alpha` of a step has passed."""
        return DrawnFlight(alpha, self.waiting, self._settings.reduced_motion, self._age)

    def draw(self, canvas: Canvas, alpha: float, head: Head, *, whole: bool, low: float = 0.0) -> None:
        """Draw the world, the craft, the read-outs and the words; `whole` is for all that can be known of it.

        `low` is how far a card reaches down, in points, which the read-outs give way to.
        """
        world, flight = canvas.whole, self.flight
        alpha = self.pace.between(alpha)
        view = self.scenery.view(world.scale, alpha).filling(world)
        self.scenery.draw_land(world, alpha, self._earth)
        if self.challenge and self.challenge.ahead:
            begin_hills(self.challenge.ahead, view)
        if self.ghost:
            self.ghost.draw_way(world, view)
        if flight.over:
            self.cockpit.track.draw(world, view)
        thinks = self.thinks or (whole and self.cockpit.copilot_panel.shown)
        if thinks and self.futures:
            draw_futures(world, view, self.futures, self.clear.head)
        else:
            self.path_preview.draw(world, view, self.scenery.clear.head, self.cockpit.coasting)
        if self.ghost:
            self.ghost.draw(world, view, alpha)
        self.scenery.draw_craft(world, alpha, words=self.ending.shown == 0)
        pose = flight.poses.at(alpha)[0]
        self.cockpit.draw_beside(world, view, pose, self._clear_of(head))
        if self.challenge:
            self.challenge.draw(world, view, flight, self.moment(alpha))
        if low * canvas.scale < world.surface.get_height() - READOUTS * world.scale:
            draw_flight(world, self._readouts, self._shown(whole=whole))
        head.write(canvas)
        if thinks and not self._behind_panel(canvas, view, pose):
            self.cockpit.copilot_panel.draw(canvas, flight.share, networks.word(self._network.name))

    def _shown(self, *, whole: bool) -> list[str]:
        """Name the read-outs: the four that a pilot needs, and what is left of a tank that is small; or all."""
        if whole:
            return [name for name in GAUGES if name != "thrust" or self.flight.recording.shares]
        return [*PILOT, *(["fuel"] if self.flight.env.conditions.tank < math.inf else [])]

    def _behind_panel(self, canvas: Canvas, view: View, pose: Doubles) -> bool:
        """Whether the craft is behind the panel, which happens only where the camera can't keep it clear."""
        place = canvas.points(canvas.whole.pixels(view.points(pose[:2]).tolist()))
        around = 2 * _CRAFT * view.pixels_per_metre / canvas.scale
        return bool(self.cockpit.panel_box(canvas).inflate(around, around).collidepoint(place))
