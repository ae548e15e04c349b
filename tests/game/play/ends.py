"""How flights that are played are brought to their end."""

import numpy as np
import pygame

from ai.lander.environment import LanderEnv
from tests.support.driver import Driver
from tests.support.flights import play

ON_PAD = (0.0, 2.6, 0.0, -0.4, 0.0, 0.0)
TOO_FAST = (0.0, 4.0, 0.0, -6.0, 0.0, 0.0)
BESIDE = (8.0, 2.2, 0.0, -0.4, 0.0, 0.0)


def place(env: LanderEnv, *state: float) -> None:
    """Put the craft somewhere: x, y, vx, vy, angle, spin."""
    env.place(np.ones(1, bool), np.array([state]))


def end(driver: Driver, state: tuple[float, ...]) -> None:
    """Touch a key, bring the flight to its end from a state, and to its card."""
    driver.frames(2)
    driver.key(pygame.K_UP)
    place(play(driver).flight.env, *state)
    for _ in range(300):
        driver.skip()
        if play(driver).ending.shown == 1:
            return
    raise AssertionError("no card came")
