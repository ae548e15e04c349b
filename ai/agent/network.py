"""The Q-network of a configuration, and the optimizer of its parameters."""

from __future__ import annotations

import numpy as np

from ai.agent.config import AgentConfig
from ai.nn import (
    OPTIMIZERS,
    ActivationLayer,
    DuelingLayer,
    FullyConnectedLayer,
    Layer,
    LayerNormalisation,
    NeuralNetwork,
)
from ai.nn.activations import ACTIVATIONS
from ai.nn.costs import COSTS
from ai.nn.optimizers import Optimizer


def build_network(num_features: int, num_actions: int, config: AgentConfig, rng: np.random.Generator) -> NeuralNetwork:
    """Build the Q-network: observations (n, num_features) in, one value per action (n, num_actions) out.

    The last layer has no activation. Initial parameters are drawn from `rng`. Raises ValueError for a network that is
    too large.
    """
    layers: list[Layer] = []
    inputs = num_features
    for units in config.hidden:
        layers.append(FullyConnectedLayer(inputs, units))
        if config.layer_normalisation:
            layers.append(LayerNormalisation(units))
        layers.append(ActivationLayer(*ACTIVATIONS[config.activation]()))
        inputs = units
    head = DuelingLayer if config.dueling else FullyConnectedLayer
    layers.append(head(inputs, num_actions, scale=config.output_scale))
    return NeuralNetwork(*COSTS[config.cost](), rng=rng).add_layer(*layers)


def make_optimizer(config: AgentConfig) -> Optimizer:
    """Make a new optimizer, at the learning rate that a run begins with."""
    return OPTIMIZERS[config.optimizer](config.learning_rate)
