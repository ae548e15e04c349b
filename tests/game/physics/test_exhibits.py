"""Exhibits: what happens in them, and what is said of it from the first step on, at rest, and with a hand in it."""

import re
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from game.core import texts
from game.scenes.physics.exhibit import Exhibit, Grip
from game.scenes.physics.exhibits import EXHIBITS, Heap, Impacts, Stack
from game.scenes.physics.falls import Bounce, DragRace, Slopes
from game.scenes.physics.scene import GRAVITIES

MOON, EARTH = GRAVITIES
FEW = {"count": 20.0}  # bodies of a heap: a hundred take long


def said(exhibit: Exhibit) -> str:
    return texts.EXHIBITS[exhibit.name][2][exhibit.state].format(**exhibit.figures())


def figures(sentence: str) -> list[float]:
    return [float(figure) for figure in re.findall(r"-?\d+\.?\d*", sentence)]


def words(exhibit: Exhibit) -> list[str]:
    return [label.text for label in exhibit.labels()]


def hold(exhibit: Exhibit, body: Any, to: tuple[float, float], steps: int = 40) -> None:
    """Take hold of a body's middle, pull it to a place, and let go there."""
    grip = Grip(body, body.position[0].copy())
    grip.target = np.array(to)
    for _ in range(steps):
        exhibit.step(grip)


def life(exhibit: Exhibit, seconds: float, hands: int = 0) -> Iterator[None]:
    """Let time pass, every now and then with a hand that throws something about; yield before each step."""
    rng = np.random.default_rng(5)
    steps = round(60 * seconds)
    grip, pause = None, steps // max(1, 2 * hands)
    for step in range(steps):
        yield
        if hands and step % pause == 0:
            body = exhibit.bodies[rng.integers(len(exhibit.bodies))]
            grip = None if grip else Grip(body, body.position[0].copy())
        if grip:
            grip.target = rng.uniform((-0.4 * exhibit.width, 0.5), (0.4 * exhibit.width, 0.3 * exhibit.width))
        exhibit.step(grip)


def run(exhibit: Any, seconds: float) -> Any:
    for _ in life(exhibit, seconds):
        pass
    return exhibit


@pytest.mark.parametrize("name", EXHIBITS)
def test_every_exhibit_keeps_within_its_room_and_says_each_of_its_sentences(name: str):
    states = set()
    for hands, seconds in ((0, 4.0), (6, 1.0)):
        shown: Any = EXHIBITS[name](EARTH, FEW if name == "heap" else {})
        for _ in life(shown, seconds, hands):
            states.add(shown.state)
        assert np.isfinite(shown.world.state.velocity).all()
        assert "nan" not in said(shown)
        for body in shown.bodies if not hands else ():
            assert abs(body.position[0, 0]) < shown.width / 2
            assert body.position[0, 1] > 0.1
    if name in ("bounce", "drag"):
        shown = EXHIBITS[name](EARTH)
        hold(shown, shown.balls[3] if name == "bounce" else shown.discs[1], (1.0, 8.0))
        states.add(shown.state)
    if name == "impacts":
        states.add(EXHIBITS[name](EARTH, {"restitution": 0.8}).state)
    if name == "stack":
        states.add("fallen")  # has a test of its own
    assert states == set(texts.EXHIBITS[name][2])


@pytest.mark.parametrize("name", EXHIBITS)
def test_nothing_that_a_hand_throws_or_drags_leaves_the_room(name: str):
    rng = np.random.default_rng(2)
    shown: Any = EXHIBITS[name](MOON, FEW if name == "heap" else {})
    far = [(-90.0, 3.0), (90.0, 90.0), (0.0, 300.0), (3.0, -80.0), (-90.0, -90.0), (90.0, 0.5)]
    for number, target in enumerate(far * 2):
        body = shown.bodies[(5 * number) % len(shown.bodies)]
        grip = Grip(body, body.position[0] + rng.uniform(-0.1, 0.1, 2))
        grip.target = np.array(target)
        for _ in range(rng.integers(8, 60)):
            shown.step(grip)
        for _ in range(20):
            shown.step()
        place = shown.world.state.pose[0, [each.index for each in shown.bodies], :2]
        assert (np.abs(place[:, 0]) < shown.width / 2).all(), target
        assert (place[:, 1] > 0).all(), target
        assert (place[:, 1] < shown.height).all(), target


