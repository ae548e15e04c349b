"""Deep Q-learning agent: its settings, network, replay buffers and schedules.

May be imported by `training`, `copilot`, `digits`, `gym` and `cli`.
"""

from ai.agent.agent import DeepQAgent
from ai.agent.config import AgentConfig
from ai.agent.replay import PrioritisedReplayBuffer, ReplayBuffer, Transition

__all__ = ["AgentConfig", "DeepQAgent", "PrioritisedReplayBuffer", "ReplayBuffer", "Transition"]
