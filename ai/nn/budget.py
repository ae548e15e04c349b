"""Limits on the size of a network: a small file must not be able to ask for more than a machine has.

An agent of that many parameters, two networks with gradients and an optimizer, takes 430 MB to load.
"""

import math
from collections.abc import Sequence
from typing import Final

from ai.nn.layers import Layer

MOST_LAYERS: Final = 500
MOST_PARAMETERS: Final = 12_000_000
WIDEST: Final = 1 << 18  # values that a layer may make of one example
MOST_WORK: Final = 1_000_000_000  # multiplications for one example


def check_budget(before: Sequence[Layer], layer: Layer) -> None:
    """Raise ValueError if a network would be too large with one more layer; nothing is drawn or made for it."""
    if len(before) >= MOST_LAYERS:
        raise ValueError(f"a network has at most {MOST_LAYERS} layers")
    if _outputs(layer) > WIDEST:
        raise ValueError(f"a layer makes at most {WIDEST:,} values of an example, not {_outputs(layer)}")
    layers = [*before, layer]
    if (parameters := sum(map(parameters_of, layers))) > MOST_PARAMETERS:
        raise ValueError(f"a network has at most {MOST_PARAMETERS:,} parameters, not {parameters}")
    if (work := sum(parameters_of(one) * _places(one) for one in layers)) > MOST_WORK:
        raise ValueError(f"a network takes at most {MOST_WORK:,} multiplications for an example, not {work}")


def parameters_of(layer: Layer) -> int:
    """Return how many numbers a layer learns, without drawing them."""
    return sum(math.prod(shape) for shape in layer.shapes.values())


def _outputs(layer: Layer) -> int:
    outputs = layer.outputs or 0
    return math.prod(outputs) if isinstance(outputs, tuple) else outputs


def _places(layer: Layer) -> int:
    """Return how often each parameter is used for one example: a convolution's once in every window."""
    return math.prod(layer.outputs[:2]) if isinstance(layer.outputs, tuple) else 1
