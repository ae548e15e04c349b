"""Watch can be touched: by mouse, keys and gamepad; the decision shown is the one that is flown; and the way back."""

import math
from collections.abc import Callable

import numpy as np
import pygame
import pytest

from ai.lander.environment import Outcome
from game.core import texts
from game.scenes.watch.scene import WatchScene
from game.scenes.watch.touch import FASTEST, NOTCH, Hand
from game.ui.context import Context
from tests.support.drawn import Drawn
from tests.support.driver import Driver
from tests.support.player import DEVICES, Player

Open = Callable[..., Driver]


@pytest.fixture(params=["modern"])
def watching(request: pytest.FixtureRequest, open_game: Open, context: Context) -> Driver:
    context.settings.model = request.param
    context.settings_file.save(context.settings)
    driver = open_game(WatchScene, seed=2)
    driver.frames(10)
    return driver


def scene(driver: Driver) -> WatchScene:
    assert isinstance(driver.top, WatchScene)
    return driver.top


def hand(driver: Driver) -> Hand:
    return scene(driver).hand


def state(driver: Driver) -> np.ndarray:
    env, slot = scene(driver).swarm.env, scene(driver).world.shown
    return np.array([*env.position[slot], *env.velocity[slot], env.angle[slot], env.angular_velocity[slot]])


def check_decision(driver: Driver) -> None:
    """The decision shown is the policy's own, on what the lander senses now; and it is flown."""
    watch = scene(driver)
    slot, swarm, shown = watch.world.shown, watch.swarm, watch.decision
    assert np.array_equal(shown.observation[0], swarm.env.observe()[slot])
    policy = watch.flyer.network.policy
    assert policy is not None
    assert shown.action[0] == policy.act(shown.observation)[0]
    if shown.points is not None:
        assert shown.values == pytest.approx(policy.q_values(shown.observation), abs=1e-5)  # type: ignore[attr-defined]
    swarm.step()
    assert swarm.env.actions[slot] == shown.action[0]


def drag(driver: Driver, start: tuple[float, float], end: tuple[float, float]) -> None:
    driver.move(start)
    driver.post(pygame.MOUSEBUTTONDOWN, pos=driver.to_window(start), button=1)
    for share in (0.3, 0.7, 1.0):
        driver.move((start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1])))
    driver.post(pygame.MOUSEBUTTONUP, pos=driver.to_window(end), button=1)


@pytest.mark.parametrize("watching", ["modern", "scripted"], indirect=True)
def test_the_mouse_puts_the_lander_elsewhere(watching: Driver):
    watching.key(pygame.K_SPACE)
    before, first = state(watching), scene(watching).decision
    middle = hand(watching).middle
    drag(watching, middle, (middle[0] - 200, middle[1] - 60))
    after = state(watching)
    assert hand(watching).middle == pytest.approx((middle[0] - 200, middle[1] - 60), abs=2)
    assert np.array_equal(after[2:], before[2:])
    assert scene(watching).decision.observation[0, 0] < first.observation[0, 0]
    check_decision(watching)


def test_the_mouse_tilts_by_the_dot_and_by_the_wheel(watching: Driver):
    watching.key(pygame.K_SPACE)
    before = state(watching)
    (x, y), size = hand(watching).middle, hand(watching).radius
    drag(watching, hand(watching).tilt_knob, (x + size, y))  # lies on its right side
    after = state(watching)
    assert after[4] == pytest.approx(-math.pi / 2, abs=0.06)
    assert after[5] == 0
    assert np.array_equal(after[:4], before[:4])
    watching.post(pygame.MOUSEWHEEL, x=0, y=2)
    assert state(watching)[4] == pytest.approx(after[4] + 2 * NOTCH)
    check_decision(watching)


def test_the_mouse_throws_by_the_arrow_whose_length_is_the_speed(watching: Driver, monkeypatch: pytest.MonkeyPatch):
    watching.key(pygame.K_SPACE)
    before = state(watching)
    (x, y), (tail, tip) = hand(watching).middle, hand(watching).arrow
    none = math.dist(tail, (x, y))
    per_speed = math.dist(tail, tip) / np.hypot(*before[2:4])
    drag(watching, tip, (x - none - 3 * per_speed, y))
    after = state(watching)
    assert after[2:4] == pytest.approx((-3, 0), abs=0.1)
    assert np.array_equal(after[[0, 1, 4, 5]], before[[0, 1, 4, 5]])
    drag(watching, hand(watching).arrow[1], (x - 900, y))
    assert np.hypot(*state(watching)[2:4]) == pytest.approx(FASTEST)
    drawn = Drawn(monkeypatch)
    watching.app.draw()
    assert texts.TOUCH_SPEED.format(speed=FASTEST) in drawn.words
    drag(watching, hand(watching).arrow[1], (x, y))
    assert np.hypot(*state(watching)[2:4]) == 0
    check_decision(watching)


