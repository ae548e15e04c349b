"""Co-pilot that shares control with a pilot, inference of the pad the pilot means, measurement of the help."""

from ai.copilot.copilot import CoPilot, Mode, Rule, SharedDecision

__all__ = ["CoPilot", "Mode", "Rule", "SharedDecision"]
