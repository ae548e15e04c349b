"""A replay saved as a moving picture."""
