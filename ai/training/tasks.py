"""Choice of the task by the name of its environment."""

from __future__ import annotations

from ai.training.config import ANYWHERE, LANDER, Config
from ai.training.task import Task


def task_of(config: Config) -> Task:
    """Make the task that a configuration names.

    Raises ValueError for an environment that does not exist or cannot be learnt by Q-learning, and ImportError
    where Gymnasium is needed and not installed.
    """
    if config.env == LANDER:
        from ai.training.lander_task import LanderTask

        return LanderTask(config)
    if config.env == ANYWHERE:
        from ai.training.anywhere_task import AnywhereTask

        return AnywhereTask(config)
    from ai.training.gym_task import GymTask

    return GymTask(config)
