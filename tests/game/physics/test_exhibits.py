"""Exhibits: what happens in them, and what is said of it, with a hand in it, too."""

import re
from collections.abc import Callable
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
FEW: dict[str, Any] = {"heap": {"count": 20.0}, "stack": {"boxes": 3.0}}  # many bodies take long


def said(exhibit: Exhibit) -> str:
    return texts.EXHIBITS[exhibit.name][2].format(**exhibit.figures())


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


def run(exhibit: Any, seconds: float) -> Any:
    for _ in range(round(60 * seconds)):
        exhibit.step()
    return exhibit


@pytest.mark.parametrize("name", EXHIBITS)
def test_nothing_that_a_hand_throws_or_drags_leaves_the_room(name: str):
    rng = np.random.default_rng(2)
    shown: Any = EXHIBITS[name](MOON, FEW.get(name, {}))
    far = [(-90.0, 3.0), (90.0, 90.0), (0.0, 300.0), (3.0, -80.0), (-90.0, -90.0), (90.0, 0.5)]
    for number, target in enumerate(far):
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


@pytest.mark.parametrize("gravity", GRAVITIES)
def test_the_ground_carries_all_there_is(gravity: float):
    stack = run(Stack(gravity), 2.0)
    count, weight, push = figures(said(stack))
    assert (count, weight) == (len(stack.bodies), pytest.approx(gravity * sum(b.mass for b in stack.bodies), abs=0.06))
    assert push == pytest.approx(weight, rel=0.01)


def test_a_heap_only_ever_loses_energy_and_comes_to_rest():
    heap = Heap(EARTH, FEW["heap"])
    energies = [run(heap, 1 / 60).energy for _ in range(300)]
    assert max(after - before for before, after in pairwise(energies)) < 1e-3 * heap.at_first
    assert heap.energy < 0.5 * heap.at_first
    assert heap.kinetic_energy < 1e-3 * heap.at_first


def test_as_many_discs_leave_as_have_struck():
    impacts = Impacts(MOON)
    assert words(impacts)[0].startswith("1 at first  ·  1 now")
    run(impacts, 2.6)
    for struck, discs in enumerate(impacts.discs, start=1):
        paces = [float(disc.velocity[0, 0]) for disc in discs]
        assert paces == pytest.approx([0.0] * impacts.row + [impacts.pace] * struck, abs=0.01)
    run(impacts, 7.0)  # off the walls and back through the rows
    assert impacts.kinetic_energy == pytest.approx(impacts.energy_at_first, rel=1e-3)


# Single bodies


def test_those_boxes_slide_whose_friction_is_less_than_the_slope():
    slopes = run(Slopes(MOON), 5.0)
    steep = np.tan(np.radians(slopes.values["degrees"]))
    assert slopes.slid == {number for number, friction in enumerate(slopes.frictions) if friction < steep}
    assert [label.within for label in slopes.labels()] == [friction >= steep for friction in slopes.frictions]


def test_a_ball_comes_back_to_e_squared_of_its_height():
    bounce = Bounce(MOON)
    assert "reached" not in words(bounce)[6]
    run(bounce, 6.0)
    expected = np.square(bounce.restitutions) * bounce.values["drop"]
    assert bounce.peaks == pytest.approx(expected, rel=0.03, abs=0.02)
    assert figures(words(bounce)[6]) == pytest.approx([expected[3], bounce.peaks[3]], abs=0.01)


def test_falls_end_at_their_terminal_speeds():
    race = run(DragRace(MOON), 10.0)
    for number, (_, _, linear, quadratic) in enumerate(race.lanes):
        falls_free = linear + quadratic == 0
        wanted = np.sqrt(2 * MOON * race.top) if falls_free else race.terminal(number)
        assert race.speeds[number] == pytest.approx(wanted, rel=0.07), number
        assert falls_free or figures(words(race)[number])[1:] == pytest.approx([race.speeds[number], wanted], rel=0.08)


@pytest.mark.parametrize("kind", [Slopes, Bounce, DragRace])
def test_what_a_hand_has_moved_is_not_measured(kind: Callable[..., Any]):
    exhibit = kind(EARTH)
    hold(exhibit, exhibit.bodies[-1], (0.0, 12.0))
    assert exhibit.touched
    before = said(exhibit), [label.text for label in exhibit.labels()]
    run(exhibit, 3.0)
    assert (said(exhibit), [label.text for label in exhibit.labels()]) == before
