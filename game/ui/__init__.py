"""Widgets, their focus and their forms, for mouse, keyboard and gamepad alike.

Every package of `game` but `core`, `input`, `audio` and `drawing` may import it.
"""
