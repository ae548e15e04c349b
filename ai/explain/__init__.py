"""Explanations: code recorded as it runs, a learning step in pieces, a unit's sum, why a digit is not another one.

It reads networks, agents and readers of digits; none of them knows of it.
"""
