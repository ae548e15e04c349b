"""A pilot with one switch and slow hands: five decisions a second, each carried out a fifth of a second late."""

from collections import deque

from ai.lander.environment import OBSERVATION_SCALE
from ai.lander.push import KEYS
from game.flight.choosers import steered
from game.flight.flight import Flight

EVERY = LATE = 12  # steps


class SlowSwitch:
    """Decides whether to hold the switch, from height and speed alone."""

    def __init__(self) -> None:
        self._wishes = deque([False] * LATE)
        self._wish, self._step = False, 0

    def held(self, flight: Flight) -> bool:
        """Whether the switch is held in the next step."""
        if self._step % EVERY == 0:
            x, y, _, vy, *_ = (flight.env.observe()[0] / OBSERVATION_SCALE).tolist()
            thrust, late = flight.env.params.main_thrust, LATE / 60
            soon = vy - flight.env.gravity * late + thrust / 60 * sum(self._wishes)
            height = y - 0.8 * min(max(abs(x) - 2.5, 0.0), 6.0)
            wanted = -min(0.9 + 0.3 * max(height, 0.0), 2.8) if height > -0.5 else 0.4
            self._wish = soon < wanted and not (y < 0.15 and abs(x) < 2.0)
        self._step += 1
        self._wishes.append(self._wish)
        return self._wishes.popleft()


def one_switch(flight: Flight) -> Flight:
    """Fly to the end with one switch."""
    hand = SlowSwitch()
    while not flight.over:
        flight.step(steered(KEYS[3 * hand.held(flight)], flight.env.observe()))
    return flight
