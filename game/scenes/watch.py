"""Watch scene: a network flies one lander or a swarm; a panel shows the decisions of one lander."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Final

import numpy as np
import pygame

from ai.common.decision import Decision
from ai.common.environment import Bools, Doubles
from ai.lander.environment import Outcome
from ai.nn.files import brief
from game.audio.flight_sounds import FlightSound
from game.cockpit import hud
from game.cockpit.decision_panel import PANEL, draw_decision
from game.core import texts
from game.core.clock import STEP, TimeScale
from game.core.scene import Transition, push
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, MARGIN, NET, SMALL, TEXT, VIEW_SIZE
from game.flight import networks
from game.flight.flight import DECISION_STEPS, REST_STEPS, Swarm
from game.input.controls import Command
from game.panels.run_status import draw_landings
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.form_scene import FormScene
from game.ui.hints import HintRow
from game.ui.pick import ChoiceOrList
from game.ui.playback import LABEL_WIDTH, Playback
from game.ui.widget import OnPress
from game.ui.widgets import Choice
from game.ui.words import GAP
from game.world import framing
from game.world.camera import Camera, ClearArea, View
from game.world.landscape.backdrop import landscape
from game.world.landscape.pad import draw_pad
from game.world.paths import Trails
from game.world.scenery import mark_lost
from game.world.stage import Stage

COUNTS: Final = (1, 16, 64, 256)
SPEEDS: Final = (0.25, 0.5, 1.0, 2.0, 4.0)
_SIZES: Final = {1: 1.0, 16: 0.66, 64: 0.46, 256: 0.36}  # a crowd is drawn smaller, to be seen through
_ROW: Final = (MARGIN, 640.0, 25.0)  # left and top of the first row of choices, and how far to the next
_ROW_HEIGHT: Final = 17.0
_WIDEST: Final = 452.0  # of a row: the pad begins there
_CLEAR: Final = ClearArea(left=340.0, right=PANEL.left - 16.0)  # beside the choices and the panel
_LONGEST_NAME: Final = 24
_LONGEST_PROBLEM: Final = 110
_CROWD: Final = 64  # landers from which on a trail more only adds to the tangle
_CLICK_REACH: Final = 1.6  # metres
_WRECK_STEPS: Final = 8  # steps a wreck of a swarm stays to be seen


class WatchScene(FormScene):
    """Watch scene: a swarm in the sky, one lander's decision in a panel, choices on the ground line.

    Attributes:
        swarm: the landers that fly.
        network: the network that flies them, one of `policies`.
        camera, stage, trails: what is drawn of them.

    """

    def __init__(self, context: Context, count: int = 1, seed: int | None = None) -> None:
        super().__init__(context)
        self._count = COUNTS.index(count)
        self._clock, self._time = TimeScale(), 0.0
        self.playback = Playback(self._clock, SPEEDS, self._fly_to_the_next_decision)
        self.shown = 0
        self.problem = self._wanted = ""
        self._settings = context.settings
        self.policies = networks.Policies(context.models_dir, context.user_dir)
        names = self.policies.names
        wanted = names.index(context.settings.model) if context.settings.model in names else 0
        self._model_choice = self.form.add(self._network_row(wanted))
        self._count_choice = self._add_choice(
            1, texts.WATCH_COUNT, [str(count) for count in COUNTS], self._count, self._choose_count
        )
        self.form.add(self.playback.row(self.form.manager, self._row_box(2, self.playback.words)))
        self._seed = int(context.rng.integers(2**31)) if seed is None else seed
        self._choose_network(wanted)
        if self.problem:
            self.network = self.policies.first_fit()
            self._begin()

    def enter(self) -> None:
        """Follow a change of the networks and of the settings."""
        self._look_again()
        if self.stage.calm != self._settings.reduced_motion:
            self._set_up_camera()

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Pick a lander, or pass the event to the actions and the choices."""
        if event.type == pygame.MOUSEBUTTONDOWN and event.button == 1 and self._pick(event.pos):
            return None
        return super().handle_event(event)

    def actions(self) -> Table:
        """Stop and step; show another lander; begin anew; pause."""
        many = COUNTS[self._count] > 1
        stop, step, *speeds = self.playback.actions(texts.HINT_DECISION)
        return [
            stop,
            step,
            Action(Command.NEXT, lambda: self._turn(1), texts.HINT_NEXT_LANDER if many else ""),
            Action(Command.RETRY, self._begin_anew, texts.HINT_RESTART),
            Action(Command.PAUSE, self._pause, texts.HINT_PAUSE),
            Action(Command.PREVIOUS, lambda: self._turn(-1)),
            *speeds,
        ]

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        """Return the hints on the right of who flies."""
        room = VIEW_SIZE[0] / 2 - 36 - canvas.text_width(self._said, size=TEXT) / 2 - 40
        return [HintRow(self.hints, (VIEW_SIZE[0] - 36, 42), from_right=True, room=room)]

    def update(self) -> Transition | None:
        """Fly as many steps as the chosen speed makes due."""
        for _ in range(self.playback.steps()):
            self._fly()
        if not self.playback.stopped:
            self._heard.follow(self.stage.thrust[self.shown], self.shown)
        if not self._settings.reduced_motion:
            self._time += STEP
        return self.form.update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the world, the swarm, the panel and the choices."""
        between = self.playback.between(alpha)
        view = self.camera.view(canvas.scale, between)
        size = canvas.surface.get_size()
        landscape(size, self._settings.reduced_motion).draw(canvas, self.camera, self._time, between)
        env, poses = self.swarm.env, self.swarm.poses.at(between)
        others = self._others()
        self.stage.draw_fires(canvas, view, poses, others, self._size)  # the pad hides what reaches below it
        draw_pad(canvas, view, (float(env.pad[0, 0]), float(env.pad[0, 1])), float(env.pad_width[0]), self._time)
        self.trails.draw(canvas, view, self.shown, _CLEAR.head)
        self.stage.draw_swarm(canvas, view, poses, others, self._size)
        self._draw_shown(canvas, view, poses[self.shown])
        self.stage.draw_dust(canvas, view, between)
        draw_decision(canvas, self.decision)
        self._draw_words(canvas)

    # What flies

    @property
    def decision(self) -> Decision:
        """The decision that the shown lander flies."""
        return self.swarm.decision.of(self.shown)

    def _begin(self) -> None:
        assert self.network.policy is not None
        count = COUNTS[self._count]
        self.swarm = Swarm(count, self._seed, self.network.policy)
        self.stage = Stage(self.swarm.env, np.random.default_rng(self._seed))
        self.stage.blue[:] = 1.0
        self._heard = FlightSound(self.context.sound, self.swarm.env, warns=False)
        self.trails = Trails(count, keep=12 if count < _CROWD else 5)
        self._set_up_camera()
        self._clock.begin()
        self.shown = min(self.shown, count - 1)

    def _set_up_camera(self) -> None:
        """Let the camera follow a single lander; with several, or reduced motion, it rests at the whole world."""
        self.camera, self.stage.calm = Camera(), self._settings.reduced_motion
        if self.swarm.env.num_envs == 1 and not self.stage.calm:
            self.camera.cut(framing.framed(self.swarm.env, clear=_CLEAR))

    def _begin_anew(self) -> None:
        self._seed = int(self.context.rng.integers(2**31))
        self._begin()

    def _fly(self) -> None:
        swarm = self.swarm
        ended = swarm.step()
        self.stage.follow(np.ones(swarm.env.num_envs, bool), ended)
        self.trails.follow(swarm.env.position, swarm.env.outcome, swarm.fresh, ended)
        if swarm.env.num_envs == 1 and not self._settings.reduced_motion:
            framing.follow(self.camera, swarm.env, clear=_CLEAR)

    def _fly_to_the_next_decision(self) -> None:
        """Fly until the shown lander's next decision; the others fly on while it rests after a flight."""
        swarm, slot = self.swarm, self.shown
        alone = not np.delete(swarm.since_end == 0, slot).any()
        before = swarm.decided[slot]
        for _ in range(REST_STEPS + DECISION_STEPS if alone else DECISION_STEPS):
            self._fly()
            if swarm.decided[slot] != before:
                return

    def _turn(self, direction: int) -> None:
        self._show((self.shown + direction) % COUNTS[self._count])

    def _show(self, slot: int) -> None:
        self.shown = slot

    def _pick(self, point: tuple[float, float]) -> bool:
        """Show the decisions of the lander nearest to a point of the canvas, if one is close."""
        if COUNTS[self._count] == 1 or PANEL.collidepoint(point):
            return False
        place = self.camera.view(1.0).metres(point)
        distance = np.hypot(*(self.swarm.env.position - place).T)
        nearest = int(distance.argmin())
        if distance[nearest] > _CLICK_REACH:
            return False
        self._show(nearest)
        return True

    def _pause(self) -> Transition:
        return push("pause", self, self._begin_anew, texts.PAUSE_NEW_STARTS, self._pause_words)

    def _pause_words(self) -> list[tuple[str, OnPress]]:
        name = brief(networks.word(self._wanted or self.network.name), _LONGEST_NAME)
        return [(texts.PAUSE_NETWORK.format(name=name), self._open_networks)]

    # Choices

    def _add_choice(
        self, row: int, label: str, words: Sequence[str], index: int, chosen: Callable[[int], None]
    ) -> Choice:
        manager, box = self.form.manager, self._row_box(row, words)
        return self.form.add(Choice(manager, box, label, words, index, chosen, label_width=LABEL_WIDTH, size=SMALL))

    def _row_box(self, row: int, words: Sequence[str]) -> pygame.Rect:
        x, y, pitch = _ROW
        width = LABEL_WIDTH + sum(typeface.width(word, SMALL, "regular") + GAP for word in words) - GAP
        return pygame.Rect(x, y + row * pitch, math.ceil(min(width, _WIDEST)), _ROW_HEIGHT)

    def _network_row(self, index: int) -> ChoiceOrList:
        words = [brief(networks.word(name), _LONGEST_NAME) for name in self.policies.names]
        box, everything = self._row_box(0, words), texts.WATCH_ALL.format(count=len(words))
        return ChoiceOrList(
            self.form.manager, box, texts.WATCH_MODEL, words, index, self._choose_network, self._open_networks,
            everything, label_width=LABEL_WIDTH,
        )  # fmt: skip

    def _open_networks(self) -> Transition:
        def choose(name: str) -> None:
            self._wanted = name

        return push("runs", choose=choose)

    def _look_again(self) -> None:
        """Apply the choice made in the list of networks, and reload networks added, removed or renamed meanwhile."""
        policies = networks.Policies(self.context.models_dir, self.context.user_dir)
        wanted, self._wanted = self._wanted or self._settings.model, ""
        if policies.names == self.policies.names and wanted == self.network.name:
            return
        self.policies = policies
        index = next((policies.names.index(name) for name in (wanted, self.network.name) if name in policies.names), 0)
        row = self._network_row(index)
        self.form.replace([self._model_choice], [row])
        self._model_choice = row
        if policies.names[index] != self.network.name:
            self._choose_network(index)

    def _choose_network(self, index: int) -> None:
        """Fly the same starts with another network; report a damaged one, and keep the last good one flying."""
        network = self.policies[self.policies.names[index]]
        self.problem = texts.WATCH_PROBLEM.format(name=network.name, problem=network.problem) if network.problem else ""
        if network.policy is None:
            return
        self.network = network
        self._settings.model = network.name
        self._begin()

    def _choose_count(self, index: int) -> None:
        self._count = index
        self._begin()

    # The picture

    @property
    def _size(self) -> float:
        return _SIZES[COUNTS[self._count]]

    def _others(self) -> Bools:
        """Which landers are drawn beside the one that is shown, (n,): all but those long wrecked."""
        others: Bools = (self.swarm.since_end <= _WRECK_STEPS) | (self.swarm.env.outcome == Outcome.LANDED)
        others[self.shown] = False
        return others

    def _draw_shown(self, canvas: Canvas, view: View, pose: Doubles) -> None:
        if self.swarm.env.outcome[self.shown] == Outcome.OUT_OF_BOUNDS:
            mark_lost(canvas, view, pose)
            return
        size = min(1.0, 1.5 * self._size)
        self.stage.draw_lander(canvas, view, pose, self.shown, size)
        if COUNTS[self._count] > 1:
            x, y = view.points(pose[:2]).tolist()
            canvas.marker("triangle_down", (x, y - 46 * size - 10), 9, INK)

    def _draw_words(self, canvas: Canvas) -> None:
        count = COUNTS[self._count]
        crowd = texts.WATCH_LANDERS.format(count=count)
        hud.draw_corner(canvas, texts.WATCH_TITLE, crowd)
        hud.draw_hand(canvas, self._said, NET)
        draw_landings(canvas, (MARGIN, 118), self.swarm.landed, self.swarm.lost)
        hud.draw_readouts(canvas, hud.flight_readouts(self.swarm.env, self.shown)[:4], (758, 880, 1002, 1124))
        if self.problem:
            middle, problem = VIEW_SIZE[0] / 2, brief(self.problem, _LONGEST_PROBLEM)
            box = canvas.text(problem, (middle, 84), size=SMALL, colour=canvas.palette.warn, align="centre")
            canvas.marker("cross", (box.left - 12, 80), 9, canvas.palette.warn)
        self.form.draw(canvas)
        if self._settings.show_hints or self.context.controls.mouse_in_use:  # for the mouse, they are what it presses
            self.draw_hints(canvas)

    @property
    def _said(self) -> str:
        """What is said of who flies."""
        if self.playback.stopped:
            return texts.WATCH_STOPPED
        if self.network.name == networks.SCRIPTED:
            return texts.WATCH_SCRIPTED
        return texts.WATCH_FLIES.format(name=brief(self.network.name, _LONGEST_NAME))
