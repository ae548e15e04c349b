"""Play for an hour, as fast as the machine can, and see whether memory is level after the first five minutes.

    python -m benchmarks.hour [--minutes 60] [--trace]

It is the real game without a window, on a clock of its own: 60 frames a second, 216,000 in all. It goes
round all scenes, as a player would: flights by hand, shared and by the network, missions, races, replays that are
wound, swarms, exhibits, digits that are drawn, screens that are looked through. Every simulated minute it prints
what is in memory, without what the allocator only keeps free. A round takes five minutes; scenes differ, so the most
of one round is compared with that of another. Exit code 1 if the last one needed 20 MB more than the second. With
`--trace`, it says at the end which lines of code hold more than after ten minutes; that takes three times as long.

Training goes by the clock on the wall, and has a script of its own: train_endurance.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
os.environ["SDL_VIDEODRIVER"] = os.environ["SDL_AUDIODRIVER"] = "dummy"

import argparse
import sys
import time
import tracemalloc
from collections import Counter
from collections.abc import Iterator
from itertools import count, cycle
from pathlib import Path

import numpy as np
import pygame

from benchmarks.monkey import resident
from game.core.scene import Pop, Push
from game.core.settings import Settings
from game.scenes import scene_of
from game.scenes.digits.quiz import QuizScene
from game.scenes.digits.scene import DigitsScene
from game.scenes.error_screen import ErrorScene
from game.shell.app import App
from game.ui.context import Context
from tests.support.monkey import playground
from tests.support.tour import makers, stock

WARM = 5  # minutes, in which every scene has its turn
GROWTH = 20.0  # megabytes
_SECOND, _MINUTE = 60, 3600  # frames
_STAY = 15  # seconds in a scene
_HELD = 24  # frames
# A key a second, over and over, until the stay is over; 0 is none.
_FLY = (
    pygame.K_UP,
    pygame.K_LEFT,
    pygame.K_UP,
    pygame.K_RIGHT,
    pygame.K_UP,
    pygame.K_TAB,
    0,
    0,
    0,
    0,
    0,
    pygame.K_RETURN,
)
_KEYS: dict[str, tuple[int, ...]] = {
    **dict.fromkeys(("PlayScene", "mission", "daily", "race"), _FLY),
    "ReplayScene": (
        0,
        0,
        pygame.K_HOME,
        0,
        pygame.K_MINUS,
        pygame.K_END,
        pygame.K_SPACE,
        pygame.K_PERIOD,
        pygame.K_PLUS,
    ),
    "WatchScene": (0, 0, pygame.K_PLUS, pygame.K_n, pygame.K_r, 0, pygame.K_MINUS),
    "PhysicsScene": (0, 0, pygame.K_c, pygame.K_n, 0, pygame.K_r),
}
_LOOK = (pygame.K_DOWN, pygame.K_RIGHT, pygame.K_DOWN, pygame.K_LEFT, pygame.K_UP, 0)


class Player:
    """Goes round the scenes for as long as it is asked for another frame."""

    def __init__(self, folder: Path) -> None:
        frames = count()
        context = Context(folder / "user", Settings(assist=0.4), rng=np.random.default_rng(1))
        stock(context)
        self.app = App(context, now=lambda: next(frames) / 60, scene_of=scene_of, capped=False)
        context.sound.open()
        self._makers = makers(context)
        self._rng = np.random.default_rng(2)

    def frames(self) -> Iterator[str]:
        """Play on, a frame at a time; say in which scene that was."""
        for name, make in cycle(self._makers.items()):
            scene = make()
            if scene is None:
                continue
            self.app.scenes.apply(Push(scene))
            keys = cycle(_KEYS.get(name, _LOOK))
            for second in range(_STAY):
                key = next(keys)
                for frame in range(_SECOND):
                    if key and frame in (0, _HELD):
                        kind = pygame.KEYUP if frame else pygame.KEYDOWN
                        pygame.event.post(pygame.event.Event(kind, key=key, mod=0, unicode="", scancode=0))
                    if isinstance(scene, DigitsScene | QuizScene):
                        self._draw(frame, second)
                    if not self.app.tick():
                        raise RuntimeError(f"{name} has closed the game")
                    yield name
            if isinstance(self.app.scenes.top, ErrorScene):
                raise RuntimeError(f"a fault in {name}")
            if (depth := len(self.app.scenes.stack)) > 1:
                self.app.scenes.apply(Pop(depth - 1))

    def _draw(self, frame: int, second: int) -> None:
        """Pull the pen across the middle of the screen, a stroke a second; every third second, away with it."""
        if second % 3 == 2:
            if frame == 0:
                pygame.event.post(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_c, mod=0, unicode="c", scancode=0))
            return
        kinds = {10: pygame.MOUSEBUTTONDOWN, 50: pygame.MOUSEBUTTONUP}
        if 10 <= frame <= 50:
            place = np.array([400, 360]) + 90 * np.array([np.cos(frame / 7 + second), np.sin(frame / 9)])
            pygame.event.post(pygame.event.Event(kinds.get(frame, pygame.MOUSEMOTION), pos=place.tolist(), button=1,
                                                 rel=(0, 0), buttons=(1, 0, 0), touch=False))  # fmt: skip


def main() -> int:
    """Play, and print what is in memory."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--minutes", type=int, default=60)
    parser.add_argument("--trace", action="store_true")
    arguments = parser.parse_args()
    memory, before = [], None
    with playground() as folder:
        player = Player(folder)
        frames = player.frames()
        began = time.process_time()
        for minute in range(1, arguments.minutes + 1):
            scenes = Counter(next(frames) for _ in range(_MINUTE))
            memory.append(resident())
            where = ", ".join(scenes)
            print(
                f"{minute:3d} min {memory[-1]:6.0f} MB {time.process_time() - began:6.0f} s of CPU   {where}",
                flush=True,
            )
            if minute == WARM and arguments.trace:
                tracemalloc.start(8)
            if minute == WARM + 5 and arguments.trace:
                before = tracemalloc.take_snapshot()
        if before:
            for line in tracemalloc.take_snapshot().compare_to(before, "lineno")[:15]:
                print(line)
        player.app.close()
    grown = max(memory[-WARM:]) - max(memory[WARM : 2 * WARM] or memory)
    print(f"grown from the second {WARM} minutes to the last: {grown:.1f} MB; the most ever: {max(memory):.0f} MB")
    return int(grown > GROWTH)


if __name__ == "__main__":  # a process that trains imports this file and must not run it again
    sys.exit(main())
