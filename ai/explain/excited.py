"""What a filter of a convolution looks for: of many images, the patch of ink that excites it most."""

from __future__ import annotations

import numpy as np

from ai.explain.unit_sums import Stage, receptive_field
from ai.nn.network import NeuralNetwork
from ai.nn.parameter import Array


class MostExciting:
    """Search through images (n, height, width), some at a time, for what excites each filter of a stage most.

    `before` are the stages of a forward pass up to that of the filters. Where an image of the data does so says more
    than one that is climbed towards: it is ink that somebody has written (Zeiler and Fergus 2014).

    Attributes:
        patches: by the number of a filter, the ink that its unit depends on, (height, width); none before one was read.
        most: (filters,) what the filters gave there.

    """

    def __init__(self, network: NeuralNetwork, before: list[Stage], images: Array) -> None:
        self._network, self._before, self._images, self._read = network, before, images, 0
        self._layer = next(at for at, layer in enumerate(network.layers) if layer is before[-1].layer)
        self.most = np.full(before[-1].outputs.shape[2], -np.inf)
        self.patches: dict[int, Array] = {}

    @property
    def done(self) -> bool:
        """Whether all images were read."""
        return self._read >= len(self._images)

    def go_on(self, count: int = 4) -> None:
        """Read so many more images."""
        images = self._images[self._read : self._read + count]
        self._read += count
        outputs = self._network.activations(images[..., None].astype(self._network.dtype))[self._layer]
        flat = outputs.reshape(-1, outputs.shape[-1])
        for number in np.flatnonzero(flat.max(axis=0) > self.most).tolist():
            at = int(flat[:, number].argmax())
            image, row, column = (int(each) for each in np.unravel_index(at, outputs.shape[:3]))
            top, left, bottom, right = receptive_field(self._before, (row, column, number))
            self.most[number] = flat[at, number]
            self.patches[number] = images[image, top:bottom, left:right]
