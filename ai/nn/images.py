"""Layers for images: convolution, max pooling, and the flattening that leads to fully connected layers.

Images are arrays of shape (batch, height, width, channels), kept in Fortran order: in memory the batch varies
fastest, so that `images.T`, (channels, width, height, batch), is an ordinary C-ordered array. NumPy then moves
and compares whole runs of examples at a time, however small the images are, and the windows of a convolution
are gathered almost at the speed of memory (docs/adr/0009-images-batch-last-in-memory.md).
"""

import numpy as np
import numpy.typing as npt

from ai.nn.correlation import Correlation
from ai.nn.layers import FullyConnectedLayer, HalvedLayer, ImageShape, Layer, checked_size, constant
from ai.nn.parameter import Array


class ConvolutionLayer(FullyConnectedLayer):
    """A fully connected layer on every window of an image: `filters` numbers in place of kernel x kernel pixels.

    `inputs` is (height, width, channels). Windows lie `stride` pixels apart, and `padding` zeros are put around
    the image on each side; padding of kernel // 2 keeps the size. As in all such libraries the kernel is not
    flipped: this is a correlation. Raises ValueError for sizes that make no sense.
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
        _, reach, _ = self.outputs = (self._reach(height), self._reach(width), self.filters)
        self.overhang = self.kernel - 1 - self.padding  # the padding of the way back
        self.forward = Correlation(self.kernel, channels, self.filters, reach, stride=self.stride, padding=self.padding)
        self.backward = Correlation(self.kernel, self.filters, channels, width, padding=self.overhang)
        # What the gradient sums up is small whichever way windows are copied, so the way that copies least is best.
        self.sums = Correlation(self.kernel, channels, self.filters, reach, stride=self.stride, padding=self.padding,
                                columns=1 if self.stride == 1 else None)  # fmt: skip
        self.framed = self.framed_error = np.empty((0, 0, 0, 0), dtype)

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
        if len(self.output) != len(input_data) or self.output.dtype != self.dtype:
            self.framed = self._frame(len(input_data))
            self.output = np.empty((len(input_data), *self.outputs), self.dtype, order="F")
        return self._correlate(input_data, self.framed, self.output)

    def predict(self, input_data: Array) -> Array:
        """Return the same as a new array, also for one image without the batch axis."""
        _check_images(self, input_data, (3, 4))
        images = input_data if input_data.ndim == 4 else input_data[None]
        output = np.empty((len(images), *self.outputs), self.dtype, order="F")
        self._correlate(images, self._frame(len(images)), output)
        return output if input_data.ndim == 4 else output[0]

    def fill_gradients(self, output_error: Array) -> None:
        """Set the gradients of weights, the sum of windowᵀ E over all windows, and of the bias."""
        weights, bias = self.parameters
        error = np.asarray(output_error, self.dtype, order="F").T
        error.reshape(self.filters, -1).dot(constant(error[0].size, 1.0, error.dtype), bias.gradient)
        weights.gradient[...] = self.sums.gradient(self.framed.T, error).reshape(weights.value.shape)

    def input_error(self, output_error: Array) -> Array:
        """Return E correlated with the kernels turned by half: (batch, height, width, channels)."""
        if len(self.framed_error) != len(output_error) or self.framed_error.dtype != self.dtype:
            height, width, channels = self.inputs
            reach = self.kernel - 1
            shape = (len(output_error), height + reach, width + reach, self.filters)
            self.framed_error = np.zeros(shape, self.dtype, order="F")
            self.error = np.empty((len(output_error), height, width, channels), self.dtype, order="F")
        _place(output_error, self.framed_error, self.overhang, self.stride)
        turned = self.kernels[::-1, ::-1].swapaxes(2, 3)
        self.backward.correlate(self.framed_error.T, turned, np.zeros(turned.shape[-1], self.dtype), self.error.T)
        return self.error

    def window(self, image: Array, row: int, column: int) -> Array:
        """Return what one output reads of an image (height, width, channels): (kernel, kernel, channels)."""
        frame = self._frame(1)
        _place(image[None], frame, self.padding)
        top, left = row * self.stride, column * self.stride
        return frame[0, top : top + self.kernel, left : left + self.kernel]

    def _correlate(self, images: Array, frame: Array, output: Array) -> Array:
        _place(images, frame, self.padding)
        self.forward.correlate(frame.T, self.kernels, self.bias, output.T)
        return output

    def _frame(self, batch: int) -> Array:
        """Return memory for images with zeros around them."""
        height, width, channels = self.inputs
        return np.zeros((batch, height + 2 * self.padding, width + 2 * self.padding, channels), self.dtype, order="F")

    def _reach(self, pixels: int) -> int:
        """Return how many windows lie along so many pixels."""
        return (pixels + 2 * self.padding - self.kernel) // self.stride + 1


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
        _check_images(self, input_data, (3, 4))
        images = input_data if input_data.ndim == 4 else input_data[None]
        output = self._maximum(images, np.empty((len(images), *self.outputs), images.dtype, order="F"))
        return output if input_data.ndim == 4 else output[0]

    def input_error(self, output_error: Array) -> Array:
        """Return the error of the largest pixels, and 0 for all others: (batch, height, width, channels)."""
        if self.error.shape != self.input.shape or self.error.dtype != self.input.dtype:
            self.error = np.zeros(self.input.shape, self.input.dtype, order="F")
            self.given, self.left = np.empty_like(self.output, bool), np.empty_like(self.output, bool)
        self.left.fill(True)  # squares whose error no pixel has been given yet
        *others, (_, last) = zip(self._squares(self.input), self._squares(self.error), strict=True)
        for pixel, error in others:
            np.equal(pixel, self.output, out=self.given)
            self.given &= self.left
            self.left ^= self.given
            np.multiply(output_error, self.given, out=error)
        np.multiply(output_error, self.left, out=last)
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
        self.error = np.empty((0, 0, 0, 0))

    def forward_propagate(self, input_data: Array) -> Array:
        """Return the same numbers, (batch, values): a view, if the images are in Fortran order."""
        _check_images(self, input_data)
        return input_data.reshape(-1, self.outputs, order="F")

    def predict(self, input_data: Array) -> Array:
        """Return the same, also for one image without the batch axis."""
        _check_images(self, input_data, (3, 4))
        return input_data.reshape(*input_data.shape[:-3], self.outputs, order="F")

    def input_error(self, output_error: Array) -> Array:
        """Return the error in the shape of the images."""
        if len(self.error) != len(output_error) or self.error.dtype != output_error.dtype:
            self.error = np.empty((len(output_error), *self.inputs), output_error.dtype, order="F")
        self.error.reshape(output_error.shape, order="F")[...] = output_error
        return self.error


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


def _check_images(layer: Layer, images: Array, dimensions: tuple[int, ...] = (4,)) -> None:
    if images.ndim not in dimensions or images.shape[-3:] != layer.inputs:
        kind = type(layer).__name__
        raise ValueError(f"{kind} takes a batch of images of shape {layer.inputs}, not {images.shape}")
