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


def network_of(features: int = 9, actions: int = 6, **options: object) -> NeuralNetwork:
    network = build_network(features, actions, Config().changed(**options), np.random.default_rng(0))
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


def test_damaged_units_are_shown_first_and_few_units_all() -> None:
    strength = np.ones(30)
    strength[[7, 21]] = np.nan, np.inf
    assert {7, 21} <= set(steady_choice(strength, 4).tolist())
    np.testing.assert_array_equal(steady_choice(np.ones(4), 12), np.arange(4))


def test_the_shown_units_do_not_flicker_as_learning_goes_on() -> None:
    network = network_of()
    view = view_of(network)
    rng = np.random.default_rng(2)
    changes = 0
    for _ in range(20):
        before = [column.units for column in view.columns]
        network.values += 0.002 * rng.normal(size=len(network.values)).astype(np.float32)
        view.set(network, OBSERVATION + 0.05 * rng.normal(size=9))
        changes += sum(len(np.setdiff1d(c.units, old)) for c, old in zip(view.columns, before, strict=True))
    assert changes <= 6


def test_only_the_largest_links_are_drawn_and_the_largest_last() -> None:
    matrix = np.array([[0.5, -2.0], [0.1, 1.0]])
    edges = strongest_edges(matrix, 3, 3)
    assert [(edge.start, edge.end, edge.positive) for edge in edges] == [(0, 0, True), (1, 1, True), (0, 1, False)]
    assert edges[-1].size == 1
    assert edges[0].size == 0.25
    assert {edge.column for edge in edges} == {3}
    assert strongest_edges(np.zeros((3, 3)), 0, 5) == []
    assert strongest_edges(np.full((3, 3), np.nan), 0, 5) == []


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


def test_the_best_output_is_the_one_the_network_would_take() -> None:
    network = network_of()
    plan = NetworkPlan(network, OBSERVATION, 12)
    assert plan.best() == int(network.predict(OBSERVATION.astype(np.float32)).argmax())
    assert NetworkPlan(network, None, 12).best() is None


# Pointing


def test_a_unit_is_found_where_it_is_drawn_and_named() -> None:
    view = view_of(network_of())
    assert [column.total for column in view.columns] == [9, 64, 64, 6]
    assert [len(column.units) for column in view.columns] == [9, 12, 12, 6]
    for number, column in enumerate(view.centres):
        for place, centre in enumerate(column):
            assert view.unit_at(centre) == (number, place)
            assert view.box.collidepoint(centre)
    assert view.unit_at((0.0, 0.0)) is None
    assert view.name(0, 3) == FEATURE_NAMES[3]
    assert view.name(3, 5) == ACTION_NAMES[5]
    assert str(view.columns[1].units[2] + 1) in view.name(1, 2)


# Drawing


def test_new_numbers_are_drawn_at_most_ten_times_a_second_and_old_ones_not_again(canvas: Canvas) -> None:
    network = network_of()
    view = view_of(network)
    for frame in range(120):
        network.values[frame] += 1
        view.set(network, OBSERVATION)
        view.update()
        view.draw(canvas)
    assert 8 <= view.redraws <= 21
    play(view, canvas)
    redraws = view.redraws
    play(view, canvas)
    assert view.redraws == redraws


def test_what_is_drawn_in_parts_ends_up_the_same_as_at_once(canvas: Canvas) -> None:
    network = network_of()
    in_parts, at_once = view_of(network, LARGE), view_of(network, LARGE)
    in_parts.draw(canvas)
    network.values *= -1
    for view in (in_parts, at_once):
        view.set(network, -OBSERVATION)
    play(in_parts, canvas, 90)
    assert (in_parts.redraws, in_parts.busy) == (2, False)
    pictures = []
    for view in (in_parts, at_once):
        canvas.surface.fill((0, 0, 0))
        view.draw(canvas)
        pictures.append(pygame.image.tobytes(canvas.surface, "RGB"))
    assert at_once.redraws == 1
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
    view.hover(view.centres[1][0])
    play(view, canvas, 8)


@pytest.mark.parametrize("bad", [np.nan, np.inf, 3e38])
def test_damaged_numbers_are_drawn_and_marked(canvas: Canvas, bad: float) -> None:
    network = network_of()
    network.values[::7] = bad
    network.gradients[::5] = bad
    view = view_of(network)
    for view.show in ("weights", "activations", "gradients"):
        view.hover(view.centres[1][3])
        play(view, canvas, 4)
    if not np.isfinite(bad):
        assert view.columns[1].damaged.any()
    view.set(network, np.full(9, bad))
    play(view, canvas, 8)


def test_without_a_fitting_observation_the_weights_are_drawn(canvas: Canvas) -> None:
    for observation in (None, np.ones(4), np.ones((3, 9)), np.zeros(0)):
        view = NetworkView(BOX, FEATURE_NAMES, ACTION_NAMES)
        view.set(network_of(), observation)
        play(view, canvas, 3)
        assert view.edges
        assert not any(column.damaged.any() for column in view.columns)


def test_nothing_is_drawn_of_no_network(canvas: Canvas) -> None:
    view = NetworkView(BOX)
    view.hover((900.0, 450.0))
    play(view, canvas, 3)
    view.set(NeuralNetwork(*CostFunctions.use_mse()), np.ones(3))
    play(view, canvas, 9)
    assert view.unit_at((900.0, 450.0)) is None


def test_a_network_of_another_size_takes_its_place_while_a_unit_is_looked_at(canvas: Canvas) -> None:
    view = view_of(network_of())
    view.hover(view.centres[2][11])
    play(view, canvas, 3)
    view.set(network_of(hidden=(3,)), OBSERVATION)
    play(view, canvas, 20)
    assert [column.total for column in view.columns] == [9, 3, 6]


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
