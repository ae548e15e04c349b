"""How soon the guess follows the pen, and what a frame of drawing costs.

    python -m benchmarks.digits_scene

Digits of templates in several styles are drawn in the scene by the mouse's events, one a frame as from a slow
mouse and eight a frame as from a fast one; then a scribble that fills the pad. CPU milliseconds of one core at
1280 x 720: from one event until the guess has changed, and of the whole frame. The digits' places, sizes and
slants are random; the share that each network reads is printed as well. Exit code 1 if the 99th percentile of
any of them reaches 16 ms.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
os.environ["SDL_AUDIODRIVER"] = "dummy"

import argparse
import sys
import time
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pygame

from game.core.settings import Settings
from game.scenes import scene_of
from game.scenes.digits.scene import DigitsScene
from game.shell.app import App
from game.ui.context import Context
from tests.support.digit_styles import template_strokes

LIMIT = 16.0
EACH = 10


class Hand:
    """Draws in the scene and keeps the time."""

    def __init__(self, folder: Path) -> None:
        frames = count()
        context = Context(folder, Settings(), rng=np.random.default_rng(1))
        self.app = App(context, DigitsScene, now=lambda: next(frames) / 60, scene_of=scene_of, capped=False)
        assert isinstance(self.app.scenes.top, DigitsScene)
        self.scene = self.app.scenes.top
        self.app.tick()
        self.guesses: list[float] = []
        self.frames: list[float] = []

    def draw(self, strokes: list[np.ndarray], at_a_time: int) -> None:
        """Draw strokes (n, 2) in points of the pad, so many events a frame."""
        corner = np.array(self.scene.canvas_rect.topleft)
        for stroke in strokes:
            first, *others = (stroke + corner).tolist()
            self._frame([self._event(pygame.MOUSEBUTTONDOWN, first)])
            for start in range(0, len(others), at_a_time):
                part = others[start : start + at_a_time]
                self._frame([self._event(pygame.MOUSEMOTION, point) for point in part])
            self._frame([self._event(pygame.MOUSEBUTTONUP, (others or [first])[-1])])

    def clear(self) -> None:
        """Make room for the next drawing."""
        self.scene.pad.clear()
        self.app.tick()

    def _event(self, kind: int, point: list[float]) -> pygame.event.Event:
        return pygame.event.Event(kind, pos=point, rel=(0, 0), buttons=(1, 0, 0), button=1)

    def _frame(self, events: list[pygame.event.Event]) -> None:
        for event in events:
            pygame.event.post(event)
        before = time.process_time()
        self.app.tick()
        self.frames.append(1e3 * (time.process_time() - before))

    def react(self, stroke: np.ndarray) -> None:
        """Draw one stroke without frames in between: each event's way to a new guess alone."""
        first, *others = (stroke + self.scene.pad.rect.topleft).tolist()
        self.scene.handle_event(self._event(pygame.MOUSEBUTTONDOWN, first))
        for point in others:
            before = time.process_time()
            self.scene.handle_event(self._event(pygame.MOUSEMOTION, point))
            _ = self.scene.probabilities
            self.guesses.append(1e3 * (time.process_time() - before))
        self.scene.handle_event(self._event(pygame.MOUSEBUTTONUP, others[-1]))


def scribble(rng: np.random.Generator, points: int = 600) -> np.ndarray:
    """Return a way back and forth over the whole pad."""
    corners = rng.uniform(30, 490, (points // 12, 2))
    along = np.linspace(0, len(corners) - 1, points)
    return np.stack([np.interp(along, np.arange(len(corners)), axis) for axis in corners.T], axis=1)


def row(name: str, spent: list[float]) -> float:
    """Print one row and return its 99th percentile."""
    p50, p99 = np.percentile(spent, (50, 99))
    print(f"{name:36s}{np.mean(spent):8.2f}{p50:8.2f}{p99:8.2f}{max(spent):8.2f}   ms of {len(spent)}")
    return float(p99)


def main() -> int:
    """Print the table."""
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    rng = np.random.default_rng(3)
    read = {"modern": 0, "classic": 0}
    worst = 0.0
    print(f"{'':36s}{'mean':>8s}{'p50':>8s}{'p99':>8s}{'max':>8s}")
    with TemporaryDirectory() as folder:
        hand = Hand(Path(folder))
        for at_a_time in (1, 8):
            hand.frames.clear()
            for digit in np.repeat(np.arange(10), EACH // 2):
                hand.draw(template_strokes(digit, rng), at_a_time)
                for name, values in hand.scene.reading.probabilities.items():
                    read[name] += int(values.argmax()) == digit
                hand.clear()
            worst = max(worst, row(f"frame, {at_a_time} events in each", hand.frames))
        for digit in np.arange(10):
            for stroke in template_strokes(digit, rng):
                hand.react(stroke)
            hand.clear()
        worst = max(worst, row("guess after an event", hand.guesses))
        hand.guesses.clear()
        wild = scribble(rng)
        hand.react(wild)
        hand.clear()
        worst = max(worst, row("guess after an event, scribbling", hand.guesses))
        hand.frames.clear()
        hand.draw([wild], 2)
        hand.clear()
        worst = max(worst, row("frame, scribbling", hand.frames))
        hand.app.close()
    for name, right in read.items():
        print(f"{name} read {right} of {10 * EACH}")
    return int(worst >= LIMIT)


if __name__ == "__main__":
    sys.exit(main())
