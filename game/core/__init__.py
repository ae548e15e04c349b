"""Parts that need no window: clock, settings, texts, files, worker processes, and the interface of a scene."""
