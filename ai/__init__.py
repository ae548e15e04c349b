"""Everything that decides: the lander's rules, the agent, its training. Never imports pygame."""
