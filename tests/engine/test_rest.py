"""What lies still falls asleep, stays where it is, and wakes as soon as anything about it changes."""

from copy import deepcopy

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import Circle, Polygon, World
from tests.engine.test_batch import assert_same
from tests.support.worlds import advance

BOX = Polygon.box(1.0, 1.0)


def tower(height=3, batch=1, gravity=9.81, **settings):
    """A floor, and boxes on it, one on another."""
    world = World(gravity=(0.0, -gravity), batch=batch, **settings)
    world.add(Polygon.box(30.0, 1.0), (0.0, -0.5), static=True)
    for row in range(height):
        world.add(BOX, (0.0, 0.5 + row), friction=0.5)
    return world


def sleeping_tower(**settings):
    world = advance(tower(**settings), 120)
    assert world.asleep[:, 1:].all()
    return world


def test_a_stack_stands_asleep_and_awake():
    for sleeping in (True, False):
        world = tower(height=3, sleeping=sleeping)
        start = world.state.pose.copy()
        advance(world, 240)
        assert world.asleep[:, 1:].all() == world.asleep.any() == sleeping
        then = world.state.pose.tobytes()
        advance(world, 120)
        assert (world.state.pose.tobytes() == then) >= sleeping  # asleep, not by a bit
        assert abs(world.state.pose - start).max() < 0.02
        assert abs(world.state.velocity).max() < (1e-300 if sleeping else 1e-6)
        assert len(world.contacts) == 3
        if sleeping:
            floor = (world.contacts.body == 0).any(axis=1)
            assert world.contacts.impulse[floor, :2].sum() * 60 == pytest.approx(3 * 9.81, rel=1e-3)
            assert not world.contacts.approach.any()


DISTURBANCES = {
    "the lowest box taken": lambda world: setattr(world.bodies[1], "active", False),
    "the floor taken": lambda world: setattr(world.bodies[0], "active", False),
    "the floor lowered": lambda world: setattr(world.bodies[0], "position", (0.0, -0.8)),
    "the floor tilted": lambda world: setattr(world.bodies[0], "angle", 0.3),
    "the floor driven": lambda world: setattr(world.bodies[0], "velocity", (1.0, 0.0)),
    "a push": lambda world: world.bodies[2].apply_force((400.0, 0.0)),
    "a turn": lambda world: world.bodies[3].apply_torque(200.0),
    "a stroke": lambda world: setattr(world.bodies[3], "velocity", (0.0, 3.0)),
    "a spin": lambda world: setattr(world.bodies[3], "angular_velocity", 2.0),
    "another gravity": lambda world: setattr(world, "gravity", (5.0, -9.81)),
}


def test_a_sleeping_stack_wakes_by(subtests):
    asleep, rested = sleeping_tower(), advance(tower(sleeping=False), 120)
    for name, disturb in DISTURBANCES.items():
        with subtests.test(disturb=name):
            world, awake = deepcopy(asleep), deepcopy(rested)
            top = world.bodies[3].position.copy()
            disturb(world)
            world.step()
            assert not world.asleep[0, world.state.active[0]].any()
            advance(world, 30)
            assert abs(world.bodies[3].position - top).max() > 0.002
            disturb(awake)
            advance(awake, 31)
            assert world.state.pose == pytest.approx(awake.state.pose, abs=0.01), "as one that has never slept"


def test_what_touches_wakes_or_leaves_and_nothing_else():
    world = tower(height=2)
    for row in range(2):
        world.add(BOX, (4.0, 0.5 + row))
    stone = world.add(BOX, (0.0, 3.0))
    stone.active = False
    advance(world, 120)
    world.bodies[4].apply_force((0.0, 30.0))
    world.step()
    assert world.asleep[0].tolist() == [False, True, True, False, False, False]
    advance(world, 60)
    stone.active = True
    while world.contacts.body.max() != stone.index:
        world.step()
    assert world.asleep[0].tolist() == [False, False, False, True, True, False]
    advance(world, 200)
    assert world.asleep[0, 1:].all()
    assert stone.position[0, 1] == pytest.approx(2.5, abs=0.02)
    world.add(BOX, (9.0, 0.5))
    world.step()
    assert not world.asleep.any(), "with a body more, all begins awake"


def test_another_gravity_wakes_all():
    world = sleeping_tower(batch=3)
    world.gravity = np.array([[0.0, -9.81], [1.0, -9.81], [0.0, -9.81]])
    world.step()
    assert not world.asleep.any()


def test_without_gravity_a_stack_stays_where_it_is():
    for sleeping in (True, False):
        world = advance(tower(height=5, batch=2, sleeping=sleeping), 300)
        before = world.state.pose.copy()
        world.gravity = np.array([[0.0, 0.0], [0.0, -9.81]])
        advance(world, 120)
        assert np.abs(world.state.pose - before).max() < 1e-3, sleeping


def test_what_floats_creeps_or_rides_is_never_stopped():
    adrift = World(gravity=(0.0, 0.0))
    lonely = adrift.add(Circle(0.5), (0.0, 0.0))
    pair = [adrift.add(BOX, (3.0, y)) for y in (0.0, 0.999)]
    lonely.velocity = (0.004, 0.0)
    advance(adrift, 300)
    assert not adrift.asleep.any()
    assert lonely.position[0, 0] == pytest.approx(0.02)
    assert pair[0].velocity.tolist() == [[0.0, 0.0]]

    lift = World(gravity=(0.0, -9.81))
    plate = lift.add(Polygon.box(4.0, 0.5), (0.0, 0.0), static=True)
    plate.velocity = (0.0, 0.005)
    rider = lift.add(BOX, (0.0, 0.75))
    for _ in range(300):
        lift.step()
        assert not lift.asleep.any()
    assert rider.position[0, 1] == pytest.approx(0.75 + 5 * 0.005, abs=0.006)


