"""Moment: everything that flights depend on but their random streams, as plain arrays, numbers and texts.

It can be taken from an environment and put back into it or into another one over the same ground, cut down to some of
its landers, and pickled for another process.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ai.environment import Doubles, Ints
from ai.lander.conditions import Conditions
from ai.lander.ground import Ground
from ai.lander.rules import LanderParams, Limits
from engine.world import World, memory_of_worlds

if TYPE_CHECKING:
    from ai.lander.environment import LanderEnv

_RULES: Final = {"params": LanderParams, "limits": Limits, "conditions": Conditions}
# What of the craft is built into the engine's tables; the other parameters may differ from lander to lander.
_BUILT: Final = ("mass", "inertia", "linear_drag", "angular_drag", "angular_quadratic_drag", "restitution", "friction")


def _built(params: LanderParams, ground: Ground) -> str:
    """Return a text that says what the bodies of a world were made of."""
    return f"{[getattr(params, name) for name in _BUILT]} {ground.text}"


def _values(record: Any) -> dict[str, Any]:
    return {field.name: getattr(record, field.name) for field in fields(record)}


def _one(rows: Doubles) -> Doubles:
    """Return the row that all (n, ...) are, or else all of them."""
    return rows[0] if (rows == rows[0]).all() else rows


def _put_air(world: World, air: Doubles) -> None:
    """Replace a table of drag only if it must be: the world is made anew then."""
    if world.params.quadratic_drag.ndim == 3:
        world.params.quadratic_drag[:] = air
    elif not (world.params.quadratic_drag == air).all():
        world.params = replace(world.params, quadratic_drag=_one(air))


@dataclass(frozen=True, eq=False)
class Moment:
    """A snapshot of n landers and the ground that they fly over.

    Numbers of the snapshot's `params`, `limits` and `conditions` may be arrays (n,), one for each lander.
    """

    ground: Ground
    state: dict[str, Any]

    @classmethod
    def of(cls, env: LanderEnv) -> Moment:
        """Return the present moment of an environment."""
        world, count = env.world, env.num_envs
        state = {
            "built": _built(env.params, env.ground),
            **{name: _values(getattr(env, name)) for name in _RULES},
            "strictness": env.strictness,
            "gravity": np.broadcast_to(world.gravity, (count, 2)).copy(),
            "air": np.broadcast_to(world.params.quadratic_drag, (count, len(world.bodies), 3)).copy(),
            "landers": {name: getattr(env, name).copy() for name in env.kept},
            "bodies": {name: value.copy() for name, value in _values(world.state).items()},
            "memory": world.memory(),
            "landings": env.landings,
        }
        return cls(env.ground, state)

    def __len__(self) -> int:
        return len(self.target)

    @property
    def target(self) -> Ints:
        """Number of the pad that each flies to, (n,)."""
        target: Ints = self.state["landers"]["target"]
        return target

    @property
    def steps(self) -> Ints:
        """Physics steps that each has flown, (n,)."""
        steps: Ints = self.state["landers"]["steps"]
        return steps

    @property
    def built(self) -> str:
        """Text that is the same for moments that can be put into the same environments."""
        return str(self.state["built"])

    def take(self, rows: Ints) -> Moment:
        """Return the moment of the landers `rows` (m,), each of them as often as it is named."""
        state = {name: _taken(value, rows) for name, value in self.state.items() if name != "memory"}
        return Moment(self.ground, {**state, "memory": memory_of_worlds(self.state["memory"], rows)})

    def put(self, env: LanderEnv) -> None:
        """Put it into an environment of as many slots as it has landers, as `LanderEnv.restore` does."""
        state, world = self.state, env.world
        if state["built"] != _built(env.params, env.ground) or len(state["gravity"]) != env.num_envs:
            raise ValueError("a snapshot belongs to the same craft over the same ground, and to as many landers")
        for name, kind in _RULES.items():
            setattr(env, name, kind(**state[name]))
        for name in env.kept:
            setattr(env, name, state["landers"][name].copy())
        world.gravity = _one(state["gravity"])
        _put_air(world, state["air"])
        for name, value in state["bodies"].items():
            setattr(world.state, name, value.copy())
        world.recall(state["memory"])
        env.strictness, env.landings = state["strictness"], state["landings"]
        env.begun = True


def _taken(value: Any, rows: Ints) -> Any:
    """Return the rows (m,) of those arrays in a value that have a row for each lander."""
    if isinstance(value, dict):
        return {name: _taken(part, rows) for name, part in value.items()}
    if isinstance(value, tuple):
        return tuple(_taken(part, rows) for part in value)
    return value[rows] if isinstance(value, np.ndarray) and value.ndim else value
