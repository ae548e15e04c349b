"""Handwritten digits: the drawing pad, the networks' readings of it, and their explanation."""