def test_no_hand_puts_it_into_the_ground_or_out_of_sight(watching: Driver):
    watching.key(pygame.K_SPACE)
    for place in ((700, 719), (3, 719), (3, 3), (1279, 3), (1279, 719)):
        drag(watching, hand(watching).middle, place)
        watching.post(pygame.MOUSEWHEEL, x=0, y=7)  # tilted, its legs reach lower
        x, y = state(watching)[:2]
        env = scene(watching).swarm.env
        assert abs(x) <= env.limits.half_width
        assert env.lowest(x, float(env.angle[0])) <= y <= env.limits.ceiling
        assert 0 < hand(watching).middle[0] < 950
    check_decision(watching)


@pytest.mark.parametrize("device", DEVICES)
def test_keys_and_gamepad_move_tilt_and_throw_with_a_pointer(watching: Driver, device: str):
    player = Player(watching, device)

    def point_at(place: tuple[float, float]) -> None:
        for axis, (less, more) in enumerate((("left", "right"), ("up", "down"))):
            name = less if place[axis] < hand(watching).place[axis] else more
            player.hold(name, down=True)
            while (hand(watching).place[axis] < place[axis]) is (name == more):
                watching.skip()
            player.hold(name, down=False)

    def pull(grip: tuple[float, float], name: str) -> np.ndarray:
        point_at(grip)
        before = state(watching)
        player.hold("confirm", down=True)
        player.hold(name, down=True)
        watching.skip(11)
        player.hold(name, down=False)
        player.hold("confirm", down=False)
        return state(watching) - before

    watching.key(pygame.K_SPACE) if device == "keys" else player.press("hand over")
    assert scene(watching).playback.stopped
    player.press("confirm")
    for name, way in {"left": [-1, 0], "right": [1, 0], "up": [0, 1], "down": [0, -1]}.items():
        moved = pull(hand(watching).middle, name)
        assert np.sign(np.round(moved[:2], 3)).tolist() == way
        assert not moved[2:].any()
    moved = pull(hand(watching).tilt_knob, "left")
    assert moved[4] > 0.1
    assert not moved[:4].any()
    tip = hand(watching).arrow[1]
    moved = pull(tip, "right")
    assert moved[2] > 0.1
    assert not moved[[0, 1, 4]].any()
    check_decision(watching)
    player.press("back")
    assert not hand(watching).typing
    assert watching.top_name == "WatchScene"


def test_a_touched_flight_is_not_counted_and_says_so(open_game: Open, context: Context, tmp_path, monkeypatch):
    context.models_dir = tmp_path  # only the scripted pilot is here
    driver = open_game(WatchScene, seed=2)
    driver.frames(5)
    driver.key(pygame.K_SPACE)
    driver.post(pygame.MOUSEWHEEL, x=0, y=1)
    watch = scene(driver)
    watch.flyer._problem = ""
    drawn = Drawn(monkeypatch)
    driver.app.draw()
    assert texts.TOUCH_COUNTS in drawn.words
    while watch.swarm.since_end[0] == 0:
        watch.swarm.step()
    assert watch.swarm.landed + watch.swarm.lost == 0
    while watch.swarm.since_end[0] > 0:
        watch.swarm.step()
    assert not watch.world.touched
    while watch.swarm.since_end[0] == 0:
        watch.swarm.step()
    assert watch.swarm.landed + watch.swarm.lost == 1


def test_a_wreck_flies_again_and_only_the_shown_one_of_a_swarm_is_touched(open_game: Open, context: Context):
    driver = open_game(WatchScene, seed=2, many=True)
    watch = scene(driver)
    while not (watch.swarm.env.outcome != Outcome.FLYING).any():
        watch.swarm.step()
    watch.world.shown = int(np.flatnonzero(watch.swarm.env.outcome != Outcome.FLYING)[0])
    driver.key(pygame.K_SPACE)
    others = np.arange(64) != watch.world.shown
    before = watch.swarm.env.observe()[others]
    middle = hand(driver).middle
    drag(driver, middle, (middle[0], middle[1] - 100))
    assert watch.swarm.env.outcome[watch.world.shown] == Outcome.FLYING
    assert np.array_equal(watch.swarm.env.observe()[others], before)
    assert watch.swarm.touched.sum() == 1
    check_decision(driver)


def test_a_lander_that_flies_cannot_be_dragged(watching: Driver):
    middle = hand(watching).middle
    drag(watching, middle, (middle[0] - 200, middle[1]))
    assert not scene(watching).world.touched
    watching.post(pygame.MOUSEWHEEL, x=0, y=2)
    assert not scene(watching).world.touched


def test_the_frame_around_the_lander_goes_when_the_flight_goes_on(watching: Driver):
    watching.key(pygame.K_SPACE)
    assert watching.form.focused is hand(watching)
    watching.key(pygame.K_SPACE)
    watching.frames(2)
    assert not scene(watching).playback.stopped
    assert watching.form.focused is not hand(watching)
