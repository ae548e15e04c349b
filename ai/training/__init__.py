"""Training runs: the loop, what is measured and kept of it, and a session that can be watched and steered."""
