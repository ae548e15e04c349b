"""The arithmetic of convolution: windows of images times kernels, as matrix products.

Arrays here are the transposed ones of `ai.nn.images`: (channels, width, height, batch) in C order.
"""

from collections.abc import Iterator
from itertools import product

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from ai.nn.parameter import Array

BLOCK = 1 << 20  # numbers at work at a time: 4 MB, which stay in the cache between one pass and the next
MOVING = 25  # multiplications of a matrix product that take as long as copying or adding one number


class Correlation:
    """Correlates images of `channels` with kernels into `filters` of a given width, block by block.

    Kernels are (kernel column, kernel row, channel, filter). Windows lie `stride` pixels apart, and the images
    come with `padding` zeros around them.

    Windows are copied into the columns of a matrix (Chellapilla, Puri & Simard 2006): whole, so that one product
    with the kernels is the result; or only one column of each, and the products with all columns of the kernels
    are added, every one shifted by its place. With many channels the second moves fewer numbers. `columns` chooses:
    `kernel` or 1, the latter for a stride of 1 only; None is what should take less time.
    """

    def __init__(
        self,
        kernel: int,
        channels: int,
        filters: int,
        width: int,
        *,
        stride: int = 1,
        padding: int = 0,
        columns: int | None = None,
    ) -> None:
        self.kernel, self.channels, self.filters, self.width = kernel, channels, filters, width
        self.stride, self.padding = stride, padding
        self.scratch: dict[str, Array] = {}
        self._copy(columns or min((kernel, 1) if stride == 1 else (kernel,), key=self._cost))

    def _copy(self, columns: int) -> None:
        """Set how many columns of each window are copied: `kernel` or 1."""
        self.columns, self.shifts = columns, self.kernel // columns
        self.rows = columns * self.kernel * self.channels  # of the matrix
        self.products = self.shifts * self.filters
        self.margin = self.padding if self.shifts > 1 else 0  # pixels of zeros, which add nothing to what is shifted

    def _cost(self, columns: int) -> int:
        self._copy(columns)
        width = self.width + self.shifts - 1 - 2 * self.margin
        return width * (self.rows * self.products + MOVING * (self.rows + self.products))

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
            shifted = products.reshape(self.shifts, self.filters, *matrix.shape[1:])
            for shift, inside, place in self._shifted(x):
                part = output[:, place, y]
                part += shifted[shift][:, inside]

    def gradient(self, images: Array, error: Array) -> Array:
        """Return the gradient of the kernels, given the output's: (shifts, rows of the matrix, filters)."""
        gradient = np.zeros((self.shifts, self.rows, self.filters), error.dtype)
        for matrix, x, y in self._matrices(images):
            for shift, inside, place in self._shifted(x):
                part = error[:, place, y].reshape(self.filters, -1)
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

    def _shifted(self, x: slice) -> Iterator[tuple[int, slice, slice]]:
        """Yield for each shift which columns of a block meet the output, and where."""
        for shift in range(self.shifts):
            first, last = max(x.start, shift), min(x.stop, self.width + shift)
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
