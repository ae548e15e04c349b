"""Deep Q-learning agent: its settings, network, replay buffers, schedules and files.

To read in this order: config, network, replay, n_step, normalizer, symmetry, schedule, agent, storage. A field of a
configuration is made by `ai.files.knobs.knob`, with its help and range; `ai.environment` has the contract of an
environment.
"""

from ai.agent.agent import DeepQAgent
from ai.agent.config import AgentConfig
from ai.agent.replay import MemoryCell, PrioritisedReplayBuffer, ReplayBuffer, Transition

__all__ = ["AgentConfig", "DeepQAgent", "MemoryCell", "PrioritisedReplayBuffer", "ReplayBuffer", "Transition"]
