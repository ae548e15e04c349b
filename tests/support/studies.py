"""Studies of tiny runs for tests."""

import json
import shutil
from pathlib import Path

from ai.sweep.plan import Plan, Point, knob_space
from ai.sweep.study import Asked, FinishedTrial, SeedResult, Study, files_in
from ai.sweep.trial import Trial
from ai.training.config import PRESETS, gym_config
from game.core.assets import MODELS_DIR

TINY = {"num_envs": 4, "learning_starts": 64, "gradient_steps": 1, "hidden": (16,), "replay_size": 2000}


def tiny_plan(**changes):
    """Return a plan of runs of some tenths of a second each."""
    config = gym_config("CartPole-v1").changed(**TINY)
    space = knob_space(config, ["learning_rate", "tau"])
    values = {
        "kind": "agent", "settings": json.loads(json.dumps(config.to_json())), "space": space, "seeds": (0, 1),
        "budget": 400, "every": 200, "metric": "return", "search": "tpe", "stop_early": False,
        "trials": 4, "validation": 5,
    }  # fmt: skip
    return Plan(**(values | changes))


def run_alone(plan, asked, parent=None, runs=None):
    """Train a trial to its end in this process."""
    trial = Trial(plan, asked, parent, runs)
    while not trial.done:
        trial.step()
    return trial.finish()


def finished_study(folder, trials=2, **changes):
    """Make a study with some finished trials, without Ray."""
    plan = tiny_plan(**changes)
    study = Study.create(folder, plan)
    for number in range(trials):
        params = {"learning_rate": 1e-3 * (number + 1), "tau": 0.01 * (number + 1)}
        study.record(*run_alone(plan, Asked(number, params)))
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


def shown_study(folder, trials=9):
    """Make a study of the lander for a screen, without training: its networks are the one that comes with the game."""
    space = knob_space(PRESETS["modern"], ["learning_rate", "tau", "optimizer"])
    plan = Plan(
        "agent", json.loads(json.dumps(PRESETS["modern"].to_json())),
        space, (0, 1), 160, 40, "time_to_99", "tpe", True,
        trials + 3,
    )  # fmt: skip
    study = Study.create(folder, plan)
    shutil.copytree(MODELS_DIR / "lander" / "modern", folder / "seed-0")
    shutil.move(folder / "seed-0", folder / "run" / "seed-0")
    runs = files_in(folder / "run")
    shutil.rmtree(folder / "run")
    for number in range(trials):
        share, stopped = 1 - abs(number - 3) / 10, number == trials - 1
        seeds = tuple(
            SeedResult(seed, tuple(Point(40 * step, max(0.0, share * step / 4 - 0.02 * seed), 1.0)
                                   for step in range(1, 5)), 40.0 * (number + 1 + seed), "", 1.0,
                       {} if stopped or seed else {"success": share})
            for seed in (0, 1)
        )  # fmt: skip
        params = {
            "learning_rate": 10 ** (-4 + number / 4),
            "tau": 0.001 * (number + 1),
            "optimizer": ("adam", "sgd")[number % 2],
        }
        trial = FinishedTrial(number, params, 40.0 * (number + 1), 160, stopped, 2.0, seeds)
        study.record(trial, {} if stopped else runs)
    study.importance = {"learning_rate": 0.71, "optimizer": 0.12, "tau": 0.03}
    study.write()
    return study
