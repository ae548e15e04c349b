"""One scene to a file."""
