"""The window, its scenes, drawing and input: the only importer of pygame."""
