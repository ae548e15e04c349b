"""Application shell: the window, the main loop and the scene stack."""
