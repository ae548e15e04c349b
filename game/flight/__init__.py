"""Flights as the game runs them: who flies, what counts, record and replay, logbook, and forecast of the path.

Every package of `game` but `core`, `input`, `audio`, `drawing`, `ui` and `charts` may import it.
"""
