"""Deep Q-learning agent: its settings, network, replay buffers and schedules.

May be imported by `training`, `copilot`, `digits`, `gym` and `cli`.
"""

from ai.agent.agent import DeepQAgent
from ai.agent.config import PRESETS, Config
from ai.agent.replay import MemoryCell, PrioritisedReplayBuffer, ReplayBuffer

__all__ = ["PRESETS", "Config", "DeepQAgent", "MemoryCell", "PrioritisedReplayBuffer", "ReplayBuffer"]
