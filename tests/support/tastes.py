"""What is asked about a taste, made up."""

from unittest.mock import patch

import numpy as np

from ai.lander.environment import Outcome
from ai.training.preferences import SUMS
from ai.training.upbringing import Asked, Flight
from game.scenes.taste.scene import TasteScene
from game.training.run import TrainingRun
from game.ui.context import Context


def flight(towards: float = 0.0, outcome: Outcome = Outcome.LANDED, decisions: int = 40) -> Flight:
    """Return a flight in a straight line from one start to a place on the ground."""
    way = np.linspace(0.0, 1.0, decisions + 1)[:, None]
    poses = (1 - way) * (3.0, 12.0, 0.2) + way * (towards, 2.6, 0.0)
    return Flight(poses.astype(np.float32), np.full(decisions, 3), int(outcome), np.zeros(len(SUMS)))


def asked(answers: int = 0) -> Asked:
    """Return a question after so many answers."""
    liking = np.linspace(-3.0, 3.0, len(SUMS)) * (answers > 0)
    return Asked(answers, (flight(), flight(9.0, Outcome.CRASHED, 60)), liking)


def raised(context: Context) -> TasteScene:
    """Return the screen as it is after a few answers, without a process."""
    with patch.object(TrainingRun, "begin"):
        scene = TasteScene(context)
    scene.run.asked = asked(3)
    scene.pair.ask(scene.run.asked.question)
    return scene
