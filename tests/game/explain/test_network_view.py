import numpy as np
import pygame
import pytest

from ai.agent.network import build_network
from ai.lander.environment import ACTION_NAMES
from ai.nn import CostFunctions, FullyConnectedLayer, NeuralNetwork
from ai.training.config import Config
from game.core import texts
from game.drawing.canvas import Canvas
from game.explain.network_plan import NetworkPlan, steady_choice, strongest_edges
from game.explain.network_view import NetworkView
from tests.support.written import words_written

BOX = (868, 420, 384, 180)
LARGE = (90, 80, 1100, 560)
OBSERVATION = np.linspace(-1, 1, 9)

FEATURE_NAMES = ("x", "y", "vx", "vy", "sin θ", "cos θ", "ω", "left foot", "right foot")


@pytest.fixture
def canvas() -> Canvas:
    return Canvas(pygame.Surface((1280, 720)))


def network_of(**options: object) -> NeuralNetwork:
    network = build_network(9, 6, Config().changed(**options), np.random.default_rng(0))
    network.gradients[:] = np.random.default_rng(1).normal(size=len(network.gradients))
    return network


def view_of(network: NeuralNetwork, box: tuple[int, int, int, int] = BOX) -> NetworkView:
    view = NetworkView(box, FEATURE_NAMES, ACTION_NAMES)
    view.set(network, OBSERVATION)
    return view


def play(view: NetworkView, canvas: Canvas, frames: int = 40) -> None:
    for _ in range(frames):
        view.update()
        view.draw(canvas)


# What is shown


def test_the_strongest_units_are_chosen_and_stay_until_another_is_much_stronger() -> None:
    strength = np.array([5.0, 1, 4, 1, 3, 1])
    chosen = steady_choice(strength, 3)
    np.testing.assert_array_equal(chosen, [0, 2, 4])
    strength[1] = 3.5  # stronger than the third, but not by much
    np.testing.assert_array_equal(steady_choice(strength, 3, chosen), chosen)
    np.testing.assert_array_equal(steady_choice(strength, 3), [0, 1, 2])
    strength[1] = 9.0
    np.testing.assert_array_equal(steady_choice(strength, 3, chosen), [0, 1, 2])
    np.testing.assert_array_equal(steady_choice(np.ones(4), 12), np.arange(4))


def test_only_the_largest_links_are_drawn_and_the_largest_last() -> None:
    matrix = np.array([[0.5, -2.0], [0.1, 1.0]])
    edges = strongest_edges(matrix, 3, 3)
    assert [(edge.start, edge.end, edge.positive) for edge in edges] == [(0, 0, True), (1, 1, True), (0, 1, False)]
    assert (edges[0].size, edges[-1].size) == (0.25, 1)
    assert {edge.column for edge in edges} == {3}
    assert strongest_edges(np.zeros((3, 3)), 0, 5) == []


def test_edges_follow_what_is_to_be_shown() -> None:
    network = NeuralNetwork(*CostFunctions.use_mse()).add_layer(FullyConnectedLayer(3, 2))
    weights, _ = network.layers[0].parameters
    network.values[:] = 0
    weights.value[:] = [[3, 0], [0, -2], [1, 0]]
    network.gradients[:] = 0
    weights.gradient[:] = [[0, 0], [0, 0], [0, 5]]
    plan = NetworkPlan(network, [0.0, 2.0, -1.0], 12)

    def drawn(show: str) -> list[tuple[int, int, bool]]:
        return [(edge.start, edge.end, edge.positive) for edge in plan.edges(show, 12)]

    assert drawn("weights") == [(2, 0, True), (1, 1, False), (0, 0, True)]
    assert drawn("activations") == [(2, 0, False), (1, 1, False)]  # an input of 0 sends nothing
    assert drawn("gradients") == [(2, 1, False)]  # learning goes down the gradient
    network = network_of()
    best = int(network.predict(OBSERVATION.astype(np.float32)).argmax())
    assert NetworkPlan(network, OBSERVATION, 12).best() == best, "the one the network would take"


def test_a_unit_is_found_where_it_is_drawn_and_named() -> None:
    view = view_of(network_of())
    assert [column.total for column in view.columns] == [9, 64, 64, 6]
    assert [len(column.units) for column in view.columns] == [9, 12, 12, 6]
    for number, column in enumerate(view.centres):
        for place, centre in enumerate(column):
            assert view.unit_at(centre) == (number, place)
            assert view.box.collidepoint(centre)
    assert view.unit_at((0.0, 0.0)) is None
    assert view.unit_name(0, 3) == FEATURE_NAMES[3]
    assert view.unit_name(3, 5) == ACTION_NAMES[5]
    assert "18" in view.unit_name(1, 17)


# Drawing


def test_new_numbers_are_drawn_at_most_ten_times_a_second_and_end_up_as_if_at_once(canvas: Canvas) -> None:
    network = network_of()
    in_parts, at_once = view_of(network, LARGE), view_of(network, LARGE)
    painted = set()
    for frame in range(120):
        network.values[frame] += 1
        in_parts.set(network, OBSERVATION)
        play(in_parts, canvas, 1)
        painted.add(id(in_parts._sheets))
    assert 2 <= len(painted) <= 21
    network.values *= -1
    pictures = []
    for view, frames in ((in_parts, 90), (at_once, 1)):
        view.set(network, -OBSERVATION)
        play(view, canvas, frames)
        canvas.surface.fill((0, 0, 0))
        view.draw(canvas)
        pictures.append(pygame.image.tobytes(canvas.surface, "RGB"))
    assert pictures[0] == pictures[1]


@pytest.mark.parametrize(
    ("options", "box"),
    [({"hidden": (1,)}, BOX), ({"hidden": (1024, 3)}, LARGE), ({"hidden": (16, 16, 16, 16, 16)}, (10, 10, 60, 40)),
     ({"dueling": True}, LARGE), ({"layer_normalisation": False, "activation": "tanh"}, BOX)],
)  # fmt: skip
def test_any_network_is_drawn_in_any_box(canvas: Canvas, options: dict[str, object], box: tuple[int, ...]) -> None:
    view = view_of(network_of(**options), box)
    for view.show in ("weights", "activations", "gradients"):
        play(view, canvas, 2)
    view.hover(view.centres[-1][-1])
    play(view, canvas, 8)
    view.set(network_of(hidden=(3,)), None)  # one of another size takes its place, before anything was sensed
    play(view, canvas, 20)
    assert [column.total for column in view.columns] == [9, 3, 6]


def test_nothing_is_drawn_of_no_network(canvas: Canvas) -> None:
    view = NetworkView(BOX)
    view.hover((900.0, 450.0))
    play(view, canvas, 3)
    view.set(NeuralNetwork(*CostFunctions.use_mse()))
    play(view, canvas, 9)
    assert view.unit_at((900.0, 450.0)) is None


def test_outputs_are_given_in_points_of_reward(monkeypatch: pytest.MonkeyPatch) -> None:
    network = network_of()
    values = network.predict(np.atleast_2d(OBSERVATION))[0]
    view = NetworkView(LARGE, FEATURE_NAMES, ACTION_NAMES)
    view.output_scale = 0.01
    view.set(network, OBSERVATION)
    written = words_written(monkeypatch)
    play(view, Canvas(pygame.Surface((1280, 720))))
    for value in (values / np.float32(0.01)).tolist():
        assert f"{value:.2f}".replace("-", "\u2212") in written
    view.hover(view.centres[-1][0])
    written.clear()
    play(view, Canvas(pygame.Surface((1280, 720))))
    assert texts.NETWORK_VIEW_POINTS in written
