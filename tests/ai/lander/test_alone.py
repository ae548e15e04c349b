"""One lander alone flies in plain numbers as the same one does among others in arrays, bit for bit."""

from dataclasses import replace

import numpy as np
import pytest

from ai.lander.anywhere import AnywhereEnv
from ai.lander.conditions import Conditions
from ai.lander.descent import AREA, leg
from ai.lander.environment import LIMITS, NUM_ACTIONS, LanderEnv, Outcome
from ai.lander.ground import Ground, Pad, hilly
from ai.lander.missions import MISSIONS
from ai.lander.pilots import ScriptedPilot
from ai.lander.spawns import SPAWNS

TWO_PADS = Ground((Pad(-5.0, 1.8, 5.0), Pad(5.0, 2.6, 4.0, 3)))
HARSH = Conditions(0.2, 0.3, 4.0, 1.5, (1.0, 2.0), -3.0, 12.0)  # wind, gusts, a small tank, an outage, a moving pad
SWAY, BRIEF = Conditions(swing=2.0, swing_period=9.0), replace(LIMITS, time=6.0)


def descent(number):
    ground = leg(5, number).ground
    return lambda slots: LanderEnv(slots, 0, ground=ground, limits=AREA, conditions=Conditions(0.1, tank=9.0))


# How to make so many landers, the spawn that they begin at, and an outcome of one of them.
CASES = {
    "plain": (LanderEnv, "random", Outcome.OUT_OF_BOUNDS),
    "any angle": (LanderEnv, "hard", Outcome.CRASHED),
    "close to the pad": (LanderEnv, "near", Outcome.LANDED),
    "hills": (lambda slots: LanderEnv(slots, ground=hilly(np.random.default_rng(4))), "graded", Outcome.CRASHED),
    "two pads": (lambda slots: LanderEnv(slots, ground=TWO_PADS, conditions=SWAY), "near", Outcome.LANDED),
    "harsh": (lambda slots: LanderEnv(slots, conditions=HARSH, limits=BRIEF), "near", Outcome.TIMED_OUT),
    "one step a decision": (lambda slots: LanderEnv(slots, frame_skip=1), "graded", Outcome.FLYING),
    "another world": (MISSIONS["earth"].begin, "near", Outcome.CRASHED),
    "canyon": (descent(3), "graded", Outcome.CRASHED),
    "cave": (descent(5), "graded", Outcome.CRASHED),
    "anywhere": (lambda slots: AnywhereEnv(slots, 0, sites=("any",)), "near", Outcome.CRASHED),
}


def begun(case, slots, rng):
    """The same landers twice: together, and each alone."""
    make, spawn, _ = CASES[case]
    many, alone = make(slots), [make(1) for _ in range(slots)]
    start = np.array([SPAWNS[spawn](rng) for _ in range(slots)])
    many.reset()
    if not isinstance(many, AnywhereEnv):
        many.target = rng.integers(many.ground.at_once, size=slots)
    many.place(np.ones(slots, dtype=bool), start)
    for slot, one in enumerate(alone):
        if isinstance(many, AnywhereEnv):
            one.settle(many.settled[[slot]])
        one.target = many.target[[slot]]
        one.place(np.ones(1, dtype=bool), start[[slot]])
    return many, alone


def asked(many, rng):
    """Actions for every step: of a pilot who can land, and of one who holds a random action for a while."""
    pilot, held = ScriptedPilot(), np.zeros(many.num_envs, dtype=np.intp)
    while True:
        held = np.where(rng.random(many.num_envs) < 0.2, rng.integers(0, NUM_ACTIONS, many.num_envs), held)
        actions = held.copy()
        actions[::2] = pilot.act(LanderEnv.observe(many))[::2]
        yield actions


def assert_same(many, slot, one):
    for kind, values in one.snapshot().items():
        if kind == "counters":
            theirs = many.snapshot()[kind]
            assert all(np.array_equal(values[name][0], theirs[name][slot]) for name in values)
    for name in ("position", "velocity", "angle", "angular_velocity"):
        assert np.array_equal(getattr(one, name)[0], getattr(many, name)[slot]), name
    for pad in range(len(many.ground.pads)):
        assert np.array_equal(one.observe(pad)[0], many.observe(pad)[slot])


def fly_both(case, slots=4, decisions=120, seed=0):
    """Fly each way, by `step` and then by `fly` with shares of thrust; return the outcomes."""
    rng, outcomes = np.random.default_rng(seed), []
    for by_shares in (False, True):
        many, alone = begun(case, slots, rng)
        for number, actions in zip(range(decisions), asked(many, rng), strict=False):
            if number == 30 and not isinstance(many, AnywhereEnv):
                for env in (many, *alone):
                    env.gravity = 0.8 * env.gravity
            ended = (many.outcome != Outcome.FLYING).all()
            if by_shares:
                fly_with_shares(many, alone, actions, rng.uniform((0.0, -1.0), (1.0, 1.0), (slots, 2)))
            else:
                step(many, alone, actions)
            if number % 10 == 0 or ended:
                for slot, one in enumerate(alone):
                    assert_same(many, slot, one)
            if ended:  # one decision more than that: nothing may change
                break
        assert many.landings == sum(one.landings for one in alone)
        outcomes += many.outcome.tolist()
    return outcomes


def step(many, alone, actions):
    result = many.step(actions)
    for slot, one in enumerate(alone):
        own = one.step(actions[[slot]])
        assert all(np.array_equal(ours[0], theirs[slot]) for ours, theirs in zip(own, result, strict=True))
        assert all(np.array_equal(own.components[name][0], part[slot]) for name, part in result.components.items())


def fly_with_shares(many, alone, actions, shares):
    many.fly(actions, shares)
    for slot, one in enumerate(alone):
        one.fly(actions[[slot]], shares[[slot]])


def test_a_lander_alone_flies_as_it_does_among_others(subtests):
    for case in CASES:
        with subtests.test(case=case):
            assert CASES[case][2] in fly_both(case)


@pytest.mark.parametrize("case", ["plain", "harsh", "cave"])
def test_gliding_alone_is_gliding_among_others(case):
    rng = np.random.default_rng(1)
    many, alone = begun(case, 3, rng)
    for _, actions in zip(range(60), asked(many, rng), strict=False):
        seen = many.glide(actions)
        for slot, one in enumerate(alone):
            assert np.array_equal(one.glide(actions[[slot]])[0], seen[slot])
    for slot, one in enumerate(alone):
        assert_same(many, slot, one)


def test_pads_that_move_stand_where_the_engine_leaves_them():
    rng = np.random.default_rng(6)
    many, alone = begun("two pads", 3, rng)
    for _ in range(12):
        step(many, alone, rng.integers(0, NUM_ACTIONS, 3))
        for slot, one in enumerate(alone):
            assert many.outcome[slot] == Outcome.FLYING
            assert np.array_equal(one.world.state.pose[0], many.world.state.pose[slot])
            assert np.array_equal(one.world.state.velocity[0], many.world.state.velocity[slot])
