"""An agent on disk: a folder with its settings and counts, both networks, and the state of its optimizer.

Its replay buffers and its random generator are not kept.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

from ai.agent.config import AgentConfig
from ai.files.folder import NETWORK, OF_A_RUN, FolderKind, recover_folder
from ai.files.reading import count_of, inside, read_arrays, read_json
from ai.files.schema import check_header
from ai.nn import NeuralNetwork
from ai.nn.layer import MOST_VALUES
from ai.nn.storage import reading

if TYPE_CHECKING:
    from ai.agent.agent import DeepQAgent

A = TypeVar("A", bound="DeepQAgent")

FORMAT: Final = "tranquility agent"
VERSION: Final = 1
AGENT_FILE: Final = "config.json"
OPTIMIZER_FILE: Final = "optimizer.npz"
LAST: Final = "last"  # folder within a run's: the agent to resume from
_ALONE: Final = FolderKind(FORMAT, (AGENT_FILE, OPTIMIZER_FILE, *NETWORK.within("online"), *NETWORK.within("target")))
KIND: Final = FolderKind(FORMAT, (*_ALONE.files, *OF_A_RUN, *_ALONE.within(LAST)))
_SLACK: Final = 1 << 16  # bytes of an archive beside its numbers


def write_agent(agent: DeepQAgent, folder: Path) -> None:
    """Write an agent's files into a new folder; `DeepQAgent.save` does so safely. Raises OSError."""
    described = {
        "format": FORMAT,
        "version": VERSION,
        "features": agent.num_features,
        "actions": agent.num_actions,
        "decisions": agent.decisions,
        "gradient_steps": agent.gradient_steps,
        "config": {**agent.config.to_json(), **agent.run_settings},
    }
    if agent.normalizer:
        described["scale"] = agent.normalizer.to_json()
    folder.mkdir(parents=True, exist_ok=True)
    agent.online.save(folder / "online")
    agent.target.save(folder / "target")
    np.savez(folder / OPTIMIZER_FILE, allow_pickle=False, **agent.optimizer.state())
    (folder / AGENT_FILE).write_text(json.dumps(described, indent=2, allow_nan=False) + "\n", encoding="utf-8")


def read_agent(folder: str | Path, make: Callable[[int, int, AgentConfig], A]) -> A:
    """Read what `write_agent` wrote; `make` makes the agent of its numbers of features and actions and its settings.

    Raises ModelFormatError, which names what is wrong.
    """
    folder = Path(folder)
    recover_folder(folder)
    with reading(folder, AGENT_FILE):
        agent = _read_description(folder, make)
    for name in ("online", "target"):
        with reading(folder, name):
            network = NeuralNetwork.load(inside(folder, name))
            if _sizes(network) != _sizes(agent.online):
                raise ValueError("its sizes are not those of the agent's settings")
            setattr(agent, name, network)
    with reading(folder, OPTIMIZER_FILE):
        values = agent.online.values
        most = (len(agent.optimizer.remembers) + 1) * values.nbytes + _SLACK
        agent.optimizer.load_state(read_arrays(inside(folder, OPTIMIZER_FILE), most), values)
    agent.folder = folder
    return agent


def _read_description(folder: Path, make: Callable[[int, int, AgentConfig], A]) -> A:
    """Make an agent as the file of settings and counts describes it."""
    described = check_header(read_json(inside(folder, AGENT_FILE)), FORMAT, VERSION)
    settings = dict(described["config"])
    if missing := AgentConfig.names() - settings.keys():
        raise ValueError(f"settings are missing: {', '.join(sorted(missing))}")
    run_settings = {name: settings.pop(name) for name in settings.keys() - AgentConfig.names()}
    features, actions = (count_of(described[name], 1, MOST_VALUES) for name in ("features", "actions"))
    agent = make(features, actions, AgentConfig.from_json(settings))
    agent.run_settings = run_settings
    agent.decisions = count_of(described["decisions"])
    agent.gradient_steps = count_of(described["gradient_steps"])
    if agent.normalizer:
        agent.normalizer.load(described["scale"])
    return agent


def _sizes(network: NeuralNetwork) -> list[Any]:
    """Return the dtype, layer types and shapes, which two networks must share to take each other's parameters."""
    return [network.dtype, *((type(layer), dict(layer.shapes)) for layer in network.layers)]
