"""One lesson: a single learning step, frame by frame, with the code that took it on request."""
