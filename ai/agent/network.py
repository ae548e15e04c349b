"""The Q-network of a configuration, and the optimizer of its parameters."""

from __future__ import annotations

import numpy as np

from ai.agent.config import AgentConfig
from ai.nn import OPTIMIZERS, ActivationLayer, DuelingLayer, FullyConnectedLayer, LayerNormalisation, NeuralNetwork
from ai.nn.activations import ACTIVATIONS
from ai.nn.costs import COSTS
from ai.nn.optimizers import Optimizer


def build_network(num_features: int, num_actions: int, config: AgentConfig, rng: np.random.Generator) -> NeuralNetwork:
    """Build the Q-network: observations (n, num_features) in, one value per action (n, num_actions) out.

    The last layer has no activation. Initial parameters are drawn from `rng` when first asked for. Raises ValueError
    for a network that is too large.
    """
    network = NeuralNetwork(*COSTS[config.cost](), rng=rng)
    inputs = num_features
    for units in config.hidden:
        network.add_layer(FullyConnectedLayer(inputs, units))
        if config.layer_normalisation:
            network.add_layer(LayerNormalisation(units))
        network.add_layer(ActivationLayer(*ACTIVATIONS[config.activation]()))
        inputs = units
    head = DuelingLayer if config.dueling else FullyConnectedLayer
    return network.add_layer(head(inputs, num_actions, scale=config.output_scale))


def make_optimizer(config: AgentConfig) -> Optimizer:
    """Make a new optimizer, at the learning rate that a run begins with."""
    return OPTIMIZERS[config.optimizer](config.learning_rate)
