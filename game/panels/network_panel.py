"""Network panel of a training run: the live network, small or large, and the parts of the reward."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, get_args

import numpy as np
import pygame

from ai.agent.network import build_network
from ai.explain.inspection import NetworkHealth
from ai.lander.environment import ACTION_NAMES, NUM_ACTIONS, NUM_FEATURES
from ai.nn import NeuralNetwork
from ai.training.config import Config
from ai.training.history import PARTS, History
from ai.training.messages import NetworkState
from game.core import texts
from game.drawing import typeface
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import MUTE, SMALL, TITLE
from game.panels.network_editing import NetworkEditing
from game.panels.network_plan import Show
from game.panels.network_view import NetworkView
from game.panels.reward_bar import RewardBar
from game.training.run import TrainingRun
from game.ui.form import Form
from game.ui.virtual_pointer import VirtualPointer
from game.ui.widget import Widget
from game.ui.widgets import Choice, TextButton

SHOWN: Final[tuple[Show, ...]] = get_args(Show)
_NETWORK, _PAID = 0, 1
_ROW: Final = pygame.Rect(868, 430, 384, 22)
_SMALL: Final = pygame.Rect(868, 458, 384, 150)
_STRIP: Final = pygame.Rect(868, 478, 384, 80)
_LARGE: Final = pygame.Rect(48, 158, 740, 534)
_LEFT: Final = 40.0


class NetworkPanel:
    """Panel that shows the network or the reward bar; the network also large, where the scene makes room for it.

    Attributes:
        large: whether the network is shown large.
        view, reward_bar: what it shows; `network` is the one in the view, None without a run,
            and `shown` the message that it came with.
        health: diagnosis of the network's units and numbers.
        editing: what a player does to the network by hand.

    """

    def __init__(self, form: Form, on_closer: Callable[[], None], lander_run: TrainingRun) -> None:
        self.large = False
        self._form = form
        self.view = NetworkView(_SMALL, texts.INPUTS, tuple(map(texts.said, ACTION_NAMES)))
        self.reward_bar = RewardBar(_STRIP)
        self.editing = NetworkEditing(form, self.view, lander_run)
        self._picture = _NETWORK
        width = typeface.width(texts.TRAIN_CLOSER, SMALL, "regular")
        self._on_closer = on_closer
        self._heading = form.add(Choice(form.manager, (_ROW.left, _ROW.top, _ROW.width - width - 20, _ROW.height), "",
                        texts.TRAIN_INSIDE, 0, self._turn, size=SMALL))  # fmt: skip
        self._closer = form.add(TextButton(form.manager, (_ROW.right - width, _ROW.top, width, _ROW.height),
                                     texts.TRAIN_CLOSER, on_closer, size=SMALL))  # fmt: skip
        form.add(VirtualPointer(form.manager, _SMALL, self.follow))
        self.clear()

    def clear(self) -> None:
        """Reset for another run."""
        self.network: NeuralNetwork | None = None
        self.shown: NetworkState | None = None
        self.health = NetworkHealth()
        self.editing.clear()

    @property
    def busy(self) -> bool:
        """Whether the next frame paints part of a new picture of the network."""
        return self._shows_network and self.view.busy

    @property
    def _shows_network(self) -> bool:
        return self.large or self._picture == _NETWORK

    def place(self, large: bool) -> list[Widget]:
        """Show the network large or small; return the large network's widgets, for the form."""
        self.large = large
        self.editing.place(large)
        self._closer.label = texts.TRAIN_CLOSER_BACK if large else texts.TRAIN_CLOSER
        self.view.place(_LARGE if large else _SMALL)
        self._heading.index = _PAID if large else self._picture  # beside the large network, the panel has the other
        box = (_LEFT, 88, 400, 28)
        index = SHOWN.index(self.view.show)
        if not large:
            return []
        return [
            Choice(self._form.manager, box, "", texts.NETWORK_VIEW_SHOWS, index, self._show),
            VirtualPointer(self._form.manager, _LARGE, self.follow, hold=texts.EDIT_PICK),
        ]

    def take(self, network_state: NetworkState, config: Config) -> None:
        """Show the network that a run reports, and see how healthy it is."""
        if self.show(network_state, config) and self.network is not None:
            self.health.look(self.network, network_state.observation, config.gradient_clip)

    def show(self, network_state: NetworkState, config: Config) -> bool:
        """Show a network, perhaps of an earlier moment; return whether it fits the run."""
        if self.network is None or self.network.values.shape != network_state.values.shape:
            self.network = build_network(NUM_FEATURES, NUM_ACTIONS, config, np.random.default_rng(0))
        network = self.network
        if network.values.shape != network_state.values.shape:
            return False  # it belongs to a run that has just been replaced
        self.shown = network_state
        network.values = network_state.values
        network.gradients[:] = network_state.gradients
        self.view.output_scale = config.reward_scale
        self.view.set(network, network_state.observation)
        self.editing.look(network)
        return True

    def pay(self, history: History, row: int = -1) -> None:
        """Show the reward of the latest flights, part by part, or of those before another point of the history."""
        self.reward_bar.set(PARTS, history.parts[row])

    def follow(self, event: pygame.event.Event) -> None:
        """Follow the mouse or the virtual pointer; an event's position is in points."""
        if event.type == pygame.MOUSEMOTION:
            self.view.hover(event.pos if self._shows_network else None)
            self.reward_bar.hover(None if self._shows_network and not self.large else event.pos)
        self.editing.follow(event)

    def covers(self, point: Point) -> bool:
        """Whether a point is on the small picture of the network."""
        return not self.large and self._picture == _NETWORK and _SMALL.collidepoint(point)

    def update(self, at_once: bool) -> None:
        """Advance by 1/60 s."""
        self.editing.update()
        self.view.update(at_once=at_once)
        self.reward_bar.update(at_once=at_once)

    def draw(self, canvas: Canvas) -> None:
        """Draw the panel's picture, and the large network with its title beside it."""
        if self.large:
            canvas.text(texts.NETWORK_VIEW_TITLE, (_LEFT, 46), size=TITLE)
            canvas.text(texts.NETWORK_VIEW_LINES[self.view.show], (_LEFT, 70), size=SMALL, colour=MUTE)
        if self._shows_network:
            self.view.draw(canvas)
        self.editing.draw(canvas)
        if self.large or self._picture == _PAID:
            self.reward_bar.draw(canvas)

    def _turn(self, index: int) -> None:
        self._picture = index
        if self.large:  # the heading asks for the network where that is small
            self._on_closer()

    def _show(self, index: int) -> None:
        self.view.show = SHOWN[index]
