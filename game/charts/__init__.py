"""Live line charts.

Every package of `game` but `core`, `input`, `audio`, `drawing` and `ui` may import it.
"""
