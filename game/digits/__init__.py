"""Handwritten digits: the drawing pad, the networks' readings of it, and their explanation.

May be imported by `play`, `export`, `shell` and `scenes`.
"""
