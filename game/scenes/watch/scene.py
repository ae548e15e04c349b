"""Watch scene: a pilot flies one lander or a swarm; beside them stands what it thinks of one lander."""

from __future__ import annotations

from collections.abc import Hashable
from functools import partial
from pathlib import Path
from typing import Final

import pygame

from ai.agent.decision import Decision
from ai.files.reading import brief
from game.core import texts
from game.core.scene import Transition, push
from game.drawing.canvas import Canvas
from game.drawing.cursor import LEADING, Cursor
from game.drawing.shapes import Shape
from game.drawing.tokens import HUMAN, INK, NET, SMALL, TEXT, Colour
from game.explain.explained import Explained
from game.explain.readouts import PILOT, draw_shade, flight_readouts, write_landings, write_readouts
from game.flight import networks
from game.flight.swarm import Swarm
from game.input.controls import Command
from game.scenes.watch.decision_panel import write_decision
from game.scenes.watch.flyer import LONGEST_NAME, Flyer
from game.scenes.watch.touch import Hand
from game.scenes.watch.watched import Watched
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.rows import ButtonRow, ChoiceRow
from game.ui.widget import OnPress
from game.ui.world_scene import WorldScene

_OPEN: Final = "watch"  # what stays open, by its name in the settings
_LAMP: Final = 22.0  # points before the sentence


