"""Contacts of one step: what touches in all worlds, how hard it met and with what impulses it parted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.collide import Manifold
from engine.vector import Array, Ints


@dataclass
class Contacts:
    """The touching pairs of one step, m of them, in the order of their colours."""

    world: Ints  # (m,)
    pair: Ints  # (m,) row of the world's table of shape pairs
    body: Ints  # (m, 2) A and B
    manifold: Manifold
    friction: Array  # (m,)
    restitution: Array  # (m,)
    impulse: Array  # (3, m) N·s: normal, normal, friction; begins with what the last step needed
    approach: Array  # (3, m) m/s before the impulses: closing at each point, then sliding
    age: Ints  # (m,) steps for which the pair has touched without a break
    colour_ends: list[int]  # manifolds up to each of these indices share no dynamic body

    def __len__(self) -> int:
        return len(self.world)

    @classmethod
    def join(cls, solved: Contacts | None, kept: Contacts | None) -> Contacts | None:
        """Return the contacts of a step, and after them those of sleeping bodies, which it left as they were."""
        if solved is None or kept is None:
            return solved or kept
        return cls(
            world=np.concatenate([solved.world, kept.world]),
            pair=np.concatenate([solved.pair, kept.pair]),
            body=np.concatenate([solved.body, kept.body]),
            manifold=Manifold.join(solved.manifold, kept.manifold),
            friction=np.concatenate([solved.friction, kept.friction]),
            restitution=np.concatenate([solved.restitution, kept.restitution]),
            impulse=np.concatenate([solved.impulse, kept.impulse], axis=1),
            approach=np.concatenate([solved.approach, kept.approach], axis=1),
            age=np.concatenate([solved.age, kept.age]),
            colour_ends=solved.colour_ends,
        )

    def resting(self, rows: Ints) -> Contacts | None:
        """Return these contacts as those of sleeping bodies, which do not move; None if there are none."""
        if not len(rows):
            return None
        return Contacts(
            world=self.world[rows],
            pair=self.pair[rows],
            body=self.body[rows],
            manifold=self.manifold.rows(rows),
            friction=self.friction[rows],
            restitution=self.restitution[rows],
            impulse=self.impulse[:, rows],
            approach=np.zeros((3, len(rows))),
            age=self.age[rows],
            colour_ends=[],
        )
