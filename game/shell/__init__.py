"""Application shell: the window, the main loop and the scene stack.

May be imported by `scenes`.
"""
