"""Layers for images: convolution, max pooling, and the flattening that leads to fully connected layers.

Images are arrays of shape (batch, height, width, channels), kept in Fortran order: in memory the batch varies
fastest, so that `images.T`, (channels, width, height, batch), is an ordinary C-ordered array. NumPy then moves
and compares whole runs of examples at a time, however small the images are, and the windows of a convolution
are gathered almost at the speed of memory (docs/adr/0009-images-batch-last-in-memory.md).
"""

from collections.abc import Iterator
from itertools import product
from math import prod

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from ai.nn.layer import NO_ARRAY, ImageShape, Layer, checked_shape, checked_size, fitting
from ai.nn.layers import FullyConnectedLayer, constant
from ai.nn.parameter import Array

Bools = NDArray[np.bool_]
BLOCK = 1 << 20  # numbers at work at a time: 4 MB, which stay in the cache between one pass and the next


class ConvolutionLayer(FullyConnectedLayer):
    """A fully connected layer on every window of an image: `filters` numbers in place of kernel x kernel pixels.

    `inputs` is (height, width, channels). Windows lie one pixel apart and inside the image. As in all such libraries
    the kernel is not flipped: this is a correlation. Raises ValueError for sizes that make no sense.

    Windows are copied into the columns of a matrix, and one product with the weights does the rest (Chellapilla, Puri &
    Simard 2006). With W the weights, X such a matrix, E the errors of its outputs and ' for the transpose, the output
    is W'X + bias, the gradient of W is XE', and WE are errors of the windows, which are added up where they overlap.
    """

    settings = ("inputs", "filters", "kernel")
    input = NO_ARRAY
    inputs: ImageShape
    outputs: ImageShape

    def __init__(self, inputs: ImageShape, filters: int, kernel: int, *, scale: float = 1.0) -> None:
        height, width, channels = shape = checked_shape("inputs", inputs)
        self.filters, self.kernel = checked_size("filters", filters), checked_size("kernel", kernel)
        if self.kernel > min(height, width):
            raise ValueError(f"a kernel of {kernel} does not fit into {height} x {width}")
        super().__init__(self.kernel**2 * channels, self.filters, scale=scale)
        self.inputs = shape
        self.outputs = checked_shape("outputs", (height - self.kernel + 1, width - self.kernel + 1, self.filters))

    @property
    def kernels(self) -> Array:
        """The weights (kernel · kernel · channels, filters) as (kernel column, kernel row, channel, filter)."""
        return self.weights.reshape(self.kernel, self.kernel, -1, self.filters)

    def forward_propagate(self, input_data: Array) -> Array:
        """Return each window times the weights, plus the bias: (batch, height, width, filters)."""
        self.input = fitting(self.input, input_data.shape, self.dtype)
        self.input[...] = input_data
        self.output = fitting(self.output, (len(input_data), *self.outputs), self.dtype)
        return self._convolve(self.input, self.output)

    def predict(self, input_data: Array) -> Array:
        images = np.asarray(input_data, self.dtype, order="F")
        return self._convolve(images, np.empty((len(images), *self.outputs), self.dtype, "F"))

    def fill_gradients(self, output_error: Array) -> None:
        """Set the gradients of weights, the sum of windowᵀ E over all windows, and of the bias."""
        weights, bias = self.parameters
        error = np.asarray(output_error, self.dtype, order="F")
        bias.gradient[...] = error.T.reshape(self.filters, -1).dot(constant(error[..., 0].size, 1.0, error.dtype))
        gradient = weights.gradient
        gradient.fill(0)
        for x, y in self._blocks(len(error)):
            gradient += self._windows(self.input, x, y) @ _columns(error, x, y).T

    def input_error(self, output_error: Array) -> Array:
        """Return the sum of what all windows that a pixel lies in send back: (batch, height, width, channels)."""
        error = np.asarray(output_error, self.dtype, order="F")
        total = self.error = fitting(self.error, (len(error), *self.inputs), self.dtype)
        total.fill(0)
        for x, y in self._blocks(len(error)):
            places = x.stop - x.start, y.stop - y.start, len(error)
            sent = self._block("sent", (self.kernel, self.kernel, self.inputs[2], *places))
            np.matmul(self.weights, _columns(error, x, y), out=sent.reshape(len(self.weights), -1))
            for i, j in np.ndindex(self.kernel, self.kernel):
                total.T[:, x.start + i : x.stop + i, y.start + j : y.stop + j] += sent[i, j]
        return total

    def _convolve(self, images: Array, output: Array) -> Array:
        weights, bias = self.weights.T, self.bias[:, None]
        for x, y in self._blocks(len(images)):
            part = _columns(output, x, y)
            np.matmul(weights, self._windows(images, x, y), out=part)
            part += bias
        return output

    def _windows(self, images: Array, x: slice, y: slice) -> Array:
        """Return windows of some outputs as the columns of a matrix, (kernel · kernel · channels, windows · batch)."""
        windows = sliding_window_view(images.T, (self.kernel, self.kernel), (1, 2))[:, x, y].transpose(4, 5, 0, 1, 2, 3)
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
        fit = max(1, BLOCK // max(1, batch * (len(self.weights) + filters)))
        return product(_parts(columns, fit // rows), _parts(rows, fit))


def _columns(outputs: Array, x: slice, y: slice) -> Array:
    """Return some outputs, or their errors, as the columns of a matrix (filters, windows · batch), a view."""
    return outputs.T[:, x, y].reshape(outputs.shape[-1], -1)


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
    output = error = NO_ARRAY
    given: Bools = np.empty(0, bool)
    left = given
    inputs: ImageShape
    outputs: ImageShape

    def __init__(self, inputs: ImageShape, size: int = 2) -> None:
        self.inputs = height, width, channels = checked_shape("inputs", inputs)
        self.size = checked_size("size", size)
        if not 2 <= self.size <= min(height, width):
            raise ValueError(f"size lies between 2 and that of the image, {height} x {width}; not {size}")
        self.outputs = (height // size, width // size, channels)

    def forward_propagate(self, input_data: Array) -> Array:
        self.input = input_data
        self.output = fitting(self.output, (len(input_data), *self.outputs), input_data.dtype)
        return self._maximum(input_data, self.output)

    def predict(self, input_data: Array) -> Array:
        return self._maximum(input_data, np.empty((len(input_data), *self.outputs), input_data.dtype, "F"))

    def input_error(self, output_error: Array) -> Array:
        """Return the error of the largest pixels, and 0 for all others: (batch, height, width, channels).

        The last pixel of a square is not compared: it gets what no other has been given.
        """
        self.error = fitting(self.error, self.input.shape, self.input.dtype)
        given = self.given = fitting(self.given, self.output.shape, bool)
        left = self.left = fitting(self.left, self.output.shape, bool)
        left.fill(True)  # squares whose error no pixel has been given yet
        *others, (_, last) = zip(self._squares(self.input), self._squares(self.error), strict=True)
        for pixel, error in others:
            np.equal(pixel, self.output, out=given)
            given &= left
            left ^= given
            np.multiply(output_error, given, out=error)
        np.multiply(output_error, left, out=last)
        return self.error

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
    error = NO_ARRAY

    def __init__(self, inputs: ImageShape) -> None:
        self.inputs = height, width, channels = checked_shape("inputs", inputs)
        self.outputs = height * width * channels

    def forward_propagate(self, input_data: Array) -> Array:
        """Return the same numbers, (batch, values): a view, if the images are in Fortran order."""
        return input_data.reshape(-1, self.outputs, order="F")

    def predict(self, input_data: Array) -> Array:
        return self.forward_propagate(input_data)

    def input_error(self, output_error: Array) -> Array:
        self.error = fitting(self.error, (len(output_error), *self.inputs), output_error.dtype)
        self.error.reshape(output_error.shape, order="F")[...] = output_error
        return self.error
