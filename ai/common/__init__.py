"""What agents, environments and digit networks share: an environment's contract, a decision, settings."""
