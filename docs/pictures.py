"""Take the README's pictures from the real game, played by the script.

python -m docs.pictures
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ["SDL_VIDEODRIVER"] = os.environ["SDL_AUDIODRIVER"] = "dummy"

import time
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pygame

ROOT = Path(__file__).resolve().parents[1]
from game.app import App
from game.context import Context
from game.scene import Scene
from game.scenes.digits import Digits
from game.scenes.menu import Menu
from game.scenes.physics import Physics
from game.scenes.play import Play
from game.scenes.train import Train
from game.scenes.watch import Watch
from game.settings import Settings

# Name, scene, and what is pressed at which frame until the picture is taken.
PICTURES: tuple[tuple[str, Scene, dict[int, int], int], ...] = (
    ("menu", Menu(), {}, 200),
    ("play", Play(seed=12), {5: pygame.K_TAB}, 170),
    ("cockpit", Play(seed=12), {5: pygame.K_UP, 40: pygame.K_RIGHT, 80: pygame.K_UP}, 89),
    ("watch", Watch(64, seed=3), {}, 260),
    ("train", Train(), {5: pygame.K_RETURN}, 30),
    ("digits", Digits(), {}, 150),
    ("physics", Physics("heap"), {60: pygame.K_c}, 400),
)


HELD = 12  # frames that a key is held
# What has been chosen where a picture needs it.
CHOSEN = {"cockpit": Settings(assist=0.6, copilot="guardian", three_pads=True)}


def take(name: str, scene: Scene, keys: dict[int, int], frames: int) -> None:
    """Play `scene` for so many frames and save what is then on the screen."""
    with TemporaryDirectory() as folder:
        ticks = count()
        context = Context(Path(folder), CHOSEN.get(name, Settings()), rng=np.random.default_rng(1))
        app = App(context, scene, now=lambda: next(ticks) / 60, capped=False)
        for frame in range(frames):
            for kind, at in ((pygame.KEYDOWN, frame), (pygame.KEYUP, frame - HELD)):
                if at in keys:
                    pygame.event.post(pygame.event.Event(kind, key=keys[at], mod=0))
            if isinstance(scene, Digits):
                _move_pen(scene, frame)
            app.tick()
        while isinstance(scene, Train) and not _has_learnt(scene):  # it learns by a clock of its own
            app.tick()
            time.sleep(1 / 60)
        pygame.image.save(app.canvas.surface, ROOT / "docs" / "images" / f"{name}.png")
        app.close()


def _move_pen(scene: Digits, frame: int) -> None:
    """Draw a two by the mouse's events, one a frame."""
    arc = [(0.5 + 0.2 * np.cos(angle), 0.34 + 0.2 * np.sin(angle)) for angle in np.radians(np.arange(200, 401, 8))]
    base = [(0.3 + 0.04 * step, 0.8 + 0.01 * np.sin(step)) for step in range(11)]
    way = [*arc, *np.linspace(arc[-1], base[0], 14)[1:], *base[1:]]
    if frame <= len(way):
        kinds = {0: pygame.MOUSEBUTTONDOWN, len(way): pygame.MOUSEBUTTONUP}
        place = np.array(way[min(frame, len(way) - 1)]) * scene.canvas_rect.size + scene.canvas_rect.topleft
        kind = kinds.get(frame, pygame.MOUSEMOTION)
        pygame.event.post(pygame.event.Event(kind, pos=place.tolist(), rel=(0, 0), button=1, buttons=(1, 0, 0)))


def _has_learnt(scene: Train) -> bool:
    history = scene.student.history
    return bool(len(history) and history["success"][-1] > 0.9)


if __name__ == "__main__":
    for picture in PICTURES:
        take(*picture)
