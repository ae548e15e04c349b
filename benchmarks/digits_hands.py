"""How well digits are read that hands of no data set draw in the scene, as events of a real mouse.

    python -m benchmarks.digits_hands [--each 12] [--sheet misread.png]

Each digit has several styles, given by the few points that a pen goes through; what is between them is smooth, and
a point given twice is a corner. Hands differ in slant, aspect, size, place, unsteadiness and haste: a pen is slower
where it turns (by the two-thirds power law, Lacquaniti et al. 1983), a mouse tells where it is 60 to 125 times a
second, in whole pixels. Prints what each network reads of each style; a sheet shows what Modern, else Classic,
misreads: drawn, and as it was seen.
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

from game.core.settings import Settings
from game.scenes import scene_of
from game.scenes.digits import DigitsScene
from game.shell.app import App
from game.ui.context import Context

# Strokes through points in percent of a box, y down.
RING = [(52, 2), (18, 14), (2, 50), (18, 88), (52, 99), (86, 84), (98, 48), (84, 14), (50, 1)]
HANDS = {
    (0, "ring"): [RING],
    (0, "open above"): [[(40, 4), (8, 30), (6, 70), (40, 99), (84, 84), (98, 45), (80, 8), (52, 8)]],
    (0, "ends within"): [[*RING, (30, 12), (28, 20)]],
    (0, "clockwise"): [RING[::-1]],
    (0, "slashed"): [RING, [(88, 4), (12, 96)]],
    (1, "bare"): [[(50, 0), (50, 100)]],
    (1, "flag"): [[(10, 34), (40, 12), (62, 0), (62, 0), (62, 100)]],
    (1, "flag and foot"): [[(20, 22), (52, 0), (52, 0), (52, 100)], [(18, 100), (88, 100)]],
    (1, "upwards"): [[(40, 100), (60, 0)]],
    (2, "flat base"): [[(8, 26), (30, 2), (72, 4), (84, 30), (56, 62), (4, 98), (4, 98), (96, 97)]],
    (2, "looped"): [[(6, 22), (40, 0), (80, 16), (72, 48), (30, 90), (10, 92), (14, 78), (44, 86), (96, 96)]],
    (2, "as a z"): [[(10, 10), (50, 0), (84, 14), (76, 42), (6, 96), (6, 96), (50, 90), (94, 96)]],
    (3, "round"): [[(8, 14), (44, 0), (82, 18), (66, 42), (36, 48), (36, 48), (80, 58), (90, 80), (50, 100), (4, 88)]],
    (3, "flat top"): [[(8, 2), (86, 0), (86, 0), (44, 40), (44, 40), (84, 52), (88, 84), (46, 100), (4, 88)]],
    (3, "soft waist"): [[(12, 10), (54, 0), (78, 22), (50, 46), (86, 66), (70, 94), (30, 100), (4, 90)]],
    (4, "open"): [[(22, 0), (10, 54), (10, 54), (94, 52)], [(72, 4), (66, 100)]],
    (4, "closed"): [[(66, 0), (4, 66), (4, 66), (98, 64)], [(66, 0), (66, 100)]],
    (4, "in one"): [[(70, 100), (66, 2), (66, 2), (4, 62), (4, 62), (96, 62)]],
    (4, "round"): [[(16, 4), (6, 36), (22, 54), (72, 44)], [(84, 0), (78, 46), (70, 100)]],
    (5, "hat last"): [[(20, 2), (12, 44), (12, 44), (56, 38), (92, 64), (66, 96), (4, 94)], [(20, 2), (90, 0)]],
    (5, "in one"): [[(88, 0), (22, 2), (22, 2), (14, 44), (14, 44), (60, 38), (92, 66), (62, 98), (4, 92)]],
    (5, "as an s"): [[(86, 4), (36, 4), (16, 28), (46, 46), (84, 66), (62, 96), (6, 92)]],
    (6, "curved"): [[(78, 0), (32, 24), (6, 66), (34, 99), (82, 88), (84, 60), (46, 52), (10, 72)]],
    (6, "straight"): [[(70, 0), (14, 62), (16, 94), (60, 99), (84, 74), (54, 54), (16, 72)]],
    (6, "upright"): [[(22, 0), (8, 50), (14, 92), (56, 99), (88, 76), (60, 54), (14, 74)]],
    (7, "plain"): [[(4, 2), (92, 2), (92, 2), (40, 100)]],
    (7, "crossed"): [[(4, 4), (94, 2), (94, 2), (38, 100)], [(26, 50), (84, 48)]],
    (7, "serif"): [[(4, 22), (8, 4), (8, 4), (94, 2), (94, 2), (58, 50), (46, 100)]],
    (7, "wavy"): [[(2, 10), (40, 2), (94, 4), (94, 4), (54, 46), (42, 100)]],
    (8, "in one"): [
        [(78, 12), (44, 0), (16, 20), (46, 46), (84, 74), (50, 100), (14, 78), (54, 46), (82, 22), (74, 10)]
    ],
    (8, "two rings"): [
        [(50, 48), (20, 28), (44, 0), (80, 20), (50, 48)],
        [(50, 48), (10, 74), (46, 100), (90, 76), (50, 48)],
    ],
    (8, "open above"): [[(70, 6), (30, 4), (20, 26), (80, 68), (62, 98), (22, 94), (18, 70), (70, 34), (84, 6)]],
    (9, "straight"): [[(84, 20), (46, 0), (10, 28), (40, 52), (82, 26), (84, 10), (84, 10), (78, 100)]],
    (9, "hooked"): [[(82, 18), (42, 0), (10, 28), (44, 52), (84, 20), (84, 60), (64, 98), (16, 90)]],
    (9, "slanted"): [[(86, 16), (48, 0), (12, 26), (36, 46), (84, 22), (70, 60), (46, 100)]],
    (9, "ring and stem"): [[(80, 24), (48, 0), (14, 26), (46, 52), (80, 24)], [(82, 4), (78, 100)]],
}


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
    """Return where the mouse is told to be, stroke by stroke, on a pad so many points wide."""
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
    return [_told(way + at, haste, rate, rng.normal(0, steady, (4000, 2))) for way in ways]


def _told(way: np.ndarray, haste: float, rate: float, tremor: np.ndarray) -> np.ndarray:
    steps = np.diff(way, axis=0)
    lengths, angles = np.hypot(*steps.T), np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    bend = np.abs(np.diff(angles, append=angles[-1])) / lengths * 100  # radians to a hundred points
    times = np.cumsum(np.r_[0, lengths / haste * (1 + bend) ** (1 / 3)])
    asked = np.r_[np.arange(0, times[-1], 1 / rate), times[-1]][: len(tremor)]
    told = np.stack([np.interp(asked, times, axis) for axis in way.T], axis=1) + tremor[: len(asked)]
    return told.round()


def draw(scene: DigitsScene, strokes: list[np.ndarray]) -> None:
    """Draw with the mouse's events."""
    scene.pad.clear()
    for stroke in strokes:
        points = [(int(x), int(y)) for x, y in stroke + scene.pad.rect.topleft]
        for number, point in enumerate(points):
            kind = pygame.MOUSEMOTION if number else pygame.MOUSEBUTTONDOWN
            scene.handle_event(pygame.event.Event(kind, pos=point, rel=(0, 0), buttons=(1, 0, 0), button=1))
        scene.handle_event(pygame.event.Event(pygame.MOUSEBUTTONUP, pos=points[-1], button=1))


