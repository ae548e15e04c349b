"""Replay scene: a recorded flight at any speed and from any moment, from which the player can fly on."""

from __future__ import annotations

import time
from functools import partial
from pathlib import Path
from typing import Final

import pygame

from ai.files import free_path
from ai.flights.code import code_of
from ai.flights.recording import SharedFlight
from ai.lander.environment import Outcome
from game.audio.flight_sounds import FlightSound
from game.core import texts
from game.core.clock import STEP, TimeScale
from game.core.scene import Pop, Transition, push
from game.core.shelf import LONGEST_NAME, fitting
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.shapes import Shape
from game.drawing.tokens import HUMAN, INK, MARGIN, MUTE, NET, SMALL, VIEW_SIZE
from game.explain import readouts
from game.explain.explained import Explained
from game.export.film import Export, films_dir
from game.flight import networks, sharing
from game.flight.flight import StickHolder
from game.flight.flight_file import Record
from game.flight.foresight import SixFutures
from game.flight.outcomes import ending_word
from game.flight.replay import FlightReplay, flown_elsewhere
from game.input.controls import Command
from game.scenes.logbook.timeline import Timeline, runs
from game.ui.actions import Action, Table
from game.ui.clipboard import give
from game.ui.context import Context
from game.ui.form import FormScene, Part
from game.ui.hints import HintRow
from game.ui.panel import Panel
from game.ui.playback import Playback
from game.ui.rows import ButtonRow
from game.ui.widget import OnPress, Widget
from game.world.camera import ClearArea, View
from game.world.paths import draw_faint, draw_futures
from game.world.scenery import Scenery

SPEEDS: Final = (0.25, 0.5, 1.0, 2.0)
_EARTH: Final = (208.0, 306.0)  # points; clear of the words
_AHEAD: Final = 3  # decisions of six futures that are flown in a frame
_SCOUT: Final = 10  # steps looked ahead in every frame: a few milliseconds
_STRIP: Final = (MARGIN, 78.0, VIEW_SIZE[0] - 2 * MARGIN, 60.0)
_FIGURE: Final = 88.0  # half of what the seconds take, and who flies
_VERBS: Final = 141.0  # where the words begin
_CLEAR: Final = ClearArea(head=_VERBS + 42.0)  # below them
_LABELS: Final = 60.0
_FIRST_HINTS: Final = 4  # hints in the first row


