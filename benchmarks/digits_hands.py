"""How well digits are read that hands of no data set draw in the scene, as events of a real mouse.

    python -m benchmarks.digits_hands [--each 12]

The styles are those of `benchmarks.hand_styles`. Hands differ in slant, aspect, size, place, unsteadiness and haste: a
pen is slower where it turns (the two-thirds power law, Lacquaniti et al. 1983), a mouse reports where it is 60 to 125
times a second, in whole pixels. Prints what each network reads of each style, and of each table of styles.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
os.environ["SDL_AUDIODRIVER"] = "dummy"

import argparse
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pygame

from benchmarks.hand_styles import HANDS, UNSEEN, Styles
from game.core.assets import MODELS_DIR
from game.core.settings import Settings
from game.scenes import scene_of
from game.scenes.digits.scene import DigitsScene
from game.shell.app import App
from game.ui.context import Context


def curve(corners: np.ndarray) -> np.ndarray:
    """Return a smooth way (n, 2) through points (Catmull-Rom, centripetal), with corners where one comes twice."""
    twice = np.flatnonzero((corners[1:] == corners[:-1]).all(axis=1)) + 1
    return np.concatenate([_smooth(part) for part in np.split(corners, twice)])


def _smooth(points: np.ndarray, samples: int = 60) -> np.ndarray:
    if len(points) < 3:
        return np.linspace(points[0], points[-1], samples)
    ends = 2 * points[0] - points[1], 2 * points[-1] - points[-2]
    points = np.concatenate([ends[:1], points, ends[1:]])
    knots = np.cumsum(np.r_[0, np.hypot(*np.diff(points, axis=0).T) ** 0.5])
    parts = []
    for first in range(len(points) - 3):
        p, t = points[first : first + 4], knots[first : first + 4]
        at = np.linspace(t[1], t[2], samples)[:, None]
        a = [(t[i + 1] - at) / (t[i + 1] - t[i]) * p[i] + (at - t[i]) / (t[i + 1] - t[i]) * p[i + 1] for i in range(3)]
        b = [(t[i + 2] - at) / (t[i + 2] - t[i]) * a[i] + (at - t[i]) / (t[i + 2] - t[i]) * a[i + 1] for i in range(2)]
        parts.append((t[2] - at) / (t[2] - t[1]) * b[0] + (at - t[1]) / (t[2] - t[1]) * b[1])
    return np.concatenate(parts)


def events(strokes: list[np.ndarray], rng: np.random.Generator, size: int) -> list[np.ndarray]:
    """Return where the mouse is reported to be, stroke by stroke, on a pad so many points wide."""
    tall = np.exp(rng.uniform(np.log(0.12), np.log(0.88))) * size
    extent = np.array([tall * rng.uniform(0.45, 0.9), tall])
    turn, slant, rate = rng.normal(0, 0.09), rng.normal(0.12, 0.18), rng.uniform(60, 125)
    turned = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    haste, steady = rng.uniform(0.7, 2.2) * size, rng.uniform(0.1, 0.8)  # points a second, points
    ways = []
    for stroke in strokes:
        unsure = rng.normal(0, 3, (len(stroke), 2))
        twice = np.flatnonzero((np.diff(stroke, axis=0) == 0).all(axis=1)) + 1
        unsure[twice] = unsure[twice - 1]
        way = curve((stroke + unsure) / 100 - 0.5)
        way = np.stack([way[:, 0] - slant * way[:, 1], way[:, 1]], axis=1) * extent @ turned
        ways.append(way[np.r_[True, np.hypot(*np.diff(way, axis=0).T) > 1e-6]])
    low, high = np.min([way.min(axis=0) for way in ways], axis=0), np.max([way.max(axis=0) for way in ways], axis=0)
    at = 16 + rng.random(2) * np.maximum(size - 32 - (high - low), 0) - low
    return [_reported(way + at, haste, rate, rng.normal(0, steady, (4000, 2))) for way in ways]


def _reported(way: np.ndarray, haste: float, rate: float, tremor: np.ndarray) -> np.ndarray:
    steps = np.diff(way, axis=0)
    lengths, angles = np.hypot(*steps.T), np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    bend = np.abs(np.diff(angles, append=angles[-1])) / lengths * 100  # radians to a hundred points
    times = np.cumsum(np.r_[0, lengths / haste * (1 + bend) ** (1 / 3)])
    asked = np.r_[np.arange(0, times[-1], 1 / rate), times[-1]][: len(tremor)]
    reported = np.stack([np.interp(asked, times, axis) for axis in way.T], axis=1) + tremor[: len(asked)]
    return reported.round()


def draw(scene: DigitsScene, strokes: list[np.ndarray]) -> None:
    """Draw with the mouse's events."""
    scene.pad.clear()
    for stroke in strokes:
        points = [(int(x), int(y)) for x, y in stroke + scene.pad.rect.topleft]
        for number, point in enumerate(points):
            kind = pygame.MOUSEMOTION if number else pygame.MOUSEBUTTONDOWN
            scene.handle_event(pygame.event.Event(kind, pos=point, rel=(0, 0), buttons=(1, 0, 0), button=1))
        scene.handle_event(pygame.event.Event(pygame.MOUSEBUTTONUP, pos=points[-1], button=1))


def read(scene: DigitsScene, styles: Styles, each: int, rng: np.random.Generator) -> None:
    """Draw so many of each style, and print what is read of them."""
    right: dict[str, list[bool]] = {"modern": [], "classic": []}
    for (digit, style), strokes in styles.items():
        for _ in range(each):
            drawn = events([np.array(stroke, float) for stroke in strokes], rng, scene.pad.rect.width)
            draw(scene, drawn)
            assert scene.probabilities is not None
            for name, values in scene.reading.probabilities.items():
                right[name].append(int(values.argmax()) == digit)
        said = "  ".join(f"{name} {sum(hits[-each:]):3d}" for name, hits in right.items())
        print(f"{digit} {style:22s} of {each:3d}:  {said}", flush=True)
    for name, hits in right.items():
        print(f"{name:8s} reads {np.mean(hits):.1%} of {len(hits)}\n")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--each", type=int, default=12, help="drawings of each style (default: 12)")
    chosen = parser.parse_args()
    frames = count()
    with TemporaryDirectory() as folder:
        context = Context(Path(folder), Settings(), models_dir=MODELS_DIR, rng=np.random.default_rng(21))
        app = App(context, DigitsScene, now=lambda: next(frames) / 60, scene_of=scene_of, capped=False)
        scene = app.scenes.top
        assert isinstance(scene, DigitsScene)
        app.tick()
        for seed, styles in ((21, HANDS), (22, UNSEEN)):
            read(scene, styles, chosen.each, np.random.default_rng(seed))
        app.close()


if __name__ == "__main__":
    main()
