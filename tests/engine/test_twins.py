"""Fast ways of the engine beside the slow, obvious ones: the same results, bit for bit."""

import numpy as np
import pytest

from engine import Polygon, World
from engine.solver import Solver
from tests.engine.test_batch import landers, throw, toys


def relax(rows, velocity, total, wanted, friction):
    """Bring manifolds to rest, one formula after another, with a new array for each: what `Rows.relax` computes."""
    motion = velocity[rows.index]
    speed = np.zeros_like(total)
    for part in range(6):
        speed += rows.jacobian[:, part] * motion[part]
    lacking = wanted - speed[:2]
    both = total[:2] + rows.inverse * lacking + rows.cross_inverse * lacking[::-1]
    alone = total[:2] + rows.mass[:2] * (lacking + rows.coupling * total[1::-1])
    pushes = np.maximum(np.where(both[::-1] >= 0, both, alone), 0.0)
    change = np.zeros_like(total)
    change[:2] = pushes - total[:2]
    sliding = speed[2] + rows.rub_coupling[0] * change[0] + rows.rub_coupling[1] * change[1]
    cone = (friction if friction is not None else 0.0) * (pushes[0] + pushes[1])
    change[2] = np.clip(total[2] - rows.mass[2] * sliding, -cone, cone) - total[2]
    total += change
    velocity[rows.index] = motion + rows.effect(change)


class ObviousSolver(Solver):
    """Solver that runs every iteration, in the obvious way."""

    def _sweep(self, velocity, impulse, target, friction, iterations):
        for _ in range(iterations):
            for rows, span in zip(self._colours, self._spans, strict=True):
                relax(rows, velocity, impulse[:, span], target[:, span], None if friction is None else friction[span])


def flight(make, seed, steps, batch=3):
    """States and impulses of a few seconds."""
    world = make(batch)
    throw(world, seed)
    for _ in range(steps):
        world.step()
        touched = world.contacts
        yield world.state.pose.copy(), world.state.velocity.copy(), touched.impulse.copy() if touched else None


def assert_same(one, two):
    touched = 0
    for mine, theirs in zip(one, two, strict=True):
        for a, b in zip(mine, theirs, strict=True):
            assert np.array_equal(a, b)
        touched += mine[-1] is not None
    assert touched


@pytest.mark.parametrize(("make", "steps"), [(toys, 150), (landers, 250)])
def test_the_solver_gives_what_all_iterations_give_in_the_obvious_way(make, steps, monkeypatch):
    fast = list(flight(make, 11, steps))
    monkeypatch.setattr("engine.world.Solver", ObviousSolver)
    assert_same(fast, flight(make, 11, steps))


def test_the_solver_stops_when_nothing_changes_any_more(monkeypatch):
    calls = []
    world = World(gravity=(0.0, -9.81), sleeping=False)
    world.add(Polygon.box(20.0, 1.0), (0.0, -0.5), static=True)
    world.add(Polygon.box(1.0, 1.0), (0.0, 0.5))
    world.add(Polygon.box(1.0, 1.0), (20.0, 0.5))  # falls, or no step would be computed at all
    for _ in range(120):
        world.step()
    inner = Solver.solve_velocities.__globals__["Rows"].relax
    monkeypatch.setattr("engine.solver.Rows.relax", lambda *given: calls.append(1) or inner(*given))
    world.step()
    assert 0 < len(calls) <= 2


def test_a_body_set_down_elsewhere_is_looked_for_there():
    world = World(gravity=(0.0, 0.0))
    world.add(Polygon.box(4.0, 1.0), (0.0, 0.0), static=True)
    box = world.add(Polygon.box(1.0, 1.0), (0.0, 10.0))
    for _ in range(5):
        world.step()
    box.position = (0.0, 0.99)
    world.step()
    assert world.contacts is not None
