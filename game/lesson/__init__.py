"""One lesson: a single learning step as a strip of seven frames, beside the code that took it."""
