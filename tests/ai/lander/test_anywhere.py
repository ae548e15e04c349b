"""Landers of one batch that fly at different sites, each as it would alone."""

from dataclasses import replace

import numpy as np
import pytest

from ai.lander.anywhere import GROUND, SITES, AnywhereEnv, Site
from ai.lander.conditions import Conditions
from ai.lander.environment import LIMITS, NUM_FEATURES, OBSERVATION_SCALE, PARAMS, Outcome
from ai.lander.ground import Ground, Pad
from ai.lander.pilots import ScriptedPilot
from ai.lander.sensing import SURROUNDINGS, SURROUNDINGS_SCALE
from tests.support.landers import STAND, fly, placed, put

HARD = Site(9.81, 16.0, 0.06, 3.0, 3.0, 12.0, 0.2, 0.3, 4.0, 5.0, 0.4, 0.9, 2.0, 15.0, 2)
MIXED = (Site(), HARD, Site(wind=-0.3, swing=-1.0, pad=3), Site(gravity=0.9, thrust=3.0, air=0.2, tank=2.0))
START = (2.0, 11.0, -0.3, -0.5, 0.05)


def alone(site):
    """A lander of its own at a site, made as missions are."""
    pad = GROUND.pads[site.pad]
    return placed(
        START,
        frame_skip=4,
        params=replace(PARAMS, gravity=site.gravity, main_thrust=site.thrust, quadratic_drag=site.air),
        ground=Ground((Pad(0.0, pad.top, pad.width),)),
        limits=replace(LIMITS, touch_speed=site.touch_speed, slide_speed=site.slide_speed, time=site.time),
        conditions=Conditions(
            site.wind, site.gust, site.gust_period, site.tank, (site.dead, site.back), site.swing, site.swing_period
        ),
    )


@pytest.mark.slow
def test_each_lander_of_a_batch_flies_as_it_would_alone():
    env = AnywhereEnv(len(MIXED), 0, frame_skip=4)
    env.set_sites(MIXED)
    put(env, START)
    single, together, apart = [alone(site) for site in MIXED], [], []
    while Outcome.FLYING in env.outcome:
        actions = ScriptedPilot().act(env.observe()[:, :NUM_FEATURES])
        env.step(actions)
        for slot, other in enumerate(single):
            other.step(actions[slot : slot + 1])
        together.append(np.column_stack([env.observe(), env.outcome, env.fuel]))
        apart.append([[*other.observe(wide=True)[0], other.outcome[0], other.fuel[0]] for other in single])
    np.testing.assert_allclose(together, apart, rtol=1e-6, atol=1e-5)
    assert Outcome.LANDED in env.outcome


def test_limits_of_a_touch_are_those_of_each_site():
    env = AnywhereEnv(2, 0, frame_skip=1)
    env.set_sites([Site(touch_speed=3.0, slide_speed=1.2), Site()])
    fly(put(env, (12.0, PARAMS.ground + PARAMS.stand + 0.01, 1.6, -0.3)), steps=30)
    assert env.outcome.tolist() == [Outcome.CRASHED] * 2
    assert env.intact.tolist() == [False, True]
    assert put(env, (18.0, 9.0)).observe()[0, 0] == pytest.approx(18 * OBSERVATION_SCALE[0])


def test_sites_are_of_the_kinds_asked_for():
    env = AnywhereEnv(60, 2, sites=("moon", "earth"))
    seen = env.reset()[:, NUM_FEATURES:] / SURROUNDINGS_SCALE
    gravity = seen[:, SURROUNDINGS.index("gravity")]
    assert gravity == pytest.approx(np.where(env.kind == 0, PARAMS.gravity, 9.81))
    assert set(env.kind) == {0, 1}
    for wrong in ((), ("moon", "venus")):
        with pytest.raises(ValueError, match="sites are some of"):
            AnywhereEnv(1, 0, sites=wrong)


def test_stricter_limits_hold_and_are_not_observed():
    env = AnywhereEnv(2, 0, "fixed", frame_skip=1, sites=("moon",))
    before = put(env, (0.0, STAND + 0.01, 0, -0.75 * LIMITS.touch_speed)).snapshot()
    for strictness, outcome in ((1.0, Outcome.FLYING), (0.5, Outcome.CRASHED)):
        env.restore(before)
        env.strictness = strictness
        fly(env, steps=5)
        assert (env.outcome == outcome).all()
        assert env.around()[0, -1] / SURROUNDINGS_SCALE[-1] == pytest.approx(LIMITS.touch_speed)


@pytest.mark.slow
def test_sites_of_every_kind_can_be_flown(subtests):
    for kind in SITES:
        with subtests.test(kind=kind):
            env = AnywhereEnv(20, 3, "near", sites=(kind,))
            assert env.reset().shape == (20, AnywhereEnv.num_features)
            while (env.outcome == Outcome.FLYING).any():
                result = env.step(ScriptedPilot().act(env.observe_for(None)))
            assert np.isfinite(result.observation).all()
            assert (env.outcome == Outcome.LANDED).any()
