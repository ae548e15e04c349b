"""The solver stops early only where nothing would change, and treats points that nearly coincide as one."""

import numpy as np
import pytest

from engine import Polygon, World
from engine.constraints import Constraints
from tests.engine.test_batch import landers, throw, toys


def flight(make, seed, steps, batch=3):
    """States and impulses of a few seconds."""
    world = make(batch)
    throw(world, seed)
    for _ in range(steps):
        world.step()
        touched = world.contacts
        yield world.state.pose.copy(), world.state.velocity.copy(), touched.impulse.copy() if touched else np.zeros(0)


@pytest.mark.parametrize(("make", "steps"), [(toys, 100), (landers, 150)])
def test_iterations_that_are_left_out_would_have_changed_no_bit(make, steps, monkeypatch):
    early = list(flight(make, 11, steps))
    relax = Constraints.relax
    monkeypatch.setattr(Constraints, "relax", lambda *given: relax(*given) or True)
    for mine, theirs in zip(early, flight(make, 11, steps), strict=True):
        for a, b in zip(mine, theirs, strict=True):
            assert np.array_equal(a, b)
    assert any(len(impulse) for _, _, impulse in early)


def test_of_points_that_nearly_coincide_the_deeper_does_alone():
    world = World(gravity=(0.0, -9.81))
    world.add(Polygon.box(8.0, 1.0), (0.0, -0.5), static=True)
    world.add(Polygon.box(0.002, 1.0), (0.0, 0.499), 0.05, mass=3.0).velocity = (0.0, -1.0)
    world.step()
    contacts = world.contacts
    assert contacts.valid.all()
    deeper = int(contacts.depth[0].argmax())
    assert contacts.impulse[0, deeper] > 1.0
    assert contacts.impulse[0, 1 - deeper] == 0.0


def test_pushes_solve_the_linear_complementarity_problem():
    random = np.random.default_rng(3)
    count, nothing = 500, np.zeros((3, 6, 1))
    first, second = random.uniform(0.5, 2.0, (2, count))
    coupling = random.uniform(-0.9, 0.9, count) * np.sqrt(first * second)
    determinant = first * second - coupling**2
    constraints = Constraints(
        index=np.zeros((6, 1), dtype=int),
        jacobian=nothing,
        response=nothing,
        mass=1 / np.stack([first, second, first]),
        coupling=coupling,
        friction_coupling=nothing[:2, 0],
        inverse=np.stack([second, first]) / determinant,
        cross_inverse=-coupling / determinant,
    )
    total, lacking = random.uniform(0, 1, (2, count)), random.normal(size=(2, count))
    change = constraints.push(lacking, total) - total
    gained = np.stack([first, second]) * change + coupling * change[::-1]
    pushes = total + change
    assert (pushes >= 0).all()
    assert (gained >= lacking - 1e-9).all()
    assert np.abs(pushes * (gained - lacking)).max() < 1e-9
    assert (pushes == 0).any(axis=0).mean() > 0.2


def test_a_point_that_no_longer_counts_keeps_no_impulse():
    world = World(gravity=(0.0, -9.81))
    world.add(Polygon.box(8.0, 1.0), (0.0, -0.5), static=True)
    stick = world.add(Polygon.box(0.002, 1.0), (0.0, 0.499), 0.05, mass=3.0)
    world.step()
    world.contacts.impulse[...] = 1.0  # as if both had pushed until now
    stick.velocity = (0.0, -1.0)
    world.step()
    contacts = world.contacts
    assert contacts.valid.all()
    shallower = int(contacts.depth[0].argmin())
    assert contacts.impulse[0][shallower] == 0.0
