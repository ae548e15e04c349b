"""Training runs on the window's side, the settings of the next run, and the saved networks."""
