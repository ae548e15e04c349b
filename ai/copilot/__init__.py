"""The co-pilot that shares the stick with a pilot, which pad the pilot means, and how much it helps."""

from ai.copilot.copilot import CoPilot, Mode, Rule, SharedDecision

__all__ = ["CoPilot", "Mode", "Rule", "SharedDecision"]
