"""Lunar lander: its craft, ground, conditions, rules, rewards and environment, and pilots that fly it."""

from ai.lander.environment import Cause, LanderEnv, Limits, Outcome
from ai.lander.ground import Ground, Pad
from ai.lander.pilots import Pilot, ScriptedPilot

__all__ = ["Cause", "Ground", "LanderEnv", "Limits", "Outcome", "Pad", "Pilot", "ScriptedPilot"]
