"""A flight of the player's with all that belongs to it alone: scenery, cockpit, paths, ghost, sounds and ending."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from game.audio.flight_sounds import FlightSound
from game.cockpit import hud
from game.cockpit.cockpit import Cockpit
from game.cockpit.readouts_explained import explain_readouts
from game.core.pace import SlowMotion
from game.drawing.canvas import Canvas
from game.flight.assists import eased
from game.flight.credit import Credit
from game.flight.difficulty import Difficulty
from game.flight.flight import Flight, StickHolder
from game.flight.flight_file import Record
from game.flight.handicap import OWN
from game.flight.logbook import Records
from game.flight.networks import Network, Policy
from game.flight.skill import Skill
from game.play import captions
from game.play.challenge import Challenge, DrawnFlight
from game.play.ending import FlightEnding
from game.play.ghost import Ghost
from game.world.landscape.ground import begin_hills
from game.world.path_preview import PathPreview
from game.world.scenery import Scenery

if TYPE_CHECKING:
    from game.ui.context import Context


class FlownFlight:
    """One flight of the player's, made anew for every start; around every step, call `prepare` and `follow`.

    Args:
        context: the shared services.
        seed: seed of the start.
        policy: the network to hand over to, if there is one; unused where the player must fly alone.
        challenge: its start and rules; None for a free flight.
        pads: number of landing pads of a free flight.
        spawn: kind of start of a free flight.
        hands: handicap of a free flight, a name of `game.flight.handicap.HANDS`.
        check: whether it is a check flight.

    Attributes:
        flight: the flight itself.
        credit: who flies it, and whether it counts as the player's own.
        difficulty: its changes of gravity, and its assists.
        pace: the clock that slows down after a crash.
        ending: the ending, with slow motion and outcome card.
        record: the record of the flight once it is over; None before, and where none is kept.
        waiting: whether the craft hangs until the pilot touches a control.
        begun: whether it has flown a step.

    """

    def __init__(
        self,
        context: Context,
        seed: int,
        policy: Policy | None,
        challenge: Challenge | None = None,
        *,
        pads: int = 1,
        spawn: str = "random",
        hands: str = OWN,
        check: bool = False,
    ) -> None:
        self._context, self._settings = context, context.settings
        self.challenge, self.hands = challenge, hands
        self.waiting = self._held_before = True
        self._written, self._age = False, 0
        self.record: Record | None = None
        self.begun = False
        self._was_over = False  # whether the flight was over before its latest step
        alone = check or (challenge is not None and challenge.alone)
        self._policy = None if alone else policy
        self.flight = self._begin(seed, spawn, pads)
        self.difficulty = Difficulty(self._settings, self.flight, free=not challenge)
        self.credit = Credit(self.flight, self.difficulty, challenge, hands, check=check)
        dial = challenge.dial(self._settings) if challenge else self._settings
        self.cockpit = Cockpit(self.flight, dial, self.credit, context.view)
        self.ghost = challenge.ghost(seed, self._policy) if challenge else None
        told = not challenge or bool(challenge.opening)
        calm = self._settings.reduced_motion
        self.scenery = Scenery(self.flight, calm, captions.BELOW_OPENING if told else self.cockpit.clear)
        self.pace = SlowMotion()
        self._heard = FlightSound(context.sound, self.flight.env, self.pace)
        self.ending = FlightEnding(self.flight, self.pace, calm)
        self._readouts, self._thrust = hud.flight_readouts(self.flight.env), hud.thrust_readout(self.flight.env)
        self.path_preview = PathPreview(self.flight, self._guide)

    def _begin(self, seed: int, spawn: str, pads: int) -> Flight:
        """Return the flight at its start, eased as the player has chosen, where that may be."""
        easing, challenge = eased(self._settings), self.challenge
        if challenge is None:
            return Flight(seed, self._policy, spawn, pads=pads, hands=self.hands, easing=easing)
        if challenge.eases:
            challenge.easing = easing
        return challenge.flight(seed, self._policy)

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

    def set_calm(self, calm: bool) -> None:
        """Set whether motion is reduced."""
        self.scenery.calm = self.ending.calm = calm
        if calm:
            self.pace.hurry()

    def change_network(self, policy: Policy | None) -> None:
        """Change the network to hand over to, unless the player must fly alone."""
        if not self.credit.alone:
            self._policy = policy
            self.flight.change_network(policy)
            self.path_preview.ask(self._guide)

    # Time

    def breathe(self) -> None:
        """Advance by 1/60 s what moves whether or not anything flies."""
        self._age += 1
        self.scenery.breathe()
        self.cockpit.ease()

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
        if self.flight.hand is StickHolder.NETWORK or (touched and not self._held_before and not holds):
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
            self._readouts, self._thrust = hud.flight_readouts(self.flight.env), hud.thrust_readout(self.flight.env)
            self.difficulty.heed()
        self.cockpit.help()
        self._guard()

    def follow(self) -> None:
        """Follow the flight's step."""
        flight = self.flight
        if self.ghost:
            self.ghost.step()
        self.path_preview.follow(waiting=False)
        if not self._was_over:
            self.cockpit.follow()
            if flight.over:
                self._readouts = hud.at_touch(self._readouts, flight.env)
            if flight.over and self.challenge:
                self.challenge.settle(flight, self.credit)
        self.scenery.clear = self.cockpit.clear
        self.scenery.follow(flight.over and not self._was_over, self.ending.shot)
        if self.challenge and (told := self.challenge.follow(flight)):
            self._context.sound.play(told)

    # The end

    def make_card(self, skill: Skill) -> None:
        """Make the outcome card of the finished flight."""
        self.ending.make_card(self.cockpit, self.challenge, skill, self.scenery)

    def write_down(self, records: Records, skill: Skill, network: Network) -> None:
        """Record the finished flight, once; save it as a demonstration if wished, and report failures."""
        if self._written:
            return
        self._written = True
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
            network=network.name if network.policy else "",
            course=challenge.name if challenge else "",
            medal=credit.medal,
            pace=credit.pace,
            guarded=max(0.0, self.cockpit.rescues.throughout),
            total=challenge.total if challenge else 0,
        )
        x, y, angle = self.flight.poses.now[0].tolist()
        self.record = Record(self.flight.recording, entry, (x, y, angle))
        told = told or (challenge.written(entry) if challenge else "")
        skill.add(entry)
        if told or records.problem:
            context.note(told or records.problem)

    # The picture

    def moment(self, alpha: float) -> DrawnFlight:
        """Return the moment that a challenge draws over, once the fraction `alpha` of a step has passed."""
        controls, clear = self._context.controls, self.cockpit.free
        stuck, calm = self.waiting and self._held_before, self._settings.reduced_motion
        return DrawnFlight(alpha, controls, clear, self.waiting, stuck, calm, self._age)

    def draw(self, canvas: Canvas, alpha: float, network: Network) -> None:
        """Draw the world, the craft and the read-outs; `network` is the one whose name the title tells."""
        alpha = self.pace.between(alpha)
        view, flight = self.scenery.view(canvas.scale, alpha).filling(canvas), self.flight
        self.scenery.draw_land(canvas, alpha)
        if self.challenge and self.challenge.ahead:
            begin_hills(self.challenge.ahead, view)
        if self.ghost:
            self.ghost.draw_way(canvas, view)
        if flight.over:
            self.cockpit.track.draw(canvas, view)
        self.path_preview.draw(canvas, view, self.scenery.clear.head, self.cockpit.coasting)
        if self.ghost:
            self.ghost.draw(canvas, view, alpha)
        self.scenery.draw_craft(canvas, alpha, words=self.ending.shown == 0)
        pose = flight.poses.at(alpha)[0]
        self.cockpit.draw_panel(canvas, view, pose)
        self.cockpit.draw_beside(canvas, view, pose)
        if self.challenge:
            self.challenge.draw(canvas, view, flight, self.moment(alpha))
        self.cockpit.draw_top(canvas)
        captions.draw_title(canvas, flight, self.challenge, network, self.hands, self.credit.notice)
        if flight.recording.shares:
            hud.draw_readouts(canvas, [*self._readouts, self._thrust], (*hud.COLUMNS, hud.THRUST_COLUMN))
        else:
            hud.draw_readouts(canvas, self._readouts)
        explain_readouts(canvas, flight.env)
        if self.waiting and not (self.challenge and not self.challenge.opening):
            words = captions.opening(
                flight, self.challenge, begun=self.begun, stuck=self._held_before, check=self.credit.check
            )
            high = float(view.points(pose[:2])[1]) < captions.OPENING_FOOT  # a craft behind the usual place
            top = captions.LOWER if self.begun and high else hud.OPENING
            captions.draw_opening(canvas, self._context.controls, words, self.path_preview.asks, top)
