"""How long one physics step takes, beside pymunk (Chipmunk in C) stepping the same bodies.

    python -m benchmarks.physics [--awake]

A lander over twenty segments of ground, while it falls, while it comes to rest (alone it lies by then; of a batch,
dropped at places of their own, hundreds still rock and roll), and once it lies there; ten columns of ten boxes at
rest; a hundred boxes falling in a heap. Each is stepped alone and in a batch of worlds with starts of
their own; what a batch takes is divided by its worlds. In both engines bodies fall asleep once they have been still for
half a second (pymunk's, which do not unless asked to, are asked to), unless `--awake` forbids it. All sides take
turns, run after run, and processor time is counted, so that a busy machine does not matter; medians of the runs are
printed. A ratio above 1 means that pymunk is quicker.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
import platform
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from engine import DT, Polygon, World
from engine.rest import STEPS

try:
    import pymunk
except ImportError:
    pymunk = None

ITERATIONS = 10  # both engines' own default
FRICTION = 0.5


@dataclass
class Thing:
    """A body of one or several polygons."""

    parts: list[Polygon]
    position: tuple[float, float]
    angle: float = 0.0
    static: bool = False


@dataclass
class Scene:
    """Bodies, and which part of their history is measured."""

    name: str
    gravity: float
    skip: float  # seconds before it
    seconds: float
    batch: int
    spread: float  # metres by which the starts of a batch differ
    things: list[Thing] = field(default_factory=list)


def lander(name: str, skip: float) -> Scene:
    scene = Scene(f"lander, 20 segments, {name}", 1.62, skip, seconds=3, batch=1024, spread=8.0)
    x = np.linspace(-20, 20, 21)
    height = 1.0 + 0.3 * np.sin(x)
    for i in range(20):
        corners = [(x[i], -1.0), (x[i + 1], -1.0), (x[i + 1], height[i + 1]), (x[i], height[i])]
        scene.things.append(Thing([Polygon(corners)], (0.0, 0.0), static=True))
    hull = Polygon([(-0.62, -0.45), (0.62, -0.45), (0.72, 0.05), (0.42, 0.75), (-0.42, 0.75), (-0.72, 0.05)])
    feet = [Polygon.box(0.4, 0.12, (side * 0.85, -0.9)) for side in (-1, 1)]
    scene.things.append(Thing([hull, *feet], (0.3, 12.0), 0.1))
    return scene


def columns(sleeping: bool) -> Scene:
    """Ten columns that sleep in both engines by then, or awake ones that still come to rest, step by step."""
    scene = Scene("10 columns of 10 boxes", 9.81, skip=5 if sleeping else 1, seconds=3, batch=16, spread=0.0)
    scene.things.append(Thing([Polygon.box(60, 1)], (0.0, -0.5), static=True))
    for i in range(100):
        scene.things.append(Thing([Polygon.box(1, 1)], (2.0 * (i // 10) - 9.0, 0.5 + i % 10)))
    return scene


def pile() -> Scene:
    random = np.random.default_rng(0)
    scene = Scene("100 boxes falling in a heap", 9.81, skip=0, seconds=6, batch=16, spread=0.02)
    scene.things.append(Thing([Polygon.box(60, 1)], (0.0, -0.5), static=True))
    scene.things += [Thing([Polygon.box(1, 20)], (side * 6.0, 10.0), static=True) for side in (-1, 1)]
    for i in range(100):
        size = random.uniform(0.5, 1.1, 2)
        place = (random.uniform(-1, 1) + 2.2 * (i % 5 - 2), 1 + 1.6 * (i // 5))
        scene.things.append(Thing([Polygon.box(*size)], place, random.uniform(0, 3)))
    return scene


def ours(scene: Scene, batch: int, sleeping: bool = True) -> Callable[[], None]:
    world = World(gravity=(0.0, -scene.gravity), batch=batch, iterations=ITERATIONS, sleeping=sleeping)
    random = np.random.default_rng(batch)
    for thing in scene.things:
        shift = np.zeros((batch, 2))
        shift[1:, 0] = 0.0 if thing.static else random.uniform(-scene.spread, scene.spread, batch - 1)
        world.add(thing.parts, thing.position + shift, thing.angle, static=thing.static, friction=FRICTION)
    return world.step


def theirs(scene: Scene, sleeping: bool = True) -> Callable[[], None]:
    space: Any = pymunk.Space()
    space.gravity, space.iterations = (0.0, -scene.gravity), ITERATIONS
    if sleeping:
        space.sleep_time_threshold = STEPS * DT
    for thing in scene.things:
        kind = pymunk.Body.STATIC if thing.static else pymunk.Body.DYNAMIC
        body = pymunk.Body(body_type=kind)
        body.position, body.angle = thing.position, thing.angle
        space.add(body)
        for part in thing.parts:
            shape = pymunk.Poly(body, part.vertices.tolist())
            shape.friction, shape.density = FRICTION, 1.0
            space.add(shape)
    return lambda: space.step(DT)


def microseconds(scene: Scene, step: Callable[[], None]) -> float:
    for _ in range(max(1, round(scene.skip / DT))):  # the first step also prepares what stays as it is
        step()
    steps = round(scene.seconds / DT)
    start = time.process_time()
    for _ in range(steps):
        step()
    return (time.process_time() - start) / steps * 1e6


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--awake", action="store_true", help="let no body sleep")
    arguments = parser.parse_args()
    runs, sleeping = arguments.runs, not arguments.awake
    rival = f"pymunk {pymunk.version}" if pymunk else "no pymunk"
    print(f"Python {platform.python_version()}, NumPy {np.__version__}, {rival}; {platform.machine()}")
    rest = "what is still sleeps" if sleeping else "all awake"
    print(f"microseconds a step, medians of {runs} runs on one thread; {rest}\n")
    print(f"{'scene':36} {'alone':>8} {'batch':>6} {'a world':>8} {'pymunk':>8} {'alone/':>8} {'batch/':>8}")
    for scene in (lander("falling", 0), lander("coming to rest", 6), lander("lying", 20), columns(sleeping), pile()):
        alone, batched, rivals = [], [], []
        for _ in range(runs):
            alone.append(microseconds(scene, ours(scene, 1, sleeping)))
            batched.append(microseconds(scene, ours(scene, scene.batch, sleeping)) / scene.batch)
            if pymunk:
                rivals.append(microseconds(scene, theirs(scene, sleeping)))
        one, many = statistics.median(alone), statistics.median(batched)
        line = f"{scene.name:36} {one:8.1f} {scene.batch:6} {many:8.1f}"
        if rivals:
            rival_time = statistics.median(rivals)
            line += f" {rival_time:8.1f} {one / rival_time:8.2f} {many / rival_time:8.2f}"
        print(line, flush=True)
    if not pymunk:
        print('\nFor the other side: pip install -e ".[bench]"')


if __name__ == "__main__":
    main()
