"""Dropout: regularisation that keeps a network from relying on any one value."""

import numpy as np

from ai.nn.layers import HalvedLayer
from ai.nn.parameter import Array


class DropoutLayer(HalvedLayer):
    """Sets each value to 0 with probability `rate` while training, and divides the others by 1 - rate.

    After Srivastava et al. 2014, inverted: sums keep their mean, so that `predict` has nothing to do. What is
    dropped comes from a generator of the network's, so the same program drops the same. Raises ValueError for
    a rate outside 0 ≤ rate < 1.
    """

    settings = ("rate",)

    def __init__(self, rate: float = 0.5) -> None:
        if isinstance(rate, bool) or not isinstance(rate, int | float) or not 0 <= rate < 1:
            raise ValueError(f"the rate of dropout is at least 0 and less than 1, not {rate!r}")
        self.rate = rate

    def forward_propagate(self, input_data: Array) -> Array:
        """Return what is kept, enlarged, and 0 elsewhere."""
        self.rng = self.rng or np.random.default_rng(0)
        # Drawn in the order that images have in memory; for small arrays the order does not matter.
        drawn = self.rng.random(input_data.shape[::-1], np.float32).T
        self.factors = self.kept("factors", input_data.shape, input_data.dtype)
        self.output = self.kept("output", input_data.shape, input_data.dtype)
        np.multiply(drawn >= self.rate, 1 / (1 - self.rate), out=self.factors, casting="same_kind")
        np.multiply(input_data, self.factors, out=self.output)
        return self.output

    def predict(self, input_data: Array) -> Array:
        """Return the input as it is."""
        return input_data

    def input_error(self, output_error: Array) -> Array:
        """Return the error of what was kept, enlarged alike, and 0 elsewhere."""
        self.error = self.kept("error", self.factors.shape, self.factors.dtype)
        np.multiply(output_error, self.factors, out=self.error)
        return self.error
