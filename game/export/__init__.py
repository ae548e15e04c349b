"""Export of replays as GIF or MP4."""
