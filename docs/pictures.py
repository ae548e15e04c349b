"""Take the README's pictures, one of them moving, from the real game, played by the script.

    python -m docs.pictures [NAME ...]      # all of them, or those

It needs Pillow, which the extra `export` brings.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ["SDL_VIDEODRIVER"] = os.environ["SDL_AUDIODRIVER"] = "dummy"

import sys
import time
from collections.abc import Callable, Iterable
from functools import partial
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pygame
from PIL import Image

from ai.lander.missions import MISSIONS
from ai.training.config import PRESETS
from ai.training.explanations import Explanations
from ai.training.loop import Training
from game.core.scene import Scene
from game.core.settings import Settings
from game.scenes import scene_of
from game.scenes.digits.scene import DigitsScene
from game.scenes.learn.scene import ChapterScene
from game.scenes.lesson.scene import LessonScene
from game.scenes.menus.menu import MenuScene
from game.scenes.physics.scene import PhysicsScene
from game.scenes.play.challenge import FlownMission
from game.scenes.play.descent import Descent
from game.scenes.play.scene import PlayScene
from game.scenes.train.scene import TrainScene
from game.scenes.watch.scene import WatchScene
from game.shell.app import App
from game.ui.context import Context

IMAGES = Path(__file__).resolve().parent / "images"
HELD = 12  # frames that a key is held
EIGHT_UNITS = {5: pygame.K_RETURN, 30: pygame.K_RIGHT, 60: pygame.K_RIGHT, 90: pygame.K_RIGHT}  # of chapter 2, tried


def lesson(context: Context) -> LessonScene:
    """Open a lesson of a run that has begun to learn."""
    training = Training(PRESETS["modern"], 0, evaluate_every=0)
    explanations = Explanations(training)
    training.on_step = lambda result: explanations.follow(training.env.actions, result)  # type: ignore[attr-defined]
    for _ in range(300):
        training.advance()
    return LessonScene(context, explanations.explain(slot=0))


def mapped(context: Context) -> Scene:
    """Watch, with its sky coloured."""
    scene = WatchScene(context, seed=4)
    scene.world.policy_map.on = True
    return scene


# Name, scene, and what is pressed at which frame until the picture is taken.
PICTURES: tuple[tuple[str, Callable[[Context], Scene], dict[int, int], int], ...] = (
    ("menu", MenuScene, {}, 200),
    ("cockpit", partial(PlayScene, seed=12), {5: pygame.K_UP, 40: pygame.K_RIGHT, 80: pygame.K_UP}, 89),
    ("watch", partial(WatchScene, seed=3, many=True), {}, 260),
    ("map", mapped, {}, 110),
    ("descent", partial(PlayScene, seed=4, challenge=Descent()), dict.fromkeys(range(5, 160, HELD), pygame.K_UP), 100),
    ("learn", partial(ChapterScene, key="plane"), EIGHT_UNITS, 700),
    ("train", TrainScene, {5: pygame.K_RETURN}, 30),
    ("lesson", lesson, dict.fromkeys((5, 25, 45), pygame.K_RIGHT), 80),
    ("digits", DigitsScene, {}, 150),
    ("physics", partial(PhysicsScene, exhibit="heap"), {}, 400),
    (
        "mars",
        partial(PlayScene, seed=0, challenge=FlownMission(MISSIONS["mars"])),
        {5: pygame.K_LEFT, 40: pygame.K_UP, 70: pygame.K_UP},
        110,
    ),
)
SHARP = 90
# What has been chosen where a picture needs it.
CHOSEN = {
    "cockpit": Settings(help="guide", three_pads=True),
    "train": Settings(slow_runs=False),
}

MOVING = "flight"
# A person falls, steers askew and is corrected on the way; then hands over, and the network lands. Key, from, until.
FLOWN = (
    (pygame.K_RIGHT, 5, 20),
    (pygame.K_UP, 20, 60),
    (pygame.K_LEFT, 90, 150),
    (pygame.K_UP, 150, 200),
    (pygame.K_TAB, 330, 340),
)
MOVING_FRAMES, MOVING_SIZE, EVERY, QUALITY = 720, (800, 450), 3, 60


def take(name: str, make: Callable[[Context], Scene], keys: dict[int, int], frames: int) -> None:
    """Play the scene that `make` builds for so many frames and save what is then on the screen."""
    held = [(key, frame, frame + HELD) for frame, key in keys.items()]
    last = play(make, held, frames, CHOSEN.get(name, Settings()))
    _picture(last).save(IMAGES / f"{name}.webp", quality=SHARP, method=6)


def film() -> None:
    """Save the moving picture: WebP, for a camera that moves makes a GIF six times as large."""
    pictures = []

    def keep(seen: pygame.Surface) -> None:
        pictures.append(_picture(seen).resize(MOVING_SIZE, Image.Resampling.LANCZOS))

    play(partial(PlayScene, seed=12), FLOWN, MOVING_FRAMES, CHOSEN["cockpit"], keep)
    first, *others = pictures[::EVERY]
    # A whole picture at least every fourth time: what is only changed, over and over, smears where the camera moves.
    first.save(IMAGES / f"{MOVING}.webp", save_all=True, append_images=others, duration=round(1000 * EVERY / 60),
               loop=0, quality=QUALITY, method=4, kmin=1, kmax=4)  # fmt: skip


def play(
    make: Callable[[Context], Scene],
    held: Iterable[tuple[int, int, int]],
    frames: int,
    settings: Settings,
    look: Callable[[pygame.Surface], None] = lambda _: None,
) -> pygame.Surface:
    """Play so many frames, with keys held from one frame until another; `look` at each, return the last."""
    with TemporaryDirectory() as folder:
        ticks = count()
        context = Context(Path(folder), settings, rng=np.random.default_rng(1))
        app = App(context, make, now=lambda: next(ticks) / 60, scene_of=scene_of, capped=False)
        scene = app.scenes.top
        for frame in range(frames):
            for key, start, stop in held:
                for kind, at in ((pygame.KEYDOWN, start), (pygame.KEYUP, stop)):
                    if at == frame:
                        pygame.event.post(pygame.event.Event(kind, key=key, mod=0))
            if isinstance(scene, DigitsScene):
                _move_pen(scene, frame)
            app.tick()
            look(app.canvas.surface)
        while isinstance(scene, TrainScene) and not _has_learnt(scene):  # it learns by a clock of its own
            app.tick()
            time.sleep(1 / 60)
        last = app.canvas.surface.copy()
        app.close()
    return last


def _picture(surface: pygame.Surface) -> Image.Image:
    return Image.frombytes("RGB", surface.get_size(), pygame.image.tobytes(surface, "RGB"))


def _move_pen(scene: DigitsScene, frame: int) -> None:
    """Draw a two by the mouse's events, one a frame."""
    arc = [(0.5 + 0.2 * np.cos(angle), 0.34 + 0.2 * np.sin(angle)) for angle in np.radians(np.arange(200, 401, 8))]
    base = [(0.3 + 0.04 * step, 0.8 + 0.01 * np.sin(step)) for step in range(11)]
    way = [*arc, *np.linspace(arc[-1], base[0], 14)[1:], *base[1:]]
    if frame <= len(way):
        kinds = {0: pygame.MOUSEBUTTONDOWN, len(way): pygame.MOUSEBUTTONUP}
        place = np.array(way[min(frame, len(way) - 1)]) * scene.canvas_rect.size + scene.canvas_rect.topleft
        kind = kinds.get(frame, pygame.MOUSEMOTION)
        pygame.event.post(pygame.event.Event(kind, pos=place.tolist(), rel=(0, 0), button=1, buttons=(1, 0, 0)))


def _has_learnt(scene: TrainScene) -> bool:
    history = scene.run.history
    return bool(len(history) and history["success_rate"][-1] > 0.9)


if __name__ == "__main__":
    for picture in PICTURES:
        if picture[0] in (sys.argv[1:] or picture):
            take(*picture)
    if MOVING in (sys.argv[1:] or MOVING):
        film()
