"""Worlds of the physics engine, as its tests run them."""

from engine.world import World


def advance(world: World, steps: int) -> World:
    """Let a world go on for so many steps."""
    for _ in range(steps):
        world.step()
    return world
