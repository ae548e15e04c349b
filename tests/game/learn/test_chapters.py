"""What each chapter claims, on real runs of what it shows."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from ai.lander.environment import Outcome
from ai.nn import SGD
from ai.nn.optimizers import Adam
from game.core import texts
from game.core.source import source_of
from game.scenes.learn import downhill, plane
from game.scenes.learn.backwards import BackwardsChapter
from game.scenes.learn.chapter import Chapter
from game.scenes.learn.downhill import DownhillChapter
from game.scenes.learn.neuron import GOAL, HINT, NeuronChapter
from game.scenes.learn.path import PATH, chapter_type
from game.scenes.learn.pay import ASKED, DECISIONS, FLIGHTS, PAYS, Flown, PayChapter, config_of
from game.scenes.learn.plane import PlaneChapter
from game.scenes.learn.scene import placed
from game.ui.context import Context
from game.ui.form import Form
from game.ui.panel import Column
from tests.support import inline_worker

SECOND = 60
Made = Callable[[type[Chapter]], Any]


@pytest.fixture
def made(context: Context) -> Made:
    """Make a chapter, as its scene does."""
    return lambda kind: kind(context)


@pytest.mark.parametrize("key", PATH)
def test_every_chapter_has_its_texts_and_every_part_of_its_code_is_found(made: Made, key: str):
    chapter = made(chapter_type(key))
    assert chapter.key == key
    assert set(chapter.words) >= {"title", "question", "lead", "predict", "task", "why", "code", "door"}
    assert sum(map(bool, texts.LEARN_ANSWERS[key])) >= 2
    for code in chapter.code():
        source = source_of(code.function)
        assert source is not None
        current, notes = placed(source, code)
        assert (current is not None) is bool(code.current)
        assert len(notes) == len(code.notes)
    chapter.close()


# One neuron steers


def flown_with(chapter: NeuronChapter, weights: tuple[float, ...], seconds: float) -> tuple[float, float]:
    """Fly with these weights; return the longest time in sight without a fall, and the largest tilt after 4 seconds."""
    chapter.restart()
    for number, weight in enumerate(weights):
        chapter.set(number, weight)
    tilts = []
    for step in range(round(seconds * SECOND)):
        chapter.update()
        if step > 4 * SECOND:
            tilts.append(float(chapter.env.tilt[0]))
    return chapter.best[0], max(tilts)


def test_the_weights_of_the_hint_fly_upright_and_in_sight_and_bear_a_push(made: Made):
    chapter = made(NeuronChapter)
    best, tilt = flown_with(chapter, HINT, 15)
    assert best > 14
    assert np.degrees(tilt) < 15
    chapter.push()
    for _ in range(10 * SECOND):
        chapter.update()
    assert chapter.best[0] > 24
    assert chapter.tried
    assert "-4.0" in chapter.why()


@pytest.mark.parametrize("weights", [(-4.0, 0.0, 2.0), (-2.0, 0.0, 1.0), (-6.0, 0.0, 4.0), (-4.0, -4.0, 2.0)])
def test_the_tilt_and_the_sideways_speed_reach_the_goal(made: Made, weights: tuple[float, ...]):
    best, _ = flown_with(made(NeuronChapter), weights, GOAL + 1)
    assert best > GOAL


@pytest.mark.parametrize("weights", [(-2.0, 0.0, 0.0), (-4.0, 0.0, 0.0), (-6.0, 0.0, 0.0), (-4.0, -4.0, 0.0)])
def test_without_the_sideways_speed_every_flight_drifts_out_of_sight(made: Made, weights: tuple[float, ...]):
    chapter = made(NeuronChapter)
    best, tilt = flown_with(chapter, weights, 40)  # each of the four first flights
    assert best < GOAL
    assert chapter.end in ("", "drifted")
    assert np.degrees(tilt) < 40


def test_without_weights_it_drifts_and_with_the_signs_turned_it_falls(made: Made):
    chapter = made(NeuronChapter)
    assert flown_with(chapter, (0.0, 0.0, 0.0), 15)[0] < GOAL
    assert not chapter.tried
    best, _ = flown_with(chapter, (4.0, 4.0, -2.0), 8)
    assert best < 4
    chapter.restart()
    chapter.set(0, 4.0)
    for _ in range(4 * SECOND):
        chapter.update()
        if chapter.end:
            break
    assert chapter.end == "fell"


def test_the_sum_that_is_shown_is_the_layers_own(made: Made):
    chapter = made(NeuronChapter)
    chapter.hint()
    for _ in range(30):
        chapter.update()
    total = float((chapter.sensed[0] * chapter.layer.weights[:, 0]).sum() + chapter.layer.bias[0])
    assert chapter.output == pytest.approx(np.tanh(total), abs=1e-6)
    assert chapter.steer == (1 if chapter.output > 0.5 else 2 if chapter.output < -0.5 else 0)


# What one line cannot do


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("units", "least", "most"), [(0, 0.5, 0.82), (2, 0.6, 0.94), (4, 0.88, 1.0), (8, 0.98, 1.0)])
def test_more_units_divide_more_of_the_plane(units: int, least: float, most: float, seed: int):
    points, targets = plane.examples(0)
    network, optimizer = plane.network_of(units, seed), Adam(0.02)
    for _ in range(600):
        network.train_batch(points, targets, optimizer)
    right = float(((network.predict(points) > 0) == (targets > 0)).mean())
    assert least <= right <= most


def test_a_neuron_without_a_middle_layer_stays_undecided():
    points, targets = plane.examples(0)
    network, optimizer = plane.network_of(0, 0), Adam(0.02)
    for _ in range(plane.STEPS):
        network.train_batch(points, targets, optimizer)
    assert np.abs(network.predict(points)).max() < 0.2


def test_the_plane_shows_what_the_trained_network_answers(made: Made):
    chapter = made(PlaneChapter)
    chapter.update()
    assert not chapter.tried
    chapter.choose(len(plane.UNITS) - 1)
    for _ in range(plane.SPOKEN):
        chapter.update()
    assert chapter.tried
    assert chapter.results == {8: chapter.right}
    assert str(chapter.right) in chapter.why()
    chapter.restart()
    assert not chapter.tried
    assert chapter.units == 0


# Downhill


@pytest.mark.parametrize(
    ("rate", "kind"), [(0.005, "short"), (0.01, "short"), (0.1, "right"), (0.2, "right"), (0.3, "long")]
)
def test_steps_are_too_short_right_or_too_long(made: Made, rate: float, kind: str):
    chapter = made(DownhillChapter)
    chapter.set_rate(rate)
    for _ in range(15 * (downhill.ENOUGH + 2)):
        chapter.update()
    assert list(chapter.results) == [kind]
    figures = chapter.results[kind]
    assert figures["rate"] == rate
    assert f"{rate:.3f}" in chapter.why()
    costs = chapter.line.costs
    assert figures["last"] == costs[-1]
    if rate == 0.2:  # it overshoots, and is on the other side after every step
        sides = np.sign(np.array(chapter.line.trail[:6])[:, 0] - chapter.line.trail[-1][0])
        assert (sides[1:] == -sides[:-1]).all()


def test_the_ball_stands_on_the_real_cost_and_steps_by_the_real_gradient(made: Made):
    descent = made(DownhillChapter).line
    weight, slope = descent.trail[0][0], float(descent.slopes[0])
    higher, lower = descent.cost((weight + 1e-2,)), descent.cost((weight - 1e-2,))
    assert slope == pytest.approx((higher - lower) / 2e-2, rel=1e-3)
    assert descent.costs[0] == pytest.approx(descent.cost((weight,)))
    descent.step()
    assert descent.trail[1][0] == pytest.approx(weight - descent.optimizer.learning_rate * slope, rel=1e-6)
    assert isinstance(descent.optimizer, SGD)


@pytest.mark.parametrize("rate", [0.01, 0.1, 0.25])
def test_in_the_valley_adam_gets_further_than_plain_steps_of_any_length(made: Made, rate: float):
    chapter = made(DownhillChapter)
    chapter.choose(1)
    chapter.set_rate(rate)
    for _ in range(6 * (downhill.VALLEY_STEPS + 2)):
        chapter.update()
    assert chapter.adam.costs[-1] < 0.2 * chapter.plain.costs[-1]
    assert "valley" in chapter.results


def test_steps_that_are_far_too_long_are_lost_and_the_chapter_goes_on(made: Made):
    chapter = made(DownhillChapter)
    chapter.choose(1)
    chapter.set_rate(0.5)
    for _ in range(6 * (downhill.VALLEY_STEPS + 2)):
        chapter.update()
    assert chapter.plain.lost
    assert "lost" in chapter.results
    assert chapter.why()


# Backwards


def test_the_blame_is_that_of_the_real_backward_pass(made: Made):
    chapter = made(BackwardsChapter)
    network, image = chapter.network, chapter.classifier.shaped(chapter._image)
    target = np.eye(10, dtype=np.float32)[[chapter.label]]
    assert chapter.classifier.predict(chapter._image)[0].argmax() == chapter.read_as != chapter.label
    assert [blame.size for blame in chapter.blames] == [784, 100, 50, 10]
    cost = network.cost(network.forward_propagate(image), target)
    pixel = int(np.abs(chapter.blames[0]).argmax())
    nudged = image.copy()
    nudged[0, pixel] += 1e-2
    risen = network.cost(network.forward_propagate(nudged), target)
    assert (risen - cost) / 1e-2 == pytest.approx(float(chapter.blames[0][pixel]), rel=0.15)
    # An output's blame is the slope of its bias before the last activation has bent it.
    bias = network.layers[-2].parameters[1].gradient
    assert bias == pytest.approx(chapter.blames[3] * (1 - chapter.answers**2), abs=1e-5)


def test_a_step_makes_the_right_answer_likelier_and_moves_about_one_weight_in_five(made: Made):
    chapter = made(BackwardsChapter)
    for _ in range(6):
        before = float(chapter.odds[chapter.label])
        for _ in range(4):
            chapter.go_on()
        assert chapter.steps == 0
        assert not np.any(chapter.network.values != chapter._shipped.network.values)
        chapter.go_on()
        assert chapter.steps == 1
        assert chapter.odds[chapter.label] > before
        assert 0.1 < chapter.moved / chapter.network.values.size < 0.3
        without_ink = chapter.classifier.shaped(chapter._image)[0] == 0
        first, shipped = chapter.network.layers[0].weights, chapter._shipped.network.layers[0].weights
        assert (first[without_ink] == shipped[without_ink]).all()
        assert f"{chapter.moved:,}" in chapter.why()
        chapter.another()


def test_a_unit_tells_its_blame_once_it_has_come_so_far(made: Made):
    chapter = made(BackwardsChapter)
    silent = chapter.unit(1, 3)
    for _ in range(3):
        chapter.go_on()
    assert chapter.unit(1, 3) != silent
    blame = float(chapter.blames[1][3])
    assert f"{abs(blame):.3f}" in chapter.unit(1, 3)


@pytest.mark.parametrize("missing", ["models_dir", "assets_dir"])
def test_without_a_network_or_images_the_chapter_says_so(context: Context, missing: str, tmp_path):
    setattr(context, missing, tmp_path)
    chapter, column = BackwardsChapter(context), Column(Form(context))
    chapter.controls(column)
    assert chapter.problem
    assert not column.rows
    assert chapter.code()
    chapter.restart()


# What is it paid for


def trained(chapter: Any, pay: str) -> Flown:
    chapter.choose(list(PAYS).index(pay))
    chapter.train()
    assert chapter.learning
    while pay not in chapter.results:
        chapter.update()
        assert not chapter.note
    return chapter.results[pay]


@pytest.mark.slow
def test_each_pay_teaches_what_it_pays_for(made: Made, monkeypatch: pytest.MonkeyPatch):
    inline_worker.install(monkeypatch.setattr)
    chapter = made(PayChapter)
    landing = trained(chapter, "landing")
    monkeypatch.setattr("game.scenes.learn.pay.DECISIONS", 8_000)  # it does not take long to learn to fall
    haste = trained(chapter, "haste")
    assert landing.landed > 0.5 * FLIGHTS
    assert haste.crashed > 0.6 * FLIGHTS
    assert haste.time < landing.time
    assert chapter.tried
    told = chapter.why()
    assert str(landing.landed) in told
    assert str(haste.crashed) in told
    chapter.close()
    assert not chapter.running


def test_the_flights_after_a_run_are_those_of_its_network(made: Made, monkeypatch: pytest.MonkeyPatch):
    inline_worker.install(monkeypatch.setattr)
    monkeypatch.setattr("game.scenes.learn.pay.DECISIONS", 64 * 40)
    chapter = made(PayChapter)
    chapter.train()
    while chapter.trial is None:
        chapter.update()
    agent, env = chapter.trial.agent, chapter.trial.env
    assert agent.decisions >= 64 * 40
    assert agent.config == config_of(PAYS[ASKED])
    expected = agent.act(env.observe(), held=np.zeros(FLIGHTS, np.intp))
    chapter.trial.step()
    assert (chapter.trial.env.actions == expected).all()
    assert (env.outcome == Outcome.FLYING).all()
    chapter.close()


def test_a_run_that_fails_is_told_and_another_can_begin(made: Made, monkeypatch: pytest.MonkeyPatch):
    inline_worker.install(monkeypatch.setattr)
    chapter = made(PayChapter)

    monkeypatch.setattr("game.scenes.learn.pay.live", _failing)
    chapter.train()
    for _ in range(3):
        chapter.update()
    assert not chapter.running
    assert "it diverged" in chapter.note


def _failing(*_: object) -> object:
    yield ()
    raise FloatingPointError("it diverged")


def test_the_length_of_a_run_is_its_schedule():
    assert all(config_of(pay).schedule_decisions == DECISIONS for pay in PAYS.values())
