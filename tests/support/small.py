"""Networks so small that tests can train them for a moment, and how they do so on a screen."""

import pygame

from ai.digits.config import DIGIT_PRESETS
from ai.training.config import PRESETS
from game.core.worker import WorkerState
from tests.support.driver import Driver

LANDERS = PRESETS["modern"].changed(
    num_envs=4, hidden=(8,), learning_starts=64, replay_size=1000, batch_size=16, gradient_steps=1
)
DIGITS = DIGIT_PRESETS["classic"].changed(hidden=(8,), held_out=2_000, batch_size=20, augmentation=0.0)


def toggle(driver: Driver) -> None:
    """Start the run on the screen, pause it, or let it go on."""
    driver.form.focus(driver.top.start_button)
    driver.key(pygame.K_RETURN)


def learn(driver: Driver, points: int = 2) -> None:
    """Start the run on the screen, and wait until it has learnt for a moment."""
    toggle(driver)
    driver.wait(lambda: len(driver.top.run.history) >= points)


def pause(driver: Driver) -> None:
    """Pause the run on the screen, and wait until it stands still."""
    toggle(driver)
    driver.wait(lambda: driver.top.run.state is WorkerState.PAUSED)
