"""Layers for images: convolution, max pooling, and the flattening that leads to fully connected layers.

Images are arrays of shape (batch, height, width, channels), kept in Fortran order: in memory the batch varies
fastest, so that `images.T`, (channels, width, height, batch), is an ordinary C-ordered array. NumPy then moves
and compares whole runs of examples at a time, however small the images are, and the windows of a convolution
are gathered almost at the speed of memory (docs/adr/0009-images-batch-last-in-memory.md).
"""

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np
import numpy.typing as npt
from numpy.lib.stride_tricks import sliding_window_view

from ai.nn.layers import FullyConnectedLayer, HalvedLayer, ImageShape, Layer, checked_size, ones
from ai.nn.parameter import Array

BLOCK = 1 << 20  # numbers at work at a time: 4 MB, which stay in the cache between one pass and the next


class Correlation:
    """Windows of images times kernels, as matrix products.

    Arrays are transposed: images (channels, width, height, batch), with `padding` zeros around each; kernels (kernel
    column, kernel row, channel, filter). Windows lie `stride` pixels apart, `width` of them in a row. For each example,
    with s the stride and a sum over i, j and c,

        output[f, x, y] = bias[f] + Σ kernels[i, j, c, f] · images[c, s·x + i, s·y + j]

    Windows are copied into the columns of a matrix (Chellapilla, Puri & Simard 2006), in one of two ways. Whole: one
    product with the kernels is the result. Or single columns of pixels, each once: column X meets all columns of the
    kernels in one product, and what column i makes of it is added at x = X - i. For each pixel the first way moves
    kernel² · channels numbers in and `filters` out, the second kernel · channels in and kernel · filters out; `whole`
    says that the first moves less, or that the second can't be taken for the stride.
    """

    def __init__(
        self, kernel: int, channels: int, filters: int, width: int, *, stride: int = 1, padding: int = 0
    ) -> None:
        self.kernel, self.filters, self.width, self.stride, self.padding = kernel, filters, width, stride, padding
        self.whole = stride > 1 or kernel * channels < filters
        self.scratch: dict[str, Array] = {}

    def correlate(self, images: Array, kernels: Array, bias: Array, output: Array) -> None:
        """Fill `output`, (filters, width, height, batch), with the correlation plus a bias of each filter."""
        bias = bias[:, None, None, None]
        if self.whole:
            weights = kernels.reshape(-1, self.filters).T
            for matrix, x, y in self._blocks(images, self.kernel):
                part = output[:, x, y]
                np.matmul(weights, matrix.reshape(len(matrix), -1), out=part.reshape(self.filters, -1))
                part += bias
            return
        output[...] = bias
        weights = kernels.reshape(self.kernel, -1, self.filters).swapaxes(1, 2).reshape(self.kernel * self.filters, -1)
        for matrix, x, y in self._blocks(images, 1):
            products = self._memory("products", (self.kernel, self.filters, *matrix.shape[1:]), output.dtype)
            np.matmul(weights, matrix.reshape(len(matrix), -1), out=products.reshape(len(weights), -1))
            for shift in range(self.kernel):
                inside, place = self._shifted(x, shift)
                part = output[:, place, y]
                part += products[shift][:, inside]

    def gradient(self, images: Array, error: Array) -> Array:
        """Return the gradient of the kernels, flat, given that of the output: Σ windowᵀ · error over all windows."""
        # The sums are small either way, so the way that copies least is best.
        columns = 1 if self.stride == 1 else self.kernel
        gradients = [np.zeros((0, 0), error.dtype)] * (self.kernel // columns)
        for block, (matrix, x, y) in enumerate(self._blocks(images, columns)):
            for shift, before in enumerate(gradients):
                inside, place = self._shifted(x, shift)
                part = error[:, place, y].reshape(self.filters, -1)
                more = matrix[:, inside].reshape(len(matrix), -1) @ part.T
                gradients[shift] = before + more if block else more
        return np.concatenate(gradients, axis=None)

    def _blocks(self, images: Array, columns: int) -> Iterator[tuple[Array, slice, slice]]:
        """Yield blocks of windows, or of single columns of them: (rows, width, height, batch), and where they start.

        A block is some columns of the images, or a part of one column: contiguous in the output, either way.
        """
        margin = self.padding if columns < self.kernel else 0  # columns of zeros, which add nothing when shifted
        windows = sliding_window_view(images, (columns, self.kernel), (1, 2))
        windows = windows[:, :: self.stride, :: self.stride].transpose(4, 5, 0, 1, 2, 3)
        width, height, batch = windows.shape[3:]
        rows = int(np.prod(windows.shape[:3]))
        # Windows of one image that fit into a block, with what is made of them.
        fit = max(1, BLOCK // (batch * (rows + self.kernel // columns * self.filters)))
        for x, y in product(_parts(margin, width - margin, fit // height), _parts(0, height, fit)):
            block = windows[..., x, y, :]
            matrix = self._memory("matrix", block.shape, images.dtype)
            matrix[...] = block
            yield matrix.reshape(rows, *block.shape[3:]), x, y

    def _shifted(self, x: slice, shift: int) -> tuple[slice, slice]:
        """Return which columns of a block at `x` meet the output, column X at X - `shift`, and where they do."""
        first = max(x.start, shift)
        last = max(first, min(x.stop, self.width + shift))
        return slice(first - x.start, last - x.start), slice(first - shift, last - shift)

    def _memory(self, name: str, shape: tuple[int, ...], dtype: npt.DTypeLike) -> Array:
        """Return scratch memory, the same at each call."""
        size, kept = int(np.prod(shape)), self.scratch.get(name)
        if kept is None or kept.size < size or kept.dtype != dtype:
            kept = self.scratch[name] = np.empty(size, dtype)
        return kept[:size].reshape(shape)


def _parts(first: int, last: int, size: int) -> list[slice]:
    """Cut a range into parts of about equal length, at most `size` (or 1) each."""
    count = -(-(last - first) // max(1, size))
    length = -(-(last - first) // count)
    return [slice(start, min(start + length, last)) for start in range(first, last, length)]


class ConvolutionLayer(FullyConnectedLayer):
    """A fully connected layer on every window of an image: `filters` numbers in place of kernel x kernel pixels.

    `inputs` is (height, width, channels). Windows lie `stride` pixels apart, and `padding` zeros are put around
    the image on each side; padding of kernel // 2 keeps the size. As in all such libraries the kernel is not
    flipped: this is a correlation. `options` are those of `FullyConnectedLayer`. Raises ValueError for sizes that make
    no sense.
    """

    settings = ("inputs", "filters", "kernel", "stride", "padding")
    inputs: ImageShape
    outputs: ImageShape
    framed: Array  # images of the last forward pass, with zeros around them

    def __init__(
        self,
        inputs: ImageShape,
        filters: int,
        kernel: int,
        *,
        stride: int = 1,
        padding: int = 0,
        **options: Any,
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
        self.overhang = self.kernel - 1 - self.padding  # the padding of the way back
        self.forward = Correlation(
            self.kernel, channels, self.filters, columns, stride=self.stride, padding=self.padding
        )
        self.backward = Correlation(self.kernel, self.filters, channels, width, padding=self.overhang)

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
        frame = self.kept("framed", self._frame(len(input_data)), self.dtype)
        return self._correlate(input_data, frame, self.kept("output", (len(input_data), *self.outputs), self.dtype))

    def predict(self, input_data: Array) -> Array:
        """Return the same as a new array, also for one image without the batch axis."""
        if input_data.ndim == 3:
            one: Array = self.predict(input_data[None])[0]
            return one
        _check_images(self, input_data)
        frame = np.zeros(self._frame(len(input_data)), self.dtype, "F")
        return self._correlate(input_data, frame, np.empty((len(input_data), *self.outputs), self.dtype, "F"))

    def fill_gradients(self, output_error: Array) -> None:
        """Set the gradients of weights, the sum of windowᵀ E over all windows, and of the bias."""
        weights, bias = self.parameters
        error = np.asarray(output_error, self.dtype, order="F").T
        error.reshape(self.filters, -1).dot(ones(error[0].size, error.dtype), bias.gradient)
        weights.gradient[...] = self.forward.gradient(self.framed.T, error).reshape(weights.value.shape)

    def input_error(self, output_error: Array) -> Array:
        """Return E correlated with the kernels turned by half: (batch, height, width, channels)."""
        (height, width, channels), reach = self.inputs, self.kernel - 1
        framed = self.kept("framed_error", (len(output_error), height + reach, width + reach, self.filters), self.dtype)
        error = self.kept("error", (len(output_error), *self.inputs), self.dtype)
        _place(output_error, framed, self.overhang, self.stride)
        turned = self.kernels[::-1, ::-1].swapaxes(2, 3)
        self.backward.correlate(framed.T, turned, np.zeros(channels, self.dtype), error.T)
        return error

    def _correlate(self, images: Array, frame: Array, output: Array) -> Array:
        _place(images, frame, self.padding)
        self.forward.correlate(frame.T, self.kernels, self.bias, output.T)
        return output

    def _frame(self, batch: int) -> tuple[int, ...]:
        """Return the shape of images with zeros around them."""
        height, width, channels = self.inputs
        return batch, height + 2 * self.padding, width + 2 * self.padding, channels


class MaxPoolingLayer(HalvedLayer):
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
        """Return the same as a new array, also for one image without the batch axis."""
        if input_data.ndim == 3:
            one: Array = self.predict(input_data[None])[0]
            return one
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


class FlattenLayer(HalvedLayer):
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
        """Return the same, also for one image without the batch axis."""
        if input_data.ndim == 3:
            one: Array = self.predict(input_data[None])[0]
            return one
        return self.forward_propagate(input_data)

    def input_error(self, output_error: Array) -> Array:
        """Return the error in the shape of the images."""
        error = self.kept("error", (len(output_error), *self.inputs), output_error.dtype)
        error.reshape(output_error.shape, order="F")[...] = output_error
        return error


def _place(images: Array, frame: Array, border: int, stride: int = 1) -> None:
    """Copy images into the middle of frames, their pixels `stride` apart."""
    rows, columns = (slice(border, border + stride * (size - 1) + 1, stride) for size in images.shape[1:3])
    frame[:, rows, columns] = images


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
