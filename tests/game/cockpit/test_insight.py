import numpy as np
import pytest

from ai.decision import Decision, decide
from game.cockpit.insight import Insight
from game.flight import Flight


class Wavers:
    """A network that wants something else in every step that it is asked in, most of what it flies."""

    def q_values(self, observation: np.ndarray) -> np.ndarray:
        return np.sin(1e4 * observation[:, :1] * np.arange(1, 7)).astype(np.float32)

    def act(self, observation: np.ndarray, *, held: np.ndarray | None = None) -> np.ndarray:
        return self.decide(observation, held=held).action

    def decide(self, observation: np.ndarray, *, held: np.ndarray | None = None) -> Decision:
        return decide(observation, self.q_values(observation), held)


@pytest.mark.parametrize("before", range(8))
def test_the_panel_shows_what_is_flown_from_the_first_step_after_a_hand_over(before: int):
    flight = Flight(3, Wavers(), shares=False)
    insight = Insight(flight.env.ground)
    for _ in range(before):
        flight.step(3)
        insight.follow(flight)
    flight.hand_over()
    seen = set()
    for _ in range(20):
        flight.step(0)
        insight.follow(flight)
        flown = flight.recording.actions[-1]
        assert insight.shown
        assert insight.values is not None
        assert insight.values.flown == np.argmax(insight.values.points) == flown
        seen.add(flown)
    assert len(seen) > 1
