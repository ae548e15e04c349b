"""The commands that need no window. Nothing heavy is imported until one runs.

No other package of `ai` imports it.
"""
