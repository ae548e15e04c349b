"""One step, taken to pieces: it ends as the engine's own step does, and the pieces add up to it, bit for bit."""

import copy
from functools import cache

import numpy as np
import pytest

from engine import World
from engine.contacts import MARGIN
from game.core.source import source_of
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


@pytest.mark.parametrize("name", MOMENTS)
def test_impulses_lead_from_one_to_the_next_and_end_as_the_solver_left_them(name: str):
    _, record = moment(name)
    contacts = record.contacts
    if contacts is None:
        assert not record.impulses
        return
    # Iterations end once one has changed nothing.
    assert 0 < len(record.impulses) <= len(contacts) * record.exhibit.world.iterations
    assert len(record.impulses) % len(contacts) == 0
    velocity = record.warm.copy()
    dynamic = record.exhibit.world.params.dynamic
    total: dict[int, np.ndarray] = {}
    for impulse in record.impulses:
        before, after = impulse.motion
        assert before[dynamic[impulse.bodies]].tobytes() == velocity[impulse.bodies][dynamic[impulse.bodies]].tobytes()
        velocity[impulse.bodies] = after
        if impulse.contact in total:
            assert impulse.before.tobytes() == total[impulse.contact].tobytes()
        total[impulse.contact] = impulse.after
        assert (impulse.after[:2] >= 0).all()
        assert abs(impulse.after[2]) <= float(impulse.value("cone"))
    assert np.abs(velocity - record.after[1]).max() < 1e-3  # pushes out of overlaps take a little
    for contact, last in total.items():
        assert last.tobytes() == np.ascontiguousarray(contacts.impulse[contact]).tobytes()


def test_the_chosen_axis_is_the_one_of_least_overlap_and_gives_normal_and_depth(subtests: pytest.Subtests):
    for name in MOMENTS:
        with subtests.test(name=name):
            _, record = moment(name)
            for pair in record.pairs:
                (low_a, high_a), (low_b, high_b) = (np.split(record.boxes[body], 2) for body in pair.bodies)
                assert (low_a <= high_b).all()  # only bodies whose boxes overlap make a pair
                assert (low_b <= high_a).all()
                gaps = [axis.gap for axis in pair.axes]
                assert gaps[pair.chosen] == pytest.approx(max(gaps), abs=1e-3)
                if pair.contact is None:
                    continue
                assert gaps[pair.chosen] <= MARGIN + 1e-9
                assert record.contacts is not None
                manifold, row, axis = record.contacts, pair.contact, pair.axes[pair.chosen]
                normal = axis.direction if axis.first else -axis.direction
                assert manifold.normal[row] == pytest.approx(normal)
                deepest = manifold.depth[row][manifold.valid[row]].max()
                assert deepest <= -axis.gap + 1e-9  # the deepest corner may lie beside the other shape's face
                assert pair.circles == 0 or deepest == pytest.approx(-axis.gap, abs=1e-9)
            touching = [pair.contact for pair in record.pairs if pair.contact is not None]
            assert sorted(touching) == list(range(len(record.contacts) if record.contacts else 0))


def test_every_piece_has_words_figures_and_a_line_of_its_function(subtests: pytest.Subtests):
    for name in MOMENTS:
        with subtests.test(name=name):
            _, record = moment(name)
            for followed in (*record.pairs[:4], *([] if record.pairs else [None])):
                pieces = record.pieces(followed)
                kinds = list(dict.fromkeys(piece.kind for piece in pieces))
                assert kinds[0] == "boxes"
                assert kinds[-1] == "end"
                assert ("impulses" in kinds) is any(
                    piece.impulse is not None and piece.kind == "impulses" for piece in pieces
                )
                of_pair = {piece.impulse.contact for piece in pieces if piece.impulse}
                assert of_pair <= {followed and followed.contact}
                for piece in pieces[:20] + pieces[-5:]:
                    source = source_of(piece.function)
                    assert source is not None
                    numbers = {number for number, _ in source.lines}
                    assert piece.function is World.step or piece.line in numbers
                    assert set(piece.notes or {}) <= numbers
                    sentences = " ".join([record.sentence(piece, followed), *(piece.notes or {}).values()])
                    assert "nan" not in sentences
                    assert "{" not in sentences


def test_a_hand_that_pulls_is_part_of_the_step():
    exhibit = EXHIBITS["stack"](EARTH)
    body = exhibit.bodies[-1]  # the ball
    grip = Grip(body, body.position[0].copy())
    grip.target = np.array((3.0, 3.0))
    record = StepRecord(exhibit, grip)
    exhibit.step(grip)
    assert record.after[1].tobytes() == exhibit.world.state.velocity.tobytes()
    assert record.fallen[body.index, 0] > 0.1
