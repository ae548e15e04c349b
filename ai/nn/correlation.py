"""The arithmetic of convolution: windows of images times kernels, as matrix products.

Arrays here are the transposed ones of `ai.nn.images`: (channels, width, height, batch) in C order.
"""

from collections.abc import Iterator
from itertools import product

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from ai.nn.parameter import Array

BLOCK = 1 << 20  # numbers at work at a time: 4 MB, which stay in the cache between one pass and the next


class Correlation:
    """Correlates images of `channels` with kernels into `filters`, block by block.

    Kernels are (kernel column, kernel row, channel, filter). Windows lie `stride` pixels apart, and the images
    come with `padding` zeros around them.

    The windows are copied into the columns of a matrix (Chellapilla, Puri & Simard 2006). Either whole, so that
    one product with the kernels is the result. Or only one column of each window, and the products with each
    column of the kernels are added, every one shifted by its place: if there are many channels, this moves
    fewer numbers.
    """

    def __init__(self, kernel: int, channels: int, filters: int, *, stride: int = 1, padding: int = 0) -> None:
        whole = stride > 1 or kernel * kernel * channels + filters <= kernel * (channels + filters)
        self.kernel, self.stride = kernel, stride
        self.columns = kernel if whole else 1  # of each window, in the matrix
        self.shifts = kernel // self.columns
        self.rows = self.columns * kernel * channels  # of the matrix
        self.products = self.shifts * filters
        self.margin = 0 if whole else padding  # pixels of zeros add nothing to a shifted product
        self.scratch: dict[str, Array] = {}

    def correlate(self, images: Array, kernels: Array, bias: Array, output: Array) -> None:
        """Fill `output`, (filters, width, height, batch), with the correlation plus a bias of each filter."""
        bias = bias[:, None, None, None]
        if self.shifts > 1:
            output[...] = bias
        kernels = kernels.reshape(self.shifts, self.rows, -1).swapaxes(1, 2).reshape(self.products, self.rows)
        for matrix, x, y in self._matrices(images):
            if self.shifts == 1:
                part = output[:, x, y]
                np.matmul(kernels, matrix.reshape(self.rows, -1), out=part.reshape(self.products, -1))
                part += bias
                continue
            products = self._memory("products", (self.products, *matrix.shape[1:]), output)
            np.matmul(kernels, matrix.reshape(self.rows, -1), out=products.reshape(self.products, -1))
            shifted = products.reshape(self.shifts, -1, *matrix.shape[1:])
            for shift, inside, place in self._shifted(x, output.shape[1]):
                part = output[:, place, y]
                part += shifted[shift][:, inside]

    def gradient(self, images: Array, error: Array) -> Array:
        """Return the gradient of the kernels, given the output's: (shifts, rows of the matrix, filters)."""
        filters = len(error)
        gradient = np.zeros((self.shifts, self.rows, filters), error.dtype)
        for matrix, x, y in self._matrices(images):
            for shift, inside, place in self._shifted(x, error.shape[1]):
                part = error[:, place, y].reshape(filters, -1)
                gradient[shift] += matrix[:, inside].reshape(self.rows, -1) @ part.T
        return gradient

    def _matrices(self, images: Array) -> Iterator[tuple[Array, slice, slice]]:
        """Yield blocks of windows, (rows, width, height, batch), with the pixels they start at, across and up.

        A block is some columns of the images, or a part of one column: contiguous in the output, either way.
        """
        windows = sliding_window_view(images, (self.columns, self.kernel), (1, 2))
        windows = windows[:, :: self.stride, :: self.stride].transpose(4, 5, 0, 1, 2, 3)
        width, height, batch = windows.shape[3:]
        fit = max(1, BLOCK // (batch * (self.rows + self.products)))
        across = _parts(self.margin, width - self.margin, fit // height)
        for x, y in product(across, _parts(0, height, fit)):
            block = windows[..., x, y, :]
            matrix = self._memory("matrix", block.shape, images)
            matrix[...] = block
            yield matrix.reshape(self.rows, *block.shape[3:]), x, y

    def _shifted(self, x: slice, width: int) -> Iterator[tuple[int, slice, slice]]:
        """Yield for each shift which columns of a block meet an output of this width, and where."""
        for shift in range(self.shifts):
            first, last = max(x.start, shift), min(x.stop, width + shift)
            if first < last:
                yield shift, slice(first - x.start, last - x.start), slice(first - shift, last - shift)

    def _memory(self, name: str, shape: tuple[int, ...], like: Array) -> Array:
        """Return scratch memory, the same at each call."""
        size, kept = int(np.prod(shape)), self.scratch.get(name)
        if kept is None or kept.size < size or kept.dtype != like.dtype:
            kept = self.scratch[name] = np.empty(size, like.dtype)
        return kept[:size].reshape(shape)


def _parts(first: int, last: int, size: int) -> list[slice]:
    """Cut a range into parts of about equal length, at most `size` (or 1) each."""
    count = -(-(last - first) // max(1, size))
    length = -(-(last - first) // count)
    return [slice(start, min(start + length, last)) for start in range(first, last, length)]
