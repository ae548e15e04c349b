"""One lesson: a single learning step as a strip of frames, beside the code that took it."""