class WatchScene(WorldScene):
    """Watch scene.

    Attributes:
        flyer: who flies.
        world: what flies, and what is drawn of it.
        hand: the player's hand on the lander that is shown.

    """

    def __init__(self, context: Context, seed: int | None = None, *, many: bool = False) -> None:
        super().__init__(context)
        self._many, self._seed = many, int(context.rng.integers(2**31)) if seed is None else seed
        self.world, self.flyer, self.explained = Watched(context), Flyer(context), Explained()
        self.playback = self.world.playback
        self.hand = Hand(self.world)
        self._begin()
        self.build()

    @property
    def swarm(self) -> Swarm:
        return self.world.swarm

    @property
    def decision(self) -> Decision:
        return self.swarm.decision.of(self.world.shown)

    def enter(self) -> None:
        self._follow(self.flyer.look_again())
        self.build()
        if self.world.stage.calm != self.context.settings.reduced_motion:
            self.world.set_up_camera()

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        if self.explained.handle_event(event) or self.hand.mouse(event):
            return None
        if event.type == pygame.MOUSEWHEEL:
            self.hand.turn(event.y)
        if event.type == pygame.MOUSEBUTTONDOWN and event.button == 1:
            self._pick(event.pos)
        return super().handle_event(event)

    def actions(self) -> Table:
        stop, step, *speeds = self.playback.actions(texts.HINT_DECISION, stop=self._stop_or_go)
        touches = self.form.focused is self.hand
        touch = self.form.confirms(texts.HINT_TOUCH)
        return [
            stop,
            step,
            *([touch] if touches else []),
            self.explained.action(),
            Action(Command.PAUSE, self._pause, "" if touches else texts.HINT_PAUSE),
            Action(Command.RETRY, self._begin_anew),
            Action(Command.NEXT, partial(self._turn, 1)),
            Action(Command.PREVIOUS, partial(self._turn, -1)),
            *speeds,
        ]

    def update(self) -> Transition | None:
        another, anew = self.flyer.update()
        if anew:  # what another one has landed is not this one's
            self.swarm.landed = self.swarm.lost = 0
        self._follow(another)
        self.world.update()
        self.explained.update()
        return super().update()

    def lay_out(self) -> None:
        super().lay_out()
        self.hand.reach(self.free)
        if self.free != self.world.free:
            self.world.free = self.free.copy()
            self.world.set_up_camera()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        self.world.draw(canvas, self.playback.between(alpha))
        draw_shade(canvas, self.foot.box.top)
        with canvas.clipped(self.free):
            self.hand.draw(canvas)
        self.draw_rows(canvas)
        self.explained.draw(canvas)

    # Rows

    def describe(self) -> None:
        """Add who flies and how many landed; what is thought; the read-outs, and who, how many and how fast."""
        more, world, side = self.context.settings.is_open(_OPEN), self.world, self.side
        self.head.add(self._write_sentence, texts.EXPLAIN_WATCH)
        landed = self.head.add(lambda cursor: write_landings(cursor, self.swarm.landed, self.swarm.lost))
        landed.what = texts.EXPLAIN_LANDINGS
        side.add(lambda to: write_decision(to, self.decision, mapped=world.policy_map.on, inputs=more))
        self.foot.add(self._write_readouts)
        names = self.flyer.names
        who = ChoiceRow(
            texts.WATCH_MODEL, names, self.flyer.index, self._choose, SMALL,
            on_open=self._open_networks, all_word=texts.WATCH_ALL.format(count=len(names)),
        )  # fmt: skip
        count = ChoiceRow(texts.WATCH_COUNT, texts.WATCH_MANY, self._many, self._choose_count, SMALL)
        widgets: list[ButtonRow | ChoiceRow] = [who, count, self.playback.choice()]
        if more:
            on = world.policy_map.on
            widgets += [
                ChoiceRow(texts.WATCH_MAP, texts.KNOB_SWITCH, on, self._choose_map, SMALL),
                ButtonRow(texts.PAUSE_NEW_STARTS, self._begin_anew, size=SMALL),
            ]
        widgets.append(ButtonRow(*self.unfolding(_OPEN), size=SMALL))
        widgets[-1].key = "more"
        choices = [widget for widget in widgets if isinstance(widget, ChoiceRow)]
        for choice, what in zip(choices, texts.EXPLAIN_CHOICES, strict=False):
            choice.what = what
        self.foot.flow(widgets)
        self.form.add(self.hand)
        self.hand.label = texts.TOUCH_LANDER

    def state(self) -> Hashable:
        return super().state(), self.world.policy_map.on

    @property
    def sentence(self) -> tuple[str, Colour, Shape]:
        """The one sentence: the most urgent of all that could be said now, with its colour and mark."""
        world, stopped = self.world, self.playback.stopped
        warn = self.context.reading().palette.warn
        said: list[tuple[bool, str, Colour, Shape]] = [
            (bool(self.flyer.problem), self.flyer.problem, warn, "cross"),
            (world.touched, texts.TOUCH_COUNTS, HUMAN, "circle"),
            (stopped, texts.TOUCH_INVITES, HUMAN, "circle"),
            (True, self.flyer.sentence, NET, "circle"),
        ]
        return next((words, colour, mark) for holds, words, colour, mark in said if holds)

    def _write_sentence(self, cursor: Cursor) -> None:
        words, colour, mark = self.sentence
        if canvas := cursor.canvas:
            place = cursor.left + 5, cursor.y + LEADING * TEXT / 2
            canvas.glow(place, 14, colour, 0.8)
            canvas.marker(mark, place, 8, colour)
        cursor.styled(words, TEXT, INK, indent=_LAMP)

    def _write_readouts(self, cursor: Cursor) -> None:
        shown = flight_readouts(self.swarm.env, self.world.shown)
        write_readouts(cursor, {name: shown[name] for name in PILOT})

    # What flies

    def _begin(self) -> None:
        self.world.begin(self._many, self._seed, self.flyer.policy)

    def _follow(self, another: bool) -> None:
        """Fly the same starts with another pilot."""
        if another:
            self._begin()
            self.build()

    def _choose(self, index: int) -> None:
        self._follow(self.flyer.choose(index))

    def _begin_anew(self) -> None:
        self._seed = int(self.context.rng.integers(2**31))
        self._begin()

    def _turn(self, direction: int) -> None:
        self.world.shown = (self.world.shown + direction) % self.swarm.env.num_envs

    def _pick(self, point: tuple[float, float]) -> None:
        """Show the decisions of the lander nearest to a point, if one is close."""
        clear = point[0] < self.free.right and point[1] < self.free.bottom
        if self._many and clear and (slot := self.world.nearest(point)) is not None:
            self.world.shown = slot

    def _stop_or_go(self) -> None:
        """Stop, with the focus on the lander, or go on; the mouse takes it without that."""
        self.playback.toggle()
        if self.playback.stopped and not self.context.controls.mouse_in_use:
            self.form.focus(self.hand)
        elif self.form.focused is self.hand:
            self.form.focus(self.form.widgets[0])

    def _choose_count(self, index: int) -> None:
        self._many = bool(index)
        self._begin()

    def _choose_map(self, index: int) -> None:
        self.world.policy_map.on = bool(index)
        self.world.set_up_camera()

    # Other scenes

    def _pause(self) -> Transition:
        return push("pause", self, self._begin_anew, lambda: texts.PAUSE_NEW_STARTS, self._pause_words)

    def _pause_words(self) -> list[tuple[str, OnPress]]:
        name = brief(networks.word(self.flyer.chosen.name), LONGEST_NAME)
        return [(texts.PAUSE_NETWORK.format(name=name), self._open_networks)]

    def _open_networks(self) -> Transition:
        return push("runs", choose=self._take)

    def _take(self, name: str, path: Path | None = None) -> None:
        self.flyer.take(name, path)
        self.playback.stopped = False
