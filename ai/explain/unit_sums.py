"""One forward pass written out unit by unit: what each unit reads, its weights, and what the layer made of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
import numpy.typing as npt

from ai.nn.dropout import DropoutLayer
from ai.nn.images import ConvolutionLayer, FlattenLayer, MaxPoolingLayer
from ai.nn.layers import ActivationLayer, FullyConnectedLayer, Layer
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
    """What one unit computes: of a patch (height, width, channels), the layer's own output.

    Attributes:
        corner: row and column of the patch in the layer's input; negative within padding.
        patch: the inputs that it reads.
        weights: a weight for each of them, and a bias; None for pooling and activations, which have none.
        output: what the layer gave.

    """

    corner: tuple[int, int]
    patch: Array
    weights: Array | None
    bias: float
    output: float

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
    """One layer in a forward pass of one example; layers that change no number are left out.

    Attributes:
        layer: the layer.
        inputs: what it read, (height, width, channels).
        outputs: what it gave, likewise.
        order: where each of `inputs` stands in a row of values: for a fully connected layer, the row of its weights.

    """

    layer: Layer
    inputs: Array
    outputs: Array
    order: npt.NDArray[np.intp]

    @property
    def kind(self) -> Kind:
        """Kind of layer; "other" for those that cannot be written out as sums."""
        return _KINDS.get(type(self.layer), "other")

    def unit(self, place: Place) -> UnitSum:
        """Return the sum of one unit; raises ValueError for a layer of another kind, IndexError for no such unit."""
        row, column, channel = place
        output = float(self.outputs[place])
        match self.layer:
            case ConvolutionLayer() as layer if self.kind == "convolution":
                corner = row * layer.stride - layer.padding, column * layer.stride - layer.padding
                weights = layer.kernels[:, :, :, channel].swapaxes(0, 1)
                border, top, left = (layer.padding, layer.padding), row * layer.stride, column * layer.stride
                framed = np.pad(self.inputs, (border, border, (0, 0)))
                patch = framed[top : top + layer.kernel, left : left + layer.kernel]
                return UnitSum(corner, patch, weights, float(layer.bias[channel]), output)
            case FullyConnectedLayer() as layer if self.kind == "connected":
                weights = layer.weights[self.order, channel]
                return UnitSum((0, 0), self.inputs, weights, float(layer.bias[channel]), output)
            case MaxPoolingLayer(size=size):
                top, left = row * size, column * size
                patch = self.inputs[top : top + size, left : left + size, channel, None]
                return UnitSum((top, left), patch, None, 0.0, output)
            case ActivationLayer():
                patch = self.inputs[row, column, channel].reshape(1, 1, 1)
                return UnitSum((row, column), patch, None, 0.0, output)
        raise ValueError(f"{type(self.layer).__name__} is no sum that can be written out")

    def read_by(self, box: Box) -> Box:
        """Return which pixels of the input the outputs in a box were made of, within the input."""
        top, left, bottom, right = box
        height, width = self.inputs.shape[:2]
        match self.layer:
            case ConvolutionLayer(stride=stride, padding=padding, kernel=kernel):
                top, left = top * stride - padding, left * stride - padding
                bottom, right = (bottom - 1) * stride - padding + kernel, (right - 1) * stride - padding + kernel
            case MaxPoolingLayer(size=size):
                top, left, bottom, right = top * size, left * size, bottom * size, right * size
            case ActivationLayer():
                pass
            case _:
                return 0, 0, height, width
        return max(top, 0), max(left, 0), min(bottom, height), min(right, width)

    def strongest_input(self, place: Place) -> Place:
        """Return the input that has the largest product in a unit's sum; of a pooling, the maximum."""
        unit = self.unit(place)
        row, column, channel = map(int, np.unravel_index(int(unit.products.argmax()), unit.products.shape))
        height, width = self.inputs.shape[:2]
        row, column = unit.corner[0] + row, unit.corner[1] + column
        last = channel if unit.weights is not None else place[2]
        return min(max(row, 0), height - 1), min(max(column, 0), width - 1), last

    def strongest_reader(self, place: Place) -> Place | None:
        """Return the unit of this stage in whose sum one of its inputs has the largest product.

        None if no unit reads that input, or the layer cannot be written out.
        """
        row, column, channel = place
        match self.layer:
            case ActivationLayer():
                return place
            case MaxPoolingLayer(size=size):
                found = row // size, column // size, channel
                return found if found[0] < self.outputs.shape[0] and found[1] < self.outputs.shape[1] else None
            case FullyConnectedLayer(weights=weights) if self.kind == "connected":
                weights = weights[self.order[place]]
                return 0, 0, int((self.inputs[place] * weights).argmax())
            case ConvolutionLayer() as layer if self.kind == "convolution":
                return self._strongest_window(layer, place)
        return None

    def _strongest_window(self, layer: ConvolutionLayer, place: Place) -> Place | None:
        """Return the output of a convolution whose window weighs one pixel most."""
        row, column, channel = place
        height, width = self.outputs.shape[:2]
        best: tuple[float, Place] | None = None
        for down in range(layer.kernel):
            for across in range(layer.kernel):
                top, below = divmod(row + layer.padding - down, layer.stride)
                left, beside = divmod(column + layer.padding - across, layer.stride)
                if below or beside or not (0 <= top < height and 0 <= left < width):
                    continue
                products = self.inputs[place] * layer.kernels[across, down, channel]
                found = int(products.argmax())
                if best is None or products[found] > best[0]:
                    best = float(products[found]), (top, left, found)
        return best[1] if best else None


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
