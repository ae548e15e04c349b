from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from game.core import texts
from game.scenes.physics.exhibit import Exhibit
from game.scenes.physics.exhibits import EXHIBITS, Heap, Impacts, Stack
from game.scenes.physics.falls import Bounce, DragRace
from game.scenes.physics.scene import GRAVITIES

MOON, EARTH = GRAVITIES


def run(exhibit: Exhibit, seconds: float = 5.0) -> Exhibit:
    for _ in range(round(60 * seconds)):
        exhibit.step()
    return exhibit


@cache
def after_five_seconds(name: str, gravity: float) -> Any:
    return run(EXHIBITS[name](gravity))


@pytest.mark.parametrize("gravity", GRAVITIES)
@pytest.mark.parametrize("exhibit", EXHIBITS)
def test_every_exhibit_runs_and_keeps_within_its_room(exhibit: str, gravity: float):
    shown = after_five_seconds(exhibit, gravity)
    state = shown.world.state
    assert np.isfinite(state.pose).all()
    assert np.isfinite(state.velocity).all()
    for body in shown.bodies:
        assert abs(body.position[0, 0]) < shown.width / 2
        assert body.position[0, 1] > 0.1
    law = texts.EXHIBITS[exhibit][2][shown.state].format(**shown.figures())
    assert "nan" not in law


@pytest.mark.parametrize("gravity", GRAVITIES)
def test_the_lowest_contact_carries_the_column_and_nothing_sways(gravity: float):
    stack = after_five_seconds("stack", gravity)
    figures = stack.figures()
    assert figures["push"] == pytest.approx(figures["weight"], rel=0.01)
    assert np.abs(stack.poses - Stack(gravity).poses)[:, :2].max() < 0.02


def test_a_heap_only_ever_loses_energy_and_comes_to_rest():
    heap = Heap(EARTH)
    energies = [run(heap, 1 / 60).energy for _ in range(120)]
    assert max(after - before for before, after in pairwise(energies)) < 1e-3 * heap.at_first
    rested = after_five_seconds("heap", EARTH)
    assert rested.energy < 0.5 * heap.at_first
    assert rested.kinetic_energy < 1e-3 * heap.at_first


@pytest.mark.parametrize("gravity", GRAVITIES)
def test_those_boxes_slide_whose_friction_is_less_than_the_slope(gravity: float):
    slopes = after_five_seconds("slopes", gravity)
    tangent = np.tan(np.radians(slopes.values["degrees"]))
    assert slopes.slid == {number for number, friction in enumerate(slopes.frictions) if friction < tangent}


@pytest.mark.parametrize("gravity", GRAVITIES)
def test_a_ball_comes_back_to_e_squared_of_its_height(gravity: float):
    bounce = Bounce(gravity)
    run(bounce, 6.0)
    expected = np.square(bounce.restitutions) * bounce.values["drop"]
    assert bounce.peaks == pytest.approx(expected, rel=0.03, abs=0.02)


def test_as_many_discs_leave_as_have_struck():
    impacts = Impacts(MOON)
    run(impacts, 2.6)
    for struck, discs in enumerate(impacts.discs, start=1):
        paces = [float(disc.velocity[0, 0]) for disc in discs]
        assert paces == pytest.approx([0.0] * impacts.row + [impacts.pace] * struck, abs=0.01)
    run(impacts, 7.0)  # off the walls and back through the rows
    assert impacts.kinetic_energy == pytest.approx(impacts.energy_at_first, rel=1e-3)


@pytest.mark.parametrize("gravity", GRAVITIES)
def test_falls_end_at_their_terminal_speeds(gravity: float):
    race = DragRace(gravity)
    fastest = np.zeros(len(race.discs))
    for _ in range(600):
        race.step()
        fastest = np.maximum(fastest, [float(np.hypot(*disc.velocity[0])) for disc in race.discs])
    for number, (_, _, linear, quadratic) in enumerate(race.lanes):
        if linear + quadratic == 0:
            assert fastest[number] == pytest.approx(np.sqrt(2 * gravity * race.top), rel=0.05)
        elif gravity == MOON:
            assert fastest[number] == pytest.approx(race.terminal(number), rel=0.07)
        else:
            assert 0.5 * race.terminal(number) < fastest[number] <= race.terminal(number)


def test_spin_is_kept_and_a_push_beside_the_middle_turns_as_well():
    spin = after_five_seconds("spin", EARTH)
    figures = spin.figures()
    assert spin.angular_momenta() == pytest.approx([spin.momentum] * 3, rel=1e-6)
    for bar, turning in zip(spin.bars, (0.0, -figures["spin"]), strict=True):
        assert bar.velocity[0] == pytest.approx((figures["pace"], 0.0), abs=1e-9)
        assert float(bar.angular_velocity[0]) == pytest.approx(turning)
