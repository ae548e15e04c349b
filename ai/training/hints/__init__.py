"""Hints: rules that find visible faults in the recent past of a training run, each with a remedy to try.

The words that a player reads for a rule belong to the game.
"""

from ai.training.hints.adviser import HOLD, REST, STAY, Adviser, Hint
from ai.training.hints.curves import RecentCurves
from ai.training.hints.rules import RULES, HintRule, returns

__all__ = ["HOLD", "REST", "RULES", "STAY", "Adviser", "Hint", "HintRule", "RecentCurves", "returns"]
