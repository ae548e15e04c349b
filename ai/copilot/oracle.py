"""Oracle: the limit of what a guardian can do, which flies ahead in the exact simulation before every decision."""

from __future__ import annotations

from ai.agent.agent import DeepQAgent
from ai.common.environment import Ints
from ai.copilot.moments import present, saved
from ai.lander.environment import LanderEnv, Outcome

_AHEAD = 2  # decisions of the pilot's after which the agent must still land


class Oracle:
    """Guardian that steps in only where its agent would no longer land after two more of the pilot's decisions.

    It takes far too long for a game, as every decision flies hundreds of flights to their end.
    """

    def __init__(self, agent: DeepQAgent) -> None:
        self.agent = agent

    def share(self, env: LanderEnv, asked: Ints) -> Ints:
        """Return the actions to fly (n,), given what the pilots ask for (n,)."""
        flying = env.outcome == Outcome.FLYING
        action = asked.copy()
        if flying.any():
            lost = flying.copy()
            moments = present(env, asked, flying)
            lost[flying] = ~saved(self.agent, moments, moments.action, _AHEAD)
            action[lost] = self.agent.act(env.observe(), held=env.actions)[lost]
        return action
