"""The moon and what flies above it, in metres: drawn in code, at the window's own resolution."""
