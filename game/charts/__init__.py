"""Live line charts."""
