"""Real lessons of small runs, for what shows them."""

from functools import cache

from ai.explain.agent_lesson import Lesson
from ai.training.config import PRESETS, Config
from ai.training.lander_session import LanderSession
from tests.support.driver import Driver
from tests.support.written import words_written

SMALL = {
    "modern": PRESETS["modern"].changed(
        num_envs=4, hidden=(16, 8), learning_starts=64, replay_size=2000, batch_size=16, gradient_steps=1
    ),
    "classic": PRESETS["classic"].changed(num_envs=1, hidden=(16, 8), learning_starts=32, batch_size=16),
}


@cache
def lesson_of(name: str, turns: int = 60) -> Lesson:
    """Return the lesson of the first lander of a small run with that preset, after so many decisions."""
    return lesson_from(SMALL[name], turns)


def lesson_from(config: Config, turns: int = 60, slot: int = 0) -> Lesson:
    """Return the lesson of a lander of a run with these settings, after so many decisions."""
    run = LanderSession.live(config, 3)
    for _ in range(turns + 1):
        next(run)
    answer = run.send(("explain", slot))
    run.close()
    (lesson,) = [message for message in answer if isinstance(message, Lesson)]
    return lesson


def shown(driver: Driver, frame: int) -> list[str]:
    """Go to a frame and return what is written on the screen there."""
    import pytest  # which benchmarks do without

    with pytest.MonkeyPatch.context() as patch:
        words = words_written(patch)
        driver.top.show(frame)
        driver.app.canvas.attach(driver.app.window.surface)
        driver.frames(2)
    return words
