"""Watch and the co-pilot's panel draw what was decided, over whole flights of the networks that come with the game."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pygame
import pytest

from ai.agent.agent import DeepQAgent
from ai.lander.environment import Outcome
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.explain.q_values import SPAN
from game.flight.networks import DECISION_STEPS
from game.scenes.play.copilot_panel import CopilotPanel
from game.scenes.watch.decision_panel import write_decision
from game.scenes.watch.scene import WatchScene
from game.ui.context import Context
from tests.support.drawn import Drawn, Panel, number, read_panel
from tests.support.driver import Driver
from tests.support.flights import begun

MODELS = Path(__file__).parents[3] / "models" / "lander"
NETWORKS = ("modern", "classic")
TINY = 1e-3  # points by which values may differ that were computed beside others, and alone
Open = Callable[..., Driver]


@pytest.fixture(params=NETWORKS, scope="module")
def agent(request: pytest.FixtureRequest) -> DeepQAgent:
    return DeepQAgent.load(MODELS / request.param)


@pytest.fixture
def canvas() -> Canvas:
    return Canvas(pygame.Surface((1280, 720)))


def check(panel: Panel, points: np.ndarray, flown: int) -> None:
    """Compare what can be read off a panel with values in points (6,) and the action that was flown."""
    assert [row.marked for row in panel.rows] == [action == flown for action in range(6)]
    assert number(panel.expected) == pytest.approx(points.max(), abs=0.051)
    loss = points.max() - points
    assert [-number(row.figure) for row in panel.rows] == pytest.approx(loss.tolist(), abs=0.051)
    assert [row.fraction for row in panel.rows] == pytest.approx(np.clip(1 - loss / SPAN, 0, 1).tolist(), abs=1e-4)
    assert [row.beyond for row in panel.rows] == (loss > SPAN).tolist()


def test_watch_draws_the_decision_that_is_flown_and_nothing_else(
    open_game: Open, context: Context, agent: DeepQAgent, canvas: Canvas, monkeypatch: pytest.MonkeyPatch
):
    count = 64 if agent.config.steadiness else 1
    context.models_dir = MODELS.parent
    context.settings.reduced_motion = True
    driver = open_game(WatchScene, seed=4, many=count > 1)
    watch = driver.top
    assert isinstance(watch, WatchScene)
    watch.swarm.policy = agent
    watch.world.shown = count - 1
    slot, env = watch.world.shown, watch.swarm.env
    drawn = Drawn(monkeypatch)
    kept = longest = steps = 0
    for step in range(160):
        before = env.observe()[slot].copy()
        decided, flying = watch.swarm.decided[slot], watch.swarm.since_end[slot] == 0
        watch.update()
        if watch.swarm.landed + watch.swarm.lost > 2 * count:
            break
        if watch.swarm.decided[slot] == decided and step < DECISION_STEPS:
            continue  # what was decided before this network flew
        if watch.swarm.decided[slot] > decided and flying:
            sensed = before
        elif watch.swarm.fresh[slot]:
            sensed = watch.swarm.decision.observation[slot]
            assert sensed[1] > 0.5  # of the new start, not of where the last flight ended
        drawn.clear()
        write_decision(Cursor(980, 100, 244, canvas=canvas), watch.decision)
        panel = read_panel(drawn)
        points = agent.q_values(sensed)[0] / agent.config.reward_scale
        if env.outcome[slot] == Outcome.FLYING:
            check(panel, points, int(env.actions[slot]))
            steps += 1
            said = any("is kept" in word for word in drawn.words)
            kept += said
            longest += not said
            behind = points.max() - points[env.actions[slot]]
            assert behind <= watch.decision.margin + TINY if said else behind < TINY
        assert [number(figure) for figure in panel.inputs] == pytest.approx(sensed.tolist(), abs=0.0051)
    assert steps > 60
    assert kept > 10 if agent.config.steadiness else longest == steps


def test_the_co_pilots_panel_draws_what_a_network_that_flies_alone_decides(
    agent: DeepQAgent, canvas: Canvas, monkeypatch: pytest.MonkeyPatch
):
    flight, drawn = begun(5, agent), Drawn(monkeypatch)
    copilot_panel = CopilotPanel()
    flight.chooser.hand_over()
    while True:
        if flight.at % DECISION_STEPS == 0:
            sensed = flight.env.observe()
        flight.step()
        if flight.over:
            break
        copilot_panel.follow(flight)
        if flight.at % 3:
            continue  # a third of the steps, which is in turn every one of a decision
        drawn.clear()
        copilot_panel.draw(canvas)
        points = agent.q_values(sensed)[0] / agent.config.reward_scale
        check(read_panel(drawn), points, flight.recording.pushes[-1].action)
        said = any("is kept" in word for word in drawn.words)
        assert said or points.max() - points[flight.recording.pushes[-1].action] < TINY
    assert flight.at > 200
