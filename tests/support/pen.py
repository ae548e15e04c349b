"""Draws digits as a hand does: with the mouse, on the pad of a scene."""

from itertools import pairwise

import numpy as np
import pygame

from tests.support.digit_styles import TEMPLATES
from tests.support.driver import Driver

SEVEN = [(200, 180), (380, 180), (280, 480)]  # points of the view, on the pad of every scene that has one


def strokes(digit: int, style: int = 0, height: float = 0.6, at: tuple[float, float] = (0.3, 0.2)) -> list[np.ndarray]:
    """A digit's template in a pad of 1 x 1."""
    return [np.array(stroke) * (0.7 * height, height) + at for stroke in TEMPLATES[digit][style]]


def pad_of(driver: Driver) -> pygame.Rect:
    """The pad of the scene on top, in the window's pixels."""
    return driver.top.context.reading().rect(*driver.top.pad.rect)


def draw(driver: Driver, drawn: list[np.ndarray]) -> None:
    """Draw on the pad of Digits, all of a stroke in one frame."""
    rect = pad_of(driver)
    for stroke in drawn:
        points = stroke * rect.size + rect.topleft
        way = np.linspace(0, len(points) - 1, 60)
        dense = np.stack([np.interp(way, np.arange(len(points)), axis) for axis in points.T], axis=1).tolist()
        pygame.event.post(pygame.event.Event(pygame.MOUSEBUTTONDOWN, pos=dense[0], button=1))
        for point in dense[1:]:
            pygame.event.post(pygame.event.Event(pygame.MOUSEMOTION, pos=point, rel=(0, 0), buttons=(1, 0, 0)))
        driver.post(pygame.MOUSEBUTTONUP, pos=dense[-1], button=1)


def guess(driver: Driver) -> int:
    """The digit that Digits reads, of probabilities that add up."""
    probabilities = driver.top.probabilities
    assert probabilities is not None
    assert abs(probabilities.sum() - 1) < 1e-4
    return int(probabilities.argmax())


def stroke(driver: Driver, points: list[tuple[float, float]]) -> None:
    """Draw one stroke through points of the view, with a frame for each event."""
    driver.post(pygame.MOUSEBUTTONDOWN, pos=driver.to_window(points[0]), button=1)
    for start, end in pairwise(points):
        for part in np.linspace(0, 1, 9)[1:]:
            at = (start[0] + (end[0] - start[0]) * part, start[1] + (end[1] - start[1]) * part)
            driver.post(pygame.MOUSEMOTION, pos=driver.to_window(at), rel=(0, 0), buttons=(1, 0, 0))
    driver.post(pygame.MOUSEBUTTONUP, pos=driver.to_window(points[-1]), button=1)
