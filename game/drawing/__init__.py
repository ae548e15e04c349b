"""The canvas and what is drawn on it: type, colours, shapes, signs, and pictures that are painted once."""
