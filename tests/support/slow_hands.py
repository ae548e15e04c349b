"""Flies landers with a person's hands: five decisions a second, each from what was to be seen a while ago."""

from collections.abc import Callable

import numpy as np

from ai.lander.environment import LanderEnv, Outcome
from ai.lander.pilots import Pilot

DECISION = 12  # physics steps, of 1/60 s


def fly_slowly(
    env: LanderEnv, pilot: Pilot, late: int = 12, slips: Callable[[], tuple[np.ndarray, np.ndarray]] | None = None
) -> np.ndarray:
    """Fly every slot to its end, `late` physics steps behind; return which landed, (n,).

    `slips`, called for every decision, says which slots are mistaken and what they do instead.
    """
    seen = [env.observe()]
    action = np.zeros(env.num_envs, dtype=np.intp)
    step = 0
    while (env.outcome == Outcome.FLYING).any():
        if step % DECISION == 0:
            action = pilot.act(seen[max(0, len(seen) - 1 - late)])
            if slips:
                mistaken, instead = slips()
                action = np.where(mistaken, instead, action)
        env.fly(action)
        seen = [*seen[-late:], env.observe()]
        step += 1
    return env.outcome == Outcome.LANDED
