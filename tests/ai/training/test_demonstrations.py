import json
from dataclasses import replace

import numpy as np
import pytest

from ai.agent.agent import DeepQAgent
from ai.lander.environment import LanderEnv
from ai.lander.ground import hilly
from ai.lander.pilots import ScriptedPilot
from ai.training.config import PRESETS
from ai.training.demonstrations import MOST, Demonstration, read, relive, takeover, teach, write
from ai.training.history import SettingChange
from ai.training.lander_session import TAUGHT, LanderSession
from ai.training.messages import NetworkState, Refused, SwarmState
from tests.support.demonstrated import demonstrate

MODERN = PRESETS["modern"]


@pytest.fixture(scope="module")
def landings():
    return demonstrate(ScriptedPilot(), 3, seed=5, spawn="near")


def test_a_landing_is_remembered_as_if_the_agent_had_flown_it(landings):
    config = MODERN.changed(n_step=1)
    cells = relive(landings[0], config)
    env = LanderEnv(1, landings[0].seed, "near", frame_skip=4, weights=config.reward_weights)
    observation, pilot, total = env.reset(), ScriptedPilot(), 0.0
    for row in range(len(cells.action)):
        assert np.array_equal(cells.state[row], observation[0])
        action = pilot.act(observation)
        assert cells.action[row] == action[0]
        result = env.step(action)
        observation, total = result.observation, total + result.reward[0]
    assert result.succeeded[0]
    assert cells.terminal.tolist() == [False] * (len(cells.action) - 1) + [True]
    # Its engines are counted as switched in physics steps, not in decisions: the same, but for rounding.
    assert cells.reward.sum() / config.reward_scale == pytest.approx(total, abs=0.1)


def test_only_what_follows_a_takeover_is_an_example(landings):
    whole = landings[0]
    begins = 4 * (len(whole.actions) // 8)
    part = Demonstration(whole.seed, whole.actions, "near", begins)
    config = MODERN.changed(n_step=1)
    all_, some = relive(whole, config), relive(part, config)
    assert len(some.action) == len(all_.action) - begins // 4
    assert np.array_equal(some.state, all_.state[begins // 4 :])
    assert takeover([True, False, True, True]) == 2
    assert takeover([True, True]) == 0
    assert takeover([True, False]) == 2


def test_a_flight_among_hills_is_about_the_pad_it_landed_on():
    env = LanderEnv(1, 3, "random", frame_skip=4, ground=hilly(np.random.default_rng(8)))
    env.target[:] = 1
    observation, actions = env.reset(), []
    while env.outcome[0] == 0:
        action = ScriptedPilot().act(observation)
        observation = env.step(action).observation
        actions += [int(action[0])] * 4
    assert env.landed_on[0] == 1
    flown = tuple(actions[: env.steps[0]])
    assert relive(Demonstration(3, flown, ground=8, pad=1), MODERN) is not None
    assert relive(Demonstration(3, flown, ground=8, pad=0), MODERN) is None
    assert relive(Demonstration(3, flown, ground=8, pad=9), MODERN) is None


def test_what_does_not_land_is_not_taught(landings):
    agent = DeepQAgent(config=MODERN.changed(success_pass=True))
    fall = Demonstration(0, (0,) * 600)
    assert relive(fall, MODERN) is None
    assert teach(agent, [*landings, fall]) == 3
    flown = sum(-(-len(landing.actions) // 4) for landing in landings)
    assert len(agent.replay) == len(agent.successes) == flown


def test_demonstrations_are_kept_in_a_file(landings, tmp_path):
    path = tmp_path / "new" / "flights.json"
    assert read(path) == []
    write(path, landings)
    assert read(path) == landings
    assert [file.name for file in path.parent.iterdir()] == ["flights.json"]


def test_a_live_run_learns_from_them_from_its_first_decision(landings, tmp_path):
    path = tmp_path / "flights.json"
    write(path, landings)
    config = PRESETS["classic"].changed(success_pass=False)
    lonely, led = LanderSession.live(config), LanderSession.live(config)
    next(lonely)
    next(led)
    answer = led.send(("teach", path))
    assert [(message.name, message.after) for message in answer if isinstance(message, SettingChange)] == [
        ("success_pass", True),
        (TAUGHT, len(landings)),
    ]
    insights = [[message for message in next(run) if isinstance(message, NetworkState)] for run in (lonely, led)]
    assert not insights[0][-1:] or not insights[0][-1].gradients.any()  # still warming up
    assert insights[1][-1].gradients.any()
    write(path, [*landings, replace(landings[0], begins=30)])
    again = led.send(("teach", path))
    assert [each.after for each in again if isinstance(each, SettingChange)] == [1], "only the new one"
    lonely.close()
    led.close()


KNOWN = '"format": "tranquility demonstrations", "version": 1'
NONSENSE: list[str | bytes] = [
    "{", "[" * 100_000, b"\xff\xfe", f'{{{KNOWN}, "flights": 3}}', f'{{{KNOWN}, "flights": [3]}}',
    *(f'{{{KNOWN}, "flights": [{{"seed": 1, "actions": [0], {wrong}}}]}}' for wrong in (
        '"ground": -1', '"ground": "x"', '"ground": 1.5', '"ground": [1]', '"ground": true', '"spawn": []',
        '"spawn": {}', '"pad": 1e400', f'"pad": 1{"0" * 30}', f'"begins": 1{"0" * 400}', '"begins": null',
        '"actions": [true]', '"actions": [Infinity]', '"seed": NaN')),
]  # fmt: skip


def test_a_live_run_goes_on_where_there_is_nothing_to_learn_from_or_it_makes_no_sense(tmp_path):
    path, run = tmp_path / "flights.json", LanderSession.live(PRESETS["classic"])
    next(run)
    for content, words in (("", "no landings"), *((content, "flights.json") for content in NONSENSE)):
        if content:
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
        (refused,) = run.send(("teach", path))
        assert isinstance(refused, Refused), content[:99]
        assert words in refused.problem
        assert len(refused.problem) < 400
    assert any(isinstance(message, SwarmState) for message in next(run))
    run.close()


KNOWN = '"format": "tranquility demonstrations", "version": 1'


def test_a_file_of_many_flights_is_read_no_further_than_one_is_written(landings, tmp_path):
    path = tmp_path / "flights.json"
    write(path, landings)
    described = json.loads(path.read_text())
    described["flights"] *= 2 * MOST
    path.write_text(json.dumps(described))
    assert len(read(path)) == MOST
