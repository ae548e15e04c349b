"""What each chapter claims and tells, on real runs of what it shows; its runs are short and need no process."""

import time
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any

import numpy as np
import pygame
import pytest

from ai.agent.agent import DeepQAgent
from ai.lander.environment import LanderEnv, Outcome
from ai.nn import SGD, Adam
from ai.pilots.folder import Measured, PilotFolder
from ai.training.config import Config
from ai.training.loop import Training
from ai.training.run import save
from ai.training.small_run import Flown as Flight
from game.core import texts
from game.core.assets import MODELS_DIR
from game.core.source import source_of
from game.drawing.canvas import Canvas
from game.explain.figures import decimal, percent
from game.flight.logbook import Records
from game.scenes.learn import downhill, pictures, plane
from game.scenes.learn import runs as runs_module
from game.scenes.learn.backwards import BackwardsChapter
from game.scenes.learn.chapter import Chapter
from game.scenes.learn.choice import MOMENTS, ChoiceChapter
from game.scenes.learn.downhill import DownhillChapter
from game.scenes.learn.list import done_with_own
from game.scenes.learn.memory import MemoryChapter
from game.scenes.learn.neuron import GOAL, HINT, NeuronChapter
from game.scenes.learn.path import PATH, chapter_type
from game.scenes.learn.pay import ASKED, DECISIONS, FLIGHTS, PAYS, Flown, PayChapter, config_of
from game.scenes.learn.plane import PlaneChapter
from game.scenes.learn.runs import DaringChapter, TargetChapter
from game.ui.context import Context
from game.world.camera import View
from tests.support import inline_worker
from tests.support.flights import landed

SECOND = 60
Made = Callable[[type[Chapter]], Any]


@pytest.fixture
def made(context: Context, monkeypatch: pytest.MonkeyPatch) -> Iterator[Made]:
    """Make a chapter, as its scene does."""
    inline_worker.install(monkeypatch.setattr)
    chapters: list[Chapter] = []

    def make(kind: type[Chapter]) -> Chapter:
        chapters.append(kind(context))
        return chapters[-1]

    yield make
    for chapter in chapters:
        chapter.close()


def test_every_chapter_has_its_texts_and_its_line_of_code_is_found(made: Made, subtests: pytest.Subtests):
    for key in PATH:
        with subtests.test(key):
            chapter = made(chapter_type(key))
            assert chapter.key == key
            assert set(chapter.words) == {"title", "question", "lead", "predict", "task", "why", "door"}
            assert sum(map(bool, texts.LEARN_ANSWERS[key])) >= 2
            assert len(chapter.words["why"]) < 350, "some four lines"
            assert chapter.verdict() is None, "nothing was tried"
            if code := chapter.code():
                source = source_of(code.function)
                assert source is not None
                assert source.line_of(code.line)


# One neuron steers


def flown_with(made: Made, weights: tuple[float, ...], seconds: float) -> tuple[NeuronChapter, float]:
    """Fly with these weights for so long; return the chapter, and the largest tilt after 4 seconds, in degrees."""
    chapter, tilts = made(NeuronChapter), []
    for number, weight in enumerate(weights):
        chapter.model.set(number, weight)
    for step in range(round(seconds * SECOND)):
        chapter.update()
        if step > 4 * SECOND:
            tilts.append(float(chapter.model.env.tilt[0]))
    return chapter, float(np.degrees(max(tilts)))


def test_the_hint_flies_and_bears_a_push(made: Made):
    chapter, tilt = flown_with(made, HINT, 15)
    model = chapter.model
    assert model.best[0] > 14
    assert tilt < 15
    model.push()
    for _ in range(10 * SECOND):
        chapter.update()
    assert model.best[0] > 24
    assert chapter.tried
    assert chapter.verdict() == 2
    assert "−4 for tilt" in chapter.why()
    values = (float(f"{value:.2f}") for value in model.sensed[0])
    written = decimal(sum(value * weight for value, weight in zip(values, HINT, strict=True)), 2, "+")
    assert f"The sum is {written}." in chapter._summed(), "what is written adds up"
    total = float((model.sensed[0] * model.layer.weights[:, 0]).sum() + model.layer.bias[0])
    assert model.output == pytest.approx(np.tanh(total), abs=1e-6)
    assert model.steer == (1 if model.output > 0.5 else 2 if model.output < -0.5 else 0)


