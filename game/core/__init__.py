"""What needs no window: clock, settings, texts, files and worker processes, and what a scene may ask for."""
