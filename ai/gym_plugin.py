"""Tells Gymnasium of our lander. Gymnasium calls `register` itself, through the entry point in pyproject.toml."""

from __future__ import annotations

from typing import Final

LANDER_ID: Final = "tranquility/Lander-v0"


def register() -> None:
    """Make `gymnasium.make(LANDER_ID)` and `gymnasium.make_vec(LANDER_ID, ...)` known."""
    import gymnasium

    if LANDER_ID not in gymnasium.registry:
        gymnasium.register(
            LANDER_ID, entry_point="ai.gym_lander:GymLander", vector_entry_point="ai.gym_lander:GymLanders",
            reward_threshold=170.0,
        )  # fmt: skip