@pytest.mark.parametrize(
    ("weights", "seconds", "stays"),
    [((-2.0, 0.0, 1.0), GOAL + 1, True), ((-4.0, -4.0, 2.0), GOAL + 1, True), ((-2.0, 0.0, 0.0), 40, False),
     ((-4.0, -4.0, 0.0), 40, False), ((0.0, 0.0, 0.0), 15, False), ((4.0, 4.0, -2.0), 8, False)],
)  # fmt: skip
def test_the_tilt_and_the_sideways_speed_are_what_it_must_sense(made: Made, weights, seconds: float, stays: bool):
    chapter, tilt = flown_with(made, weights, seconds)
    assert (chapter.model.best[0] > GOAL) == stays
    assert chapter.verdict() == (2 if stays else None)
    assert chapter.tried == any(weights)
    if weights[0] < 0 and not stays:  # without the speed each of the four first flights drifts away, upright
        assert chapter.model.end in ("", "drifted")
        assert tilt < 40


# What one line cannot do


def test_more_units_divide_more_of_the_plane(subtests: pytest.Subtests):
    for units, least, most in ((0, 0.5, 0.82), (2, 0.6, 0.94), (4, 0.88, 1.0), (8, 0.98, 1.0)):
        for seed in range(2):
            with subtests.test(units=units, seed=seed):
                points_, targets = plane.examples(0)
                network, optimizer = plane.network_of(units, seed), Adam(0.02)
                for _ in range(600):
                    network.train_batch(points_, targets, optimizer)
                said = network.predict(points_)
                assert least <= float(((said > 0) == (targets > 0)).mean()) <= most
                assert units or np.abs(said).max() < 0.4, "one neuron stays undecided"


def test_the_plane_shows_what_the_trained_network_answers(made: Made):
    chapter = made(PlaneChapter)
    chapter.update()
    assert not chapter.tried
    chapter.model.choose(len(plane.UNITS) - 1)
    for _ in range(plane.SPOKEN):
        chapter.update()
    assert chapter.tried
    assert chapter.verdict() is None, "fewer were not tried"
    assert chapter.model.results == {8: chapter.model.right}
    assert str(chapter.model.right) in chapter.why()
    # The fewest neurons that are enough are the answer.
    for right, answer in (({0: 60}, None), ({0: 78}, 0), ({0: 60, 2: 77}, 1), ({0: 60, 4: 80}, None),
                          ({0: 60, 2: 74, 4: 76}, 2), ({0: 60, 2: 74, 4: 75, 8: 80}, None)):  # fmt: skip
        chapter.model.results = right
        assert chapter.verdict() == answer


# Downhill


def test_steps_are_too_short_right_or_too_long_on_the_real_cost(made: Made):
    chapter = made(DownhillChapter)
    descent = chapter.model
    for rate, kind, answer in ((0.01, "short", None), (0.2, "right", None), (0.3, "long", 1)):
        descent.begin(rate)
        weight, slope = descent.trail[0], descent.slope
        higher, lower, here = descent.cost(np.array([weight + 1e-2, weight - 1e-2, weight]))
        assert here == pytest.approx(descent.costs[0]), "the curve is that of the network"
        assert slope == pytest.approx((higher - lower) / 2e-2, rel=1e-3)
        for _ in range(15 * (downhill.ENOUGH + 2)):
            chapter.update()
        assert descent.trail[1] == pytest.approx(weight - rate * slope, rel=1e-6)
        assert descent.results[kind]["last"] == descent.costs[-1]
        assert f"{rate:.3f}" in chapter.why()
        assert chapter.verdict() == answer, "once some were too short and some too long"
        if kind == "right":  # it overshoots, and is on the other side after every step
            sides = np.sign(np.array(descent.trail[:6]) - descent.trail[-1])
            assert (sides[1:] == -sides[:-1]).all()
    assert isinstance(descent.optimizer, SGD)


