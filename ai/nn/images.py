"""Layers for images: convolution, max pooling, and the flattening that leads to fully connected layers.

Images are arrays of shape (batch, height, width, channels), kept in Fortran order: in memory the batch varies
fastest, so that `images.T`, (channels, width, height, batch), is an ordinary C-ordered array. NumPy then moves
and compares whole runs of examples at a time, however small the images are, and the windows of a convolution
are gathered almost at the speed of memory (docs/adr/0009-images-batch-last-in-memory.md).
"""

from collections.abc import Iterator
from itertools import product
from math import prod
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from ai.nn.layer import Layer
from ai.nn.layers import FullyConnectedLayer, ones
from ai.nn.limits import ImageShape, checked_size
from ai.nn.parameter import Array

BLOCK = 1 << 20  # numbers at work at a time: 4 MB, which stay in the cache between one pass and the next


class ConvolutionLayer(FullyConnectedLayer):
    """A fully connected layer on every window of an image: `filters` numbers in place of kernel x kernel pixels.

    `inputs` is (height, width, channels). Windows lie `stride` pixels apart, and `padding` zeros are put around
    the image on each side; padding of kernel // 2 keeps the size. As in all such libraries the kernel is not
    flipped: this is a correlation. `options` are those of `FullyConnectedLayer`. Raises ValueError for sizes that make
    no sense.

    Windows are copied into the columns of a matrix, and one product with the weights does the rest (Chellapilla, Puri &
    Simard 2006). With W the weights, X such a matrix, E the errors of its outputs and ' for the transpose, the output
    is W'X + bias, the gradient of W is XE', and WE are errors of the windows, which are added up where they overlap.
    """

    settings = ("inputs", "filters", "kernel", "stride", "padding")
    inputs: ImageShape
    outputs: ImageShape
    framed: Array  # images of the last forward pass, with zeros around them

    def __init__(
        self, inputs: ImageShape, filters: int, kernel: int, *, stride: int = 1, padding: int = 0, **options: Any
    ) -> None:
        height, width, channels = shape = _checked_shape(inputs)
        self.kernel, self.stride = checked_size("kernel", kernel), checked_size("stride", stride)
        self.padding = padding if padding == 0 else checked_size("padding", padding)
        if self.padding >= self.kernel:
            raise ValueError(f"padding is smaller than the kernel of {self.kernel}, not {padding}")
        if self.kernel > min(height, width) + 2 * self.padding:
            raise ValueError(f"a kernel of {kernel} does not fit into {height} x {width} with padding {padding}")
        self.filters = checked_size("filters", filters)
        super().__init__(self.kernel**2 * channels, self.filters, **options)
        rows, columns = ((size + 2 * self.padding - self.kernel) // self.stride + 1 for size in (height, width))
        self.inputs, self.outputs = shape, (rows, columns, self.filters)

    @property
    def weights(self) -> Array:
        """Weights, (kernel · kernel · channels, filters), rows by kernel column, kernel row and channel."""
        return self.parameters[0].value

    @property
    def kernels(self) -> Array:
        """The weights as (kernel column, kernel row, channel, filter)."""
        return self.weights.reshape(self.kernel, self.kernel, -1, self.filters)

    def forward_propagate(self, input_data: Array) -> Array:
        """Return each window times the weights, plus the bias: (batch, height, width, filters)."""
        _check_images(self, input_data)
        self.framed = self.kept("framed", self._frame(len(input_data)), self.dtype)
        output = self.kept("output", (len(input_data), *self.outputs), self.dtype)
        return self._convolve(input_data, self.framed, output)

    def predict(self, input_data: Array) -> Array:
        """Return the same as a new array."""
        _check_images(self, input_data)
        framed = np.zeros(self._frame(len(input_data)), self.dtype, "F")
        return self._convolve(input_data, framed, np.empty((len(input_data), *self.outputs), self.dtype, "F"))

    def fill_gradients(self, output_error: Array) -> None:
        """Set the gradients of weights, the sum of windowᵀ E over all windows, and of the bias."""
        weights, bias = self.parameters
        error = np.asarray(output_error, self.dtype, order="F")
        bias.gradient[...] = error.T.reshape(self.filters, -1).dot(ones(error[..., 0].size, error.dtype))
        weights.gradient.fill(0)
        for x, y in self._blocks(len(error)):
            weights.gradient += self._windows(self.framed, x, y) @ _columns(error, x, y).T

    def input_error(self, output_error: Array) -> Array:
        """Return the sum of what all windows that a pixel lies in send back: (batch, height, width, channels)."""
        (height, width, channels), stride = self.inputs, self.stride
        error = np.asarray(output_error, self.dtype, order="F")
        framed = self.kept("framed_error", self._frame(len(error)), self.dtype)
        framed.fill(0)
        for x, y in self._blocks(len(error)):
            part, places = _columns(error, x, y), (x.stop - x.start, y.stop - y.start, len(error))
            sent = self._block("sent", (self.kernel, self.kernel, channels, *places))
            np.matmul(self.weights, part, out=sent.reshape(len(self.weights), -1))
            for i, j in np.ndindex(self.kernel, self.kernel):
                columns, rows = _strided(x, i, stride), _strided(y, j, stride)
                reached = framed.T[:, columns, rows]
                reached += sent[i, j]
        inside = slice(self.padding, self.padding + height), slice(self.padding, self.padding + width)
        return np.asarray(framed[:, *inside], order="F")

    def _convolve(self, images: Array, framed: Array, output: Array) -> Array:
        inside = (slice(self.padding, self.padding + size) for size in self.inputs[:2])
        framed[:, *inside] = images
        weights, bias = self.weights.T, self.bias[:, None]
        for x, y in self._blocks(len(images)):
            matrix, part = self._windows(framed, x, y), _columns(output, x, y)
            np.matmul(weights, matrix, out=part)
            part += bias
        return output

    def _frame(self, batch: int) -> tuple[int, ...]:
        """Return the shape of images with zeros around them."""
        height, width, channels = self.inputs
        return batch, height + 2 * self.padding, width + 2 * self.padding, channels

    def _windows(self, framed: Array, x: slice, y: slice) -> Array:
        """Return windows as the columns of a matrix, (kernel · kernel · channels, windows · batch)."""
        windows = sliding_window_view(framed.T, (self.kernel, self.kernel), (1, 2))
        windows = windows[:, :: self.stride, :: self.stride][:, x, y].transpose(4, 5, 0, 1, 2, 3)
        matrix = self._block("matrix", windows.shape)
        matrix[...] = windows
        return matrix.reshape(len(self.weights), -1)

    def _block(self, name: str, shape: tuple[int, ...]) -> Array:
        """Return memory for a block, the same at each call: fresh pages would take longer than what is put there."""
        size = prod(shape)
        memory = self.__dict__.get(name)
        if memory is None or memory.size < size or memory.dtype != self.dtype:
            memory = self.__dict__[name] = np.empty(size, self.dtype)
        return memory[:size].reshape(shape)

    def _blocks(self, batch: int) -> Iterator[tuple[slice, slice]]:
        """Yield which columns and rows of outputs are worked at together: some whole columns, or a part of one."""
        rows, columns, filters = self.outputs
        fit = max(1, BLOCK // (batch * (len(self.weights) + filters)))
        return product(_parts(columns, fit // rows), _parts(rows, fit))


def _columns(outputs: Array, x: slice, y: slice) -> Array:
    """Return some outputs, or their errors, as the columns of a matrix (filters, windows · batch), a view."""
    return outputs.T[:, x, y].reshape(outputs.shape[-1], -1)


def _strided(outputs: slice, shift: int, stride: int) -> slice:
    """Return where the pixels lie that are `shift` pixels into the windows of some outputs."""
    return slice(outputs.start * stride + shift, (outputs.stop - 1) * stride + shift + 1, stride)


def _parts(size: int, most: int) -> list[slice]:
    """Cut a range from 0 into parts of about equal length, at most `most` (or 1) each."""
    count = -(-size // max(1, most))
    length = -(-size // count)
    return [slice(start, min(start + length, size)) for start in range(0, size, length)]


class MaxPoolingLayer(Layer):
    """The largest of each `size` x `size` pixels, channel by channel; what does not fill a square is left out.

    On the way back the error goes to that one pixel: of equal ones to the first, row by row.
    """

    settings = ("inputs", "size")
    inputs: ImageShape
    outputs: ImageShape

    def __init__(self, inputs: ImageShape, size: int = 2) -> None:
        self.inputs = height, width, channels = _checked_shape(inputs)
        self.size = checked_size("size", size)
        if not 2 <= self.size <= min(height, width):
            raise ValueError(f"size lies between 2 and that of the image, {height} x {width}; not {size}")
        self.outputs = (height // size, width // size, channels)

    def forward_propagate(self, input_data: Array) -> Array:
        """Return the maxima, (batch, height, width, channels)."""
        _check_images(self, input_data)
        self.input = input_data
        self.output = self.kept("output", (len(input_data), *self.outputs), input_data.dtype)
        return self._maximum(input_data, self.output)

    def predict(self, input_data: Array) -> Array:
        """Return the same as a new array."""
        _check_images(self, input_data)
        return self._maximum(input_data, np.empty((len(input_data), *self.outputs), input_data.dtype, "F"))

    def input_error(self, output_error: Array) -> Array:
        """Return the error of the largest pixels, and 0 for all others: (batch, height, width, channels).

        The last pixel of a square is not compared: it gets what no other has been given.
        """
        found = self.kept("error", self.input.shape, self.input.dtype)
        given, left = (self.kept(name, self.output.shape, bool) for name in ("given", "left"))
        left.fill(True)  # squares whose error no pixel has been given yet
        *others, (_, last) = zip(self._squares(self.input), self._squares(found), strict=True)
        for pixel, error in others:
            np.equal(pixel, self.output, out=given)
            given &= left
            left ^= given
            np.multiply(output_error, given, out=error)
        np.multiply(output_error, left, out=last)
        return found

    def _maximum(self, images: Array, output: Array) -> Array:
        first, second, *others = self._squares(images)
        np.maximum(first, second, out=output)
        for pixel in others:
            np.maximum(output, pixel, out=output)
        return output

    def _squares(self, images: Array) -> list[Array]:
        """Return views of the first pixel of each square, of the second, and so on, row by row."""
        rows, columns = (count * self.size for count in self.outputs[:2])
        squares = np.ndindex(self.size, self.size)
        return [images[:, row : rows : self.size, column : columns : self.size] for row, column in squares]


class FlattenLayer(Layer):
    """Images as rows of numbers, (batch, height · width · channels), for fully connected layers.

    The numbers stay where they are in memory, so within an example the height varies fastest.
    """

    settings = ("inputs",)
    inputs: ImageShape
    outputs: int

    def __init__(self, inputs: ImageShape) -> None:
        self.inputs = height, width, channels = _checked_shape(inputs)
        self.outputs = height * width * channels

    def forward_propagate(self, input_data: Array) -> Array:
        """Return the same numbers, (batch, values): a view, if the images are in Fortran order."""
        _check_images(self, input_data)
        return input_data.reshape(-1, self.outputs, order="F")

    def predict(self, input_data: Array) -> Array:
        """Return the same."""
        return self.forward_propagate(input_data)

    def input_error(self, output_error: Array) -> Array:
        """Return the error in the shape of the images."""
        error = self.kept("error", (len(output_error), *self.inputs), output_error.dtype)
        error.reshape(output_error.shape, order="F")[...] = output_error
        return error


def _checked_shape(inputs: ImageShape) -> ImageShape:
    """Return (height, width, channels) of plain numbers; raises ValueError if it is none."""
    if not isinstance(inputs, tuple | list) or len(inputs) != 3:
        raise ValueError(f"inputs is (height, width, channels), not {inputs!r}")
    names = ("height", "width", "channels")
    height, width, channels = (checked_size(name, size) for name, size in zip(names, inputs, strict=True))
    checked_size("height · width · channels", height * width * channels)
    return height, width, channels


def _check_images(layer: Layer, images: Array) -> None:
    if images.ndim != 4 or images.shape[1:] != layer.inputs:
        kind = type(layer).__name__
        raise ValueError(f"{kind} takes a batch of images of shape {layer.inputs}, not {images.shape}")