def test_what_slides_ever_faster_is_not_stopped_however_slowly_it_begins():
    world = World(gravity=np.array([[0.02, -9.81], [0.05, -9.81], [0.2, -9.81]]), batch=3)
    world.add(Polygon.box(40.0, 1.0), (0.0, -0.5), static=True, friction=0.0)
    box = world.add(BOX, (0.0, 0.5), friction=0.0)
    advance(world, 180)
    assert box.velocity[:, 0] == pytest.approx([0.06, 0.15, 0.6], rel=1e-6)


@pytest.mark.parametrize("pull", [0.0005, 0.01])
def test_what_stands_at_its_turning_point_does_not_sleep(pull):
    world = World(gravity=(-pull, -9.81))  # a floor that slopes a little, without friction
    world.add(Polygon.box(40.0, 1.0), (0.0, -0.5), static=True, friction=0.0)
    box = world.add(BOX, (0.0, 0.5), friction=0.0)
    box.velocity = (2 * pull, 0.0)
    advance(world, 90)
    advanced = 240
    for _ in range(advanced):
        world.step()
        assert not world.asleep.any()
    assert box.velocity[0, 0] == pytest.approx(2 * pull - pull * (90 + advanced) / 60, abs=1e-9)


def high_heap():
    random = np.random.default_rng(0)
    world = World(gravity=(0.0, -9.81))
    world.add(Polygon.box(60.0, 1.0), (0.0, -0.5), static=True)
    for side in (-1, 1):
        world.add(Polygon.box(1.0, 40.0), (side * 6.0, 20.0), static=True)
    for i in range(100):
        size, place = random.uniform(0.5, 1.1, 2), (random.uniform(-1, 1) + 2.2 * (i % 5 - 2), 1.0 + 1.6 * (i // 5))
        world.add(Polygon.box(*size), place, random.uniform(0, 3), friction=0.5)
    return world


@pytest.mark.slow
def test_a_high_heap_of_a_hundred_boxes_comes_to_rest():
    """Without impulses that pass over to new points it creeps by centimetres a second for ever."""
    world = advance(high_heap(), 1800)
    before = world.state.pose.copy()
    advance(world, 300)
    assert np.abs(world.state.pose - before)[..., :2].max() < 0.005
    assert np.where(world.contacts.valid, world.contacts.depth, 0.0).max() < 0.01


def heap(seed):
    random = np.random.default_rng(seed)
    world = World(gravity=(0.0, -9.81))
    world.add(Polygon.box(30.0, 1.0), (0.0, -0.5), static=True)
    for side in (-1, 1):
        world.add(Polygon.box(1.0, 16.0), (side * 3.0, 8.0), static=True)
    for i in range(24):
        place = (random.uniform(-0.3, 0.3) + 1.2 * (i % 4) - 1.8, 1.0 + 1.2 * (i // 4))
        shape = Circle(random.uniform(0.25, 0.45)) if i % 6 == 0 else Polygon.box(*random.uniform(0.5, 1.1, 2))
        world.add(shape, place, random.uniform(0, 3), friction=0.5, angular_drag=0.02)
    return world


def test_a_heap_comes_to_rest_and_sleeps_island_by_island():
    world = heap(0)
    for _ in range(600):
        world.step()
        for pair in world.contacts.body[(world.contacts.body > 2).all(axis=1)] if world.contacts else ():
            assert world.asleep[0, pair[0]] == world.asleep[0, pair[1]]
    assert world.asleep[0, 3:].all()
    assert np.where(world.contacts.valid, world.contacts.depth, 0.0).max() < 0.02


@settings(max_examples=3, deadline=None)
@given(data=st.data())
def test_worlds_that_sleep_and_wake_in_a_batch_are_the_same_alone(data):
    batch = 2
    many, few = tower(batch=batch), [tower() for _ in range(batch)]
    for row in range(batch):
        aside = data.draw(st.floats(-0.1, 0.1))
        many.bodies[2].set(position=(aside, 1.5), mask=np.arange(batch) == row)
        few[row].bodies[2].position = (aside, 1.5)
    for _ in range(5):
        row = data.draw(st.integers(0, batch - 1))
        body = data.draw(st.integers(1, 3))
        kind = data.draw(st.sampled_from(["push", "throw", "nothing"]))
        mask = np.arange(batch) == row
        if kind == "push":
            many.bodies[body].apply_force(mask[:, None] * np.array([150.0, 0.0]))
            few[row].bodies[body].apply_force((150.0, 0.0))
        elif kind == "throw":
            many.bodies[body].set(velocity=(1.0, 2.0), mask=mask)
            few[row].bodies[body].velocity = (1.0, 2.0)
        for _ in range(data.draw(st.integers(5, 32))):
            many.step()
            for row, alone in enumerate(few):
                alone.step()
                assert_same(many, alone, [row])
                assert many.asleep[row].tolist() == alone.asleep[0].tolist()
