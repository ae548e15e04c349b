"""One lander alone flies in plain floats as the same one does among others in arrays, bit for bit."""

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
    "any angle": (LanderEnv, "hard", Outcome.OUT_OF_BOUNDS),
    "close to the pad": (LanderEnv, "near", Outcome.LANDED),
    "hills": (lambda slots: LanderEnv(slots, ground=hilly(np.random.default_rng(4))), "graded", Outcome.CRASHED),
    "two pads": (lambda slots: LanderEnv(slots, ground=TWO_PADS, conditions=SWAY), "near", Outcome.CRASHED),
    "harsh": (lambda slots: LanderEnv(slots, conditions=HARSH, limits=BRIEF), "near", Outcome.TIMED_OUT),
    "one step a decision": (lambda slots: LanderEnv(slots, frame_skip=1), "graded", Outcome.FLYING),
    "another world": (MISSIONS["earth"].begin, "near", Outcome.FLYING),
    "canyon": (descent(3), "graded", Outcome.CRASHED),
    "cave": (descent(5), "graded", Outcome.CRASHED),
    "anywhere": (lambda slots: AnywhereEnv(slots, 0, sites=("any",)), "near", Outcome.LANDED),
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
            one.set_sites(many.settled[[slot]])
        one.target = many.target[[slot]]
        one.place(np.ones(1, dtype=bool), start[[slot]])
    return many, alone


def asked(many, rng):
    """Actions for every step: of a pilot who can land, and of one who holds a random action for a while."""
    pilot, held = ScriptedPilot(), np.zeros(many.num_envs, dtype=np.intp)
    while True:
        held = np.where(rng.random(many.num_envs) < 0.2, rng.integers(0, NUM_ACTIONS, many.num_envs), held)
        actions = held.copy()
        actions[::2] = pilot.act(many.observe(wide=False))[::2]
        yield actions


def assert_same(many, alone):
    together = many.snapshot()
    for slot, one in enumerate(alone):
        own = one.snapshot()
        for name in many.kept:
            assert np.array_equal(own["landers"][name][0], together["landers"][name][slot]), name
        # Pads of an ended flight go on while others fly, and those of a lander at a site of its own are put in place.
        bodies = slice(0, 1 if many.outcome[slot] or isinstance(many, AnywhereEnv) else None)
        for name in ("pose", "velocity", "cos", "sin", "active"):
            assert np.array_equal(own["bodies"][name][0, bodies], together["bodies"][name][slot, bodies]), name
        assert np.array_equal(one.observe_pads()[0], many.observe_pads()[slot])


def fly_both(case, slots=3, decisions=120):
    """Fly together and alone, by `step` and now and then by `fly` with shares of thrust; return the outcomes."""
    rng = np.random.default_rng(0)
    many, alone = begun(case, slots, rng)
    for number, actions in zip(range(decisions), asked(many, rng), strict=False):
        if number == 30 and not isinstance(many, AnywhereEnv):
            for env in (many, *alone):
                env.world.gravity = (0.0, -0.8 * env.gravity)
        ended = (many.outcome != Outcome.FLYING).all()
        if number % 3 == 2:
            shares = rng.uniform((0.0, -1.0), (1.0, 1.0), (slots, 2))
            many.fly(actions, shares)
            for slot, one in enumerate(alone):
                one.fly(actions[[slot]], shares[[slot]])
        else:
            result = many.step(actions)
            for slot, one in enumerate(alone):
                own = one.step(actions[[slot]])
                assert all(np.array_equal(ours[0], theirs[slot]) for ours, theirs in zip(own, result, strict=True))
                assert all(own.components[name][0] == part[slot] for name, part in result.components.items())
        if number % 10 == 0 or ended:
            assert_same(many, alone)
        if ended:  # one decision more than that: nothing may change
            break
    assert many.landings == sum(one.landings for one in alone)
    return many.outcome.tolist()


def glide_both(case, slots=2):
    """Look ahead together and alone, without collisions."""
    rng = np.random.default_rng(1)
    many, alone = begun(case, slots, rng)
    for _, actions in zip(range(15), asked(many, rng), strict=False):
        many.glide(actions)
        for slot, one in enumerate(alone):
            one.glide(actions[[slot]])
    assert_same(many, alone)


@pytest.mark.slow
def test_a_lander_alone_flies_as_it_does_among_others(subtests):
    for case in CASES:
        with subtests.test(case=case):
            assert CASES[case][2] in fly_both(case)
            glide_both(case)


def test_a_lander_alone_is_not_looked_at_by_the_engine_in_free_flight(monkeypatch):
    env = LanderEnv(1, 0, frame_skip=4)
    env.reset()
    monkeypatch.setattr(env.world, "step", None)
    for _ in range(20):
        env.fly(np.array([3]))
    assert env.steps[0] == 80
