"""Export of replays as GIF."""
