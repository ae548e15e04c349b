"""One forward pass written out unit by unit: what each unit reads, its weights, and what the layer made of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
import numpy.typing as npt

from ai.nn.images import ConvolutionLayer, FlattenLayer, MaxPoolingLayer
from ai.nn.layer import Layer
from ai.nn.layers import ActivationLayer, DropoutLayer, FullyConnectedLayer
from ai.nn.network import NeuralNetwork
from ai.nn.parameter import Array

Kind = Literal["convolution", "pooling", "activation", "connected", "other"]
Place = tuple[int, int, int]  # row, column and channel of a unit; a layer of plain values has one row and one column
Box = tuple[int, int, int, int]  # top, left, bottom, right: of pixels, the last two beyond the end

_KINDS: Final[dict[type[Layer], Kind]] = {
    ConvolutionLayer: "convolution", MaxPoolingLayer: "pooling", ActivationLayer: "activation",
    FullyConnectedLayer: "connected",
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class UnitSum:
    """What one unit computes: of a patch (height, width, channels), the layer's own output."""

    corner: tuple[int, int]  # row and column of the patch in the layer's input
    patch: Array  # the inputs that it reads
    weights: Array | None  # a weight for each of them; pooling and activations have none
    bias: float
    output: float  # what the layer gave

    @property
    def products(self) -> Array:
        """Inputs times weights, in the layer's own precision; the inputs themselves where there are no weights."""
        return self.patch if self.weights is None else self.patch * self.weights

    @property
    def total(self) -> float:
        """Sum of all products and the bias; rounding apart, the output of a layer that has weights."""
        return float(self.products.sum(dtype=np.float64)) + self.bias


@dataclass(frozen=True, eq=False)
class Stage:
    """One layer in a forward pass of one example; layers that change no number are left out."""

    layer: Layer
    inputs: Array  # what it read, (height, width, channels)
    outputs: Array  # what it gave, likewise
    order: npt.NDArray[np.intp]  # where each input stands in a row of values: in a fully connected layer, its weights

    @property
    def kind(self) -> Kind:
        """Kind of layer; "other" for those that cannot be written out as sums."""
        return _KINDS.get(type(self.layer), "other")

    @property
    def window(self) -> tuple[int, int, int]:
        """Height and width of the patch that a unit reads, and pixels from one patch to the next."""
        match self.layer:
            case ConvolutionLayer(kernel=kernel):
                return kernel, kernel, 1
            case MaxPoolingLayer(size=size):
                return size, size, size
            case ActivationLayer():
                return 1, 1, 1
        return *self.inputs.shape[:2], 1

    def unit(self, place: Place) -> UnitSum:
        """Return the sum of one unit; raises ValueError for a layer of another kind, IndexError for no such unit."""
        if self.kind == "other":
            raise ValueError(f"{type(self.layer).__name__} is no sum that can be written out")
        row, column, channel = place
        height, width, stride = self.window
        top, left = row * stride, column * stride
        patch, weights, bias = self.inputs[top : top + height, left : left + width], None, 0.0
        match self.layer:
            case ConvolutionLayer() as layer:
                weights, bias = layer.kernels[:, :, :, channel].swapaxes(0, 1), float(layer.bias[channel])
            case FullyConnectedLayer() as layer:
                weights, bias = layer.weights[self.order, channel], float(layer.bias[channel])
            case _:
                patch = patch[..., channel, None]
        return UnitSum((top, left), patch, weights, bias, float(self.outputs[place]))

    def read_by(self, box: Box) -> Box:
        """Return which pixels of the input the outputs in a box were made of."""
        height, width, stride = self.window
        top, left, bottom, right = box
        return top * stride, left * stride, (bottom - 1) * stride + height, (right - 1) * stride + width

    def strongest_input(self, place: Place) -> Place:
        """Return the input that has the largest product in a unit's sum; of a pooling, the maximum."""
        unit = self.unit(place)
        row, column, channel = map(int, np.unravel_index(int(unit.products.argmax()), unit.products.shape))
        return unit.corner[0] + row, unit.corner[1] + column, place[2] if unit.weights is None else channel


def stages(network: NeuralNetwork, example: npt.ArrayLike) -> list[Stage]:
    """Return a forward pass of one example, (height, width, channels) or (values,), layer by layer.

    A row of values that is an image laid out row by row may be given as that image: a first layer that is fully
    connected then reads it in its own order.
    """
    data: Array = np.asarray(example, network.dtype)
    shown = data if data.ndim == 3 else data.reshape(1, 1, -1)
    order = np.arange(data.size).reshape(shown.shape)
    if data.ndim == 3 and not _takes_images(network):
        data = data.reshape(-1)
    found = []
    for layer, output in zip(network.layers, network.activations(data[None]), strict=True):
        if isinstance(layer, FlattenLayer):
            order = np.arange(shown.size).reshape(shown.shape, order="F")
        elif not isinstance(layer, DropoutLayer):
            rows = output.ndim == 2
            given = output[0]
            if rows:
                given = given[order] if isinstance(layer, ActivationLayer) else given.reshape(1, 1, -1)
            found.append(Stage(layer, shown, given, order))
            shown = given
            if not (rows and isinstance(layer, ActivationLayer)):  # an activation leaves every value in its place
                order = np.arange(shown.size).reshape(shown.shape)
    return found


def receptive_field(before: list[Stage], place: Place) -> Box:
    """Return the pixels of the example that a unit of the last of these stages depends on."""
    box = place[0], place[1], place[0] + 1, place[1] + 1
    for stage in reversed(before):
        box = stage.read_by(box)
    return box


def _takes_images(network: NeuralNetwork) -> bool:
    """Whether a network's first layer of a certain shape takes images."""
    return isinstance(next((each.inputs for each in network.layers if each.inputs is not None), None), tuple)
