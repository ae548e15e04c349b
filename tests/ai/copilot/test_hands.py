"""Hands do what they are said to do."""

from typing import Any

import numpy as np
import pytest

from ai.agent.agent import DeepQAgent
from ai.cli.copilot import MODEL
from ai.copilot.hands import HANDS, Adversary, ClumsyHands, Faults
from ai.lander.environment import LanderEnv


@pytest.fixture(scope="module")
def agent():
    return DeepQAgent.load(MODEL)


def doing(*actions):
    """A pilot that does this for ever."""

    class Always:
        def act(self, observation, *, held=None):
            return np.array(actions, dtype=np.intp)

    return Always()


def test_hands_have_the_faults_they_are_given():
    for faults, wish, does in (
        (Faults(), 4, {4}),
        (Faults(inverted=True), 4, {5}),
        (Faults(one_key=True), 4, {1, 3}),
        (Faults(thrust=1.0), 1, {4}),
        (Faults(timid=1.0), 4, {1}),
        (Faults(flip=1.0), 1, {4}),
        (Faults(change=1.0), 1, {0, 2}),
        (Faults(sticky=1.0), 4, {0}),
        (Faults(late=99), 4, {4}),  # nothing is later than what was first wished
    ):
        hands = ClumsyHands(doing(*[wish] * 40), 40, np.random.default_rng(0), faults)
        assert {int(action) for _ in range(3) for action in hands.act(np.zeros((40, 9)))} == does, faults


def test_late_hands_do_what_was_wished_before():
    wishes = iter(range(6))
    pilot = doing(0)
    pilot.act = lambda observation, *, held=None: np.array([next(wishes)])
    hands = ClumsyHands(pilot, 1, np.random.default_rng(0), Faults(late=2))
    assert [int(hands.act(np.zeros((1, 9)))[0]) for _ in range(6)] == [0, 0, 0, 1, 2, 3]


def test_every_family_flies_and_follows_from_its_seed(agent):
    def first(make, seed):
        env = LanderEnv(8, 0, "random")
        env.reset()
        pilot = make(8, np.random.default_rng(seed), agent)
        for _ in range(20):
            env.fly(pilot.act(env.observe(), held=env.actions))
        return env.position

    for name, make in HANDS.items():
        np.testing.assert_array_equal(first(make, 4), first(make, 4), err_msg=name)
        assert np.isfinite(first(make, 5)).all(), name


def test_keys_are_held_and_a_weak_stick_pushes_less(agent):
    rng, seen = np.random.default_rng(1), np.zeros((5, 9), np.float32)
    held = HANDS["holds main + left"](5, rng, agent)
    assert {int(action) for _ in range(20) for action in held.act(seen)} == {4}
    each = HANDS["a key each second"](5, rng, agent)
    asked = np.array([each.act(seen) for _ in range(60)])
    assert (asked.reshape(4, 15, 5) == asked.reshape(4, 15, 5)[:, :1]).all()
    assert len(np.unique(asked)) > 2
    weak: Any = HANDS["thrust 0.3"](5, rng, agent)
    assert weak.shares(np.array([0, 1, 5])).tolist() == [[0, 0], [0, -1], [0.3, 1]]


def test_an_adversary_asks_for_the_worst_that_passes(agent):
    rng = np.random.default_rng(0)
    seen = rng.normal(size=(40, 9)).astype(np.float32)
    values, passes = agent.q_values(seen), rng.random((40, 6)) < 0.5
    passes[0], passes[1:, 3] = False, True  # where nothing passes, it asks for whatever it likes
    least, random = (Adversary(agent, rng, least=least) for least in (True, False))
    assert least.act(seen).tolist() == values.argmin(axis=1).tolist()
    asked = least.act(seen, passes=passes)
    assert asked[0] == values[0].argmin()
    assert asked[1:].tolist() == np.where(passes, values, np.inf)[1:].argmin(axis=1).tolist()
    asked = random.act(seen, passes=passes)
    assert passes[np.arange(40), asked][1:].all()
    assert set(asked.tolist()) == set(range(6))
