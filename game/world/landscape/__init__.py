"""Landscape: sky, ridges, ground, pads and wind, and the themes of other worlds."""
