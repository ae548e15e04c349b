"""Inside the network of a training run: the live network, and what it is paid for."""

from __future__ import annotations

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
from game.scenes.train.rewind import Rewind
from game.training.run import TrainingRun
from game.ui.panel import Column

SHOWN: Final[tuple[Show, ...]] = get_args(Show)
_MARGIN: Final = 32.0


class Inside:
    """The network and the parts of its reward, at the moment that is shown.

    Attributes:
        view: shows `network`, None without a run; `shown` is the message that it came with.

    """

    def __init__(self, run: TrainingRun, rewind: Rewind) -> None:
        self._run, self._rewind = run, rewind
        self.view = NetworkView((0, 0, 400, 300), texts.INPUTS, tuple(map(texts.said, ACTION_NAMES)))
        self.clear()

    def clear(self) -> None:
        """Reset for another run."""
        self.network: NeuralNetwork | None = None
        self.shown: NetworkState | None = None

    def place(self, display: pygame.FRect) -> None:
        """Move to another box."""
        self.view.place((display.left + _MARGIN, display.top + 20, display.width - 2 * _MARGIN, display.height - 36))

    def follow(self, event: pygame.event.Event) -> None:
        """Follow the mouse or the virtual pointer; an event's position is in points."""
        if event.type == pygame.MOUSEMOTION:
            self.view.hover(event.pos)

    def update(self) -> None:
        """Advance by 1/60 s; call it while it is seen: to choose what it shows takes a millisecond."""
        state = self._run.network_state if self._rewind.moment is None else self._rewind.network_state
        if state is not None and state is not self.shown:
            self._show(state)
        self.view.update()

    def _show(self, state: NetworkState) -> None:
        config, network = self._run.config, self.network
        if network is None or network.values.shape != state.values.shape:
            network = build_network(NUM_FEATURES, NUM_ACTIONS, config, np.random.default_rng(0))
        if network.values.shape != state.values.shape:
            return  # it belongs to a run that has just been replaced
        self.network, self.shown = network, state
        network.values = state.values
        network.gradients[:] = state.gradients
        self.view.output_scale = config.reward_scale
        self.view.set(network, state.observation)

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
        paid = np.nan_to_num(self._run.history.parts[self._rewind.row]).round(1).tolist()  # what is written adds up
        lines = [Line((word, points(each, 1)), what) for (word, what), each in zip(words, paid, strict=True)]
        return [*lines, Line((texts.REWARD_SUM, points(sum(paid), 1)), lit=True)]

    def draw(self, canvas: Canvas) -> None:
        """Draw the network."""
        self.view.draw(canvas)

    def _choose(self, index: int) -> None:
        self.view.show = SHOWN[index]
