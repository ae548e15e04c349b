"""Watch scene: a pilot flies one lander or a swarm; a panel shows the decisions of one lander."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Final

import pygame

from ai.agent.decision import Decision
from ai.files import brief
from ai.lander.environment import ACTION_NAMES
from ai.pilots.own import OwnPilot
from game.core import texts
from game.core.catalogue import capital
from game.core.scene import Transition, push
from game.drawing import typeface
from game.drawing.canvas import Canvas, moved
from game.drawing.tokens import HUMAN, INK, MARGIN, MUTE, NET, SMALL, TEXT, VIEW_SIZE
from game.explain import readouts
from game.explain.explained import Explained
from game.explain.readouts import draw_landings
from game.flight import networks, own
from game.flight.swarm import Swarm
from game.input.controls import Command
from game.scenes.watch.decision_panel import PANEL, draw_decision
from game.scenes.watch.touch import Hand
from game.scenes.watch.watched import Watched
from game.ui.actions import Action, Run, Table
from game.ui.context import Context
from game.ui.form import FormScene, Part
from game.ui.hints import HintRow
from game.ui.panel import Panel
from game.ui.widget import OnPress, Widget

_ROWS: Final = (452.0, 712.0)  # greatest width of the choices, for the pad begins there, and where they end
_LABELS: Final = 60.0
_BETWEEN: Final = 2.0  # points above and below each row
_LONGEST_NAME: Final = 24
_TOUCHED: Final = pygame.Rect(40, 108, PANEL.left - 80, 600)  # where the hand can put a lander


class WatchScene(FormScene):
    """Watch scene: a swarm in the sky, one lander's decision in a panel, choices on the ground line.

    Attributes:
        network: the pilot that flies, one of `policies`.
        world: what flies, and what is drawn of it.
        hand: the player's hand on the lander that is shown.
        problem: why another network cannot fly; empty if it can.

    """

    def __init__(self, context: Context, seed: int | None = None, *, many: bool = False) -> None:
        super().__init__(context)
        self.form.anchor = (-1, 1)
        self._many = many
        self.world = Watched(context)
        self.playback = self.world.playback
        self.explained = Explained()
        self.problem = self._wanted = self._message = ""
        self._awaited: networks.Network | None = None  # a file that is being loaded, to fly then
        self._stood = False  # whether all stood still in the last update
        self._version = 0  # of the player's own file that flies
        self._settings = context.settings
        self._seed = int(context.rng.integers(2**31)) if seed is None else seed
        self.policies = self._known()
        names = self.policies.names
        wanted = names.index(context.settings.model) if context.settings.model in names else 0
        self._rows: list[Widget] = []
        self._describe(wanted)
        self.hand = self.form.add(Hand(self.world, _TOUCHED, context.view))
        self._choose_network(wanted)
        if self.problem:
            self.network = self.policies.first_fit()
            self._begin()
        if context.pilot and context.pilot.chosen:
            self._wanted = context.pilot.path.name
            self._look_again()

    @property
    def swarm(self) -> Swarm:
        """The landers that fly."""
        return self.world.swarm

    @property
    def decision(self) -> Decision:
        """The decision that the shown lander flies."""
        return self.world.decision

    def enter(self) -> None:
        """Follow a change of the networks and of the settings."""
        self._look_again()
        self._describe(self._model_choice.index)
        if self.world.stage.calm != self._settings.reduced_motion:
            self.world.set_up_camera()

    def reword(self) -> None:
        self._message, self.hand.label = "", texts.TOUCH_LANDER
        self._describe(self._model_choice.index)

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Explain, touch or pick a lander, or pass the event to the actions and the choices."""
        if self.explained.handle_event(event) or self.hand.mouse(event):
            return None
        if event.type == pygame.MOUSEWHEEL:
            self.hand.turn(event.y)
        if event.type == pygame.MOUSEBUTTONDOWN and event.button == 1 and self._pick(event.pos):
            return None
        return super().handle_event(event)

    def actions(self) -> Table:
        """Stop and step; touch, and undo it; colour the sky; explain; show another lander; begin anew; pause."""
        world, playback, hand = self.world, self.playback, self.hand
        by_pad = self.context.controls.gamepad_in_use  # which undoes in the hand, and finds the maps in their row
        stop, step, *speeds = playback.actions(texts.HINT_DECISION)
        says = self._saying

        def turned(notches: int) -> Run:
            return says(lambda: hand.turn(notches), texts.TOUCH_PARTS[1], lambda: world.tilt_words)

        def shown(direction: int) -> Run:
            return says(lambda: self._turn(direction), texts.HINT_NEXT_LANDER, lambda: str(world.shown + 1))

        turn_map = says(self._turn_map, texts.HINT_MAP, lambda: texts.KNOB_SWITCH[world.policy_map.on])
        undo = Action(pygame.K_z, says(world.untouch, texts.HINT_UNTOUCH), "" if by_pad else texts.HINT_UNTOUCH)
        return [
            stop,
            Action(step.key, says(playback.step, texts.HINT_DECISION, self._flown), step.hint),
            Action(Command.MODE, self._touch, texts.HINT_TOUCH),
            *([undo] if world.can_untouch else []),
            Action(pygame.K_m, turn_map, "" if by_pad else texts.HINT_MAP),
            Action(Command.NEXT, shown(1), texts.HINT_NEXT_LANDER if self._many else ""),
            Action(Command.RETRY, says(self._begin_anew, texts.HINT_RESTART), texts.HINT_RESTART),
            Action(pygame.K_o, self._open_pilots, "" if by_pad else texts.HINT_PILOTS),
            Action(Command.PAUSE, self._pause, texts.HINT_PAUSE),
            Action(Command.PREVIOUS, shown(-1)),
            Action(pygame.K_q, turned(1)),
            Action(pygame.K_e, turned(-1)),
            *(Action(each.key, says(each.run, texts.WATCH_SPEED, lambda: playback.word)) for each in speeds),
            self.explained.action(),
        ]

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        """Return the hints in two rows: what can be done with the lander, on the right of who flies; and the rest."""
        view = canvas.view
        right, top = view.right - 36, view.top
        room = right - VIEW_SIZE[0] / 2 - canvas.text_width(self._said, size=TEXT) / 2 - 40
        hints = self.hints
        undo = self.world.can_untouch and not (self.context.controls.gamepad_in_use or self.hand.typing)
        first = 4 if undo else 3
        return [
            HintRow(row, (right, top + y), from_right=True, room=room)
            for row, y in ((hints[:first], 42), (hints[first:], 66))
            if row
        ]

    def update(self) -> Transition | None:
        """Fly as many steps as the chosen speed makes due."""
        if isinstance(pilot := (self._awaited or self.network).policy, OwnPilot):
            pilot.look()
            if pilot.version != self._version:  # what another one has landed is not this one's
                self._version = pilot.version
                self.swarm.landed = self.swarm.lost = 0
            if self._awaited and pilot.ready:
                self._fly(self._awaited)
        self.world.update()
        if self.form.focused is self.hand and not self.playback.stopped and self._stood:
            self.form.focus(self._model_choice)  # or its frame would follow the flight
        self._stood = self.playback.stopped
        self.explained.update()
        outcome = self.form.update()
        self._lay_out()
        return outcome

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the world, the swarm, the panel and the choices."""
        self.world.draw(canvas, self.playback.between(alpha))
        above = self.hand.used(canvas.pointer)  # then it is drawn over the panel
        if not above:
            self.hand.draw(canvas)
        draw_decision(canvas, self.decision, mapped=self.world.policy_map.on)
        if above:
            self.hand.draw(canvas)
        self._draw_words(canvas)
        self.explained.draw(canvas)

    # What flies

    def _begin(self) -> None:
        policy = self.network.policy
        assert policy is not None
        self.world.begin(self._many, self._seed, policy)

    def _begin_anew(self) -> None:
        self._seed = int(self.context.rng.integers(2**31))
        self._begin()

    def _turn(self, direction: int) -> None:
        self.world.shown = (self.world.shown + direction) % self.swarm.env.num_envs

    def _pick(self, point: tuple[float, float]) -> bool:
        """Show the decisions of the lander nearest to a point of the canvas, if one is close."""
        panel = PANEL.move(moved(self.context.view, 1, -1))
        if not self._many or panel.collidepoint(point) or (slot := self.world.nearest(point)) is None:
            return False
        self.world.shown = slot
        return True

    def _touch(self) -> None:
        """Stop with a hand on the lander; the mouse takes it without that."""
        self.playback.stopped, self._message = True, ""
        if not self.context.controls.mouse_in_use:
            self.form.focus(self.hand)
            self.hand.hold()

    def _saying(self, run: Run, what: str, value: Callable[[], str] = str) -> Run:
        """Return what runs an action, and then says what it did, for nothing else moves while all stands still."""

        def runs() -> Transition | None:
            outcome = run()
            said = value()
            self._message = f"{capital(what)}: {said}" if said else capital(what)
            return outcome

        return runs

    def _flown(self) -> str:
        return str(texts.said(ACTION_NAMES[int(self.decision.action[0])]))

    # Choices

    def _known(self) -> networks.Policies:
        """Return all that can fly: the player's own file too, once it was chosen by name."""
        policies = networks.Policies(self.context.models_dir, self.context.user_dir)
        if pilot := self.context.pilot:
            policies.add(networks.Network(pilot.path.name, pilot))
        return policies

    def _describe(self, chosen: int) -> None:
        """Describe the rows anew: who flies, how many, how fast, and the map."""
        part, self._size = Part(self.form), (size := typeface.grown(SMALL))
        self._panel = panel = Panel(part)
        names = [brief(networks.word(name), _LONGEST_NAME) for name in self.policies.names]
        self._model_choice = panel.choice(
            texts.WATCH_MODEL, names, chosen, self._choose_network, size,
            on_open=self._open_networks, all_word=texts.WATCH_ALL.format(count=len(names)),
        )  # fmt: skip
        count = panel.choice(texts.WATCH_COUNT, texts.WATCH_MANY, self._many, self._choose_count, size)
        speed = self.playback.describe(panel, size)
        switch, shown = texts.KNOB_SWITCH, self.world.policy_map.on
        self._map_choice = panel.choice(texts.WATCH_MAP, switch, shown, self._choose_map, size)
        choices = self._model_choice, count, speed, self._map_choice
        for row, choice, what in zip(panel.rows, choices, texts.EXPLAIN_CHOICES, strict=True):
            row.what = what
            choice.compact(_LABELS, _BETWEEN)
        for old, new in zip(self._rows, part.widgets, strict=False):
            new.warmth = old.warmth
        self.form.replace(self._rows, part.widgets)
        self._rows = part.widgets
        self._lay_out()

    def _lay_out(self) -> None:
        """Put the rows above the lower edge of the page, whatever their height."""
        if self._size != typeface.grown(SMALL):
            self._describe(self._model_choice.index)
        (width, end), scale = _ROWS, self.context.reading().whole.scale
        self._panel.lay_out(pygame.FRect(MARGIN, 0, width, end), scale)
        height = self._panel.height + 1
        self._panel.lay_out(pygame.FRect(MARGIN, end - height, width, height), scale)

    def _pause(self) -> Transition:
        return push("pause", self, self._begin_anew, lambda: texts.PAUSE_NEW_STARTS, self._pause_words)

    def _pause_words(self) -> list[tuple[str, OnPress]]:
        name = brief(networks.word(self._wanted or self.network.name), _LONGEST_NAME)
        return [
            (texts.WATCH_PAUSE.format(name=name), self._open_networks),
            (texts.PILOTS_OPEN, self._open_pilots),
        ]

    def _open_networks(self) -> Transition:
        return push("runs", choose=self._take)

    def _open_pilots(self) -> Transition:
        def choose(path: Path) -> None:
            own.take(self.context, path)
            self._take(path.name)

        return push("pilots", choose, now=self.context.pilot.path if self.context.pilot else None)

    def _take(self, name: str) -> None:
        """Let a pilot fly that was chosen in a list."""
        self._wanted, self.playback.stopped = name, False

    def _look_again(self) -> None:
        """Apply the choice made in a list, and reload networks added, removed or renamed meanwhile."""
        policies = self._known()
        own_flies = isinstance(self.network.policy, OwnPilot)
        wanted, self._wanted = self._wanted or (self.network.name if own_flies else self._settings.model), ""
        known = policies.names == self.policies.names and wanted == self.network.name
        if known and policies[wanted].policy is self.network.policy:
            return
        self.policies = policies
        index = next((policies.names.index(name) for name in (wanted, self.network.name) if name in policies.names), 0)
        self._describe(index)
        self._choose_network(index)

    def _choose_network(self, index: int) -> None:
        """Fly the same starts with another network; report a damaged one, and keep the last good one flying."""
        network = self.policies[self.policies.names[index]]
        self._awaited = None
        self.problem = texts.WATCH_PROBLEM.format(name=network.name, problem=network.problem) if network.problem else ""
        if isinstance(network.policy, OwnPilot) and not network.policy.ready:
            self._awaited = network
        elif network.policy:
            self._fly(network)

    def _fly(self, network: networks.Network) -> None:
        self.network, self._awaited = network, None
        own_flies = isinstance(network.policy, OwnPilot)
        if self.context.pilot:
            self.context.pilot.chosen = own_flies
        if not own_flies:
            self._settings.model = network.name
        self._begin()

    def _choose_count(self, index: int) -> None:
        self._many = bool(index)
        self._begin()

    def _choose_map(self, index: int) -> None:
        self.world.policy_map.on = bool(index)
        self.world.set_up_camera()

    def _turn_map(self) -> None:
        self._map_choice.choose(1 - self._map_choice.index)

    # The words

    def _draw_words(self, canvas: Canvas) -> None:
        readouts.draw_corner(canvas, texts.WATCH_TITLE, texts.WATCH_LANDERS.format(count=self.swarm.env.num_envs))
        left = canvas.at(-1, -1)
        left.explain((MARGIN - 4, 24, 120, 42), texts.EXPLAIN_WATCH)
        readouts.draw_hand(canvas, self._said, NET)
        draw_landings(left, (MARGIN, 118), self.swarm.landed, self.swarm.lost)
        readouts.draw_watched(canvas, self.swarm.env, self.world.shown)
        self._draw_notice(canvas.at(0, -1))
        self._panel.draw(canvas.at(*self.form.anchor).ungrown)
        if self._settings.show_hints or self.context.controls.mouse_in_use:  # for the mouse, they are what it presses
            self.draw_hints(canvas)

    def _draw_notice(self, canvas: Canvas) -> None:
        """Say below who flies what is wrong with a pilot, what the hand can do or has done, and what a key did."""
        words = partial(canvas.text, size=SMALL, align="centre")
        middle, problem = VIEW_SIZE[0] / 2, self._problem()
        if problem:
            box = words(problem, (middle, 84), colour=canvas.palette.warn)
            canvas.marker("cross", (box.left - 12, 80), 9, canvas.palette.warn)
        elif self.world.touched:
            words(texts.TOUCH_COUNTS, (middle, 84), colour=HUMAN)
        elif self.playback.stopped:
            words(texts.TOUCH_INVITES, (middle, 84), colour=MUTE)
        if self.playback.stopped:
            words(self._message, (middle, 102), colour=INK)

    def _problem(self) -> str:
        """Return what is wrong with a network that was chosen, or with the player's own file."""
        network = self._awaited or self.network
        return self.problem or (own.wrong(network.policy) if isinstance(network.policy, OwnPilot) else "")

    @property
    def _said(self) -> str:
        """What is said of who flies."""
        if self.playback.stopped:
            return texts.WATCH_STOPPED
        if self.network.name == networks.SCRIPTED:
            return texts.WATCH_SCRIPTED
        said = texts.WATCH_OWN if isinstance(self.network.policy, OwnPilot) else texts.WATCH_FLIES
        return said.format(name=brief(self.network.name, _LONGEST_NAME))
