"""Shared parts of agents, environments and digit networks: environment protocol, decisions, settings."""
