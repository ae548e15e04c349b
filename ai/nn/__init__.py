"""A neural network library on NumPy: layers, costs, optimizers and a folder format, every gradient by hand.

To read in this order: parameter, activations, costs, layer, layers, optimizers, network; then storage, and images,
which agents do without.
"""

from ai.nn.activations import Activation, ActivationFunctions
from ai.nn.costs import Cost, CostFunctions, softmax
from ai.nn.images import ConvolutionLayer, FlattenLayer, MaxPoolingLayer
from ai.nn.layer import Layer
from ai.nn.layers import ActivationLayer, DropoutLayer, DuelingLayer, FullyConnectedLayer, LayerNormalisation
from ai.nn.network import NeuralNetwork
from ai.nn.optimizers import OPTIMIZERS, SGD, Adam, DivergenceError, Momentum, Optimizer
from ai.nn.parameter import Array, Parameter
from ai.nn.storage import ModelFormatError, register_layer

__all__ = [
    "OPTIMIZERS",
    "SGD",
    "Activation",
    "ActivationFunctions",
    "ActivationLayer",
    "Adam",
    "Array",
    "ConvolutionLayer",
    "Cost",
    "CostFunctions",
    "DivergenceError",
    "DropoutLayer",
    "DuelingLayer",
    "FlattenLayer",
    "FullyConnectedLayer",
    "Layer",
    "LayerNormalisation",
    "MaxPoolingLayer",
    "ModelFormatError",
    "Momentum",
    "NeuralNetwork",
    "Optimizer",
    "Parameter",
    "register_layer",
    "softmax",
]
