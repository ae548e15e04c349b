"""Networks on disk: a folder of `.npy` files and a `config.json` that a person can read. Never pickle.

The reasons are in docs/adr/0004-models-are-folders.md.
"""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from inspect import signature
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from ai.files import (
    CONFIG,
    NETWORK,
    atomic_folder,
    brief,
    check_header,
    inside,
    problem_in,
    read_array,
    read_json,
    recover_folder,
    shown,
)
from ai.nn.activations import ACTIVATIONS, Activation
from ai.nn.costs import COSTS, Cost
from ai.nn.images import ConvolutionLayer, FlattenLayer, MaxPoolingLayer
from ai.nn.layer import MOST_LAYERS, Layer, check_next
from ai.nn.layers import ActivationLayer, DropoutLayer, DuelingLayer, FullyConnectedLayer, LayerNormalisation
from ai.nn.parameter import Array, Parameter

T = TypeVar("T")
L = TypeVar("L", bound=Layer)

FORMAT = NETWORK.format
VERSION = 1
_NAMED = 20  # problems that a message names
DTYPES = ("float32", "float64")
LAYERS: dict[str, type[Layer]] = {
    "FullyConnectedLayer": FullyConnectedLayer,
    "DuelingLayer": DuelingLayer,
    "ActivationLayer": ActivationLayer,
    "LayerNormalisation": LayerNormalisation,
    "DropoutLayer": DropoutLayer,
    "ConvolutionLayer": ConvolutionLayer,
    "MaxPoolingLayer": MaxPoolingLayer,
    "FlattenLayer": FlattenLayer,
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
    """A folder is not a model that can be read; `problems` lists all that is wrong with it."""

    def __init__(self, folder: str | Path, problems: list[str]) -> None:
        more = [f"and {len(problems) - _NAMED:,} more"] if len(problems) > _NAMED else []
        self.problems = [*map(brief, problems[:_NAMED]), *more]
        super().__init__("\n  - ".join([f"no readable model in {folder}:", *self.problems]))
        self.folder = Path(folder)


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
    """Read cost, layers and dtype; raises ModelFormatError, which names all that is wrong with the folder."""
    folder = Path(folder)
    recover_folder(folder)
    problems: list[str] = []
    with noted(problems, CONFIG):
        config = _read_config(folder)
    if problems:
        raise ModelFormatError(folder, problems)
    dtype, descriptions = config.get("dtype"), config.get("layers")
    if dtype not in DTYPES:
        problems.append(f"{CONFIG}: dtype is {shown(dtype)}, not one of {', '.join(DTYPES)}")
    with noted(problems, f"{CONFIG}: cost"):
        cost = _named(COSTS, config.get("cost"))
    if not isinstance(descriptions, list):
        problems.append(f"{CONFIG}: layers is to be a list")
        descriptions = []
    layers: dict[int, Layer] = {}
    for index, description in enumerate(descriptions[: MOST_LAYERS + 1]):
        with noted(problems, f"{CONFIG}: layer {index}"):
            layer = _make_layer(description)
            check_next(list(layers.values()), layer)
            layers[index] = layer
    for index, layer in layers.items() if dtype in DTYPES else ():
        parameters = []
        for name, shape in layer.shapes.items():
            with noted(problems, f"{CONFIG}: layer {index}"):
                array = _read_array(folder, descriptions[index], name, shape, str(dtype))
                parameters.append(Parameter(name, array))
        layer.parameters = tuple(parameters)
    if problems:
        raise ModelFormatError(folder, problems)
    return cost, list(layers.values()), str(dtype)


@contextmanager
def noted(problems: list[str], place: str) -> Iterator[None]:
    """Add what is wrong at a place to `problems`, instead of raising it; damage can surface as any exception."""
    try:
        yield
    except ModelFormatError as error:
        problems += [f"{place}: {problem}" for problem in error.problems]
    except OSError as error:
        name = Path(error.filename or place).name
        asked = "" if name == place else f", and {place} asks for it"
        problems.append(f"{name}: {error.strerror or error}{asked}")
    except Exception as error:
        problems.append(f"{place}: {problem_in(error)}")


def _read_config(folder: Path) -> dict[str, Any]:
    if not folder.is_dir():
        raise ValueError("this is a file, not a folder" if folder.exists() else "there is no such folder")
    return check_header(read_json(inside(folder, CONFIG)), FORMAT, VERSION)


def _make_layer(description: Any) -> Layer:
    name = _required(description, "type")
    if name not in LAYERS:
        raise ValueError(f"unknown type {shown(name)}; known are {', '.join(LAYERS)}")
    kind = LAYERS[name]
    if unknown := sorted(description.keys() - {"type", "arrays", *kind.settings}):
        raise ValueError(f"a {name} has no {brief(', '.join(unknown))}")
    settings = {setting: _required(description, setting) for setting in kind.settings}
    if "activation" in settings:
        settings["activation"] = _named(ACTIVATIONS, settings["activation"])
    return kind(**settings)


def _named(table: Mapping[str, Callable[..., T]], description: Any) -> T:
    """Return the cost or activation of a description such as {"name": "huber", "delta": 1.0}."""
    name = _required(description, "name")
    if name not in table:
        raise ValueError(f"unknown name {shown(name)}; known are {', '.join(table)}")
    make = table[name]
    return make(**{option: _required(description, option) for option in signature(make).parameters})


def _required(description: Any, name: str) -> Any:
    if not isinstance(description, dict) or name not in description:
        raise ValueError(f"{name} is missing")
    return description[name]


def _read_array(folder: Path, description: Any, name: str, shape: Sequence[int], dtype: str) -> Array:
    """Return a parameter's array; raises OSError or ValueError if it is not as the layer and the folder say."""
    entry = _required(_required(description, "arrays"), name)
    file = _required(entry, "file")
    if not isinstance(file, str) or Path(file).name != file:
        raise ValueError(f"{name}: {shown(file)} is not a file of this folder")
    said = {key: entry.get(key) for key in ("shape", "dtype")}
    if said != {"shape": list(shape), "dtype": dtype}:
        raise ValueError(f"{file} is said to hold {brief(said, 60)}, and should hold {dtype} {list(shape)}")
    array: Array = read_array(inside(folder, file), tuple(shape), dtype)
    if not np.isfinite(array).all():
        raise ValueError(f"{file} holds numbers that are not finite")
    return array
