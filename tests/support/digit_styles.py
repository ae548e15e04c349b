"""Digits in several styles of handwriting that owe nothing to MNIST, and strokes of them as a hand would draw them."""

import numpy as np


def arc(x, y, across, down, start, end, points=24):
    """Points along an ellipse, from one angle to another, in degrees."""
    angles = np.radians(np.linspace(start, end, points))
    return list(zip(x + across * np.cos(angles), y + down * np.sin(angles), strict=True))


# In a box of 1 x 1, y down. Each digit has several styles, each of one stroke or several.
TEMPLATES = (
    (
        [arc(0.5, 0.5, 0.35, 0.5, -90, 270)],
        [arc(0.5, 0.5, 0.28, 0.5, -60, 310)],
        [arc(0.5, 0.5, 0.45, 0.48, -100, 255)],
    ),
    (
        [[(0.5, 0), (0.5, 1)]],
        [[(0.25, 0.25), (0.5, 0), (0.5, 1)]],
        [[(0.25, 0.25), (0.5, 0), (0.5, 1)], [(0.25, 1), (0.75, 1)]],
        [[(0.6, 0), (0.4, 1)]],
    ),
    (
        [[*arc(0.5, 0.28, 0.35, 0.28, 190, 390), (0.15, 1), (0.85, 1)]],
        [[*arc(0.5, 0.3, 0.35, 0.3, 200, 400), (0.5, 0.7), (0.2, 0.95), *arc(0.25, 0.88, 0.1, 0.1, 120, 340),
          (0.6, 0.98), (0.9, 0.92)]],
        [[*arc(0.45, 0.25, 0.33, 0.25, 180, 370), (0.7, 0.5), (0.15, 0.97), (0.5, 0.95), (0.85, 1)]],
    ),
    (
        [arc(0.45, 0.26, 0.35, 0.26, 200, 450) + arc(0.45, 0.74, 0.38, 0.26, 270, 520)],
        [[(0.15, 0), (0.8, 0), (0.45, 0.4), *arc(0.45, 0.7, 0.37, 0.3, 270, 500)]],
    ),
    (
        [[(0.6, 0), (0.1, 0.65), (0.9, 0.65)], [(0.65, 0.3), (0.65, 1)]],
        [[(0.2, 0), (0.15, 0.5), (0.8, 0.5)], [(0.8, 0), (0.78, 1)]],
        [[(0.65, 1), (0.65, 0), (0.1, 0.7), (0.95, 0.7)]],
    ),
    (
        [[(0.8, 0), (0.25, 0), (0.2, 0.42), *arc(0.45, 0.68, 0.37, 0.32, 230, 500)]],
        [[(0.25, 0.05), (0.2, 0.45), *arc(0.45, 0.68, 0.37, 0.31, 230, 500)], [(0.25, 0.03), (0.85, 0)]],
    ),
    (
        [[(0.7, 0), (0.4, 0.2), (0.2, 0.5), *arc(0.5, 0.7, 0.33, 0.3, 190, 550)]],
        [arc(0.8, 0.65, 0.62, 0.65, 250, 180) + arc(0.5, 0.7, 0.32, 0.29, 180, 530)],
    ),
    (
        [[(0.1, 0), (0.85, 0), (0.4, 1)]],
        [[(0.1, 0), (0.85, 0), (0.4, 1)], [(0.3, 0.5), (0.8, 0.5)]],
        [[(0.12, 0.15), (0.12, 0), (0.88, 0), (0.55, 0.5), (0.45, 1)]],
    ),
    (
        [arc(0.5, 0.25, 0.28, 0.25, 90, -270) + arc(0.5, 0.75, 0.35, 0.25, -90, 270)],
        [[(0.75, 0.12), *arc(0.5, 0.22, 0.27, 0.22, -40, -270)[:20], (0.5, 0.45),
          *arc(0.5, 0.74, 0.33, 0.26, -60, 200), (0.35, 0.55), (0.75, 0.12)]],
    ),
    (
        [[*arc(0.5, 0.28, 0.3, 0.28, 0, -360), (0.8, 0.28), (0.78, 1)]],
        [[*arc(0.5, 0.28, 0.3, 0.28, -10, -370), (0.8, 0.3), (0.7, 0.75), *arc(0.45, 0.75, 0.28, 0.25, 20, 140)]],
        [[*arc(0.45, 0.3, 0.33, 0.3, -20, -370), (0.75, 0.3), (0.45, 1)]],
    ),
)  # fmt: skip


def template_strokes(digit, rng, size=520):
    """Return the strokes of a digit of a random style, place, size and slant on a canvas."""
    styles = TEMPLATES[digit]
    style = styles[rng.integers(len(styles))]
    height = rng.uniform(0.3, 0.8) * size
    extent = np.array([height * rng.uniform(0.5, 0.9), height])
    turn, slant = rng.normal(0, 0.08), rng.normal(0.08, 0.15)
    phases, heights = rng.uniform(0, 2 * np.pi, (2, 3)), rng.normal(0, 0.012, (2, 3))
    cosine, sine = np.cos(turn), np.sin(turn)
    strokes = []
    for stroke in style:
        corners = np.array(stroke) + rng.normal(0, 0.025, (len(stroke), 2)) * (len(stroke) < 8) - 0.5
        along, given = np.linspace(0, 1, max(40, 3 * len(corners))), np.linspace(0, 1, len(corners))
        points = np.stack([np.interp(along, given, corners[:, axis]) for axis in (0, 1)], axis=1)
        for axis in (0, 1):
            waves = 2 * np.pi * np.arange(1, 4) * points[:, 1 - axis, None] + phases[axis]
            points[:, axis] += np.sin(waves) @ heights[axis]
        points += rng.normal(0, 0.004, points.shape)
        points[:, 0] -= slant * points[:, 1]
        strokes.append(points * extent @ np.array([[cosine, sine], [-sine, cosine]]))
    everything = np.concatenate(strokes)
    low, high = everything.min(axis=0), everything.max(axis=0)
    at = 15 + rng.random(2) * np.maximum(size - 30 - (high - low), 0) - low
    return [points + at for points in strokes]
