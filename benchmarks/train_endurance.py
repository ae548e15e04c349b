"""Kill the training's process at random moments, then come and go, and see what is lost or left behind.

    python -m benchmarks.train_endurance [--kills 50] [--visits 10]

Each round starts a run in the game, saves it under a name at some moment, and kills its process at another, often
in the middle of a save. The game has to say why and go on, and every run that the library lists afterwards has to
load and to be ready to go on. Then the scene is entered, started and left again and again: no process and no
thread may stay, nor may the game's memory grow. Exit code 1 if any of that fails.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
os.environ["SDL_AUDIODRIVER"] = "dummy"

import argparse
import gc
import sys
import threading
import time
from collections.abc import Callable
from multiprocessing import active_children
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pygame

from ai.training.config import PRESETS
from ai.training.history import History
from ai.training.loop import Training
from ai.training.run import resume
from game.core.scene import Push
from game.core.settings import Settings
from game.core.worker import WorkerState
from game.scenes import scene_of
from game.scenes.train.scene import TrainScene
from game.shell.app import App
from game.ui.context import Context

PATIENCE = 60.0  # seconds


class Game:
    """The game without a window, with the training screen above the menu."""

    def __init__(self, folder: Path) -> None:
        self.app = App(Context(folder, Settings(), rng=np.random.default_rng(1)), scene_of=scene_of, capped=False)
        self.scene: TrainScene

    def enter(self) -> None:
        """Come in from the menu."""
        self.scene = TrainScene(self.app.context)
        self.app.scenes.apply(Push(self.scene))
        self.scene.knobs.set_config(PRESETS["modern"], 0)

    def leave(self) -> None:
        """Go back to the menu."""
        while self.app.scenes.top is not self.scene:
            self.key(pygame.K_ESCAPE)
        self.key(pygame.K_ESCAPE)

    def key(self, key: int) -> None:
        """Press a key."""
        pygame.event.post(pygame.event.Event(pygame.KEYDOWN, key=key, mod=0, unicode="", scancode=0))
        self.frame()

    def frame(self) -> None:
        """Play one frame."""
        if not self.app.tick():
            raise RuntimeError("the game was closed")
        time.sleep(0.004)

    def rest(self, seconds: float) -> None:
        """Play on for so long."""
        self.wait(lambda: False, seconds)

    def wait(self, until: Callable[[], object], seconds: float = PATIENCE) -> bool:
        """Play until something holds; whether it does."""
        end = time.monotonic() + seconds
        while not until() and time.monotonic() < end:
            self.frame()
        return bool(until())


def kill(game: Game, rounds: int, rng: np.random.Generator) -> list[str]:
    """Kill so many runs; return what went wrong."""
    problems, states = [], dict.fromkeys(("starting", "learning", "saving"), 0)
    game.enter()
    lander_run = game.scene.run
    for number in range(rounds):
        if game.app.scenes.top is not game.scene:
            return [*problems, f"round {number}: {game.app.scenes.top} came up"]
        game.key(pygame.K_RETURN)
        if rng.random() < 0.1:
            state = "starting"
            game.rest(rng.uniform(0.0, 1.0))
        else:
            state = "learning"
            game.wait(lambda: lander_run.swarm_state)
            game.rest(rng.uniform(0.0, 1.5))
            if rng.random() < 0.7:
                state = "saving"
                lander_run.save(f"run {number}")
                game.rest(rng.uniform(0.0, 2.5))
        states[state] += 1
        for child in active_children():
            child.kill()
        if not game.wait(lambda: lander_run.state is WorkerState.FAILED):
            problems.append(f"round {number}: nobody noticed")
        if not lander_run.problem:
            problems.append(f"round {number}: no reason was given")
        if lander_run.collection.rescued() and rng.random() < 0.5:
            lander_run.save(lander_run.collection.free_name(f"rescued {number}"))
    game.leave()
    runs = lander_run.collection.items()
    for run in runs:
        try:
            resume(Training, run.folder)
            History.read(run.folder)
        except Exception as error:
            problems.append(f"{run.name}: {error}")
        if run.problem:
            problems.append(f"{run.name}: {run.problem}")
    counts = ", ".join(f"{count} {state}" for state, count in states.items())
    print(f"killed {rounds} ({counts}); {len(runs)} saved runs, {len(problems)} problems", flush=True)
    return problems


def visit(game: Game, visits: int) -> list[str]:
    """Enter, start and leave so many times; return what went wrong."""
    problems, memory = [], []
    threads = threading.active_count()
    for _ in range(visits + 1):
        game.enter()
        if game.wait(lambda: game.app.scenes.top is not game.scene, 0.1):  # it asks about the run left last time
            game.key(pygame.K_ESCAPE)
        game.key(pygame.K_RETURN)
        game.wait(lambda: len(game.scene.run.history) >= 40)
        game.leave()
        game.rest(0.2)
        if active_children():
            problems.append(f"left behind: {active_children()}")
        if threading.active_count() > threads:
            problems.append(f"left behind: {threading.enumerate()[threads:]}")
        gc.collect()
        memory.append(resident())
    grown = memory[-1] - memory[len(memory) // 2]  # the first visits fill caches
    print(f"visited {visits} times; memory " + " ".join(f"{each:.0f}" for each in memory) + " MB", flush=True)
    if grown > 3.0:
        problems.append(f"memory grew by {grown:.1f} MB")
    return problems


def resident() -> float:
    """Return the megabytes this process has in memory; 0 where the system does not tell."""
    file = Path("/proc/self/statm")
    return int(file.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6 if file.exists() else 0.0


def main() -> int:
    """Do both and say how it went."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--visits", type=int, default=10)
    arguments = parser.parse_args()
    with TemporaryDirectory() as folder:
        game = Game(Path(folder))
        problems = kill(game, arguments.kills, np.random.default_rng(0)) + visit(game, arguments.visits)
        game.app.close()
    print("\n".join(problems) or "nothing was lost, and nothing was left behind")
    return int(bool(problems))


if __name__ == "__main__":  # the worker's process imports this file and must not run it again
    sys.exit(main())