def test_every_quantity_has_words_and_begins_at_a_value_that_can_be_chosen():
    assert texts.EXHIBITS.keys() == EXHIBITS.keys()
    assert texts.QUANTITIES.keys() == {each.name for kind in EXHIBITS.values() for each in kind.quantities}
    for each in (quantity for kind in EXHIBITS.values() for quantity in kind.quantities):
        low, high = each.limits
        steps = (np.array([high, each.start]) - low) / each.step
        assert steps == pytest.approx(np.rint(steps), abs=1e-6), each.name
        assert low <= each.start <= high


# Many bodies


@pytest.mark.parametrize(("gravity", "hands"), [(MOON, 0), (EARTH, 8)])
def test_a_column_weighs_what_is_said_and_is_said_to_stand_only_while_it_does(gravity: float, hands: int):
    stack = Stack(gravity)
    for _ in life(stack, 2.0, hands):
        count, *_ = figures(said(stack).removeprefix("No column stands. "))
        if "No column" in said(stack):
            assert count == len(stack.bodies)
        else:
            assert max(column[1].position[0, 1] for column in stack.columns) > stack.box  # on one that stands
            assert said(stack).startswith(f"A column of {count:.0f} boxes of 1 kg weighs {count * gravity:.1f} N")
        if stack.steps and not hands:
            assert ("pushes" in said(stack)) is (stack.steps >= 60)
        if "pushes" in said(stack) and not hands:
            assert figures(said(stack))[-1] == pytest.approx(count * gravity, rel=0.01)


def test_fallen_columns_are_said_to_have_fallen_and_the_ground_carries_all_there_is():
    stack = Stack(EARTH, {"boxes": 4.0})
    for column in stack.columns:
        for box in column[1:]:
            box.position = (box.position[0, 0] * 0.3 + 0.9 * float(box.position[0, 1]), float(box.position[0, 1]))
    for _ in life(stack, 30.0):  # a heap of boxes comes to lie when it comes to lie
        if stack.steps > 60 and stack.kinetic_energy < 0.001:
            break
    count, weight, push = figures(said(stack))
    assert said(stack).startswith("No column stands")
    assert (count, weight) == (len(stack.bodies), pytest.approx(EARTH * sum(b.mass for b in stack.bodies), abs=0.06))
    assert push == pytest.approx(weight, rel=0.02)


def test_a_heap_only_ever_loses_energy_and_comes_to_rest():
    heap = Heap(EARTH, FEW)
    energies = [run(heap, 1 / 60).energy for _ in range(300)]
    assert max(after - before for before, after in pairwise(energies)) < 1e-3 * heap.at_first
    assert heap.energy < 0.5 * heap.at_first
    assert heap.kinetic_energy < 1e-3 * heap.at_first


@pytest.mark.parametrize("kind", [Heap, Impacts])
def test_energy_that_a_hand_brings_in_is_named(kind: Callable[..., Any]):
    exhibit = kind(MOON, FEW if kind is Heap else {})
    first = exhibit.energy if kind is Heap else exhibit.kinetic_energy
    for _ in life(exhibit, 2.0):
        at_first, now = figures(said(exhibit).replace("e = 1", ""))
        assert "hand" not in said(exhibit)
        assert at_first == pytest.approx(first, abs=0.51)
        assert now <= at_first
        assert kind is Heap or now == at_first
    hold(exhibit, exhibit.bodies[0], (3.0, 9.0))
    assert "hand" in said(exhibit)
    assert figures(said(exhibit))[1] > figures(said(exhibit))[0] or kind is Heap


def test_as_many_discs_leave_as_have_struck_and_rails_are_named_by_the_discs_on_them():
    impacts = Impacts(MOON)
    assert words(impacts)[0].startswith("1 in motion at first  ·  1 now")
    run(impacts, 2.6)
    for struck, discs in enumerate(impacts.discs, start=1):
        paces = [float(disc.velocity[0, 0]) for disc in discs]
        assert paces == pytest.approx([0.0] * impacts.row + [impacts.pace] * struck, abs=0.01)
    run(impacts, 7.0)  # off the walls and back through the rows
    assert impacts.kinetic_energy == pytest.approx(impacts.energy_at_first, rel=1e-3)
    impacts.discs[0][-1].position = (9.0, 5.0)
    assert [len(impacts.on_rail(number)) for number in range(3)] == [6, 9, 9]


