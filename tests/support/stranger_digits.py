"""Digits of hands that no network learned from: slashed and crossed zeros, narrow zeros and eights, small scans.

They owe nothing to `ai.digits.handwriting`: rings are superellipses, eights are two rings or one figure of Lissajous.
"""

import numpy as np

from ai.digits.strokes import draw_strokes

TURNS = {"rising": (40, 75), "falling": (105, 140), "upright": (80, 100), "level": (-12, 12)}  # degrees
ENDS = {  # how far the two ends of a slash lie from the middle, in half the height of the ring
    "inside": ((0.4, 0.75), (0.4, 0.75)),
    "touching": ((0.9, 1.08), (0.9, 1.08)),
    "out on one side": ((1.15, 1.6), (0.5, 1.05)),
    "out on both": ((1.15, 1.6), (1.15, 1.6)),
}


def _ring(rng, wide, points=60):
    power, start = rng.uniform(1.7, 2.6), rng.uniform(-2.2, -0.9)
    turn = start + np.linspace(0, 2 * np.pi + rng.uniform(-0.25, 0.35), points) * rng.choice((1, -1))
    across, down = np.cos(turn), np.sin(turn)
    egg = 1 + rng.normal(0, 0.08) * down
    x, y = (np.sign(each) * np.abs(each) ** (2 / power) for each in (across, down))
    drift = np.linspace(0, 1, points)[:, None] * rng.normal(0, 0.04, 2)
    return np.stack([x * wide * egg, y], axis=1) + drift


def _by_hand(strokes, rng):
    """Return strokes as a hand of some slant and steadiness draws them, in whole pixels."""
    height, slant, turn = rng.uniform(40, 220), rng.normal(0.12, 0.15), rng.normal(0, 0.07)
    cosine, sine = np.cos(turn), np.sin(turn)
    manner = np.array([[1, 0], [-slant, 1]]) @ np.array([[cosine, sine], [-sine, cosine]])
    phases, bends, waves = rng.uniform(0, 2 * np.pi, 2), rng.normal(0, 0.02, 2), rng.uniform(1.5, 3.5, 2)
    drawn = []
    for stroke in strokes:
        bent = stroke + bends * np.sin(waves * stroke[:, ::-1] + phases)
        drawn.append(np.rint(height * (bent @ manner) + rng.normal(0, 0.4, stroke.shape)))
    return drawn


def slashed_zero(turn, ends, rng, in_one=False):
    """Return the strokes of a zero with a slash, by keys of `TURNS` and `ENDS`; one stroke if it is drawn in one."""
    wide = rng.uniform(0.45, 0.9)
    angle, middle = np.radians(rng.uniform(*TURNS[turn])), rng.normal(0, 0.07, 2) * (wide, 1)
    way = np.array([np.cos(angle) * wide, -np.sin(angle)])
    reach = [rng.uniform(*each) for each in ENDS[ends]][:: rng.choice((1, -1))]
    first, last = (middle + side * length * way for side, length in zip((1, -1), reach, strict=True))
    along = np.linspace(0, 1, 20)[:, None]
    slash = first + along * (last - first) + np.sin(np.pi * along) * rng.normal(0, 0.04, 2)
    ring = _ring(rng, wide)
    return _by_hand([np.concatenate([ring, slash[:: rng.choice((1, -1))]])] if in_one else [ring, slash], rng)


def narrow(digit, rng):
    """Return the strokes of a zero or an eight, 0.15 to 0.33 times as wide as high."""
    wide = rng.uniform(0.15, 0.33)
    turn = np.linspace(0, 2 * np.pi, 80) + rng.uniform(0, 2 * np.pi)
    if digit == 0:
        strokes = [_ring(rng, wide)]
    elif rng.random() < 0.5:
        strokes = [
            np.stack([width * np.sin(turn), middle + 0.5 * np.cos(turn)], axis=1)
            for middle, width in ((-0.5, 0.9 * wide), (0.5, wide))
        ]
    else:
        strokes = [np.stack([-wide * np.sin(2 * turn), -np.cos(turn)], axis=1)]
    return _by_hand(strokes, rng)


def scan(strokes, side, pen, binary=False):
    """Return strokes as a scanner sees them: so many pixels along the longer side, grey or black and white."""
    everything = np.concatenate(strokes)
    low, high, fine = everything.min(axis=0), everything.max(axis=0), 8
    scale, margin = fine * (side - pen) / max(float((high - low).max()), 1e-9), fine * (1 + pen / 2)
    columns, rows = (np.ceil(((high - low) * scale + 2 * margin) / fine).astype(int) * fine).tolist()
    drawn = draw_strokes([(stroke - low) * scale + margin for stroke in strokes], (rows, columns), pen * fine)
    grey = drawn.reshape(rows // fine, fine, columns // fine, fine).mean(axis=(1, 3))
    return (grey > 0.5).astype(np.float32) if binary else grey
