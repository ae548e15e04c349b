"""Training runs on the window's side, the settings of the next run, and the saved networks.

Every package of `game` but `core`, `input`, `audio`, `drawing`, `ui`, `charts` and `flight` may import it.
"""
