"""An agent on disk: a folder with its settings and counts, both networks, and the state of its optimizer.

The format knows the parts of an agent, not the agent: `ai.agent.agent` turns itself into a `SavedAgent` and back.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from ai.agent.config import AgentConfig
from ai.agent.network import build_network, make_optimizer
from ai.agent.normalizer import Normalizer
from ai.common.environment import Floats
from ai.files import NETWORK, FolderKind, check_header, count_of, inside, problem_in, read_arrays, read_json
from ai.nn import ModelFormatError, NeuralNetwork, atomic_folder, recover_folder
from ai.nn.budget import WIDEST
from ai.nn.optimizers import Optimizer

FORMAT: Final = "tranquility agent"
VERSION: Final = 1
AGENT_FILE: Final = "config.json"
OPTIMIZER_FILE: Final = "optimizer.npz"
LAST: Final = "last"  # folder within a run's: the agent to resume from
_OLD: Final = FolderKind("tranquility safety critic", (), {"network": NETWORK})  # earlier versions kept one beside it
_PARTS: Final = {"online": NETWORK, "target": NETWORK, "guardian": _OLD}
_ALONE: Final = FolderKind(FORMAT, (OPTIMIZER_FILE,), _PARTS)
KIND: Final = FolderKind(FORMAT, (OPTIMIZER_FILE, "training.json", "history.npz"), {**_ALONE.folders, LAST: _ALONE})
_SLACK: Final = 1 << 16  # bytes of an archive beside its numbers


@dataclass
class SavedAgent:
    """All that is saved of an agent: everything but its replay buffers and its random generator."""

    num_features: int
    num_actions: int
    config: AgentConfig
    run_settings: dict[str, Any]  # of the run it is from, by name: kept as they are, for what is above to read
    decisions: int  # taken so far
    train_count: int  # gradient steps taken so far
    online: NeuralNetwork
    target: NeuralNetwork
    optimizer: Optimizer
    normalizer: Normalizer | None  # of observations; None unless `config.normalise_inputs`


def save_agent(agent: SavedAgent, folder: str | Path) -> None:
    """Write an agent to a folder, whole or not at all.

    Raises OSError if it cannot be written, FileExistsError if the folder holds something else.
    """
    with atomic_folder(folder, KIND) as temporary:
        write_agent(agent, temporary)


def write_agent(agent: SavedAgent, folder: Path) -> None:
    """Write an agent's files into a new folder; `save_agent` does so safely. Raises OSError."""
    described = {
        "format": FORMAT,
        "version": VERSION,
        "features": agent.num_features,
        "actions": agent.num_actions,
        "decisions": agent.decisions,
        "train_count": agent.train_count,
        "config": {**agent.config.to_json(), **agent.run_settings},
    }
    if agent.normalizer:
        described["scale"] = agent.normalizer.to_json()
    folder.mkdir(parents=True, exist_ok=True)
    agent.online.save(folder / "online")
    agent.target.save(folder / "target")
    np.savez(folder / OPTIMIZER_FILE, allow_pickle=False, **agent.optimizer.state())
    (folder / AGENT_FILE).write_text(json.dumps(described, indent=2) + "\n", encoding="utf-8")


def read_agent(folder: str | Path) -> SavedAgent:
    """Read what `save_agent` wrote. Raises ModelFormatError, which names everything that is wrong."""
    folder = Path(folder)
    recover_folder(folder)
    described = _read_description(folder)
    try:
        settings = AgentConfig.renamed(described["config"])
        run_settings = {name: settings.pop(name) for name in settings.keys() - AgentConfig.names()}
        config = AgentConfig.from_json(settings)
        features, actions = (count_of(described[name], 1, WIDEST) for name in ("features", "actions"))
        network = build_network(features, actions, config, np.random.default_rng(0))
        decisions, train_count = count_of(described["decisions"]), count_of(described["train_count"])
        normalizer = Normalizer(features) if config.normalise_inputs else None
        if normalizer:
            normalizer.load(described["scale"])
    except (KeyError, TypeError, ValueError, ArithmeticError) as error:
        raise ModelFormatError(folder, [f"{AGENT_FILE}: {problem_in(error)}"]) from error
    problems: list[str] = []
    online, target = (_read_network(folder, name, network, problems) for name in ("online", "target"))
    optimizer = make_optimizer(config)
    try:
        optimizer.load_state(_read_state(inside(folder, OPTIMIZER_FILE), optimizer, network.values), network.values)
    except OSError as error:
        problems.append(f"{OPTIMIZER_FILE}: {error.strerror or error}")
    except (ValueError, KeyError) as error:
        problems.append(f"{OPTIMIZER_FILE}: {problem_in(error)}")
    if problems:
        raise ModelFormatError(folder, problems)
    return SavedAgent(features, actions, config, run_settings, decisions, train_count,
                      online, target, optimizer, normalizer)  # fmt: skip


def _read_description(folder: Path) -> dict[str, Any]:
    """Read the file of settings and counts; raises ModelFormatError unless it is of this format and version."""
    try:
        return check_header(read_json(inside(folder, AGENT_FILE)), FORMAT, (VERSION,))
    except OSError as error:
        raise ModelFormatError(folder, [f"{AGENT_FILE}: {error.strerror or error}"]) from error
    except ValueError as error:
        raise ModelFormatError(folder, [f"{AGENT_FILE}: {error}"]) from error


def _read_network(folder: Path, name: str, like: NeuralNetwork, problems: list[str]) -> NeuralNetwork:
    """Read a network of the sizes of `like`; return that itself, and add to `problems`, if there is none."""
    try:
        network = NeuralNetwork.load(inside(folder, name))
        if _sizes(network) == _sizes(like):
            return network
        problems.append(f"{name}: its sizes are not those of the agent's settings")
    except ModelFormatError as error:
        problems += [f"{name}: {problem}" for problem in error.problems]
    except OSError as error:
        problems.append(f"{name}: {error.strerror or error}")
    return like


def _sizes(network: NeuralNetwork) -> list[Any]:
    """Return the dtype, layer types and shapes, which two networks must share to take each other's parameters."""
    return [network.dtype, *((type(layer), dict(layer.shapes)) for layer in network.layers)]


def _read_state(path: Path, optimizer: Optimizer, values: Floats) -> dict[str, Any]:
    """Read the arrays of an optimizer of the parameters `values`; raises OSError, or ValueError for any others."""
    remembers = optimizer.remembers

    def expect(name: str, shape: tuple[int, ...], dtype: np.dtype[Any]) -> None:
        steps = name == "steps" and shape == () and dtype.kind in "iu"
        if not steps and not (
            name in remembers and shape == values.shape and dtype.kind == "f" and dtype.itemsize <= 8
        ):
            raise ValueError(f"{name} is no state of {type(optimizer).__name__} of {len(values):,} parameters")

    return read_arrays(path, len(remembers) * values.size * 8 + _SLACK, expect)
