"""The map of the chance to be saved is what the critic says of each place, and its edge lies between saved and lost."""

from pathlib import Path

import numpy as np
import pygame
import pytest

from ai.agent.agent import DeepQAgent
from ai.copilot.critic import SafetyCritic, critic_beside
from ai.lander.environment import LanderEnv, Outcome
from ai.lander.ground import hilly
from game.drawing.canvas import Canvas
from game.world.camera import View
from game.world.chance_map import EDGE, GRID, ChanceMap
from game.world.contours import contours, smooth

MODERN = Path(__file__).parents[3] / "models" / "lander" / "modern"
FALLING = np.array([0.0, 10.0, 3.0, -4.0, 0.5, 0.0])


@pytest.fixture(scope="module")
def agent() -> DeepQAgent:
    return DeepQAgent.load(MODERN)


@pytest.fixture(scope="module")
def critic(agent: DeepQAgent) -> SafetyCritic:
    critic, problem = critic_beside(agent)
    assert critic is not None, problem
    return critic


def over(env: LanderEnv, critic: SafetyCritic, start: np.ndarray = FALLING) -> ChanceMap:
    """A whole map for a lander that moves so."""
    env.reset()
    env.begin_at(0, start)
    chance_map = ChanceMap()
    for _ in range(40):
        chance_map.follow(env, 0, critic)
        if chance_map.cells is not None:
            return chance_map
    raise AssertionError("no whole map")


def test_a_cell_is_what_the_critic_says_of_a_lander_that_is_really_there(critic: SafetyCritic):
    env = LanderEnv(1, 3, frame_skip=1)
    cells = over(env, critic).cells
    assert cells is not None
    assert cells.chances.shape == GRID[::-1]
    for row, column in ((2, 5), (9, 30), (14, 50), (20, 33)):
        env.begin_at(0, np.array([*cells.places[row, column], *FALLING[2:]]))
        assert cells.chances[row, column] == pytest.approx(
            float(critic.chances(env.observe(), env.around()).max()), abs=1e-5
        )


def test_of_several_pads_the_one_that_can_be_reached_counts(critic: SafetyCritic):
    env = LanderEnv(1, 3, frame_skip=1, ground=hilly(np.random.default_rng(3)))
    cells = over(env, critic).cells
    assert cells is not None
    x, y = cells.places[9, 20]
    env.begin_at(0, np.array([x, y, *FALLING[2:]]))
    chances = critic.chances(env.observe_pads()[0], env.around_pads()[0])
    assert cells.chances[9, 20] == pytest.approx(float(chances.max()), abs=1e-5)


def test_it_is_computed_in_pieces_and_only_when_something_has_changed(critic: SafetyCritic):
    asked: list[int] = []

    class Counted:
        def chances(self, observation: np.ndarray, surroundings: np.ndarray) -> np.ndarray:
            asked.append(len(observation))
            return critic.chances(observation, surroundings)

    env = LanderEnv(1, 3, frame_skip=1)
    env.reset()
    chance_map = ChanceMap()
    for _ in range(40):
        chance_map.follow(env, 0, Counted())
    assert sum(asked) == GRID[0] * GRID[1]
    assert max(asked) <= 400
    env.fly(np.array([3]))
    chance_map.follow(env, 0, Counted())
    assert sum(asked) > GRID[0] * GRID[1]


def test_landers_put_well_inside_the_edge_land_and_those_well_outside_are_lost(agent: DeepQAgent, critic: SafetyCritic):
    cells = over(LanderEnv(1, 3, frame_skip=1), critic).cells
    assert cells is not None
    clear = cells.places[..., 1] > 3.0
    saved = np.argwhere((cells.chances > 0.98) & clear)
    lost = np.argwhere((cells.chances < 0.02) & clear)
    assert min(len(saved), len(lost)) > 40
    picks = [places[:: len(places) // 40][:40] for places in (saved, lost)]
    rows = [[*cells.places[tuple(place)], *FALLING[2:]] for group in picks for place in group]
    env = LanderEnv(len(rows), 1)
    env.reset()
    env.place(np.ones(len(rows), bool), np.array(rows))
    held = np.zeros(len(rows), np.intp)
    for _ in range(600):
        held = agent.act(env.observe(), held=held)
        env.step(held)
    landed = (env.outcome == Outcome.LANDED).reshape(2, -1).mean(axis=1)
    assert landed[0] > 0.9
    assert landed[1] < 0.1


def test_the_lost_side_of_the_edge_is_on_the_hand_where_its_ticks_are_drawn(critic: SafetyCritic):
    cells = over(LanderEnv(1, 3, frame_skip=1), critic).cells
    assert cells is not None
    (edge,) = cells.edges
    middle = len(edge) // 2
    way = edge[middle + 1] - edge[middle]
    lost = np.array([-way[1], way[0]]) / np.hypot(*way)
    aside = [_chance(cells, edge[middle] + side * 1.5 * lost) for side in (1, -1)]
    assert aside[0] < EDGE < aside[1]


def _chance(cells, place: np.ndarray) -> float:
    away = np.hypot(*(cells.places - place).transpose(2, 0, 1))
    return float(cells.chances[np.unravel_index(away.argmin(), away.shape)])


def test_it_is_drawn_at_any_size_and_says_so_where_there_is_no_edge(critic: SafetyCritic):
    env = LanderEnv(1, 3, frame_skip=1)
    for start, edges in ((FALLING, True), (np.array([0.0, 10.0, 0.0, -25.0, 2.0, 3.0]), False)):
        chance_map = over(env, critic, start)
        assert chance_map.cells is not None
        assert bool(chance_map.cells.edges) is edges
        assert chance_map.said
        for size in ((1280, 720), (800, 900)):
            canvas = Canvas(pygame.Surface(size))
            before = pygame.image.tobytes(canvas.surface, "RGB")
            chance_map.draw_veil(canvas, View(canvas.scale))
            chance_map.draw_edge(canvas, View(canvas.scale), 100.0)
            assert pygame.image.tobytes(canvas.surface, "RGB") != before
    assert ChanceMap().said == ""


# Contours


def test_a_contour_of_a_cone_is_a_closed_circle():
    rows, columns = np.mgrid[:41, :41]
    field = 20.0 - np.hypot(columns - 20.3, rows - 19.6)
    (line,) = contours(field, 8.0)
    assert np.array_equal(line[0], line[-1])
    assert np.hypot(*(line - (20.3, 19.6)).T) == pytest.approx(12.0, abs=0.05)
    finer = smooth(line)
    assert len(finer) > 2 * len(line)
    assert np.hypot(*(finer - (20.3, 19.6)).T) == pytest.approx(12.0, abs=0.1)


def test_a_contour_that_leaves_the_field_is_open_and_a_flat_field_has_none():
    field = np.add.outer(np.zeros(5), np.arange(7.0))
    (line,) = contours(field, 2.5)
    assert line[:, 0] == pytest.approx(2.5)
    assert sorted(line[[0, -1], 1].tolist()) == [0.0, 4.0]
    assert contours(np.ones((4, 4)), 0.5) == []
    assert contours(np.ones((4, 4)), 1.5) == []


def test_two_islands_have_two_contours_and_a_saddle_is_cut_in_two():
    field = np.zeros((9, 9))
    field[2, 2] = field[6, 6] = 1.0
    assert len(contours(field, 0.5)) == 2
    saddle = np.array([[1.0, 0.0], [0.0, 1.0]])
    assert len(contours(saddle, 0.5)) == 2