# Backwards


def test_the_blame_is_that_of_the_real_backward_pass(made: Made):
    chapter = made(BackwardsChapter)
    model = chapter.model
    network, image = model.network, model.classifier.shaped(model.image)
    target = np.eye(10, dtype=np.float32)[[model.label]]
    assert model.classifier.predict(model.image)[0].argmax() == model.read_as != model.label
    assert [blame.size for blame in model.blames] == [784, 100, 50, 10]
    cost = network.cost(network.forward_propagate(image), target)
    pixel = int(np.abs(model.blames[0]).argmax())
    nudged = image.copy()
    nudged[0, pixel] += 1e-2
    risen = network.cost(network.forward_propagate(nudged), target)
    assert (risen - cost) / 1e-2 == pytest.approx(float(model.blames[0][pixel]), rel=0.15)
    # An output's blame is the slope of its bias before the last activation has bent it.
    bias = network.layers[-2].parameters[1].gradient
    assert bias == pytest.approx(model.blames[3] * (1 - model.answers**2), abs=1e-5)
    assert not model.blames[0][image[0] == 0].any(), "a pixel without ink is not to blame"
    assert all(image[0, start] > 0 and slope != 0 for start, _, slope in model.links[0]), "nor is its connection"


def test_a_step_makes_the_right_answer_likelier_and_moves_about_one_weight_in_five(made: Made):
    chapter = made(BackwardsChapter)
    model = chapter.model
    for _ in range(6):
        before = float(model.odds[model.label])
        for _ in range(4):
            chapter.go_on()
        assert (model.steps, chapter.verdict()) == (0, None)
        chapter.go_on()
        assert model.steps == 1
        assert model.odds[model.label] > before
        assert 0.1 < model.moved / model.network.values.size < 0.3
        assert chapter.verdict() == 1
        without_ink = model.classifier.shaped(model.image)[0] == 0
        first, shipped = (each.layers[0].weights for each in (model.network, model._shipped.network))
        assert (first[without_ink] == shipped[without_ink]).all()
        assert f"{model.moved:,}" in chapter.why()
        chapter.another()


# What is it paid for


def trained(chapter: Any, pay: str) -> Flown:
    chapter.choose(list(PAYS).index(pay))
    chapter.train()
    assert chapter.learning
    while pay not in chapter.results:
        chapter.update()
        assert not chapter.note
    flown: Flown = chapter.results[pay]
    return flown


@pytest.mark.slow
def test_each_pay_teaches_what_it_pays_for(made: Made, monkeypatch: pytest.MonkeyPatch):
    chapter = made(PayChapter)
    landing = trained(chapter, "landing")
    monkeypatch.setattr("game.scenes.learn.pay.DECISIONS", 8_000)  # it does not take long to learn to fall
    haste = trained(chapter, "haste")
    assert landing["landed"] > 0.5 * FLIGHTS
    assert haste["crashed"] > 0.6 * FLIGHTS
    assert haste["time"] < landing["time"]
    assert chapter.tried
    assert {str(landing["landed"]), str(haste["crashed"])} <= set(chapter.why().split())
    assert chapter.verdict() is None, "the question was about another pay"
    for answer, kind in enumerate(("landed", "late", "crashed")):
        chapter.results[ASKED] = {**landing, **dict.fromkeys(("landed", "late", "gone", "crashed"), 1), kind: 9}
        assert chapter.verdict() == answer


def test_the_flights_after_a_run_are_those_of_its_network(made: Made, monkeypatch: pytest.MonkeyPatch):
    assert all(config_of(pay).schedule_decisions == DECISIONS for pay in PAYS.values())
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
    assert (env.actions == expected).all()
    assert (env.outcome == Outcome.FLYING).all()


