"""One memory that is learned by itself: plain steps on its error, repeated until the value is at its target."""

from __future__ import annotations

from typing import Final

import numpy as np

from ai.environment import Floats
from ai.nn import SGD, NeuralNetwork

_PART: Final = 0.2  # of the way to the target that the first step would go, were the network a straight line


class LearnedAlone:
    """One output of a copy of a network that learns its target, which stands still, and nothing else.

    No other example is in its batch, and plain gradient descent carries nothing on.

    Attributes:
        network: the copy.
        way: the output before the first step and after each, in the network's scale.
        outputs: (outputs,) all of them now.

    """

    def __init__(self, network: NeuralNetwork, state: Floats, output: int, target: float) -> None:
        self.network, self._state, self._output, self.target = network.copy(), state[None], output, target
        self.outputs = self.network.predict(self._state)[0].copy()
        self.way = [float(self.outputs[output])]
        self._optimizer = SGD(self._rate())

    @property
    def error(self) -> float:
        """The output now, less its target."""
        return self.way[-1] - self.target

    @property
    def arrived(self) -> bool:
        """Whether no more than a hundredth of the first error is left."""
        return abs(self.error) <= 0.01 * abs(self.way[0] - self.target)

    def step(self) -> None:
        """Learn it once more."""
        # The other outputs are their own targets, so that nothing is to be learned of them.
        self.network.train_batch(self._state, self._wanted(), self._optimizer)
        self.outputs = self.network.predict(self._state)[0].copy()
        self.way.append(float(self.outputs[self._output]))

    def _wanted(self) -> Floats:
        wanted: Floats = self.network.predict(self._state).copy()
        wanted[0, self._output] = self.target
        return wanted

    def _rate(self) -> float:
        """Return the learning rate with which the first step goes that part of the way, to first order."""
        network = self.network
        derivative = network.cost.derivative(network.forward_propagate(self._state), self._wanted())
        network.backward_propagate(derivative)
        slope = float(derivative[0, self._output])
        squared = float(np.square(network.gradients.astype(float)).sum())
        return _PART * self.error * slope / squared if squared > 0.0 else 1e-3
