"""Flights on record: how one is noted, what its landing scores, its code for a message, and flying it again.

Imports `ai.lander`, and may be imported by every package above that, and by `game`.
"""
