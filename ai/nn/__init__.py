"""A neural network library on NumPy: layers, costs, optimizers and a folder format, every gradient by hand.

To read it in building order: parameter, activations, costs, layers, optimizers, storage, network.
"""

from ai.nn.activations import Activation, ActivationFunctions
from ai.nn.costs import Cost, CostFunctions
from ai.nn.folder import atomic_folder, recover_folder
from ai.nn.layers import ActivationLayer, DuelingLayer, FullyConnectedLayer, Layer, LayerNormalisation
from ai.nn.network import NeuralNetwork
from ai.nn.optimizers import OPTIMIZERS, SGD, Adam, Momentum, Optimizer
from ai.nn.parameter import Array, Parameter
from ai.nn.storage import ModelFormatError

__all__ = [
    "OPTIMIZERS",
    "SGD",
    "Activation",
    "ActivationFunctions",
    "ActivationLayer",
    "Adam",
    "Array",
    "Cost",
    "CostFunctions",
    "DuelingLayer",
    "FullyConnectedLayer",
    "Layer",
    "LayerNormalisation",
    "ModelFormatError",
    "Momentum",
    "NeuralNetwork",
    "Optimizer",
    "Parameter",
    "atomic_folder",
    "recover_folder",
]
