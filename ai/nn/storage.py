"""Networks on disk: a folder of `.npy` files and a `config.json` that a person can read. Never pickle.

The reasons are in docs/adr/0004-models-are-folders.md.
"""

import json
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from inspect import signature
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from ai.files.folder import CONFIG, NETWORK, atomic_folder, recover_folder
from ai.files.reading import brief, inside, problem_in, read_array, read_json, shown
from ai.files.schema import check_header
from ai.nn.activations import ACTIVATIONS, Activation
from ai.nn.costs import COSTS, Cost
from ai.nn.images import ConvolutionLayer, FlattenLayer, MaxPoolingLayer
from ai.nn.layer import Layer, check_next
from ai.nn.layers import ActivationLayer, DropoutLayer, DuelingLayer, FullyConnectedLayer, LayerNormalisation
from ai.nn.parameter import Array, Parameter

T = TypeVar("T")
L = TypeVar("L", bound=Layer)

FORMAT = NETWORK.format
VERSION = 1
DTYPES = ("float32", "float64")
LAYERS: dict[str, type[Layer]] = {
    kind.__name__: kind
    for kind in (
        FullyConnectedLayer,
        DuelingLayer,
        ActivationLayer,
        LayerNormalisation,
        DropoutLayer,
        ConvolutionLayer,
        MaxPoolingLayer,
        FlattenLayer,
    )
}


def register_layer(kind: type[L]) -> type[L]:
    """Let networks with layers of your own kind be saved and loaded, under the name of the class.

    Takes the class and returns it, so it may stand above it as a decorator. What the constructor needs is named in
    the class's `settings`. Raises ValueError for a name that another kind has.
    """
    if LAYERS.setdefault(kind.__name__, kind) is not kind:
        raise ValueError(f"there is another kind of layer called {kind.__name__}")
    return kind


class ModelFormatError(ValueError):
    """A folder is not a model that can be read: `problem` is the first thing found wrong with it."""

    def __init__(self, folder: str | Path, problem: str) -> None:
        super().__init__(f"no readable model in {folder}: {brief(problem)}")
        self.problem = problem


@contextmanager
def reading(folder: str | Path, part: str) -> Iterator[None]:
    """Raise whatever goes wrong with a part of a folder as a ModelFormatError; damage can surface as any exception."""
    try:
        yield
    except ModelFormatError as error:
        raise ModelFormatError(folder, f"{part}: {error.problem}") from error
    except OSError as error:
        raise ModelFormatError(folder, f"{Path(error.filename or part).name}: {error.strerror or error}") from error
    except Exception as error:
        raise ModelFormatError(folder, f"{part}: {problem_in(error)}") from error


def save_network(folder: str | Path, cost: Cost, layers: list[Layer], dtype: npt.DTypeLike) -> None:
    """Write a network to a folder, whole or not at all; raises as `NeuralNetwork.save` says."""
    with atomic_folder(folder) as temporary:
        config = {
            "format": FORMAT,
            "version": VERSION,
            "dtype": np.dtype(dtype).name,
            "cost": _described(cost),
            "layers": [_write_layer(temporary, index, layer) for index, layer in enumerate(layers)],
        }
        (temporary / CONFIG).write_text(json.dumps(config, indent=2, allow_nan=False) + "\n", encoding="utf-8")


def _write_layer(folder: Path, index: int, layer: Layer) -> dict[str, Any]:
    name = type(layer).__name__
    if LAYERS.get(name) is not type(layer):
        raise ValueError(f"layer {index}, a {name}, could not be loaded again: tell ai.nn.register_layer of its class")
    arrays = {}
    for parameter in layer.parameters:
        if not np.isfinite(parameter.value).all():
            raise ValueError(f"layer {index} has {parameter.name} that are not finite; nothing is saved")
        file = f"layer-{index}-{parameter.name}.npy"
        np.save(folder / file, parameter.value, allow_pickle=False)
        shape, dtype = list(parameter.value.shape), parameter.value.dtype.name
        arrays[parameter.name] = {"file": file, "shape": shape, "dtype": dtype}
    settings = {name: _described(value) for name, value in layer.arguments().items()}
    return {"type": name, **settings, "arrays": arrays}


def _described(value: object) -> object:
    if not isinstance(value, Activation | Cost):
        return value
    if value.name is None:
        raise ValueError(
            f"a plain {type(value).__name__.lower()} has no name to save it by; "
            "only those of ActivationFunctions and CostFunctions have"
        )
    return {"name": value.name, **value.options}


def read_network(folder: str | Path) -> tuple[Cost, list[Layer], str]:
    """Read cost, layers and dtype; raises ModelFormatError."""
    folder = Path(folder)
    recover_folder(folder)
    with reading(folder, CONFIG):
        if not folder.is_dir():
            raise ValueError("this is a file, not a folder" if folder.exists() else "there is no such folder")
        config = check_header(read_json(inside(folder, CONFIG)), FORMAT, VERSION)
        dtype = config["dtype"]
        if dtype not in DTYPES:
            raise ValueError(f"dtype is {shown(dtype)}, not one of {', '.join(DTYPES)}")
        cost = _named(COSTS, config["cost"])
        descriptions = config["layers"]
        if not isinstance(descriptions, list):
            raise ValueError("layers is to be a list")
    layers: list[Layer] = []
    for index, description in enumerate(descriptions):
        with reading(folder, f"{CONFIG}: layer {index}"):
            layer = _make_layer(description)
            check_next(layers, layer)
            arrays = [_read_array(folder, description, name, shape, dtype) for name, shape in layer.shapes.items()]
            layer.parameters = tuple(Parameter(*each, np.zeros(0)) for each in zip(layer.shapes, arrays, strict=True))
            layers.append(layer)
    return cost, layers, dtype


def _make_layer(description: Any) -> Layer:
    name = description["type"]
    if name not in LAYERS:
        raise ValueError(f"unknown type {shown(name)}; known are {', '.join(LAYERS)}")
    kind = LAYERS[name]
    if unknown := sorted(description.keys() - {"type", "arrays", *kind.settings}):
        raise ValueError(f"a {name} has no {', '.join(unknown)}")
    settings = {setting: description[setting] for setting in kind.settings}
    if "activation" in settings:
        settings["activation"] = _named(ACTIVATIONS, settings["activation"])
    return kind(**settings)


def _named(table: Mapping[str, Callable[..., T]], description: Any) -> T:
    """Return the cost or activation of a description such as {"name": "huber", "delta": 1.0}."""
    name = description["name"]
    if name not in table:
        raise ValueError(f"unknown name {shown(name)}; known are {', '.join(table)}")
    make = table[name]
    return make(**{option: description[option] for option in signature(make).parameters})


def _read_array(folder: Path, description: Any, name: str, shape: tuple[int, ...], dtype: str) -> Array:
    """Return a parameter's array; raises ValueError if it is not as the layer and the folder say."""
    entry = description["arrays"][name]
    file = entry["file"]
    if not isinstance(file, str) or Path(file).name != file:
        raise ValueError(f"{name}: {shown(file)} is not a file of this folder")
    if (entry["shape"], entry["dtype"]) != (list(shape), dtype):
        raise ValueError(f"{file} is not said to hold {dtype} {list(shape)}")
    with reading(folder, file):
        return read_array(inside(folder, file), shape, dtype)
