"""What the gallery says is held against its worlds: from the first step on, at rest, and with a hand in it."""

import re
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from game.core import texts
from game.scenes.physics.exhibit import Exhibit, Grip
from game.scenes.physics.exhibits import EXHIBITS, Heap, Impacts, Spin, Stack
from game.scenes.physics.falls import Bounce, DragRace, Slopes
from game.scenes.physics.scene import GRAVITIES

MOON, EARTH = GRAVITIES


def said(exhibit: Exhibit) -> str:
    name = next(name for name, kind in EXHIBITS.items() if kind is type(exhibit))
    return texts.EXHIBITS[name][2][exhibit.state].format(**exhibit.figures())


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


@pytest.mark.parametrize("hands", [0, 8])
@pytest.mark.parametrize("gravity", GRAVITIES)
def test_a_column_weighs_what_is_said_and_is_said_to_stand_only_while_it_does(gravity: float, hands: int):
    stack = Stack(gravity)
    for _ in life(stack, 3.0, hands):
        count, *_ = figures(said(stack).removeprefix("No column stands. "))
        tops = [column[level].position[0, 1] for column in stack.columns for level in (0, 1)]
        if "No column" in said(stack):
            assert count == len(stack.bodies)
        else:
            assert max(tops[1::2]) > stack.box  # on one that stands
            assert said(stack).startswith(f"A column of {count:.0f} boxes of 1 kg weighs {count * gravity:.1f} N")
        if stack.steps and not hands:
            assert ("pushes" in said(stack)) is (stack.steps >= 60)
        if "pushes" in said(stack) and not hands:
            assert figures(said(stack))[-1] == pytest.approx(count * gravity, rel=0.01)


def test_fallen_columns_are_said_to_have_fallen_and_the_ground_carries_all_there_is():
    stack = Stack(EARTH)
    for column in stack.columns:
        for box in column[1:]:
            box.position = (box.position[0, 0] * 0.3 + 0.9 * float(box.position[0, 1]), float(box.position[0, 1]))
    for _ in life(stack, 30.0):  # a heap of boxes comes to lie when it comes to lie
        if stack.steps > 60 and stack.kinetic_energy < 0.001:
            break
    assert stack.kinetic_energy < 0.001
    count, weight, push = figures(said(stack))
    assert said(stack).startswith("No column stands")
    assert (count, weight) == (len(stack.bodies), pytest.approx(EARTH * sum(b.mass for b in stack.bodies), abs=0.06))
    assert push == pytest.approx(weight, rel=0.02)


def test_a_column_that_was_robbed_weighs_less():
    stack = Stack(MOON)
    for number, column in enumerate(stack.columns):
        column[-1].position = (9.0 + number, 9.0)
    for _ in life(stack, 1.5):
        pass
    assert figures(said(stack))[0] == 9
    assert figures(said(stack))[-1] == pytest.approx(9 * MOON, rel=0.02)


@pytest.mark.parametrize("kind", [Heap, Impacts])
def test_energy_that_a_hand_brings_in_is_named(kind: Callable[[float], Exhibit]):
    exhibit = kind(MOON)
    first = exhibit.energy if kind is Heap else exhibit.kinetic_energy
    for _ in life(exhibit, 3.0):
        at_first, now = figures(said(exhibit).replace("e = 1", ""))
        assert "hand" not in said(exhibit)
        assert at_first == pytest.approx(first, abs=0.51)
        assert now <= at_first
        assert kind is Heap or now == at_first
    hold(exhibit, exhibit.bodies[0], (3.0, 9.0))
    assert "hand" in said(exhibit)
    assert figures(said(exhibit))[1] > figures(said(exhibit))[0] or kind is Heap


def test_only_boxes_that_slid_by_themselves_count_and_the_slope_is_given_only_of_them():
    slopes = Slopes(EARTH)
    steep = np.tan(np.radians(30))
    lying = 0
    for _ in life(slopes, 12.0, hands=8):
        slid = figures(said(slopes))[2]
        assert slid <= sum(friction < steep for friction in slopes.frictions)
        for box, friction, label in zip(slopes.boxes, slopes.frictions, slopes.labels(), strict=True):
            if label.within is None:
                assert label.text == f"μ = {friction:.2f}"
                continue
            lying += 1
            tangent, shown = figures(label.text)
            assert (shown, label.within) == (friction, tangent <= friction)
            assert tangent == pytest.approx(steep, abs=0.01)
            assert abs(np.tan(float(box.angle[0]))) == pytest.approx(tangent, abs=0.12)
    assert lying > 150
    still = Slopes(EARTH)
    hold(still, still.boxes[-1], (0.0, 12.0))
    assert len(still.frictions) - 1 not in still.slid


