"""Panels that explain a network or a training run: Q-values, charts, settings, rewards."""
