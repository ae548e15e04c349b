import numpy as np

from ai.lander.environment import PARAMS, LanderEnv, Outcome
from ai.lander.pilots import ScriptedPilot
from ai.lander.push import KEYS
from game.audio.flight_sounds import FlightSound
from tests.support.flights import begun
from tests.support.listener import Listener

STANDING = PARAMS.pad_top + PARAMS.stand
NOTHING = np.zeros(3)


class Heard:
    """A flight with somebody who listens."""

    def __init__(self, *start: float, warns: bool = True) -> None:
        self.flight = begun(seed=3)
        env = self.flight.env
        env.place(np.ones(1, bool), np.array([start or (float(env.pad[0, 0]), STANDING + 8, 0.0, 0.0, 0.0, 0.0)]))
        self.sound = Listener()
        self.ears = FlightSound(self.sound, env, warns=warns)

    def step(self, action: int = 0, number: int = 1) -> None:
        for _ in range(number):
            self.flight.step(KEYS[action])
            self.ears.follow(NOTHING)

    def to_the_end(self, pilot: ScriptedPilot | None = None) -> list[str]:
        while not self.flight.over:
            self.step(int(pilot.act(self.flight.env.observe())[0]) if pilot else 0)
        self.step(number=5)
        return self.sound.heard()


def over_the_pad(height: float, across: float = 0.0, angle: float = 0.0, fall: float = 0.0) -> Heard:
    middle = float(begun(seed=3).env.pad[0, 0])
    return Heard(middle + across, STANDING + height, 0.0, -fall, angle, 0.0)


def test_engines_sound_as_they_burn():
    heard = over_the_pad(8)
    heard.ears.follow(np.array([0.7, 0.0, 0.2]))
    assert heard.sound.loops == {"engine": 0.7, "jet_left": 0.0, "jet_right": 0.2}


def test_a_fall_is_warned_of_then_a_crash_once():
    played = over_the_pad(14).to_the_end()
    assert played.count("crash") == 1
    assert "too_fast" in played[: played.index("crash")]
    assert not {"landed", "contact", "too_tilted"} & set(played)


def test_a_landing_touches_lights_up_and_ends_in_a_chord():
    heard = over_the_pad(6)
    played = heard.to_the_end(ScriptedPilot())
    assert heard.flight.outcome is Outcome.LANDED
    assert played.count("contact") == played.count("landed") == 1
    assert 1 <= played.count("touchdown") <= 6
    assert played.index("touchdown") < played.index("landed")
    assert "crash" not in played


def test_a_harder_touch_is_louder():
    def blow(fall: float) -> float:
        heard = over_the_pad(0.3, fall=fall)
        played = heard.to_the_end()
        return heard.sound.volumes[played.index("touchdown")]

    assert 0.15 <= blow(0.2) < blow(1.4) <= 1.0


def warned(heard: Heard) -> list[str]:
    return [key for key in heard.sound.heard() if key.startswith("too")]


def test_warnings_come_when_they_matter_and_know_gravity_and_the_brake():
    for height, fall, angle, action, share, warning in (
        (2.0, 3.0, 0.0, 0, 1.0, ["too_fast"]), (2.0, 1.0, 0.0, 0, 1.0, []), (12.0, 3.0, 0.0, 0, 1.0, []),
        (12.0, 7.0, 0.0, 0, 1.0, ["too_fast"]), (4.0, 0.0, 0.7, 0, 1.0, ["too_tilted"]),
        (4.0, 0.0, -0.7, 0, 1.0, ["too_tilted"]), (12.0, 0.0, 0.7, 0, 1.0, []), (4.0, 0.0, 0.3, 0, 1.0, []),
        (3.6, 3.8, 0.0, 3, 1.0, []), (3.6, 3.8, 0.0, 0, 1.0, ["too_fast"]), (3.8, 3.8, 0.0, 0, 0.6, []),
        (4.5, 3.8, 0.0, 0, 1.0, []), (4.5, 3.8, 0.0, 0, 1.4, ["too_fast"]),
    ):  # fmt: skip
        heard = over_the_pad(height, fall=fall, angle=angle)
        env = heard.flight.env
        env.world.gravity = (0.0, -share * env.params.gravity)
        heard.step(action)
        assert warned(heard) == warning, (height, fall, angle, action, share)
    watched = Heard(0.0, STANDING + 2, 0.0, -3.0, 0.8, 0.0, warns=False)
    watched.step()
    assert not warned(watched), "who only watches"


def test_two_warnings_take_turns():
    heard = over_the_pad(4.5, fall=5.0, angle=0.8)
    heard.flight.env.world.gravity = (0.0, 0.0)
    heard.step(number=45)
    assert warned(heard) == ["too_fast", "too_tilted"]


def test_turning_to_another_lander_is_no_event():
    env = LanderEnv(2, seed=1, frame_skip=1)
    env.reset()
    sound = Listener()
    ears = FlightSound(sound, env)
    ears.follow(NOTHING, 0)
    sound.heard()
    env.outcome[1] = Outcome.CRASHED
    ears.follow(NOTHING, 1)
    ears.follow(NOTHING, 1)
    assert sound.heard() == []
    env.outcome[0] = Outcome.TIMED_OUT
    ears.follow(NOTHING, 0)
    assert sound.heard() == []


def test_a_flight_that_begins_anew_is_heard_anew():
    heard = over_the_pad(14)
    first = heard.to_the_end()
    heard.flight.env.reset()
    heard.ears.follow(NOTHING)
    assert not heard.sound.heard()
    assert heard.to_the_end() == first
