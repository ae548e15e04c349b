"""One step, taken to pieces: it ends as the engine's own step does, bit for bit."""

import copy
from functools import cache

import numpy as np
import pytest

from game.scenes.physics.exhibit import Exhibit, Grip
from game.scenes.physics.exhibits import EXHIBITS
from game.scenes.physics.step import StepRecord

EARTH = 9.81
# Exhibits and steps at which much happens: rest, fall, sliding, rebound, impacts, flight, a push.
MOMENTS = {"stack": 40, "heap": 95, "slopes": 20, "bounce": 66, "impacts": 113, "drag": 20}


@cache
def moment(name: str) -> tuple[Exhibit, StepRecord]:
    exhibit = EXHIBITS[name](EARTH, {"count": 20.0} if name == "heap" else {})
    for _ in range(MOMENTS[name]):
        exhibit.step()
    return exhibit, StepRecord(exhibit)


def state(exhibit: Exhibit) -> bytes:
    world = exhibit.world
    contacts = world.contacts.impulse.tobytes() if world.contacts else b""
    return world.state.pose.tobytes() + world.state.velocity.tobytes() + contacts


def test_the_recorded_step_ends_as_the_unrecorded_one_bit_for_bit(subtests: pytest.Subtests):
    for name in MOMENTS:
        with subtests.test(name=name):
            exhibit, record = moment(name)
            before = state(exhibit)
            twin = copy.deepcopy(exhibit)
            twin.step()
            assert state(record.exhibit) == state(twin)
            assert record.after[0].tobytes() == twin.world.state.pose.tobytes()
            assert record.after[1].tobytes() == twin.world.state.velocity.tobytes()
            assert state(exhibit) == before  # the exhibit itself has not moved
            later = copy.deepcopy(record.exhibit)
            for _ in range(3):  # and what both remember for the next steps is the same
                twin.step()
                later.step()
            assert state(later) == state(twin)


def test_the_chosen_axis_gives_the_normal_and_the_next_step_its_figures(subtests: pytest.Subtests):
    for name in MOMENTS:
        with subtests.test(name=name):
            _, record = moment(name)
            contacts = record.contacts
            for pair in record.pairs:
                (low_a, high_a), (low_b, high_b) = (np.split(record.boxes[body], 2) for body in pair.bodies)
                assert (low_a <= high_b).all()  # only bodies whose boxes overlap make a pair
                assert (low_b <= high_a).all()
                if contacts is not None and pair.contact is not None:
                    assert contacts.normal[pair.contact] == pytest.approx(pair.to_b)
                for piece in record.pieces(pair):
                    assert "{" not in record.sentence(piece, pair)
            touching = [pair.contact for pair in record.pairs if pair.contact is not None]
            assert sorted(touching) == list(range(len(contacts) if contacts else 0))


def test_a_hand_that_pulls_is_part_of_the_step():
    exhibit = EXHIBITS["stack"](EARTH)
    body = exhibit.bodies[-1]  # the ball
    body.angle = 0.6
    grip = Grip(body, place := body.position[0] + (0.2, 0.1))
    assert grip.place(exhibit.poses[body.index]) == pytest.approx(place), "it holds what was gripped"
    grip.target = np.array((3.0, 3.0))
    record = StepRecord(exhibit, grip)
    exhibit.step(grip)
    assert record.after[1].tobytes() == exhibit.world.state.velocity.tobytes()
    assert record.fallen[body.index, 0] > 0.1
