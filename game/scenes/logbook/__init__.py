"""The logbook, a flight's replay, and a friend's flight."""
