"""Studies of tiny runs for tests."""

import json
from pathlib import Path

from ai.sweep.plan import Plan
from ai.sweep.space import knob_space
from ai.sweep.study import Study
from ai.sweep.trial import Asked, Trial
from ai.training.gym_task import gym_config

TINY = {"num_envs": 4, "learning_starts": 64, "gradient_steps": 1, "hidden": (16,), "replay_size": 2000}


def tiny_plan(**changes):
    """Return a plan of runs of some tenths of a second each."""
    config = gym_config("CartPole-v1").changed(**TINY)
    space = {name: each.to_json() for name, each in knob_space(config, ["learning_rate", "tau"]).items()}
    told = {
        "kind": "agent", "settings": json.loads(json.dumps(config.to_json())), "space": space, "seeds": (0, 1),
        "budget": 400, "every": 200, "metric": "return", "judge": "median", "search": "tpe", "stop_early": False,
        "trials": 4, "validation": 5,
    }  # fmt: skip
    return Plan(**(told | changes))


def run_alone(plan, asked, parents=b""):
    """Train a trial to its end in this process."""
    trial = Trial(plan, asked, parents)
    while not trial.done:
        trial.step()
    return trial.finish()


def finished_study(folder, trials=2, **changes):
    """Make a study with some finished trials, without Ray."""
    plan = tiny_plan(**changes)
    study = Study.create(folder, plan)
    for number in range(trials):
        params = {"learning_rate": 1e-3 * (number + 1), "tau": 0.01 * (number + 1)}
        study.begin(number, params)
        study.record(*run_alone(plan, Asked(number, params)))
    return study


def networks_in(folder: Path):
    """Return the content of every file of a run that follows from its seed: all but the times that its file tells."""
    found = {}
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            content = path.read_bytes()
            if path.name == "training.json":
                told = json.loads(content)
                del told["seconds"]
                content = json.dumps(told).encode()
            if path.suffix != ".npz":  # an archive tells when it was made; its numbers are compared as files
                found[path.relative_to(folder).as_posix()] = content
    return found
