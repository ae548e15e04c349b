"""One lesson: a single learning step as a strip of seven frames, beside the code that took it.

May be imported by `cockpit`, `exhibits`, `digits`, `play`, `export`, `shell` and `scenes`.
"""
