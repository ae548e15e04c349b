"""The lunar lander: its craft, ground and conditions, what counts and what it is paid for, and pilots that fly it."""

from ai.lander.environment import Cause, LanderEnv, Limits, Outcome
from ai.lander.ground import Ground, Pad
from ai.lander.pilots import Pilot, ScriptedPilot

__all__ = ["Cause", "Ground", "LanderEnv", "Limits", "Outcome", "Pad", "Pilot", "ScriptedPilot"]
