"""Widgets, their focus and their forms, for mouse, keyboard and gamepad alike."""
