"""Replay scene: a recorded flight at any speed and from any moment, from which the player can fly on."""

from __future__ import annotations

import time
from collections.abc import Hashable
from dataclasses import replace
from pathlib import Path
from typing import Final

import pygame

from ai.files.writing import free_path
from ai.flights.code import code_of
from ai.flights.recording import ClaimedFlight
from ai.lander.environment import Outcome
from game.audio.flight_sounds import FlightSound
from game.core import texts
from game.core.clock import STEP, TimeScale
from game.core.scene import Transition, push
from game.core.shelf import LONGEST_NAME, fitting
from game.drawing.canvas import Canvas
from game.drawing.cursor import BASELINE, LEADING, Cursor
from game.drawing.shapes import Shape
from game.drawing.tokens import HUMAN, INK, MUTE, NET, SMALL
from game.explain import readouts
from game.explain.explained import Explained
from game.explain.readouts import PILOT
from game.export.film import Export, films_dir
from game.flight import codes, networks
from game.flight.flight import StickHolder
from game.flight.flight_file import Record
from game.flight.outcomes import ending_word
from game.flight.replay import FlightReplay
from game.input.controls import Command
from game.scenes.logbook.timeline import Timeline, runs
from game.ui.actions import Action, Table
from game.ui.clipboard import give
from game.ui.context import Context
from game.ui.playback import Playback
from game.ui.rows import ButtonRow, ChoiceRow
from game.ui.world_scene import WorldScene
from game.world.camera import ClearArea, View
from game.world.landscape.backdrop import EARTH, EARTH_RADIUS
from game.world.paths import draw_faint
from game.world.scenery import Scenery

SPEEDS: Final = (0.25, 0.5, 1.0, 2.0)
_SCOUT: Final = 10  # steps looked ahead in every frame: a few milliseconds
_OPEN: Final = "replay"  # what stays open, by its name in the settings
_LOW: Final = 320.0  # points of a window's height below which figures would leave the flight no room
_SECONDS: Final = 22.0  # size of the moment that is shown


