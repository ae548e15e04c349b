"""Co-pilot that shares control with a pilot, inference of the pad the pilot means."""

from ai.copilot.copilot import CoPilot, Mode, SharedDecision
from ai.copilot.guardian import ActionSource

__all__ = ["ActionSource", "CoPilot", "Mode", "SharedDecision"]