def tile(scene: DigitsScene, digit: int, drawn: list[np.ndarray]) -> pygame.Surface:
    """Return a drawing with the mouse's places on it, what was seen, and what was read."""
    picture = pygame.Surface((360, 180))
    ink = pygame.surfarray.make_surface((scene.pad.ink.T[..., None] * [150, 150, 150]).astype(np.uint8))
    for stroke in drawn:
        for x, y in stroke / 2:
            ink.set_at((int(x), int(y)), (255, 120, 0))
    seen = (scene.reading.stages.centred.T[..., None] * [255, 255, 255]).astype(np.uint8)
    picture.blit(pygame.transform.smoothscale(ink, (170, 170)), (0, 0))
    picture.blit(pygame.transform.scale(pygame.surfarray.make_surface(seen), (168, 168)), (180, 0))
    said = ", ".join(
        f"{name} {values.argmax()} {values.max():.0%}" for name, values in scene.reading.probabilities.items()
    )
    picture.blit(pygame.font.Font(None, 18).render(f"{digit}: {said}", True, (255, 255, 255)), (4, 168))
    return picture


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--each", type=int, default=12, help="drawings of each style (default: 12)")
    parser.add_argument("--sheet", type=Path, help="where to put a picture of what is misread")
    chosen = parser.parse_args()
    rng, frames = np.random.default_rng(21), count()
    right: dict[str, list[bool]] = {"modern": [], "classic": []}
    tiles = []
    with TemporaryDirectory() as folder:
        app = App(
            Context(Path(folder), Settings(), rng=rng),
            DigitsScene,
            now=lambda: next(frames) / 60,
            scene_of=scene_of,
            capped=False,
        )
        scene = app.scenes.top
        assert isinstance(scene, DigitsScene)
        app.tick()
        for (digit, style), strokes in HANDS.items():
            for _ in range(chosen.each):
                drawn = events([np.array(stroke, float) for stroke in strokes], rng, scene.pad.rect.width)
                draw(scene, drawn)
                assert scene.probabilities is not None
                for name, values in scene.reading.probabilities.items():
                    right[name].append(int(values.argmax()) == digit)
                if not right["modern"][-1] or (not right["classic"][-1] and len(tiles) < 60):
                    tiles.append(tile(scene, digit, drawn))
            said = "  ".join(f"{name} {sum(each[-chosen.each :]):3d}" for name, each in right.items())
            print(f"{digit} {style:16s} of {chosen.each:3d}:  {said}", flush=True)
        if chosen.sheet and tiles:
            rows = -(-len(tiles) // 5)
            sheet = pygame.Surface((5 * 360, rows * 184))
            for number, each in enumerate(tiles):
                sheet.blit(each, (number % 5 * 360, number // 5 * 184))
            pygame.image.save(sheet, chosen.sheet)
        app.close()
    for name, each in right.items():
        print(f"{name:8s} reads {np.mean(each):.1%} of {len(each)}")


if __name__ == "__main__":
    main()
