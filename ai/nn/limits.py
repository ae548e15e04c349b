"""Limits of networks: a small file must not be able to ask for more than a machine has."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ai.nn.layer import Layer

ImageShape = tuple[int, int, int]  # height, width, channels

MAX_SIZE = 1 << 20  # of any one size
MOST_LAYERS = 500
MOST_PARAMETERS = 12_000_000  # an agent of so many, two networks with gradients and an optimizer, takes 430 MB to load
WIDEST = 1 << 18  # values that a layer may make of one example
MOST_WORK = 1_000_000_000  # multiplications for one example


def check_next(before: Sequence[Layer], layer: Layer) -> None:
    """Raise ValueError if a layer does not take what those before it give, or makes the network too large."""
    given = next((one.outputs for one in reversed(before) if one.outputs is not None), None)
    if None not in (given, layer.inputs) and given != layer.inputs:
        kind = type(layer).__name__
        raise ValueError(f"{kind} takes {_said(layer.inputs)}, the layer before gives {_said(given)}")
    layers = [*before, layer]
    width = math.prod(layer.outputs) if isinstance(layer.outputs, tuple) else layer.outputs or 0
    parameters = [sum(map(math.prod, one.shapes.values())) for one in layers]
    # A convolution uses each of its parameters in every window.
    windows = [math.prod(one.outputs[:2]) if isinstance(one.outputs, tuple) else 1 for one in layers]
    work = sum(count * places for count, places in zip(parameters, windows, strict=True))
    if len(layers) > MOST_LAYERS:
        raise ValueError(f"a network has at most {MOST_LAYERS} layers")
    if width > WIDEST:
        raise ValueError(f"a layer makes at most {WIDEST:,} values of an example, not {width}")
    if sum(parameters) > MOST_PARAMETERS:
        raise ValueError(f"a network has at most {MOST_PARAMETERS:,} parameters, not {sum(parameters)}")
    if work > MOST_WORK:
        raise ValueError(f"a network takes at most {MOST_WORK:,} multiplications for an example, not {work}")


def _said(shape: int | ImageShape | None) -> str:
    return "images of {} x {} x {}".format(*shape) if isinstance(shape, tuple) else f"{shape} values"


def checked_size(name: str, size: int) -> int:
    """Return a size as a plain int; raises ValueError if it is none."""
    if isinstance(size, bool) or not isinstance(size, int | np.integer) or not 1 <= size <= MAX_SIZE:
        raise ValueError(f"{name} is a whole number from 1 to {MAX_SIZE}, not {size!r}")
    return int(size)
