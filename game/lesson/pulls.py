"""Pulls on one value in a learning step: that of its own memory, of the others, and of the steps before.

The step of each of our optimizers is a pace times a sum of gradients, parameter by parameter, and the gradient of a
batch is the sum of its memories' shares. So each part of the sum has its part of the step, and the slope of the value
says how far that part alone would move it along a straight line. What is left is the bend of the network.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from game.lesson.step import LearningStep


@dataclass(frozen=True)
class Pulls:
    """Change of one output in a step, by its causes, in the unit of the network.

    Attributes:
        own: by the gradient of its own example.
        others: by the gradients of the other examples in the batch.
        earlier: by what the optimizer still carries of the steps before.
        bend: the rest, since a network is no straight line.

    """

    own: float
    others: float
    earlier: float
    bend: float

    @classmethod
    def of(cls, step: LearningStep, derivative: float, moved: float) -> Pulls | None:
        """Return the pulls that moved an output by `moved`; None where the cost's `derivative` by it is 0.

        The share of the example in the gradient is that derivative times the slope of the output.
        """
        taken = step.taken
        length = float(np.linalg.norm(taken.gradient.astype(float)))
        if derivative == 0.0 or not np.isfinite(derivative):
            return None
        clipped = length / taken.gradient_length if taken.gradient_length > 0 else 1.0
        share = taken.share.astype(float)
        slope = share / derivative
        gradient, whole = taken.gradient.astype(float), taken.taken.astype(float)
        own = step.pace * share * clipped
        together = step.pace * gradient
        pulls = [-float(slope @ part) for part in (own, together - own, whole - together)]
        return cls(pulls[0], pulls[1], pulls[2], bend=moved - sum(pulls))
