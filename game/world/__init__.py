"""The moon and what flies above it: drawn in code, at the window's own resolution."""
