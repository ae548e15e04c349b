"""Panels that explain a network or a training run: Q-values, charts, settings, rewards.

May be imported by `cockpit`, `exhibits`, `digits`, `play`, `export`, `shell` and `scenes`.
"""