def broken(*_: object, **__: object) -> Iterator[tuple[()]]:
    yield ()
    raise FloatingPointError("it diverged")


def test_a_run_that_fails_is_reported(made: Made, monkeypatch: pytest.MonkeyPatch):
    chapter = made(PayChapter)
    monkeypatch.setattr("game.scenes.learn.pay.LanderSession.live", broken)
    chapter.train()
    for _ in range(3):
        chapter.update()
    assert not chapter.learning
    assert "it diverged" in chapter.note
    duel = made(TargetChapter)
    monkeypatch.setattr(runs_module, "small_runs", broken)
    duel.start()
    duel.update()
    assert "it diverged" in duel._status()
    assert not duel.tried


# Six values, and what came


def flown_to_its_end(action: int | None, number: int) -> tuple[Any, list[float], bool]:
    """Fly on from a moment, from an action if one is given; return the decision there, all pay, and if it landed."""
    agent, (seed, spawn, decisions) = DeepQAgent.load(MODELS_DIR / "lander" / "modern"), MOMENTS[number]
    env = LanderEnv(1, seed, spawn, frame_skip=4, weights=Config.of(agent).reward_weights)
    observation, pays, taken = env.reset(), list[float](), 0
    while env.outcome[0] == Outcome.FLYING:
        decided = agent.decide(observation, held=env.actions)
        if taken == decisions:
            first = decided
        result = env.step(decided.action if action is None or taken != decisions else np.array([action]))
        observation = result.observation
        if taken >= decisions:
            pays.append(float(result.reward[0]))
        taken += 1
    return first, pays, bool(env.outcome[0] == Outcome.LANDED)


def fly(chapter: ChoiceChapter) -> None:
    assert chapter.model.running
    while not chapter.model.over:
        chapter.update()
    assert not chapter.model.running


def test_six_values_and_what_comes_of_each_are_the_networks_own(made: Made):
    chapter = made(ChoiceChapter)
    for number in range(2):
        for action in (chapter.model.best, chapter.model.worst):
            chapter.begin_with(action)
            fly(chapter)
            first, pays, safely = flown_to_its_end(action, number)
            np.testing.assert_allclose(chapter.model.values, first.points[0], rtol=1e-5)
            came = sum(chapter.model.agent.config.discount**late * pay for late, pay in enumerate(pays))
            # The chapter adds the pay of each physics step, the other that of each decision of four.
            assert chapter.model.results[action].points == pytest.approx(came, abs=0.5)
            assert chapter.model.results[action].landed == safely
            assert [bool(line.cells[2]) for line in chapter._lines()].count(True) == len(chapter.model.results)
        if number < 1:
            chapter.turn()
    best, worst = chapter.model.results[chapter.model.best], chapter.model.results[chapter.model.worst]
    assert best.landed
    assert chapter.verdict() == (0 if not worst.landed else 1 if best.points - worst.points <= 5 else 2)
    assert chapter.tried
    chapter.turn()
    assert chapter.verdict() is None


# Runs side by side


def run(chapter: Any, choice: int) -> None:
    """Let the runs learn to their end."""
    chapter.choose(choice)
    chapter.start()
    while not chapter.over:
        assert chapter.running
        chapter.update()
    assert chapter.tried
    assert not chapter.running
    assert [states[0].decisions for states in chapter.states] == list(range(chapter.LENGTH + 1))


