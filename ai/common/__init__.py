"""Shared parts of agents, environments and digit networks: environment protocol, decisions, settings.

Every other package of `ai` may import it.
"""
