"""Draw a digit: the pad, what the networks read, why they read it; a quiz against them, and what they dream of."""
