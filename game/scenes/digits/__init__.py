"""Draw a digit: the pad, what the networks read, why they read it, and what they dream of."""
