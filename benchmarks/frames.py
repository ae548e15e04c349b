"""What a frame of each scene costs, what it costs to enter the scene, and how much memory that takes.

    python -m benchmarks.frames                                # SDL draws into memory
    python -m benchmarks.frames --size 1920x1080 3840x2160
    python -m benchmarks.frames --only play watch              # scenes whose names begin so
    SDL_VIDEODRIVER=x11 python -m benchmarks.frames            # in a window, on the display there is

A frame is everything the game does for it: events, the step, the picture, a share of the large pictures that are
painted in pieces. CPU milliseconds of one core; the same frames are played several times, and the median of each
counts, because a busy machine empties the processor's caches in some of them. Train starts a run, pauses it and goes
on; the learning is a process of its own, and not counted.

`enter` is all that is done from the choice to the first picture of the scene; `opening` rows begin with
nothing painted, as in a window that has just got its size. In the first eleven frames of every row the menu fades away
over the scene: they are among its dearest hundredth. `MB` is the most memory that the process has held since the scene
before. Exit code 1 if the 99th percentile of a scene, or what it costs to enter one, reaches the limit.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
os.environ.setdefault("SDL_FRAMEBUFFER_ACCELERATION", "0")  # as the game has it
os.environ["SDL_AUDIODRIVER"] = "dummy"

import argparse
import gc
import math
import sys
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pygame

from ai.digits.classifier import DigitClassifier
from ai.digits.preprocessing import preprocess_strokes
from ai.lander.missions import MISSIONS
from game.core.scene import Scene
from game.core.settings import Settings
from game.digits.kept import classifier_in
from game.drawing.paint_cache import A_FRAME, idle, spread
from game.scenes import scene_of
from game.scenes.ahead import load
from game.scenes.digits.inside import DigitInsideScene
from game.scenes.error_screen import ErrorScene
from game.scenes.learn.path import PATH
from game.scenes.learn.scene import ChapterScene
from game.scenes.lesson.scene import LessonScene
from game.scenes.menus.background import LOADER
from game.scenes.menus.dialogs import NameDialog, QuestionDialog
from game.scenes.menus.menu import MenuScene
from game.scenes.physics.exhibits import EXHIBITS
from game.scenes.physics.scene import PhysicsScene
from game.scenes.physics.step_scene import PhysicsStepScene
from game.scenes.play.challenge import FlownMission
from game.scenes.play.descent import Descent
from game.scenes.play.pause import FlightPauseScene
from game.scenes.play.scene import PlayScene
from game.scenes.train.landers import LanderView
from game.scenes.train.scene import TrainScene
from game.scenes.watch.scene import WatchScene
from game.shell.app import App
from game.ui.context import Context
from game.world.landscape.backdrop import landscape
from tests.support.lessons import lesson_of
from tests.support.screens import FLOWN as FLIGHTS
from tests.support.screens import SCREENS
from tests.support.tour import scene_types, stock

ALL = {**SCREENS, **FLIGHTS}
FRAMES = 1000
RUNS = 3
# Milliseconds: of the 99th percentile of frames, and of entering a scene.
LIMITS = {"1280x720": (8.0, 50.0), "1920x1080": (8.0, 50.0), "2560x1440": (12.0, 80.0), "3840x2160": (16.0, 120.0)}
COVERED = 30  # frames for which a scene below another has been on the screen
SEVEN = [np.array([(100.0, 100.0), (400.0, 100.0), (200.0, 450.0)])]
FLOWN = (pygame.K_r, pygame.K_UP, pygame.K_LEFT, pygame.K_RIGHT)
SHARED: dict[str, Any] = {"help": "guide"}
GUARDED: dict[str, Any] = {"help": "guard"}
PADS: dict[str, Any] = {**SHARED, "three_pads": True}


@dataclass(frozen=True)
class Row:
    """A scene and what is done in it: every 500 frames, keys are held in turn, 30 frames each.

    `make` gets what `before` returns, which is there before the scene is entered: the context alone, a network, or a
    scene below it, which has been on the screen. `cold` is whether it begins with no land painted; `times` how many
    times as many frames it takes as others.
    """

    make: Callable[..., Scene | None]
    keys: tuple[int, ...] = ()
    settings: dict[str, Any] = field(default_factory=dict)
    cold: bool = False
    times: int = 1
    before: Callable[[Context], tuple[Any, ...]] = lambda context: (context,)


def rows() -> dict[str, Row]:
    """Every scene of the game by name, those that fly in several ways."""

    def over_play(make: Callable[[PlayScene], Scene], keys: tuple[int, ...] = ()) -> Row:
        return Row(make, keys, before=lambda context: (PlayScene(context, seed=4),))

    def of_tour(name: str, keys: tuple[int, ...]) -> Row:
        return Row(ALL[name], keys)

    def of_seven(make: Callable[..., Scene], keys: tuple[int, ...], name: str = "modern") -> Row:
        return Row(make, keys, before=lambda context: (*_read(context, name), preprocess_strokes(SEVEN)))

    play = Row(lambda context: PlayScene(context, seed=4), FLOWN)

    def mapped(context: Context) -> Scene:
        scene = WatchScene(context, seed=4)
        scene.world.policy_map.on = True
        return scene

    def heap(context: Context) -> Scene:
        scene = PhysicsScene(context, "heap")
        scene.show_contacts(True)
        return scene

    special = {
        "WatchScene", "PhysicsScene", "PhysicsStepScene", "ChapterScene", "mission", "descent", "LessonScene",
        "DigitInsideScene", "inside, sums", "inside, dreams", "Play", "swarm",
    }  # fmt: skip
    others = {name for name in ALL if name not in special and not name.startswith("chapter")}
    return {
        "play, by hand": play,
        "play, network": Row(play.make, (pygame.K_r, pygame.K_TAB)),
        "play, shared": Row(play.make, FLOWN, SHARED),
        "play, guarded": Row(play.make, FLOWN, GUARDED),
        "play, three pads": Row(play.make, FLOWN, PADS),
        "opening, play": Row(play.make, FLOWN, cold=True),
        "opening, menu": Row(MenuScene, cold=True),
        # The network takes over, and lands leg after leg.
        "descent": Row(lambda context: PlayScene(context, 4, challenge=Descent()), (pygame.K_TAB,), times=3),
        **{
            f"mission, {name}": Row(lambda context, m=m: PlayScene(context, 0, challenge=FlownMission(m)), FLOWN)
            for name, m in MISSIONS.items()
        },
        "pause": over_play(lambda below: FlightPauseScene(below.context, below), (pygame.K_DOWN, pygame.K_RIGHT)),
        "dialog": over_play(lambda below: QuestionDialog(below, "?", "", [("a", print), ("b", print)])),
        "dialog, naming": over_play(lambda below: NameDialog(below, "?", "name", lambda _: "")),
        "fault": Row(lambda context: ErrorScene(context, ValueError(), Path("log"))),
        "watch": Row(lambda context: WatchScene(context, seed=4)),
        "watch, many": Row(lambda context: WatchScene(context, seed=4, many=True)),
        "watch, map": Row(mapped),
        "watch, touched": Row(mapped, (pygame.K_SPACE, pygame.K_RETURN, pygame.K_LEFT)),
        **{f"physics, {name}": Row(lambda context, n=name: PhysicsScene(context, n)) for name in EXHIBITS},
        **{
            f"chapter, {key}": Row(lambda context, k=key: ChapterScene(context, k), (pygame.K_n, pygame.K_RETURN))
            for key in PATH
        },
        "physics, contacts": Row(heap),
        "physics, one step": Row(
            lambda below: PhysicsStepScene(below.context, below.exhibit),
            (pygame.K_PERIOD,),
            before=lambda context: (PhysicsScene(context, "stack"),),
        ),
        **{
            name.removesuffix("Scene").lower(): of_tour(name, (pygame.K_DOWN, pygame.K_RETURN))
            for name in sorted(others)
        },
        **{
            f"lesson, {name}": Row(
                LessonScene,
                (pygame.K_DOWN, pygame.K_RETURN),
                before=lambda context, n=name: (context, lesson_of(n)),  # type: ignore[misc]
            )
            for name in ("modern", "classic")
        },
        "inside, modern": of_seven(DigitInsideScene, (pygame.K_3, pygame.K_RIGHT)),
        "inside, classic": of_seven(DigitInsideScene, (pygame.K_3, pygame.K_RIGHT), "classic"),
        "menu": Row(MenuScene),
        "train": of_tour("TrainScene", (pygame.K_RETURN,)),
        "train, split": Row(_split),
        "digittraining": of_tour("DigitTrainingScene", (pygame.K_RETURN,)),
    }


def _read(context: Context, name: str = "modern") -> tuple[Context, DigitClassifier]:
    """Return the context and a shipped network, which the scene below has read."""
    return context, classifier_in(context.models_dir / "digits" / name)


def _split(context: Context) -> Scene:
    """Make Train with an experiment beside its run, from the first frame on."""
    scene = TrainScene(context)
    assert isinstance(scene.view, LanderView)
    scene.view.laboratory.sabotage = "rate_times_100"
    scene.view.laboratory.fly("few")
    return scene


def cost(row: Row, size: tuple[int, int], seen: set[type]) -> np.ndarray:
    """Milliseconds of entering a scene and of every frame after; the types of the scenes on top are added to `seen`."""
    spent = []
    with TemporaryDirectory() as folder:
        frames = count()
        context = Context(Path(folder), Settings(**row.settings), rng=np.random.default_rng(1))
        stock(context)
        app = App(context, now=lambda: next(frames) / 60, scene_of=scene_of, capped=False)
        app.window.size = size
        for thread in threading.enumerate():
            if thread.name == LOADER:
                thread.join()  # the network that lands behind the menu
        for _ in range(10):  # a window that has got its size is not painted at once
            app.tick()
        while not idle():
            app.tick()
        given = row.before(context)
        for below in given:
            if isinstance(below, Scene):
                app.show(lambda _, below=below: below)  # type: ignore[misc]
                for _ in range(COVERED):
                    app.tick()
        while not idle():
            app.tick()
        if row.cold:
            landscape.cache_clear()
        for frame in range(-1, row.times * FRAMES):
            if frame >= 0:
                act(app.scenes.top, row.keys, frame, app)
            before = time.process_time()
            if frame < 0:
                app.show(_made(row.make, given))
            app.tick()
            spent.append(1e3 * (time.process_time() - before))
            seen.add(type(app.scenes.top))
        app.close()
    return np.array(spent)


def most_memory() -> float:
    """Return the most memory that the process has held since the last call, in MB; 0 where no system says."""
    try:
        status = Path("/proc/self/status").read_text()
        Path("/proc/self/clear_refs").write_text("5")
    except OSError:
        return 0.0
    return next(int(line.split()[1]) / 1024 for line in status.splitlines() if line.startswith("VmHWM"))


def _made(make: Callable[..., Scene | None], given: tuple[Any, ...]) -> Callable[[Context], Scene]:
    """Return what makes a scene for certain."""

    def made(_: Context) -> Scene:
        scene = make(*given)
        assert scene is not None
        return scene

    return made


def act(scene: Scene, keys: tuple[int, ...], frame: int, app: App) -> None:
    """Hold keys, and draw in a loop where there is a pad to draw on."""
    for number, key in enumerate(keys):
        for event, at in ((pygame.KEYDOWN, 20), (pygame.KEYUP, 50)):
            if frame % 500 == at + 40 * number:
                pygame.event.post(pygame.event.Event(event, key=key, mod=0, unicode="", scancode=0))
    if pad := getattr(scene, "pad", None):
        box, turn = app.canvas.rect(*pad.rect), frame / 20
        place = box.centerx + box.width / 3 * math.sin(turn), box.centery + box.height / 3 * math.sin(1.3 * turn)
        kinds = {10: pygame.MOUSEBUTTONDOWN, 110: pygame.MOUSEBUTTONUP}
        event = kinds.get(frame % 120, pygame.MOUSEMOTION)
        pygame.event.post(pygame.event.Event(event, pos=place, rel=(0, 0), buttons=(1, 0, 0), button=1))


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", choices=LIMITS, nargs="+", default=["1280x720"])
    parser.add_argument("--runs", type=int, default=RUNS)
    parser.add_argument("--only", nargs="*", default=[""], help="beginnings of names of scenes")
    chosen = parser.parse_args()
    spread(A_FRAME)
    gc.freeze()  # as the game does
    gc.set_threshold(20_000, 20, 50)
    with TemporaryDirectory() as folder:
        load(Context(Path(folder), Settings()))
    return max(_table(size, chosen.only, chosen.runs) for size in chosen.size)


def _table(lines: str, only: Sequence[str], runs: int) -> bool:
    """Print the table of a window's size; return whether a scene reaches its limit."""
    (width, height), (most, longest) = map(int, lines.split("x")), LIMITS[lines]
    print(f"{lines:26s}" + "".join(f"{name:>8s}" for name in ("enter", "mean", "p50", "p99", "max", "MB")))
    slow, seen = [], set[type]()
    most_memory()
    for name, row in (row for row in rows().items() if row[0].startswith(tuple(only))):
        enter, *spent = np.median([cost(row, (width, height), seen) for _ in range(runs)], axis=0)
        p50, p99 = np.percentile(spent, (50, 99))
        if p99 >= most or enter >= longest:
            slow.append(name)
        figures = (enter, np.mean(spent), p50, p99, max(spent))
        print(f"{name:26s}" + "".join(f"{each:8.2f}" for each in figures) + f"{most_memory():8.0f}", flush=True)
    if list(only) == [""]:
        print("not seen:", ", ".join(sorted({each.__name__ for each in scene_types()} - {s.__name__ for s in seen})))
    print(f"over {most:.0f} ms, or {longest:.0f} ms to enter:", ", ".join(slow) or "none")
    return bool(slow)


if __name__ == "__main__":
    sys.exit(main())
