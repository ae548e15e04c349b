"""Dust, sparks, fragments and wrecks: they obey the flight's own ground and gravity, and nothing obeys them."""

import numpy as np
import pytest

from ai.lander.environment import PARAMS, LanderEnv, Outcome
from ai.lander.ground import hilly
from ai.lander.missions import MISSIONS
from ai.lander.pilots import ScriptedPilot
from game.flight.flight import Flight
from game.world.particles import ParticleKind, Particles, Relief
from game.world.stage import Stage
from game.world.wreck import Wreck


def crashed(env: LanderEnv) -> LanderEnv:
    while env.outcome[0] == Outcome.FLYING:
        env.step(np.zeros(1, np.intp))
    assert env.outcome[0] == Outcome.CRASHED
    return env


def over_hills() -> LanderEnv:
    env = LanderEnv(1, 0, frame_skip=1, ground=hilly(np.random.default_rng(4)))
    env.reset()
    env.place(np.ones(1, bool), np.array([[-4.6, 9.0, 2.0, -2.0, 0.4, 1.0]]))
    return env


def test_the_relief_is_the_ground():
    env = over_hills()
    x = np.linspace(-21, 21, 200)
    assert np.quantile(np.abs(Relief(env).height(x) - env.ground.height(x)), 0.95) < 0.1


def test_the_relief_of_a_moving_pad_moves():
    env = MISSIONS["ferry"].begin()
    before = Relief(env).height(np.array([3.6]))[0]
    for _ in range(270):
        env.step(np.array([3]))
    assert env.pad_shift[0] > 3
    assert Relief(env).height(np.array([3.6]))[0] > before or env.ground.pads[0].right >= 3.6
    assert Relief(env).deck(float(env.pad[0, 0])) is not None
    assert Relief(env).deck(float(env.pad[0, 0]) + 9) is None


def test_fragments_fly_and_bounce_above_the_hills_and_come_to_rest():
    env = over_hills()
    relief = Relief(env)
    particles = Particles(np.random.default_rng(0), relief, env.params.gravity)
    particles.burst(np.array([-4.6, 6.0]), np.array([2.0, -6.0]))
    rose = 0
    for _ in range(200):
        particles.update()
        live = particles.alive
        place = particles.position[live]
        assert (place[:, 1] >= relief.height(place[:, 0]) - 1e-9).all()
        shards = live & (particles.kind == ParticleKind.SHARD)
        rose += int((particles.velocity[shards, 1] > 0.2).sum())
    assert rose > 50


@pytest.mark.parametrize("mission", ["mars", "earth"])
def test_what_flies_about_falls_as_on_that_world(mission: str):
    env = MISSIONS[mission].begin()
    stage = Stage(env, np.random.default_rng(0))
    stage.particles.add(ParticleKind.SHARD, np.array([[0.0, 20.0]]), np.zeros((1, 2)), np.array([9.0]), np.array([0.1]))
    for _ in range(60):
        stage.particles.update()
    assert stage.particles.velocity[0, 1] == pytest.approx(-env.params.gravity)


def test_what_flies_about_is_gone_after_its_time():
    particles = Particles(np.random.default_rng(0), Relief(LanderEnv()), PARAMS.gravity)
    particles.add(ParticleKind.SHARD, np.full((2, 2), 20.0), np.zeros((2, 2)), np.array([0.5, 1.0]), np.full(2, 0.1))
    left = []
    for _ in range(62):
        particles.update()
        left.append(int(particles.alive.sum()))
    assert left[28] == 2
    assert left[31] == left[58] == 1
    assert left[-1] == 0


def test_the_wind_carries_what_is_light_and_no_faster_than_it_goes():
    env, calm = MISSIONS["wind"].begin(), LanderEnv(1, 0, frame_skip=1)
    calm.reset()
    sideways = []
    for each in (env, calm):
        stage = Stage(each, np.random.default_rng(0))
        stage.thrust[0, 0] = 1.0
        speeds = []
        for _ in range(60):
            each.step(np.array([3]))
            stage.follow(np.zeros(1, bool), np.zeros(1, bool))
            assert stage.particles.wind == stage.wind.speed
            gas = stage.particles.alive & (stage.particles.kind == ParticleKind.AMBER)
            speeds += (stage.particles.velocity[gas, 0] - each.velocity[0, 0]).tolist()
        sideways.append(np.mean(speeds))
    blowing = [MISSIONS["wind"].conditions.push(np.arange(60) / 60).max() * 16]
    assert stage.wind.speed == 0
    assert 1.0 < sideways[0] - sideways[1] < blowing[0]


def test_a_jet_raises_more_dust_the_nearer_and_the_stronger_it_is():
    raised = []
    for height, action in ((7.5, 3), (5.0, 3), (2.7, 3), (2.7, 0)):
        env = LanderEnv(1, 0, frame_skip=1)
        env.reset()
        stage = Stage(env, np.random.default_rng(0))
        for _ in range(40):
            env.place(np.ones(1, bool), np.array([[8.0, height, 0, 0, 0, 0]]))
            env.step(np.array([action]))
            stage.follow(np.zeros(1, bool), np.zeros(1, bool))
        raised.append(int((stage.particles.alive & (stage.particles.kind == ParticleKind.DUST)).sum()))
    far, middle, near, off = raised
    assert far == 0
    assert off == 0
    assert near > middle > 0


def test_dust_is_blown_off_beside_a_deck_and_not_from_it():
    particles = Particles(np.random.default_rng(0), Relief(LanderEnv()), PARAMS.gravity)
    for _ in range(20):
        particles.blow(0.5, 1.0)
    assert particles.alive.any()
    assert (np.abs(particles.position[particles.alive, 0]) > PARAMS.pad_width / 2).all()


@pytest.mark.parametrize("seed", range(6))
def test_a_wreck_tumbles_to_rest_on_the_ground(seed: int):
    env = LanderEnv(1, seed, frame_skip=1, ground=hilly(np.random.default_rng(seed)))
    env.reset()
    wreck = Wreck(crashed(env), 0, np.random.default_rng(seed))
    began = wreck.pose(1.0)
    for _ in range(500):
        wreck.step()
    x, y, _ = wreck.pose(1.0)
    assert not wreck.moves
    assert np.abs(wreck.pose(1.0) - began).max() > 0.05
    around = env.ground.height(np.linspace(x - 1.1, x + 1.1, 45))
    assert around.min() < y < around.max() + 1.2  # it may lean on a slope
    assert np.array_equal(wreck.pose(0.0), wreck.pose(1.0))


def test_no_effect_ever_changes_a_flight():
    """With everything on: what was flown is what the rules alone would have flown, bit for bit, to the last step."""
    for seed in (3, 5):
        plain, dressed = (Flight(seed, ScriptedPilot(), pads=3) for _ in range(2))
        stage = Stage(dressed.env, np.random.default_rng(seed))
        for flight in (plain, dressed):
            flight.hand_over()
        for step in range(1600):
            held = 0 if step < 300 else 5  # and crashes in the end, at the latest on the time limit
            if step == 300 and not plain.over:
                plain.hand_over()
                dressed.hand_over()
            was_over = dressed.over
            plain.step(held)
            dressed.step(held)
            stage.follow(np.zeros(1, bool), np.array([dressed.over and not was_over]))
            if was_over and step % 100:
                continue
            assert np.array_equal(plain.poses.now, dressed.poses.now)
        assert plain.outcome is dressed.outcome
        assert plain.recording == dressed.recording
