"""Layers for images: convolution, max pooling, and the flattening that leads to fully connected layers.

Images are arrays of shape (batch, height, width, channels), kept in Fortran order: in memory the batch varies
fastest, so that `images.T`, (channels, width, height, batch), is an ordinary C-ordered array. NumPy then moves
and compares whole runs of examples at a time, however small the images are, and the windows of a convolution
are gathered almost at the speed of memory (docs/adr/0009-images-batch-last-in-memory.md).
"""

from collections.abc import Iterator
from itertools import product

import numpy as np
import numpy.typing as npt
from numpy.lib.stride_tricks import sliding_window_view

from ai.nn.layers import FullyConnectedLayer, ImageShape, Layer, checked_size
from ai.nn.parameter import Array

BLOCK = 1 << 19  # values gathered at a time: 2 MB, which stay in the cache between gathering and product


class ConvolutionLayer(FullyConnectedLayer):
    """A fully connected layer on every window of an image: `filters` numbers in place of kernel x kernel pixels.

    `inputs` is (height, width, channels). Windows lie `stride` pixels apart, and `padding` zeros are put around
    the image on each side; padding of kernel // 2 keeps the size. As in all such libraries the kernel is not
    flipped: this is a correlation. Raises ValueError for sizes that make no sense.

    The windows become the columns of a matrix, and the convolution one product with the weights (Chellapilla,
    Puri & Simard 2006). They are gathered block by block and again on the way back: that costs less than
    keeping kernel² copies of every image.
    """

    settings = ("inputs", "filters", "kernel", "stride", "padding")
    inputs: ImageShape
    outputs: ImageShape

    def __init__(
        self,
        inputs: ImageShape,
        filters: int,
        kernel: int,
        *,
        stride: int = 1,
        padding: int = 0,
        initialisation: str | None = None,
        scale: float = 1.0,
        rng: np.random.Generator | None = None,
        dtype: npt.DTypeLike = np.float32,
    ) -> None:
        height, width, channels = shape = _checked_shape(inputs)
        self.kernel, self.stride = checked_size("kernel", kernel), checked_size("stride", stride)
        self.padding = padding if padding == 0 else checked_size("padding", padding)
        if self.padding >= self.kernel:
            raise ValueError(f"padding is smaller than the kernel of {self.kernel}, not {padding}")
        if self.kernel > min(height, width) + 2 * self.padding:
            raise ValueError(f"a kernel of {kernel} does not fit into {height} x {width} with padding {padding}")
        self.filters = checked_size("filters", filters)
        super().__init__(
            self.kernel**2 * channels, self.filters, initialisation=initialisation, scale=scale, rng=rng, dtype=dtype
        )
        self.inputs = shape
        self.outputs = (self._reach(height), self._reach(width), self.filters)
        self.padded = self.padded_error = self.scratch = np.empty(0, dtype)

    @property
    def weights(self) -> Array:
        """Weights, (kernel · kernel · channels, filters), rows by kernel row, kernel column and channel."""
        return self.parameters[0].value

    def forward_propagate(self, input_data: Array) -> Array:
        """Return each window times the weights, plus the bias: (batch, height, width, filters)."""
        _check_images(self, input_data)
        if len(self.output) != len(input_data) or self.output.dtype != self.dtype:
            self.padded, self.output = self._padded(len(input_data)), self._empty_output(len(input_data))
        self._inner(self.padded)[...] = input_data
        return self._correlate(self.padded, self.output)

    def predict(self, input_data: Array) -> Array:
        """Return the same as a new array, also for one image without the batch axis."""
        _check_images(self, input_data)
        images = input_data if input_data.ndim == 4 else input_data[None]
        padded = self._padded(len(images))
        self._inner(padded)[...] = images
        output = self._correlate(padded, self._empty_output(len(images)))
        return output if input_data.ndim == 4 else output[0]

    def fill_gradients(self, output_error: Array) -> None:
        """Set the gradients of weights, the sum of windowᵀ E over all windows, and of the bias."""
        weights, bias = self.parameters
        error = self._rows(output_error)
        error.reshape(self.filters, -1).sum(axis=1, out=bias.gradient)
        weights.gradient.fill(0)
        for windows, block in self._blocks(self.padded):
            weights.gradient += self._gathered(windows) @ error[block].reshape(self.filters, -1).T

    def input_error(self, output_error: Array) -> Array:
        """Return what all windows send back to each pixel, summed: (batch, height, width, channels)."""
        error = self._rows(output_error)
        if self.padded_error.shape != self.padded.shape:
            self.padded_error = self._padded(len(output_error))
        self.padded_error.fill(0)
        for windows, block in self._blocks(self.padded_error):
            columns = self._columns(windows)
            matrix = columns.reshape(len(self.weights), -1)
            np.matmul(self.weights, error[block].reshape(self.filters, -1), out=matrix)
            for tap in np.ndindex(self.kernel, self.kernel):
                pixels = windows[tap]
                pixels += columns[tap]  # in place: the windows overlap, those of one tap do not
        return self._inner(self.padded_error)

    def _correlate(self, padded: Array, output: Array) -> Array:
        weights, bias = self.parameters
        for windows, block in self._blocks(padded):
            out = output.T[block].reshape(self.filters, -1)
            np.matmul(weights.value.T, self._gathered(windows), out=out)
            out += bias.value[:, None]
        return output

    def _blocks(self, padded: Array) -> Iterator[tuple[Array, tuple[slice, ...]]]:
        """Yield views of all windows, (kernel, kernel, channels, width, height, batch), and their places.

        A place is what picks the same windows from the transposed output. It is some whole columns of the
        image, or a part of one: contiguous either way.
        """
        windows = sliding_window_view(padded.T, (self.kernel, self.kernel), (1, 2), writeable=True)
        windows = windows[:, :: self.stride, :: self.stride].transpose(5, 4, 0, 1, 2, 3)
        *_, width, height, batch = windows.shape
        fit = max(1, BLOCK // (len(self.weights) * batch))
        rows = -(-height // -(-height // fit))  # parts of equal size
        columns = max(1, fit // height)
        for x, y in product(range(0, width, columns), range(0, height, rows)):
            block = (slice(None), slice(x, x + columns), slice(y, y + rows))
            yield windows[:, :, *block], block

    def _gathered(self, windows: Array) -> Array:
        """Return windows as columns of a matrix, (kernel · kernel · channels, windows)."""
        columns = self._columns(windows)
        columns[...] = windows
        return columns.reshape(len(self.weights), -1)

    def _columns(self, windows: Array) -> Array:
        """Return memory for so many windows: the same at each call."""
        if self.scratch.size < windows.size or self.scratch.dtype != self.dtype:
            self.scratch = np.empty(windows.size, self.dtype)
        return self.scratch[: windows.size].reshape(windows.shape)

    def _rows(self, output_error: Array) -> Array:
        """Return the transposed error, (filters, width, height, batch), contiguous."""
        return np.asarray(output_error, self.dtype, order="F").T

    def _padded(self, batch: int) -> Array:
        height, width, channels = self.inputs
        return np.zeros((batch, height + 2 * self.padding, width + 2 * self.padding, channels), self.dtype, order="F")

    def _inner(self, padded: Array) -> Array:
        inner = slice(self.padding, -self.padding or None)
        return padded[:, inner, inner]

    def _empty_output(self, batch: int) -> Array:
        return np.empty((batch, *self.outputs), self.dtype, order="F")

    def _reach(self, pixels: int) -> int:
        """Return how many windows lie along so many pixels."""
        return (pixels + 2 * self.padding - self.kernel) // self.stride + 1


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
        self.output = self.error = np.empty((0, 0, 0, 0))

    def forward_propagate(self, input_data: Array) -> Array:
        """Return the maxima, (batch, height, width, channels)."""
        _check_images(self, input_data)
        if len(self.output) != len(input_data) or self.output.dtype != input_data.dtype:
            self.output = np.empty((len(input_data), *self.outputs), input_data.dtype, order="F")
        self.input = input_data
        return self._maximum(input_data, self.output)

    def predict(self, input_data: Array) -> Array:
        """Return the same as a new array, also for one image without the batch axis."""
        _check_images(self, input_data)
        images = input_data if input_data.ndim == 4 else input_data[None]
        output = self._maximum(images, np.empty((len(images), *self.outputs), images.dtype, order="F"))
        return output if input_data.ndim == 4 else output[0]

    def input_error(self, output_error: Array) -> Array:
        """Return the error of the largest pixels, and 0 for all others: (batch, height, width, channels)."""
        if self.error.shape != self.input.shape or self.error.dtype != self.input.dtype:
            self.error = np.zeros(self.input.shape, self.input.dtype, order="F")
            self.left = np.empty_like(self.output)
        self.left[...] = output_error
        *others, (_, last) = zip(self._pixels(self.input), self._pixels(self.error), strict=True)
        for pixel, error in others:
            np.multiply(self.left, pixel == self.output, out=error)
            self.left -= error  # what is given away leaves exactly nothing for pixels of the same value
        last[...] = self.left
        return self.error

    def _maximum(self, images: Array, out: Array) -> Array:
        first, second, *others = self._pixels(images)
        np.maximum(first, second, out=out)
        for pixel in others:
            np.maximum(out, pixel, out=out)
        return out

    def _pixels(self, images: Array) -> list[Array]:
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
        self.error = np.empty((0, 0, 0, 0))

    def forward_propagate(self, input_data: Array) -> Array:
        """Return the same numbers, (batch, values): a view, if the images are in Fortran order."""
        _check_images(self, input_data)
        return input_data.reshape(-1, self.outputs, order="F")

    def predict(self, input_data: Array) -> Array:
        """Return the same, also for one image without the batch axis."""
        _check_images(self, input_data)
        return input_data.reshape(*input_data.shape[:-3], self.outputs, order="F")

    def input_error(self, output_error: Array) -> Array:
        """Return the error in the shape of the images."""
        if len(self.error) != len(output_error) or self.error.dtype != output_error.dtype:
            self.error = np.empty((len(output_error), *self.inputs), output_error.dtype, order="F")
        self.error.reshape(output_error.shape, order="F")[...] = output_error
        return self.error


def _checked_shape(inputs: ImageShape) -> ImageShape:
    """Return (height, width, channels) of plain numbers; raises ValueError if it is none."""
    if not isinstance(inputs, tuple | list) or len(inputs) != 3:
        raise ValueError(f"inputs is (height, width, channels), not {inputs!r}")
    names = ("height", "width", "channels")
    height, width, channels = (checked_size(name, size) for name, size in zip(names, inputs, strict=True))
    checked_size("height · width · channels", height * width * channels)
    return height, width, channels


def _check_images(layer: Layer, images: Array) -> None:
    if images.ndim not in (3, 4) or images.shape[-3:] != layer.inputs:
        kind = type(layer).__name__
        raise ValueError(f"{kind} takes images of shape {layer.inputs}, or a batch of them; not {images.shape}")