class ReplayScene(FormScene):
    """Replay of a recorded flight.

    Attributes:
        friend: what a friend has sent; None for a flight of the player's own.
        export: the film that is being made of it; None while there is none.

    """

    takes_tab = True

    def __init__(self, context: Context, record: Record, friend: SharedFlight | None = None) -> None:
        super().__init__(context)
        self.record = record
        self._pace = TimeScale()
        self.playback = Playback(self._pace, SPEEDS, self._fly)
        self._warned = False
        self._asks, self._looked = False, -1  # whether futures are asked for, and of which step they are
        self._futures: SixFutures | None = None
        self.explained = Explained()
        self.export: Export | None = None
        self.flight_replay = FlightReplay(self.record)
        self.flight_replay.scout(1)
        self.form.anchor = (0, -1)
        self.friend = friend
        self._scenery = Scenery(self.flight_replay.flight, context.settings.reduced_motion, _CLEAR)
        self._heard = FlightSound(context.sound, self.flight_replay.flight.env, self._pace, warns=False)
        self._build()
        self._readouts: dict[str, readouts.Readout] = {}
        self._look()

    def enter(self) -> None:
        self.playback.stopped = True
        self._scenery.set_calm(self.context.settings.reduced_motion)

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        return None if self.explained.handle_event(event) else super().handle_event(event)

    def close(self) -> None:
        if self.export:
            self._stop_export()

    def actions(self) -> Table:
        stop, step, *speeds = self.playback.actions(
            texts.HINT_STEP, stop=self._stop_or_go, gamepad=Command.CONFIRM, resting=self.ended
        )
        on_strip = self.form.focused is self._strip
        if self.context.controls.gamepad_in_use and not on_strip:  # its A presses what is in focus
            stop = self.form.confirms(texts.HINT_CHOOSE)
        table = [
            stop,
            step,
            Action(Command.RETRY, self._replay, texts.REPLAY_FROM_START),
            Action(Command.HANDOVER, self._take_over, texts.REPLAY_HINT_TAKE),
            self.form.goes_back(texts.HINT_BACK),
            *speeds,
            Action(pygame.K_HOME, lambda: self.go_to(0)),
            Action(pygame.K_END, lambda: self.go_to(self.flight_replay.length)),
        ]
        if on_strip or self.context.controls.gamepad_in_use:
            winds = ((Command.NEXT, 60), (Command.PREVIOUS, -60))
            table += [Action(command, partial(self._wind, steps)) for command, steps in winds]
        return [*table, Action(pygame.K_t, self._show_futures, texts.REPLAY_FUTURES), self.explained.action()]

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        right, top = canvas.view.right - MARGIN, canvas.view.top
        room, hints = right - VIEW_SIZE[0] / 2 - _FIGURE, self.hints
        rows = ((hints[:_FIRST_HINTS], 38), (hints[_FIRST_HINTS:], 60))
        return [HintRow(row, (right, top + y), from_right=True, room=room) for row, y in rows if row]

    def update(self) -> Transition | None:
        self.flight_replay.scout(1 if self.flight_replay.touching else _SCOUT)
        self._look_ahead()
        self._strip.reached = self.flight_replay.reached
        self.explained.update()
        if self.export:
            self._follow_export(self.export)
        if not self.friend and self.flight_replay.complete and not self.flight_replay.faithful and not self._warned:
            self._warned = True
            self.context.note(texts.REPLAY_OTHER_RULES)
        for _ in range(self.playback.steps()):
            self._fly()
        if not self.playback.stopped:
            self._heard.follow(self._scenery.stage.thrust[0])
        self._scenery.animate()
        outcome = self.form.update()
        self._lay_out()
        return outcome

    # Time

    def go_to(self, step: int) -> None:
        self.flight_replay.go_to(step)
        self._scenery.wind_to()
        self._pace.begin()
        self._look()

    def _show_futures(self) -> None:
        self._futures = None
        self._asks = not self._asks
        if self._asks:
            self.playback.stopped = True

    def _look_ahead(self) -> None:
        """Fly the six futures of the moment that is shown, if somebody asks and nothing moves."""
        flight = self.flight_replay.flight
        if not self._asks or flight.over or not self.playback.stopped:
            self._futures = None
            return
        if self._futures is None or self._looked != self.flight_replay.at:
            context, self._looked = self.context, self.flight_replay.at
            elsewhere = flown_elsewhere(self.record.recording)
            policy = networks.chosen(context.models_dir, context.user_dir, context.settings.model, elsewhere).policy
            if policy is None:
                self._asks = False
                self.context.note(texts.REPLAY_NO_FUTURES)
                return
            self._futures = SixFutures(policy, flight.route)
            self._futures.begin(flight.env)
        self._futures.follow(_AHEAD)

    def _wind(self, steps: int) -> None:
        self.go_to(self.flight_replay.at + steps)

    @property
    def ended(self) -> bool:
        return self.flight_replay.complete and self.flight_replay.at >= self.flight_replay.reached

    def _fly(self) -> None:
        """Show the next moment, with fire and dust."""
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

    # Words

    def _build(self) -> None:
        recording = self.record.recording
        flown = [push.action for push in recording.pushes], recording.hands
        self._strip = Timeline(_STRIP, texts.REPLAY_LANES, *flown, self.go_to, self._stop_or_go)
        self.form.add(self._strip)
        self._rows: list[Widget] = []
        self._describe()

    def _describe(self) -> None:
        part, self._size = Part(self.form), (size := typeface.grown(SMALL))
        self._panel = Panel(part)
        speeds, verbs = self._panel.beside((2, 3), least=0.0)
        self.playback.describe(speeds, size).compact(_LABELS, ButtonRow.pad)
        words: list[tuple[str, OnPress]] = [
            (texts.REPLAY_TAKE_OVER, self._take_over),
            (texts.FRIEND_ANSWER if self.friend else texts.LOGBOOK_RACE, self._race),
            (texts.CODE_COPY, self._copy),
            (texts.REPLAY_EXPORT, self._begin_or_stop_export),
            (texts.BACK, Pop),
        ]
        *_, self._export_word, _ = verbs.words(words, size)
        self.form.replace(self._rows, part.widgets)
        self._rows = part.widgets
        self._lay_out()

    def _lay_out(self) -> None:
        if self._size != typeface.grown(SMALL):
            self._describe()
        scale = self.context.reading().whole.scale
        self._panel.lay_out(pygame.FRect(MARGIN, _VERBS, VIEW_SIZE[0] - 2 * MARGIN, 100.0), scale)

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
        """Copy the flight as a code; a friend's as it came, with its own claim."""
        code = code_of(self.friend) if self.friend else sharing.code(self.record)
        give(self.context, code, texts.CODE_COPIED)

    def _begin_or_stop_export(self) -> None:
        if self.export:
            self._stop_export()
            return
        name = fitting(Path(self.record.entry.file).stem).strip(" .")[:LONGEST_NAME]  # which a file can say anything of
        path = free_path(films_dir(), name or texts.REPLAY_TITLE, ".gif")
        self.export = Export(ReplayScene, self.record, path, colour_safe=self.context.settings.colour_safe)

    def _stop_export(self) -> None:
        assert self.export is not None
        self.export.close()
        self._end_export(texts.EXPORT_STOPPED)

    def _follow_export(self, export: Export) -> None:
        export.poll()
        self._export_word.label = texts.EXPORT_GOES_ON.format(percent=round(100 * export.share))
        if export.over:
            failed = texts.EXPORT_FAILED.format(reason=export.problem)
            export.close()
            self._end_export(failed if export.problem else texts.EXPORT_DONE.format(path=export.path))

    def _end_export(self, note: str) -> None:
        self.export = None
        self._export_word.label = texts.REPLAY_EXPORT
        self.context.note(note)

    # The picture

    def draw(self, canvas: Canvas, alpha: float) -> None:
        self.draw_world(canvas, alpha)
        self._draw_title(canvas)
        self._draw_moment(canvas)
        self.form.draw(canvas)
        self._panel.draw(canvas.at(*self.form.anchor).ungrown)
        self.draw_hints(canvas)
        self.explained.draw(canvas)

    def draw_world(self, canvas: Canvas, alpha: float) -> None:
        between = self.playback.between(alpha)
        view = self._scenery.view(canvas.scale, between).filling(canvas)
        self._scenery.draw_land(canvas, between, _EARTH)
        _draw_way(canvas, view, self.flight_replay, _CLEAR.head)
        if self._futures:
            draw_futures(canvas, view, self._futures, _CLEAR.head)
        self._scenery.draw_craft(canvas, between)
        readouts.draw_flight(canvas, self._readouts)

    def _draw_title(self, canvas: Canvas) -> None:
        if self.friend:
            where, real = sharing.where(self.friend), self.flight_replay.earned
            line = texts.FRIEND_LINE.format(where=where, earned=sharing.words(real)) if real else where
            readouts.draw_corner(canvas, texts.FRIEND_TITLE, line)
            return
        entry = self.record.entry
        when = time.strftime("%Y-%m-%d %H:%M", time.localtime(entry.when))
        mission = texts.MISSIONS.get(self.record.recording.mission)
        title = texts.REPLAY_MISSION.format(mission=mission[0]) if mission else texts.REPLAY_TITLE
        end = ending_word(entry.outcome, intact=entry.intact)
        readouts.draw_corner(canvas, title, texts.REPLAY_LINE.format(end=end, seconds=entry.seconds, when=when))

    def _draw_moment(self, canvas: Canvas) -> None:
        """Draw the seconds, and who flies at that moment or how it ended."""
        flight = self.flight_replay.flight
        seconds = f"{self.flight_replay.at * STEP:.2f}"
        middle = VIEW_SIZE[0] / 2
        canvas = canvas.at(0, -1)
        figure = canvas.text(f"{seconds} s", (middle, 58), size=22, weight="light", align="centre", tabular=True)
        by_hand = flight.flown_by is StickHolder.HUMAN
        other = networks.sentence(texts.NETWORK_FLEW, networks.flew(self.record.entry.network))
        by = texts.FRIEND_FLEW[by_hand] if self.friend else texts.YOU_FLEW if by_hand else other
        if self.ended:
            by = ending_word(flight.outcome.name, intact=flight.intact) if flight.over else by
        canvas.text(by, (middle, 34), size=SMALL, colour=MUTE, align="centre", room=2 * _FIGURE - 16)
        if flight.over:
            good = flight.outcome is Outcome.LANDED
            colour = canvas.palette.good if good else INK if flight.intact else canvas.palette.warn
            mark: Shape = "check" if good else "diamond" if flight.intact else "cross"
            canvas.marker(mark, (figure.left - 16, 51), 11, colour)
        elif self.playback.stopped:
            for x in (figure.left - 20, figure.left - 15):
                canvas.line((x, 45), (x, 57), INK, 2)


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