class ReplayScene(WorldScene):
    """Replay of a recorded flight.

    Attributes:
        friend: what a friend has sent; None for a flight of the player's own.

    """

    takes_tab = True

    def __init__(self, context: Context, record: Record, friend: ClaimedFlight | None = None) -> None:
        super().__init__(context)
        self.record, self.friend = record, friend
        self._pace = TimeScale()
        self.playback = Playback(self._pace, SPEEDS, self._fly)
        self.explained = Explained()
        self.flight_replay = FlightReplay(self.record)
        self.flight_replay.scout(1)
        self._readouts = readouts.flight_readouts(self.flight_replay.flight.env)
        self._scenery = Scenery(self.flight_replay.flight, context.settings.reduced_motion)
        self._heard = FlightSound(context.sound, self.flight_replay.flight.env, warns=False)
        self.build()

    def enter(self) -> None:
        self.playback.stopped = True
        self._scenery.set_calm(self.context.settings.reduced_motion)

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        return None if self.explained.handle_event(event) else super().handle_event(event)

    def actions(self) -> Table:
        step_hint = "" if self.ended else texts.HINT_STEP
        stop, step, *speeds = self.playback.actions(step_hint, stop=self._stop_or_go, gamepad=Command.CONFIRM)
        stop = replace(stop, hint=texts.CARD_WATCH) if self.ended else stop
        on_strip = self.form.focused is self._strip
        if self.context.controls.gamepad_in_use and not on_strip:  # its A presses what is in focus
            stop = self.form.confirms(texts.HINT_CHOOSE)
        return [
            stop,
            step,
            self.explained.action(),
            self.form.goes_back(texts.HINT_BACK),
            Action(Command.RETRY, self._replay),
            Action(Command.HANDOVER, self._take_over),
            *speeds,
        ]

    def update(self) -> Transition | None:
        self.flight_replay.scout(1 if self.flight_replay.touching else _SCOUT)
        self._strip.reached = self.flight_replay.reached
        self.explained.update()
        self._export_word.label = self._export_words
        for _ in range(self.playback.steps()):
            self._fly()
        if not self.playback.stopped:
            self._heard.follow(self._scenery.stage.thrust[0])
        return super().update()

    # Time

    def go_to(self, step: int) -> None:
        step = min(step, self.flight_replay.reached)
        for at in (step - 1, step):  # at the end, read-outs are of the moment before
            self.flight_replay.go_to(at)
            self._look()
        self._scenery.wind_to()
        self._pace.begin()

    @property
    def ended(self) -> bool:
        return self.flight_replay.complete and self.flight_replay.at >= self.flight_replay.reached

    def _fly(self) -> None:
        if self.ended:
            self.flight_replay.flight.rest()
        flight = self.flight_replay.flight
        was_over = flight.over
        self.flight_replay.step()
        ended = flight.over and not was_over
        if ended and flight.wrecked and self._pace.rate == 1 and not self._scenery.calm:
            self._pace.slow_down()
        self._scenery.follow(ended)
        self._look()

    def _look(self) -> None:
        """Update the read-outs; at the end they keep the values of the last moment before."""
        self._strip.at = self.flight_replay.at
        flight = self.flight_replay.flight
        now = readouts.flight_readouts(flight.env)
        self._readouts = readouts.at_touch(self._readouts, flight.env) if flight.over else now

    def _stop_or_go(self) -> None:
        self._replay() if self.ended else self.playback.toggle()

    def _replay(self) -> None:
        self.go_to(0)
        self.playback.stopped = False

    # Rows

    def state(self) -> Hashable:
        return super().state(), self.flight_replay.flight.over

    def describe(self) -> None:
        """Add which flight it is, and its moment; the read-outs, the strip, and what can be done with the flight."""
        head, foot = self.head, self.foot
        head.aside(lambda: self._titles()[0])
        head.text(lambda: self._titles()[1])
        head.add(self._write_moment)
        foot.add(self._write_readouts)
        self._strip = foot.widget(Timeline(self.record.recording, self.go_to, self._stop_or_go))
        self._strip.at = self.flight_replay.at
        more = self.context.settings.is_open(_OPEN)
        race = texts.FRIEND_ANSWER if self.friend else texts.LOGBOOK_RACE
        self._export_word = ButtonRow(self._export_words, self._begin_or_stop_export, size=SMALL)
        rows: list[ButtonRow | ChoiceRow] = [ButtonRow(race, self._race, size=SMALL)]
        if not self.flight_replay.flight.over:
            rows.insert(0, ButtonRow(texts.REPLAY_TAKE_OVER, self._take_over, size=SMALL))
        if more:
            rows += [ButtonRow(texts.CODE_COPY, self._copy, size=SMALL), self._export_word]
            rows.insert(0, self.playback.choice())  # or the arrow to the left of "Less" would go no farther
        rows.append(ButtonRow(*self.unfolding(_OPEN), size=SMALL))
        rows[-1].key = "more"
        foot.flow(rows)

    def lay_out(self) -> None:
        super().lay_out()
        if (clear := ClearArea.of(self.context.reading(), self.free)) != self._scenery.clear:
            self._scenery.clear = clear
            self._scenery.cut()

    def _take_over(self) -> Transition | None:
        if self.flight_replay.flight.over:
            self.context.note(texts.REPLAY_OVER)
            return None
        return push("fly_on", self.record, self.flight_replay, self._rival)

    def _race(self) -> Transition:
        return push("race", self.record, self._rival)

    @property
    def _rival(self) -> str:
        """Name of a friend's ghost; empty for one of the player's own."""
        return texts.FRIEND_NAME if self.friend else ""

    def _copy(self) -> None:
        code = code_of(self.friend) if self.friend else codes.code(self.record)
        give(self.context, code, texts.CODE_COPIED)

    def _begin_or_stop_export(self) -> None:
        context = self.context
        if context.film:
            context.film.close()
            context.film = None
            context.note(texts.EXPORT_STOPPED)
            return
        name = fitting(Path(self.record.entry.file).stem).strip(" .")[:LONGEST_NAME]  # which a file can say anything of
        path = free_path(films_dir(), name or texts.REPLAY_TITLE, ".gif")
        context.film = Export(ReplayScene, self.record, path, colour_safe=context.settings.colour_safe)

    @property
    def _export_words(self) -> str:
        film = self.context.film
        return texts.EXPORT_GOES_ON.format(percent=round(100 * film.share)) if film else texts.REPLAY_EXPORT

    # The picture

    def draw(self, canvas: Canvas, alpha: float) -> None:
        self._draw_world(self.framed(canvas), alpha)
        readouts.draw_shade(canvas, self.foot.box.top)
        self.draw_rows(canvas)
        self.explained.draw(canvas)

    def draw_world(self, canvas: Canvas, alpha: float) -> None:
        """Draw the world with its read-outs, and without any words: for a film."""
        foot = readouts.foot_of(canvas.reading, PILOT)
        self._draw_world(canvas.above(canvas.reading.view.bottom - foot.top), alpha)
        readouts.draw_flight(canvas.reading, self._readouts, PILOT)

    def _draw_world(self, canvas: Canvas, alpha: float) -> None:
        between, head = self.playback.between(alpha), self._scenery.clear.head
        view = self._scenery.view(canvas.scale, between).filling(canvas)
        self._scenery.draw_land(canvas, between, self._scenery.clear.earth(EARTH, EARTH_RADIUS))
        _draw_way(canvas, view, self.flight_replay, head)
        self._scenery.draw_craft(canvas, between)

    def _titles(self) -> tuple[str, str]:
        """Return what is replayed, and how it ended or what it earned."""
        if self.friend:
            where, real = codes.where(self.friend), self.flight_replay.earned
            line = texts.FRIEND_LINE.format(where=where, earned=codes.words(real)) if real else where
            return texts.FRIEND_TITLE, line
        entry = self.record.entry
        when = time.strftime("%Y-%m-%d %H:%M", time.localtime(entry.when))
        mission = texts.MISSIONS.get(self.record.recording.mission)
        title = texts.REPLAY_MISSION.format(mission=mission[0]) if mission else texts.REPLAY_TITLE
        title = title if self.flight_replay.faithful else texts.REPLAY_OTHER_RULES
        end = ending_word(entry.outcome, intact=entry.intact)
        return title, texts.REPLAY_LINE.format(end=end, seconds=entry.seconds, when=when)

    def _write_readouts(self, cursor: Cursor) -> None:
        if self.context.reading().view.height >= _LOW:
            readouts.write_readouts(cursor, {name: self._readouts[name] for name in PILOT})

    def _write_moment(self, cursor: Cursor) -> None:
        """Write the seconds, and who flies at that moment or how it ended."""
        flight, canvas, left = self.flight_replay.flight, cursor.canvas, cursor.left
        by_hand = flight.flown_by is StickHolder.HUMAN
        other = networks.sentence(texts.NETWORK_FLEW, networks.flew(self.record.entry.network))
        by = texts.FRIEND_FLEW[by_hand] if self.friend else texts.YOU_FLEW if by_hand else other
        if self.ended and flight.over:
            by = ending_word(flight.outcome.name, intact=flight.intact)
        y = cursor.y + BASELINE * _SECONDS
        cursor.gap(LEADING * _SECONDS)
        if canvas is None:
            return
        if flight.over:
            good = flight.outcome is Outcome.LANDED
            colour = canvas.palette.good if good else INK if flight.intact else canvas.palette.warn
            mark: Shape = "check" if good else "diamond" if flight.intact else "cross"
            canvas.marker(mark, (left + 6, y - 7), 11, colour)
        elif self.playback.stopped:
            for x in (left + 3, left + 8):
                canvas.line((x, y - 13), (x, y - 1), INK, 2)
        else:
            canvas.marker("circle", (left + 6, y - 7), 8, HUMAN if by_hand else NET)
        seconds = f"{self.flight_replay.at * STEP:.2f} s"
        figure = canvas.text(seconds, (left + 22, y), size=_SECONDS, weight="light", tabular=True)
        canvas.text(by, (max(figure.right, left + 96) + 12, y), size=SMALL, colour=MUTE)


def _draw_way(canvas: Canvas, view: View, flight_replay: FlightReplay, head: float) -> None:
    """Draw the path so far in the colour of who flew, and the path to come faintly."""
    path, hands = flight_replay.path, flight_replay.record.recording.hands
    at, head = min(flight_replay.at, len(path) - 1), canvas.scale * head
    if at + 4 < len(path):
        draw_faint(canvas.surface, view.pixels(path[at::4]), MUTE, 0.35, head)
    for start, stop, hand in runs(hands[:at]):
        if stop - start > 1:
            stretch = path[start : stop + 1 : 4] if stop - start > 8 else path[start : stop + 1]
            draw_faint(canvas.surface, view.pixels(stretch), HUMAN if hand is StickHolder.HUMAN else NET, 0.6, head)
