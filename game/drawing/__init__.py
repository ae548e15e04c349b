"""Drawing: the canvas, and type, colours, shapes, signs and cached pictures to draw on it.

Every package of `game` but `core`, `input` and `audio` may import it.
"""
