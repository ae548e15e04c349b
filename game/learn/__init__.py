"""The path: ten short chapters, each one question and one thing to touch, with the real network, engine and agent."""