@pytest.mark.parametrize("kind", [TargetChapter, DaringChapter])
def test_two_agents_learn_and_a_guess_gets_its_verdict_from_this_very_run(
    made: Made, monkeypatch: pytest.MonkeyPatch, kind: Any
):
    monkeypatch.setattr(kind, "LENGTH", 40)
    chapter = made(kind)
    chapter.update()
    assert not chapter.states
    run(chapter, 1)
    assert chapter.verdict() is None, "the question was about another choice"
    run(chapter, 0)
    left, right = (state.landed or 0.0 for state in chapter.states[-1])
    assert {percent(left), percent(right)} <= set(_percents(chapter.why()))
    if kind is TargetChapter:
        assert f"first {kind.LENGTH} decisions" in chapter.why(), "of which moment its figures are"
        assert (chapter.verdict() == 2) is (chapter.peaks[1] > 300.0)
        monkeypatch.setattr(TargetChapter, "peaks", (0.0, 400.0))
        run(chapter, 0)
        assert chapter.verdict() == 2
    else:
        came = {(True, True): 2, (True, False): 0, (False, True): 1}.get((left >= 0.5, right >= 0.5), 3)
        assert chapter.verdict() == came
    assert chapter.judged == chapter.names()[1], "whatever is tried next"
    chapter.start()
    assert chapter.verdict() is None, "the new run of the question has shown nothing yet"


def _percents(sentence: str) -> list[str]:
    words = sentence.split()
    return [f"{figure} %" for figure, sign in pairwise(words) if sign.startswith("%")]


def test_both_memories_are_compared_once_both_were_tried(made: Made, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(MemoryChapter, "LENGTH", 40)
    monkeypatch.setattr("game.scenes.learn.memory.YESTERDAY", 20)
    monkeypatch.setattr(MemoryChapter, "PLAN", MemoryChapter.PLAN._replace(change=20))
    chapter = made(MemoryChapter)
    run(chapter, 0)
    assert chapter.verdict() is None
    run(chapter, 1)
    lost = [before - after for before, after in (chapter.results[choice] for choice in range(2))]
    assert chapter.verdict() == (int(np.argmax(lost)) if max(lost) >= 0.25 else 2)
    assert all(name in chapter.why() for name in texts.LEARN_MEMORY_NAMES)
    assert chapter.states[-1][0].memory.oldest > 0, "the last one kept the latest only"


# Your own


def test_what_was_done_with_ones_own_is_ticked_and_nothing_before(context: Context):
    def done() -> set[str]:
        return {name for name, ticked in done_with_own(context).items() if ticked}

    assert done() == set()
    training = Training(Config(num_envs=4, learning_starts=8, batch_size=8), validation_episodes=2, evaluate_every=0)
    training.advance()
    save(training, context.user_dir / "models" / "mine", state=False)
    assert done() == {"train"}
    records = Records(context.user_dir)
    records.keep(landed(), time.time(), network="modern")
    assert done() == {"train"}, "another network flew"
    records.keep(landed(), time.time(), network="mine")
    assert done() == {"train", "hand"}
    own_pilots = PilotFolder(context.user_dir)
    own_pilots.keep(Measured("fall", 0.5))
    assert done() == {"train", "hand"}, "it lands too seldom"
    own_pilots.keep(Measured("land", 0.95))
    assert done() == {"train", "hand", "file"}


# Pictures


def test_no_lander_is_cut_at_the_upper_edge(monkeypatch: pytest.MonkeyPatch):
    drawn: list[np.ndarray] = []
    monkeypatch.setattr(pictures, "draw_crowd", lambda _, __, poses, ___: drawn.append(poses))
    canvas, box = Canvas(pygame.Surface((1280, 720))), pygame.FRect(400, 100, 500, 120)
    heights = np.arange(0.0, 30.0, 0.5)
    flown = Flight(heights, np.zeros(60), np.zeros(60, bool), np.zeros(60, np.intp))
    runs_module.draw_side_by_side(canvas, box, flown, 0, count=60)
    poses = np.stack([np.zeros(60), heights, np.zeros(60)], axis=1)
    view = View.within(box, canvas.scale, (0.0, 5.0), box.width / 40.0)
    pictures.draw_landers(canvas, box, view, poses, np.zeros(60, bool), 0)
    assert len(drawn[0]) > 20
    assert 10 < len(drawn[1]) < 60
    assert view.points([(0.0, drawn[1][:, 1].max() + pictures.HEAD)])[0, 1] >= box.top
