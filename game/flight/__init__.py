"""Flights as the game runs them: who flies, what counts, record and replay, logbook, and forecast of the path."""
