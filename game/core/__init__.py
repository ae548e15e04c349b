"""Parts that need no window: clock, settings, texts, files, worker processes, and the interface of a scene.

Every other package of `game` may import it.
"""
