"""Nothing tunnels and nothing explodes at the speeds the game reaches."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import Circle, Polygon, World
from tests.engine.test_batch import landers
from tests.support.worlds import advance


@given(st.integers(0, 10**6), st.floats(0, 20), st.floats(0, 1))
@settings(max_examples=5, deadline=None)
def test_a_craft_thrown_down_neither_sinks_nor_explodes(seed, speed, restitution):
    random = np.random.default_rng(seed)
    world = landers(32, restitution)
    craft = world.bodies[-1]
    craft.set(
        position=np.stack([random.uniform(-6, 6, 32), random.uniform(3.2, 6, 32)], axis=1),
        angle=random.uniform(-np.pi, np.pi, 32),
        velocity=np.stack([random.uniform(-3, 3, 32), np.full(32, -speed)], axis=1),
        angular_velocity=random.uniform(-2, 2, 32),
    )
    energy = 0.5 * (craft.velocity**2).sum(axis=1) + 1.62 * craft.position[:, 1]
    energy += 0.5 * craft.inertia / craft.mass * craft.angular_velocity**2
    for _ in range(150):
        world.step()
        inside = abs(craft.position[:, 0]) < 9
        assert (craft.position[inside, 1] > 1.0).all()
        assert (np.hypot(*craft.velocity.T) <= np.sqrt(2 * energy) * 1.15 + 0.1).all()
        assert (abs(craft.angular_velocity) < 60).all()


def test_a_ball_does_not_pass_a_floor_of_its_own_size():
    world = World(gravity=(0.0, 0.0), batch=256)
    world.add(Polygon.box(20.0, 0.6), (0.0, 0.0), static=True)
    ball = world.add(Circle(0.3), (0.0, 5.0))
    starts = np.stack([np.zeros(256), 5 + np.arange(256) % 64 / 128], axis=1)
    speeds = np.repeat([5.0, 10.0, 20.0, 30.0], 64)
    ball.set(velocity=np.stack([np.zeros(256), -speeds], axis=1), position=starts)
    advance(world, 120)
    assert (ball.position[:, 1] > 0.55).all()
