"""Networks on disk: a folder of `.npy` files and a `config.json` that a person can read. Never pickle.

The reasons are in docs/adr/0004-models-are-folders.md.
"""

import json
from collections.abc import Callable, Mapping
from inspect import signature
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from ai.nn.activations import ACTIVATIONS, Activation
from ai.nn.costs import COSTS, Cost
from ai.nn.dropout import DropoutLayer
from ai.nn.folder import CONFIG, recover_folder
from ai.nn.images import ConvolutionLayer, FlattenLayer, MaxPoolingLayer
from ai.nn.layers import ActivationLayer, DuelingLayer, FullyConnectedLayer, Layer, LayerNormalisation, check_fit
from ai.nn.parameter import Array, Parameter

T = TypeVar("T")
L = TypeVar("L", bound=Layer)

FORMAT = "tranquility network"
VERSION = 1
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
        super().__init__("\n  - ".join([f"no readable model in {folder}:", *problems]))
        self.folder = Path(folder)
        self.problems = problems


def write_network(folder: Path, cost: Cost, layers: list[Layer], dtype: npt.DTypeLike) -> None:
    """Write a network's files into an existing folder; raises ValueError if it cannot be saved."""
    config = {
        "format": FORMAT,
        "version": VERSION,
        "dtype": np.dtype(dtype).name,
        "cost": _described(cost),
        "layers": [_write_layer(folder, index, layer) for index, layer in enumerate(layers)],
    }
    (folder / CONFIG).write_text(json.dumps(config, indent=2) + "\n", encoding="utf-8")


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
    config = _attempt(problems, CONFIG, _read_config, folder)
    if config is None:
        raise ModelFormatError(folder, problems)

    dtype = config.get("dtype")
    if dtype not in DTYPES:
        problems.append(f"{CONFIG}: dtype is {dtype!r}, not one of {', '.join(DTYPES)}")
    cost = _attempt(problems, f"{CONFIG}: cost", _named, COSTS, config.get("cost"))
    descriptions = config.get("layers")
    if not isinstance(descriptions, list):
        problems.append(f"{CONFIG}: layers is to be a list")
        descriptions = []
    layers: list[Layer] = []
    for index, description in enumerate(descriptions):
        where = f"{CONFIG}: layer {index}"
        layer = _attempt(problems, where, _make_layer, description)
        if layer is None:
            continue
        _attempt(problems, where, check_fit, layers, layer)
        layers.append(layer)
        arrays = {
            name: _attempt(problems, where, _read_array, folder, description, name, f"{dtype} {list(shape)}")
            for name, shape in layer.shapes.items()
        }
        layer.parameters = tuple(
            Parameter(name, array, np.zeros_like(array)) for name, array in arrays.items() if array is not None
        )
    if problems or cost is None:
        raise ModelFormatError(folder, problems)
    return cost, layers, str(dtype)


def _attempt(problems: list[str], where: str, read: Callable[..., T], *arguments: object) -> T | None:
    """Return what `read` returns, or note what it raises; damage can surface as any exception."""
    try:
        return read(*arguments)
    except OSError as error:
        name = Path(error.filename or where).name
        asked = "" if name == where else f", and {where} asks for it"
        problems.append(f"{name}: {error.strerror or error}{asked}")
    except Exception as error:
        problems.append(f"{where}: {error or type(error).__name__}")
    return None


def _read_config(folder: Path) -> dict[str, Any]:
    if not folder.is_dir():
        raise ValueError("this is a file, not a folder" if folder.exists() else "there is no such folder")
    config = json.loads((folder / CONFIG).read_text(encoding="utf-8"))
    if not isinstance(config, dict) or config.get("format") != FORMAT:
        raise ValueError(f"does not say that this is a {FORMAT!r}")
    if config.get("version") != VERSION:
        raise ValueError(f"format version {config.get('version')!r}; this program reads version {VERSION}")
    return config


def _make_layer(description: Any) -> Layer:
    name = _required(description, "type")
    if name not in LAYERS:
        raise ValueError(f"unknown type {name!r}; known are {', '.join(LAYERS)}")
    kind = LAYERS[name]
    settings = {setting: _required(description, setting) for setting in kind.settings}
    if "activation" in settings:
        settings["activation"] = _named(ACTIVATIONS, settings["activation"])
    return kind(**settings)


def _named(table: Mapping[str, Callable[..., T]], description: Any) -> T:
    """Return the cost or activation of a description such as {"name": "huber", "delta": 1.0}."""
    name = _required(description, "name")
    if name not in table:
        raise ValueError(f"unknown name {name!r}; known are {', '.join(table)}")
    make = table[name]
    return make(**{option: _required(description, option) for option in signature(make).parameters})


def _required(description: Any, name: str) -> Any:
    if not isinstance(description, dict) or name not in description:
        raise ValueError(f"{name} is missing")
    return description[name]


def _read_array(folder: Path, description: Any, name: str, wanted: str) -> Array:
    """Return a parameter whose dtype and shape, as in "float32 [9, 128]", are as wanted."""
    entry = _required(_required(description, "arrays"), name)
    file = _required(entry, "file")
    if Path(file).name != file:
        raise ValueError(f"{name}: {file!r} is not a file of this folder")
    try:
        # Mapped, a header that promises more than the file holds is an error, not an allocation.
        array = np.lib.format.open_memmap(folder / file, mode="r")
    except OSError:
        raise  # names the file itself
    except Exception as error:
        raise ValueError(f"{file}: {error}") from error
    said = f"{entry.get('dtype')} {entry.get('shape')}"
    held = f"{array.dtype.name} {list(array.shape)}"
    if not said == held == wanted:
        raise ValueError(f"{file} holds {held}, is said to hold {said}, and should hold {wanted}")
    if not np.isfinite(array).all():
        raise ValueError(f"{file} holds numbers that are not finite")
    return np.array(array, order="C")