@pytest.mark.parametrize("gravity", GRAVITIES)
def test_a_ball_is_said_to_have_come_back_only_once_it_has(gravity: float):
    bounce = Bounce(gravity)
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
        else:
            assert figures(said(bounce))[-1] == pytest.approx(0.75**2 * bounce.values["drop"], rel=0.01)
        assert ("was" in words(bounce)[6]) is (state == "came back")
    assert states == ["not bounced", "on its way up", "came back"]
    hold(bounce, ball, (2.0, 9.0))
    assert figures(said(bounce))[-1] == pytest.approx(
        0.75**2 * bounce.values["drop"], rel=0.01
    )  # what was measured stays


@pytest.mark.parametrize("wait", [0, 100, 170, 200])
def test_a_ball_that_a_hand_has_moved_first_is_never_said_to_have_come_back(wait: int):
    bounce = Bounce(MOON)
    for _ in range(wait):
        bounce.step()
    hold(bounce, bounce.balls[3], (6.0, 10.0))
    for _ in life(bounce, 12.0):
        assert said(bounce).endswith("Your hand moved that ball before it was measured.")
        assert "was" not in words(bounce)[6]


@pytest.mark.parametrize("gravity", GRAVITIES)
def test_a_disc_is_said_to_fall_only_while_it_does(gravity: float):
    race = DragRace(gravity)
    disc, last = race.discs[1], 0.0
    for _ in life(race, 10.0):
        terminal, speed = figures(said(race))[-2:]
        if "falls at" in said(race):
            last = -float(disc.velocity[0, 1])
            assert float(disc.position[0, 1]) > 0.42
            assert speed == pytest.approx(last, abs=0.006)
        else:
            assert said(race).endswith(f"fell at {last:.2f} m/s in the end.")
        assert speed <= terminal
    assert "fell at" in said(race)
    caught = DragRace(gravity)
    hold(caught, caught.discs[1], (0.0, 13.0))
    for _ in life(caught, 10.0):
        assert "Your hand moved" in said(caught)


def test_rails_are_named_by_the_discs_that_are_on_them():
    impacts = Impacts(MOON)
    assert words(impacts)[0].startswith("1 in motion at first  ·  1 now")
    hold(impacts, impacts.discs[0][-1], (9.0, 2.0), steps=1)
    impacts.discs[0][-1].position = (9.0, 5.0)
    assert [len(impacts.on_rail(number)) for number in range(3)] == [6, 9, 9]


def test_bars_are_said_to_have_been_pushed_only_after_it_and_not_if_a_hand_was_there_first():
    spin = Spin(MOON)
    for _ in life(spin, 2.0):
        before = spin.steps <= spin.push_at
        assert all(word.startswith("to be pushed" if before else "pushed") for word in words(spin)[-2:])
    taken = Spin(MOON)
    hold(taken, taken.bars[1], (8.0, 8.0), steps=20)
    for _ in range(60):
        taken.step()
    assert words(taken)[-2].startswith("pushed in the middle: 0.40 m/s")
    assert "pushed" not in words(taken)[-1]


def test_every_sentence_of_an_exhibit_can_be_said(subtests: pytest.Subtests):
    for name in EXHIBITS:
        with subtests.test(name=name):
            states = set()
            for hands, seconds in ((0, 3.0), (6, 1.0)):
                exhibit: Any = EXHIBITS[name](EARTH)
                for _ in life(exhibit, seconds, hands):
                    states.add(exhibit.state)
            if name in ("bounce", "drag"):
                hold(
                    exhibit := EXHIBITS[name](EARTH),
                    exhibit.balls[3] if name == "bounce" else exhibit.discs[1],
                    (1.0, 8.0),
                )
                states.add(exhibit.state)
            if name == "impacts":
                states.add(EXHIBITS[name](EARTH, {"restitution": 0.8}).state)
            if name == "stack":
                states.add("fallen")  # has a test of its own
            assert states == set(texts.EXHIBITS[name][2])
