"""Training runs as the window knows them, the settings chosen for the next, and the networks that were kept."""
