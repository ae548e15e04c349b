"""Settings of a digit training run, as one dataclass, and the presets; like `ai.training.config`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from ai.digits.preprocessing import SIDE
from ai.files.knobs import Knobs, knob
from ai.nn import (
    OPTIMIZERS,
    ActivationLayer,
    ConvolutionLayer,
    DropoutLayer,
    FlattenLayer,
    FullyConnectedLayer,
    MaxPoolingLayer,
    NeuralNetwork,
)
from ai.nn.activations import ACTIVATIONS
from ai.nn.costs import COSTS

MOST_VALUES: Final = 20_000_000  # of one layer for one batch: some 450 MB with all that a step makes of them


@dataclass(frozen=True)
class DigitConfig(Knobs):
    """Settings of one training run. The defaults are the `modern` preset."""

    # fmt: off
    learning_rate: float = knob(1e-3, "Peak learning rate: how far a step moves the weights.",
                                "learning", low=1e-5, high=1.0, log=True, live=True)
    final_learning_rate: float = knob(1e-6, "Final learning rate, reached along half a cosine.",
                                      "learning", low=1e-7, high=1.0, log=True, live=True)
    warm_up_epochs: float = knob(0.5, "Epochs over which the learning rate rises from 0.",
                                 "learning", low=0.0, high=10.0)
    epochs: int = knob(12, "Epochs: passes over all training images.", "learning", low=1, high=1000)
    batch_size: int = knob(50, "Batch size: images in each learning step.", "learning", low=1, high=5000)
    optimizer: str = knob("adam", "Optimizer: how a gradient becomes a step.", "learning", choices=tuple(OPTIMIZERS))
    cost: str = knob("softmax_cross_entropy", "Cost function: measures the error.", "learning", choices=tuple(COSTS))
    label_smoothing: float = knob(0.05, "Label smoothing: share of each label given to all digits alike.",
                            "learning", low=0.0, high=0.5, live=True)
    ema_decay: float = knob(0.998, "Decay of the moving average of weights that is kept; 0 keeps the last.",
                            "learning", low=0.0, high=0.9999, offers=(0.0, 0.9, 0.98, 0.99, 0.995, 0.998, 0.999))
    held_out: int = knob(5_000, "Validation images, never learnt from, to pick the best by.",
                         "learning", low=0, high=30_000)

    filters: tuple[int, ...] = knob((32, 64), "Filters of each convolution, each followed by pooling.",
                                    "network", low=1, high=256, offers=((8,), (16,), (8, 16), (16, 32), (32, 64)),
                                    needs="convolutions")
    convolutions: bool = knob(True, "Convolutions: small windows that slide over the image.", "network")
    kernel: int = knob(5, "Kernel size, in pixels.", "network", low=1, high=9, needs="convolutions")
    hidden: tuple[int, ...] = knob((128,), "Units in each hidden layer.", "network", low=1, high=2048,
                                   offers=((32,), (128,), (512,), (100, 50), (256, 128)))
    activation: str = knob("relu", "Activation function of the hidden layers.", "network", choices=tuple(ACTIVATIONS))
    output_activation: bool = knob(False, "Apply the activation to the outputs too.", "network")
    dropout: float = knob(0.3, "Dropout: share of hidden values left out.", "network", low=0.0, high=0.9)

    augmentation: float = knob(1.0, "Augmentation: how far images are bent, slanted and turned.",
                               "images", low=0.0, high=2.0, live=True)
    unaugmented: float = knob(0.1, "Share of images left without augmentation.", "images", low=0.0, high=1.0, live=True,
                           needs="augmentation")
    drawn: float = knob(0.0, "Share of images replaced by the same digit from a simulated hand.",
                        "images", low=0.0, high=0.5, live=True)
    # fmt: on

    def problems(self) -> list[str]:
        """Return what is wrong with the values, alone and together, a sentence each."""
        problems = super().problems()
        if problems:
            return problems
        try:
            network = build_digit_network(self, np.random.default_rng(0))  # nothing is drawn before it is asked for
        except ValueError as error:
            return [str(error)]
        widest = max(math.prod(np.atleast_1d(layer.outputs)) for layer in network.layers if layer.outputs is not None)
        if self.batch_size * widest > MOST_VALUES:
            problems.append(
                f"batch_size is at most {MOST_VALUES // widest:,} with this network, whose layers make up to"
                f" {widest:,} values of an image; not {self.batch_size:,}"
            )
        return problems


def build_digit_network(config: DigitConfig, rng: np.random.Generator) -> NeuralNetwork:
    """Build the network of a configuration: images (28, 28, 1) or rows of 784 in, ten outputs."""
    network = NeuralNetwork(*COSTS[config.cost](), rng=rng)

    def activation() -> ActivationLayer:
        return ActivationLayer(*ACTIVATIONS[config.activation]())

    values = SIDE * SIDE
    if config.convolutions:
        shape = (SIDE, SIDE, 1)
        for filters in config.filters:
            convolution = ConvolutionLayer(shape, filters, config.kernel)
            pooling = MaxPoolingLayer(convolution.outputs)
            network.add_layer(convolution).add_layer(pooling).add_layer(activation())
            shape = pooling.outputs
        flatten = FlattenLayer(shape)
        network.add_layer(flatten)
        values = flatten.outputs
    for units in config.hidden:
        if config.dropout:
            network.add_layer(DropoutLayer(config.dropout))
        network.add_layer(FullyConnectedLayer(values, units))
        network.add_layer(activation())
        values = units
    network.add_layer(FullyConnectedLayer(values, 10))
    if config.output_activation:
        network.add_layer(activation())
    return network


DIGIT_PRESETS: Final[dict[str, DigitConfig]] = {
    "modern": DigitConfig(),
    # The shipped modern network: wider, longer, and taught by hands that write as MNIST's writers seldom do.
    "thorough": DigitConfig(preset="thorough", epochs=14, filters=(32, 96), ema_decay=0.999, drawn=0.1),
    "classic": DigitConfig(
        preset="classic", learning_rate=3e-3, cost="mse", label_smoothing=0.0, convolutions=False, hidden=(100, 50),
        activation="tanh", output_activation=True, dropout=0.0, augmentation=0.8, unaugmented=0.2, epochs=60,
        batch_size=100,
    ),
    # The classic network as it was first described: all 60,000 images once, and plain steps.
    "as-described": DigitConfig(
        preset="as-described", learning_rate=0.2, final_learning_rate=0.2, warm_up_epochs=0.0, epochs=1, batch_size=500,
        optimizer="sgd", cost="mse", label_smoothing=0.0, ema_decay=0.0, held_out=0, convolutions=False,
        hidden=(100, 50), activation="tanh", output_activation=True, dropout=0.0, augmentation=0.0,
    ),
}  # fmt: skip
