"""Studies of tiny runs for tests."""

import json
from pathlib import Path

from ai.sweep.design import Design, Measurement
from ai.sweep.study import SeedResult, Study, Trial
from ai.training.config import gym_config

TINY = {"num_envs": 4, "learning_starts": 64, "gradient_steps": 1, "hidden": (16,), "replay_size": 2000}


def tiny_design(**changes):
    """Return a design of runs of some tenths of a second each."""
    config = gym_config("CartPole-v1").changed(**TINY)
    values = {"decisions": 400, "every": 200, "metric": "return", "seeds": 2, "trials": 4, "validation": 5}
    return Design.of(config, ("learning_rate", "tau", "double"), **(values | changes))


def result(number=0, value=1.0, **changes):
    """Return a finished trial of such a design."""
    params = {"learning_rate": 1e-3 * (number + 1), "tau": 0.01 * (number + 1), "double": number % 2 == 0}
    seeds = tuple(
        SeedResult(seed, (Measurement(200, 0.0, value), Measurement(400, 0.5, value)), value - seed) for seed in (0, 1)
    )
    return Trial(**({"number": number, "params": params, "value": value, "seconds": 1.0, "seeds": seeds} | changes))


def made_study(folder: Path):
    """Make a study of which two trials of four are finished, without training."""
    study = Study.create(folder, tiny_design())
    study.record(result(0, 5.0), {"seed-0/config.json": b"{}", "seed-1/config.json": b"{}"})
    study.record(result(1, 7.5), {"seed-0/config.json": b"{}"})
    return study


def networks_in(folder: Path):
    """Return the content of every file of a run that follows from its seed: all but the times that its file tells."""
    found = {}
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            content = path.read_bytes()
            if path.name == "training.json":
                values = json.loads(content)
                del values["seconds"]
                content = json.dumps(values).encode()
            if path.suffix != ".npz":  # an archive tells when it was made; its numbers are compared as files
                found[path.relative_to(folder).as_posix()] = content
    return found
