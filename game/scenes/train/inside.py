"""Inside the network of a training run: the live network, and what it is paid for."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, get_args

import numpy as np
import pygame

from ai.agent.network import build_network
from ai.lander.environment import ACTION_NAMES, NUM_ACTIONS, NUM_FEATURES
from ai.nn import NeuralNetwork
from ai.training.loop import PARTS
from ai.training.messages import NetworkState
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import SMALL, TITLE
from game.explain.figures import points
from game.explain.network_plan import Show
from game.explain.network_view import NetworkView
from game.explain.tables import Line, table
from game.training.run import TrainingRun
from game.ui.panel import Column

SHOWN: Final[tuple[Show, ...]] = get_args(Show)
_MARGIN: Final = 32.0


class Inside:
    """The network and the parts of its reward.

    Attributes:
        display: where it is drawn, in points.
        view: shows `network`, None without a run; `shown` is the message that it came with.
        paid: points that each part of the reward has paid per flight, (len(PARTS),).

    """

    def __init__(self, run: TrainingRun, is_open: Callable[[], bool]) -> None:
        self._run, self._is_open = run, is_open
        self.display = pygame.FRect(0, 0, 400, 300)
        self.view = NetworkView((0, 0, 400, 300), texts.INPUTS, tuple(map(texts.said, ACTION_NAMES)))
        self.clear()

    def clear(self) -> None:
        """Reset for another run."""
        self.network: NeuralNetwork | None = None
        self.shown: NetworkState | None = None
        self._seen: NetworkState | None = None
        self._row = 0
        self.paid = np.zeros(len(PARTS))

    @property
    def opened(self) -> bool:
        """Whether they are seen; the network is followed in any case."""
        return self._is_open()

    def place(self, display: pygame.FRect) -> None:
        """Move to another box."""
        self.display = display
        self.view.place((display.left + _MARGIN, display.top + 20, display.width - 2 * _MARGIN, display.height - 36))

    def show(self, state: NetworkState | None, row: int = -1) -> None:
        """Show a network, perhaps of an earlier moment, and what was paid at that row of the history."""
        if state is None or (state is self.shown and row == self._row):
            return
        self._row = row
        if len(self._run.history):
            self.paid = np.nan_to_num(self._run.history.parts[row])
        config, network = self._run.config, self.network
        if network is None or network.values.shape != state.values.shape:
            network = build_network(NUM_FEATURES, NUM_ACTIONS, config, np.random.default_rng(0))
        if network.values.shape != state.values.shape:
            return  # it belongs to a run that has just been replaced
        self.network, self.shown = network, state
        network.values = state.values
        network.gradients[:] = state.gradients

    def follow(self, event: pygame.event.Event) -> None:
        """Follow the mouse or the virtual pointer; an event's position is in points."""
        if event.type == pygame.MOUSEMOTION:
            self.view.hover(event.pos if self.opened else None)

    def update(self) -> None:
        """Advance by 1/60 s; the view follows while it is seen: to choose what it shows takes a millisecond."""
        if self.opened and self.shown is not self._seen and self.network is not None and self.shown is not None:
            self._seen = self.shown
            self.view.output_scale = self._run.config.reward_scale
            self.view.set(self.network, self.shown.observation)
        if self.opened:
            self.view.update()

    def describe(self, column: Column) -> None:
        """Add what the lines show, and what a flight was paid for."""
        column.text(texts.NETWORK_VIEW_TITLE, size=TITLE)
        column.choice("", texts.NETWORK_VIEW_SHOWS, SHOWN.index(self.view.show), self._choose, SMALL)
        column.aside(lambda: texts.NETWORK_VIEW_LINES[self.view.show])
        column.gap()
        column.caption(texts.REWARD_BAR_LABEL)
        if len(self._run.history):
            column.add(table((), self._paid_lines))
        else:
            column.aside(texts.REWARD_BAR_EMPTY)

    def _paid_lines(self) -> list[Line]:
        """Return what each part has paid a flight, and the sum."""
        words = [texts.REWARD_PARTS[name] for name in PARTS]
        paid = [round(each, 1) for each in self.paid.tolist()]  # what is written adds up
        lines = [Line((word, points(each, 1)), what) for (word, what), each in zip(words, paid, strict=True)]
        return [*lines, Line((texts.REWARD_SUM, points(sum(paid), 1)), lit=True)]

    def draw(self, canvas: Canvas) -> None:
        """Draw the network."""
        self.view.draw(canvas)

    def _choose(self, index: int) -> None:
        self.view.show = SHOWN[index]