# Single bodies


def test_those_boxes_slide_whose_friction_is_less_than_the_slope_and_only_such_as_did_by_themselves_count():
    slopes = run(Slopes(MOON), 5.0)
    steep = np.tan(np.radians(slopes.values["degrees"]))
    assert slopes.slid == {number for number, friction in enumerate(slopes.frictions) if friction < steep}
    lying = 0
    slopes = Slopes(EARTH)
    for _ in life(slopes, 5.0, hands=4):
        assert figures(said(slopes))[2] <= sum(friction < steep for friction in slopes.frictions)
        for box, friction, label in zip(slopes.boxes, slopes.frictions, slopes.labels(), strict=True):
            if label.within is None:
                assert label.text == f"μ = {friction:.2f}"
                continue
            lying += 1
            tangent, shown = figures(label.text)
            assert (shown, label.within) == (friction, tangent <= friction)
            assert tangent == pytest.approx(steep, abs=0.01)
            assert abs(np.tan(float(box.angle[0]))) == pytest.approx(tangent, abs=0.12)
    assert lying > 60
    still = Slopes(EARTH)
    hold(still, still.boxes[-1], (0.0, 12.0))
    assert len(still.frictions) - 1 not in still.slid


def test_a_ball_comes_back_to_e_squared_of_its_height_and_is_said_to_only_once_it_has():
    bounce = Bounce(MOON)
    ball, states, below, up = bounce.balls[3], [], False, False
    for _ in life(bounce, 6.0):
        bottom = float(ball.position[0, 1]) - bounce.radius
        below |= bottom < 0.005
        up |= below and float(ball.velocity[0, 1]) > 0
        state = next(word for word in ("not bounced", "on its way up", "came back") if word in said(bounce))
        states += [state] if state not in states else []
        if state == "not bounced":
            assert not up
        elif state == "on its way up":
            assert float(ball.velocity[0, 1]) > 0
            assert figures(said(bounce))[-1] == pytest.approx(bottom, abs=0.005)
        assert ("was" in words(bounce)[6]) is (state == "came back")
    assert states == ["not bounced", "on its way up", "came back"]
    expected = np.square(bounce.restitutions) * bounce.values["drop"]
    assert bounce.peaks == pytest.approx(expected, rel=0.03, abs=0.02)
    hold(bounce, ball, (2.0, 9.0))
    assert figures(said(bounce))[-1] == pytest.approx(expected[3], rel=0.01)  # what was measured stays


@pytest.mark.parametrize("wait", [0, 170, 200])  # before it falls, in its fall, on its way up
def test_a_ball_that_a_hand_has_moved_first_is_never_said_to_have_come_back(wait: int):
    bounce = run(Bounce(MOON), wait / 60)
    hold(bounce, bounce.balls[3], (6.0, 10.0))
    for _ in life(bounce, 8.0):
        assert said(bounce).endswith("Your hand moved that ball before it was measured.")
        assert "was" not in words(bounce)[6]


def test_falls_end_at_their_terminal_speeds():
    race = DragRace(MOON)
    fastest = np.zeros(len(race.discs))
    for _ in life(race, 10.0):
        fastest = np.maximum(fastest, [float(np.hypot(*disc.velocity[0])) for disc in race.discs])
    for number, (_, _, linear, quadratic) in enumerate(race.lanes):
        falls_free = linear + quadratic == 0
        wanted = np.sqrt(2 * MOON * race.top) if falls_free else race.terminal(number)
        assert fastest[number] == pytest.approx(wanted, rel=0.07), number


def test_a_disc_is_said_to_fall_only_while_it_does():
    race = DragRace(EARTH)
    disc, last = race.discs[1], 0.0
    for _ in life(race, 8.0):
        terminal, speed = figures(said(race))[-2:]
        if "falls at" in said(race):
            last = -float(disc.velocity[0, 1])
            assert float(disc.position[0, 1]) > 0.42
            assert speed == pytest.approx(last, abs=0.006)
        else:
            assert said(race).endswith(f"fell at {last:.2f} m/s in the end.")
        assert speed <= terminal
    assert "fell at" in said(race)
    caught = DragRace(EARTH)
    hold(caught, caught.discs[1], (0.0, 13.0))
    for _ in life(caught, 5.0):
        assert "Your hand moved" in said(caught)
