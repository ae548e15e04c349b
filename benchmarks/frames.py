"""What a frame of each scene costs, and how long the moon takes to paint.

    python -m benchmarks.frames                       # SDL draws into memory
    SDL_VIDEODRIVER=x11 python -m benchmarks.frames   # in a window, on the display there is

A frame is everything the game does for it: events, the step, the picture. CPU milliseconds of one core, which
a busy machine does not lengthen, at 1280 x 720; the first second of each scene counts too, with its empty
caches. Train starts a run, pauses it and goes on; the learning is a process of its own, and not counted.
Exit code 1 if the 99th percentile of a scene reaches 8 ms, half of what 60 frames a second allow.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
os.environ.setdefault("SDL_FRAMEBUFFER_ACCELERATION", "0")  # as the game has it
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
from game.scenes.menu import Menu
from game.scenes.pause import Pause
from game.scenes.physics import Physics
from game.scenes.play import Play
from game.scenes.settings import SettingsScene
from game.scenes.train import Train
from game.scenes.watch import COUNTS, Watch
from game.settings import Settings
from game.world.backdrop import Backdrop, landscape

FRAMES = 1500
CHOSEN = {
    "play, shared": Settings(assist=0.6),
    "play, three pads": Settings(assist=0.6, copilot="guardian", three_pads=True),
}
LIMIT = 8.0


def cost(scene: Scene, keys: tuple[int, ...] = (), settings: Settings | None = None) -> np.ndarray:
    """Milliseconds of every frame; every 500 frames the keys are held in turn, 30 frames each."""
    spent = []
    with TemporaryDirectory() as folder:
        frames = count()
        context = Context(Path(folder), settings or Settings(), rng=np.random.default_rng(1))
        app = App(context, scene, now=lambda: next(frames) / 60, capped=False)
        landscape((1280, 720), False)  # painted once, and timed above
        for frame in range(FRAMES):
            for number, key in enumerate(keys):
                for event, at in ((pygame.KEYDOWN, 20), (pygame.KEYUP, 50)):
                    if frame % 500 == at + 40 * number:
                        pygame.event.post(pygame.event.Event(event, key=key, mod=0))
            before = time.process_time()
            app.tick()
            spent.append(1e3 * (time.process_time() - before))
        app.close()
    return np.array(spent)


def paused() -> Scene:
    below = Play(seed=4)
    below.enter(Context(Path("nowhere"), Settings(), rng=np.random.default_rng(1)))
    return Pause(below)


def main() -> int:
    """Print the table."""
    times = []
    for size in ((1280, 720), (1920, 1080)):
        before = time.process_time()
        Backdrop(size, np.random.default_rng(1))
        times.append(f"{size[0]} x {size[1]}: {1e3 * (time.process_time() - before):.0f} ms")
    print("painting the moon   ", ", ".join(times))
    print(f"{'scene':20s}{'mean':>8s}{'p50':>8s}{'p99':>8s}{'max':>8s}   ms")
    rows: list[tuple[str, Callable[[], Scene], tuple[int, ...]]] = [
        ("menu", Menu, ()),
        ("settings", SettingsScene, ()),
        ("pause", paused, ()),
        ("play, by hand", lambda: Play(seed=4), (pygame.K_r, pygame.K_UP, pygame.K_LEFT)),
        ("play, network", lambda: Play(seed=4), (pygame.K_r, pygame.K_TAB)),
    ]
    rows += [(name, lambda: Play(seed=4), (pygame.K_r, pygame.K_UP, pygame.K_LEFT, pygame.K_RIGHT)) for name in CHOSEN]
    rows += [(f"watch, {n}", lambda n=n: Watch(n, seed=4), ()) for n in COUNTS]
    rows += [
        ("physics, stack", Physics, (pygame.K_c,)),
        ("physics, heap", lambda: Physics("heap"), ()),
        ("physics, contacts", lambda: Physics("heap"), (pygame.K_c,)),
        ("train", Train, (pygame.K_RETURN,)),
    ]
    slow = False
    for name, make, keys in rows:
        spent = cost(make(), keys, CHOSEN.get(name))
        slow |= bool(np.percentile(spent, 99) >= LIMIT)
        figures = (spent.mean(), *np.percentile(spent, (50, 99)), spent.max())
        print(f"{name:20s}" + "".join(f"{figure:8.2f}" for figure in figures))
    return int(slow)


if __name__ == "__main__":
    sys.exit(main())
