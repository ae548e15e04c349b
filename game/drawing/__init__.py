"""Drawing: the canvas, and type, colours, shapes, signs and cached pictures to draw on it."""
