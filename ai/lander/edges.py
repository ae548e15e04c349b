"""Edges of the area that a lander comes near, before it leaves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

from ai.lander.environment import LanderEnv, Outcome

NEAR: Final = 10.0  # metres within which an edge is announced


@dataclass(frozen=True)
class Edge:
    """An edge near a lander: its `place` is a metre mark across, or up for the one above; `away` is in metres."""

    side: Literal["left", "right", "above"]
    place: float
    away: float
    ahead: bool  # whether the lander moves towards it


def near_edges(env: LanderEnv, slot: int = 0) -> list[Edge]:
    """Return the edges of the area within `NEAR` of a lander in flight, the nearest first."""
    if env.outcome[slot] != Outcome.FLYING:
        return []
    (x, y), (across, up), limits = env.position[slot].tolist(), env.velocity[slot].tolist(), env.limits
    wide, ceiling = limits.half_width, limits.ceiling
    edges = (
        Edge("left", -wide, max(0.0, x + wide), across < 0),
        Edge("right", wide, max(0.0, wide - x), across > 0),
        Edge("above", ceiling, max(0.0, ceiling - y), up > 0),
    )
    return sorted((edge for edge in edges if edge.away < NEAR), key=lambda edge: edge.away)
