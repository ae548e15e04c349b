"""Every kind of file and folder the game keeps: how two versions of it are written, and how it is read."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ai.digits.classifier import DigitClassifier
from ai.digits.config import DIGIT_PRESETS
from ai.digits.training import DigitTraining
from ai.environment import finished
from ai.lander.push import KEYS
from ai.nn import FullyConnectedLayer, ModelFormatError, NeuralNetwork
from ai.nn.costs import CostFunctions
from ai.training.config import PRESETS
from ai.training.history import Checkpoint, History, SettingChange, Validation
from ai.training.loop import Training
from ai.training.run import resume, save
from game.core.settings import Settings, SettingsFile
from game.flight import flight_file
from game.flight.flight import Recording, StickHolder
from game.flight.flight_file import Entry, Record
from game.flight.logbook import Records
from game.training.library import Library
from tests.support.points import point

Data = tuple[Any, Any]


@dataclass(frozen=True)
class Subject:
    """A kind of file or folder.

    Attributes:
        write: writes version 0 or 1 of it into a folder.
        read: reads it there, and uses it a little; returns which version it is, or None where it says none.
        refusals: what it may raise.

    """

    name: str
    write: Callable[[Path, int], None]
    read: Callable[[Path], Any]
    refusals: tuple[type[Exception], ...] = ()


def _data() -> Data:
    rng = np.random.default_rng(0)
    return rng.random((160, 28, 28), dtype=np.float32), rng.integers(10, size=160).astype(np.uint8)


def _network(folder: Path, version: int) -> None:
    network = NeuralNetwork(*CostFunctions.use_mse()).add_layer(FullyConnectedLayer(3, 2))
    network.values = np.full_like(network.values, version)
    network.save(folder / "network")


def _read_network(folder: Path) -> Any:
    network = NeuralNetwork.load(folder / "network")
    network.predict(np.zeros(network.layers[0].inputs or 1) if network.layers else np.zeros(1))
    return int(network.values[0]) if len(network.values) else None


def _training(version: int) -> Training:
    config = PRESETS["modern"].changed(hidden=(8,), num_envs=2, replay_size=200, normalise_inputs=True)
    training = Training(config, evaluate_every=0, validation_episodes=1)
    training.episodes = version
    return training


def _run(folder: Path, version: int) -> None:
    training, history = _training(version), History()
    training.best = finished(training.task.trial(training.agent, 1, 0))
    history.append(point(seconds=float(version), decisions=float(version)))
    history.append(Checkpoint(0.0, 0, 0.0, training.agent.network.values.copy(), None))
    history.append(Validation(0, 0.5, 1.0, best=True))
    history.append(SettingChange(0, "discount", 0.9, 0.99))
    save(training, folder / "models" / "run", state=False)
    history.write(folder / "models" / "run")


def _read_run(folder: Path) -> Any:
    """Read a run in all ways there are: in a list, its history, and to go on with."""
    for listed in Library(folder).runs():
        f"{listed.name} {listed.decisions:,} {listed.seconds:.0f} {listed.success or 0:.0%}"
    History.read(folder / "models" / "run")
    training = resume(Training, folder / "models" / "run")
    training.advance()
    if training.best is not None:
        training.best.better_than(training.best)
    return training.episodes


def _digits(folder: Path, version: int) -> None:
    config = DIGIT_PRESETS["modern"].changed(filters=(2,), hidden=(4,), held_out=10, batch_size=30, epochs=4)
    training = DigitTraining(config, 0, _data())
    training.advance()
    training.seconds = float(version)
    save(training, folder / "run")


def _read_digits(folder: Path) -> Any:
    DigitClassifier.load(folder / "run").predict(np.zeros((28, 28)))
    training = resume(DigitTraining, folder / "run", data=_data())
    if not training.done:
        with np.errstate(all="ignore"):
            training.advance()
    return int(training.seconds)


def _settings(folder: Path, version: int) -> None:
    SettingsFile(folder).save(Settings(model=str(version), keys={"up": ["w"]}, unknown={"new": [1, {"a": 2}]}))


def _read_settings(folder: Path) -> Any:
    settings = SettingsFile(folder).load()
    json.dumps(settings.to_dict())
    return int(settings.model) if settings.model in ("0", "1") else None


def _flight(folder: Path, version: int) -> None:
    recording = Recording(version, "random", pushes=list(KEYS), hands=[StickHolder.HUMAN] * len(KEYS))
    entry = Entry(1e9, "CRASHED", 1.0, 0.5, 3.0, 1.0, network="modern", file=f"{version}.json")
    with suppress(FileExistsError):
        flight_file.write(folder / "flights" / entry.file, Record(recording, entry, (0.0, 1.0, 0.0)))
    with (folder / "logbook.jsonl").open("a", encoding="utf-8") as file:
        file.write(2 * (json.dumps(vars(entry)) + "\n"))


def _read_flight(folder: Path) -> Any:
    records = Records(folder)
    for entry in records.entries():
        f"{entry.when:.0f} {entry.score:,} {entry.network}"
    return [records.read(name).recording.seed for name in sorted(records.kept() or {"0.json"})][-1]


SUBJECTS = (
    Subject("network", _network, _read_network, (ModelFormatError,)),
    Subject("run", _run, _read_run, (ModelFormatError,)),
    Subject("digits", _digits, _read_digits, (ModelFormatError,)),
    Subject("settings", _settings, _read_settings),
    Subject("flight", _flight, _read_flight, (ValueError,)),
)
