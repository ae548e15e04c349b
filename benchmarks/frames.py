"""What a frame of Play and of Watch costs, and how long the moon takes to paint.

    python -m benchmarks.frames

A frame is everything the game does for it: events, the step, the picture. CPU milliseconds of one core, SDL
drawing into memory at 1280 x 720; the first second of each scene counts too, with its empty caches.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
os.environ["SDL_VIDEODRIVER"] = "dummy"
os.environ["SDL_AUDIODRIVER"] = "dummy"

import sys
import time
from collections.abc import Callable
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pygame

from game.app import App
from game.context import Context
from game.scene import Scene
from game.scenes.play import Play
from game.scenes.watch import COUNTS, Watch
from game.settings import Settings
from game.world.backdrop import Backdrop, landscape

FRAMES = 1500


def cost(scene: Scene, press: int | None = None) -> np.ndarray:
    """Milliseconds of every frame; `press` is a key pressed once, early on, and again every 500 frames."""
    spent = []
    with TemporaryDirectory() as folder:
        frames = count()
        context = Context(Path(folder), Settings(), rng=np.random.default_rng(1))
        app = App(context, scene, now=lambda: next(frames) / 60, capped=False)
        landscape((1280, 720), False)  # painted once, and timed above
        for frame in range(FRAMES):
            if press and frame % 500 == 20:
                pygame.event.post(pygame.event.Event(pygame.KEYDOWN, key=press, mod=0))
            before = time.process_time()
            app.tick()
            spent.append(1e3 * (time.process_time() - before))
        app.close()
    return np.array(spent)


def main() -> int:
    """Print the table."""
    times = []
    for size in ((1280, 720), (1920, 1080)):
        before = time.process_time()
        Backdrop(size, np.random.default_rng(1))
        times.append(f"{size[0]} x {size[1]}: {1e3 * (time.process_time() - before):.0f} ms")
    print("painting the moon   ", ", ".join(times))
    print(f"{'scene':20s}{'mean':>8s}{'p50':>8s}{'p99':>8s}{'max':>8s}   ms")
    rows: list[tuple[str, Callable[[], Scene], int | None]] = [
        ("play, by hand", lambda: Play(seed=4), pygame.K_r),
        ("play, network", lambda: Play(seed=4), pygame.K_TAB),
    ]
    rows += [(f"watch, {n}", lambda n=n: Watch(n, seed=4), None) for n in COUNTS]
    for name, make, press in rows:
        spent = cost(make(), press)
        figures = (spent.mean(), *np.percentile(spent, (50, 99)), spent.max())
        print(f"{name:20s}" + "".join(f"{figure:8.2f}" for figure in figures))
    return 0


if __name__ == "__main__":
    sys.exit(main())
