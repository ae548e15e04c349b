"""Dust, sparks, fragments and wrecks: they obey the flight's own ground and gravity, and nothing obeys them."""

from collections.abc import Callable

import numpy as np
import pytest

from ai.lander.environment import LIMITS, LanderEnv, Outcome
from ai.lander.ground import hilly
from ai.lander.missions import MISSIONS
from ai.lander.pilots import ScriptedPilot
from ai.lander.push import KEYS
from ai.lander.sensing import near_edges
from game.audio.flight_sounds import FlightSound
from game.scenes.play.words import dangers
from game.world.particles import ParticleKind, Particles
from game.world.stage import Stage
from game.world.wreck import Wreck
from tests.support.flights import begun
from tests.support.landers import placed, put
from tests.support.listener import Listener


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


def test_fragments_fly_and_bounce_above_the_hills_and_come_to_rest():
    env = over_hills()
    particles = Particles(np.random.default_rng(0), env)
    particles.burst(np.array([-4.6, 6.0]), np.array([2.0, -6.0]))
    rose = 0
    for _ in range(200):
        particles.update()
        live = particles.alive
        place = particles.position[live]
        assert (place[:, 1] >= particles.floor(place[:, 0]) - 1e-9).all()
        shards = live & (particles.kind == ParticleKind.SHARD)
        rose += int((particles.velocity[shards, 1] > 0.2).sum())
    assert rose > 50


@pytest.mark.parametrize("mission", ["mars", "earth"])
def test_what_flies_about_falls_as_on_that_world(mission: str):
    env = MISSIONS[mission].begin()
    stage = Stage(env, np.random.default_rng(0))
    stage.particles.add(ParticleKind.SHARD, np.array([[0.0, 20.0]]), np.zeros((1, 2)), (9.0, 9.0), (0.1, 0.1))
    for _ in range(60):
        stage.particles.update()
    assert stage.particles.velocity[0, 1] == pytest.approx(-env.params.gravity)


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


@pytest.mark.parametrize("seed", range(2))
def test_a_wreck_tumbles_to_rest_on_the_ground(seed: int):
    env = LanderEnv(1, seed, frame_skip=1, ground=hilly(np.random.default_rng(seed)))
    env.reset()
    wreck = Wreck(crashed(env), 0, np.random.default_rng(seed))
    began = wreck.pose(1.0)
    while wreck.moves:
        wreck.step()
    assert np.abs(wreck.pose(1.0) - wreck.pose(0.0)).max() < 0.002, "it stops where it lies still, and not before"
    wreck.step()
    x, y, _ = wreck.pose(1.0)
    assert np.abs(wreck.pose(1.0) - began).max() > 0.05
    around = env.ground.height(np.linspace(x - 1.1, x + 1.1, 45))
    assert around.min() < y < around.max() + 1.2  # it may lean on a slope
    assert np.array_equal(wreck.pose(0.0), wreck.pose(1.0))


def test_no_effect_ever_changes_a_flight():
    """With everything on: what was flown is what the rules alone would have flown, bit for bit, to the last step."""
    plain, dressed = (begun(3, ScriptedPilot(), pads=3) for _ in range(2))
    stage = Stage(dressed.env, np.random.default_rng(3))
    for flight in (plain, dressed):
        flight.chooser.hand_over()
    for step in range(900):
        if step == 300:  # by hand into a crash
            plain.chooser.hand_over()
            dressed.chooser.hand_over()
        was_over = dressed.over
        for flight in (plain, dressed):
            flight.step(KEYS[0 if step < 300 else 5])
        stage.follow(np.zeros(1, bool), np.array([dressed.over and not was_over]))
        assert np.array_equal(plain.poses.now, dressed.poses.now)
    assert plain.outcome is dressed.outcome is not Outcome.FLYING
    assert plain.recording == dressed.recording


# Edges of the area: seen, heard and said before a craft leaves; and what comes down beside the pad.


def at(*state: float) -> LanderEnv:
    """A lander in the area of people."""
    return placed(state, limits=LIMITS.roomy())


@pytest.mark.parametrize(("state", "side"), [((27, 10, 2, 0, 0, 0), "right"), ((-27, 10, -2, 0, 0, 0), "left"),
                                             ((0, 26, 0, 2, 0, 0), "above")])  # fmt: skip
def test_an_edge_is_named_and_sounds_before_it_is_crossed(state: tuple[float, ...], side: str):
    env, sound = at(*state), Listener()
    [edge] = near_edges(env)
    assert (edge.side, edge.ahead) == (side, True)
    assert edge.away == pytest.approx(3)
    assert any("3 m" in text for text in dangers(env))
    heard = FlightSound(sound, env)
    heard.follow(np.zeros(3))
    assert "edge" in sound.heard()


def test_a_craft_that_is_whole_comes_to_rest_upright_beside_the_pad():
    for seed in range(4):
        rng = np.random.default_rng(seed)
        env = LanderEnv(1, seed, frame_skip=1, ground=hilly(rng) if seed % 2 else None)
        env.reset()
        while not env.intact[0]:
            x, lean = rng.uniform(-16, 16), rng.uniform(-0.35, 0.35)
            put(env, (x, env.lowest(x, lean) + 0.05, rng.uniform(-1, 1), -1.0, lean))
            while env.outcome[0] == Outcome.FLYING:
                env.fly(np.zeros(1, int))
        whole = Wreck(env, 0, np.random.default_rng(0))
        for _ in range(430):
            whole.step()
        x, _, angle = whole.pose(1.0)
        assert not whole.moves
        assert abs(angle) < 1.0
        assert abs(x - env.position[0, 0]) < 2.5


def test_down_softly_beside_the_pad_is_a_touch_and_no_blast():
    env, sound = at(9, 2.2, 0, -0.4, 0, 0), Listener()
    heard = FlightSound(sound, env)
    stage = Stage(env, np.random.default_rng(0))
    ended: Callable[[], bool] = lambda: bool(env.outcome[0] != Outcome.FLYING)  # noqa: E731
    while not ended():
        env.fly(np.zeros(1, int))
        heard.follow(np.zeros(3))
        stage.follow(np.zeros(1, bool), np.array([ended()]))
    sounds = sound.heard()
    assert "touchdown" in sounds
    assert "crash" not in sounds
    assert not stage.flash.any()
    assert stage.sprite().image != "wreck"
