"""Chapters 6 to 10: what they show is what was computed, and what they tell is true of the player's own try."""

import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from ai.agent.agent import DeepQAgent
from ai.lander.environment import LanderEnv, Outcome
from ai.training.config import Config
from ai.training.loop import Training
from ai.training.run import save
from game.core import texts
from game.core.assets import MODELS_DIR
from game.core.scene import Push
from game.flight.logbook import Records
from game.panels.figures import percent, points
from game.scenes.learn import runs as runs_module
from game.scenes.learn.chapter import Chapter
from game.scenes.learn.duels import DaringChapter, TargetChapter
from game.scenes.learn.memory import KINDS, MemoryChapter
from game.scenes.learn.moment import MOMENTS, ChoiceChapter, MomentChapter
from game.scenes.learn.own import OwnChapter
from game.scenes.learn.runs import RunsChapter
from game.ui.context import Context
from game.ui.form import Form
from game.ui.panel import Column
from tests.support.flights import landed
from tests.support.inline_worker import InlineWorker

Made = Callable[[type[Chapter]], Any]


@pytest.fixture
def made(context: Context, monkeypatch: pytest.MonkeyPatch) -> Iterator[Made]:
    """Make a chapter, as its scene does; its runs are short and need no process."""
    monkeypatch.setattr(runs_module, "Worker", InlineWorker)
    chapters: list[Chapter] = []

    def make(kind: type[Chapter]) -> Chapter:
        chapters.append(kind(context))
        return chapters[-1]

    yield make
    for chapter in chapters:
        chapter.close()


# The value of a moment


def test_the_value_is_the_networks_own_and_what_comes_is_the_discounted_pay(made: Made):
    chapter = made(MomentChapter)
    agent = DeepQAgent.load(MODELS_DIR / "lander" / "modern")
    for number, (seed, spawn, decisions) in enumerate(MOMENTS[:3]):
        chapter.set_guess(40.0)
        chapter.go()
        while not chapter.over:
            chapter.update()
        env = LanderEnv(1, seed, spawn, frame_skip=4, weights=Config.of(agent).reward_weights)
        observation, pays = env.reset(), []
        while env.outcome[0] == Outcome.FLYING:
            decided = agent.decide(observation, held=env.actions)
            if len(pays) == decisions:
                value = float(decided.points.max())
            result = env.step(decided.action)
            observation = result.observation
            pays.append(float(result.reward[0]))
        pays = pays[decisions:]
        came = sum(pay * agent.config.discount**late for late, pay in enumerate(pays))
        judged = chapter.judged[number]
        assert judged.value == pytest.approx(value, abs=1e-3)
        assert judged.plain == pytest.approx(sum(pays), abs=1e-2)
        # The chapter adds the pay of each physics step, the loop above that of each decision of four.
        assert judged.came == pytest.approx(came, abs=0.05)
        assert judged.decisions == len(pays)
        assert chapter.tried
        agrees = 2 if number == 0 else None  # about 20 points; the other flights are shorter
        assert chapter.verdict() == agrees
        chapter.turn()
        assert points(judged.value, 1) in str([code.notes for code in chapter.code()]), "the moment that was judged"
    assert "3 moments" in chapter.why()


def test_the_network_judges_moments_better_than_a_guess_of_the_whole_score(made: Made):
    chapter = made(MomentChapter)
    for _ in MOMENTS:
        chapter.go()
        while not chapter.over:
            chapter.update()
        chapter.turn()
    missed = [abs(each.value - each.came) for each in chapter.judged]
    assert np.mean(missed) < 12
    assert np.mean([abs(each.plain - each.came) for each in chapter.judged]) > 40
    # The answer to the chapter's question: the start of a good flight is worth some 20 points.
    assert 10 < chapter.judged[0].came < 45


def test_a_missing_network_is_said_and_the_chapter_stays_usable(context: Context, tmp_path):
    context.models_dir = tmp_path
    chapter, column = MomentChapter(context), Column(Form(context))
    chapter.controls(column)
    assert chapter.problem
    assert not column.rows
    chapter.update()
    chapter.restart()
    assert len(chapter.code()) == 3


# Runs side by side


@pytest.mark.parametrize("kind", [TargetChapter, MemoryChapter, DaringChapter])
def test_a_run_learns_to_its_end_and_tells_its_own_numbers(made: Made, kind, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(kind, "LENGTH", 90)
    if kind is MemoryChapter:
        monkeypatch.setattr("game.scenes.learn.memory.YESTERDAY", 45)
        monkeypatch.setattr(kind, "PLAN", kind.PLAN._replace(change=45))
    chapter = made(kind)
    assert isinstance(chapter, RunsChapter)
    chapter.update()
    assert not chapter.states
    chapter.start()
    for _ in range(100):
        chapter.update()
    assert chapter.over
    assert chapter.tried
    assert not chapter.running
    assert [states[0].decisions for states in chapter.states] == list(range(91))
    told = chapter.why()
    assert "{" not in told
    last = chapter.states[-1]
    if kind is not MemoryChapter:
        assert percent(last[0].landed) in told
        assert percent(last[1].landed) in told
    chapter.restart()
    assert not chapter.states
    assert not chapter.tried


@pytest.mark.parametrize("kind", [TargetChapter, DaringChapter])
def test_a_guess_gets_its_verdict_from_this_very_run(made: Made, kind, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(kind, "LENGTH", 150)
    chapter = made(kind)
    asked, other = (0, 2) if kind is TargetChapter else (1, 2)
    for choice in (other, asked):
        chapter.choose(choice)
        chapter.start()
        while not chapter.over:
            chapter.update()
        came, (left, right) = chapter.verdict(), (state.landed or 0.0 for state in chapter.states[-1])
        if choice == other:
            assert came is None, "the question was about another choice"
        elif kind is TargetChapter:
            ran = max(chapter.peaks[1:]) > 300.0
            assert came == (2 if ran else 0 if right > left + 0.2 else 1 if right >= left - 0.2 else None)
            assert ran, "it does on most processors"
        else:
            assert came == {(True, True): 2, (True, False): 0, (False, True): 1}.get((left >= 0.5, right >= 0.5), 3)


def test_each_memory_that_was_tried_is_compared(made: Made, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(MemoryChapter, "LENGTH", 60)
    monkeypatch.setattr("game.scenes.learn.memory.YESTERDAY", 30)
    monkeypatch.setattr(MemoryChapter, "PLAN", MemoryChapter.PLAN._replace(change=30))
    chapter = made(MemoryChapter)
    for number in range(len(KINDS)):
        chapter.choose(number)
        chapter.start()
        for _ in range(70):
            chapter.update()
        assert chapter.light.max() == 1.0  # something was drawn with the last decision
        assert (chapter.verdict() is None) == (number < len(KINDS) - 1), "the question is about all three"
    assert set(chapter.results) == set(KINDS)
    lost = [before - after for before, after in (chapter.results[kind] for kind in KINDS)]
    assert chapter.verdict() == (int(np.argmax(lost)) if max(lost) >= 0.25 else 3)
    assert all(name in chapter.why() for name in texts.LEARN_MEMORY_NAMES)
    assert chapter.states[-1][0].memory.oldest > 0  # the last one kept the latest only


def test_a_worker_that_fails_is_said(made: Made, monkeypatch: pytest.MonkeyPatch):
    chapter = made(TargetChapter)
    monkeypatch.setattr(runs_module, "small_runs", _broken)
    chapter.start()
    chapter.update()
    assert "broken on purpose" in chapter.problem
    assert not chapter.tried


def _broken(*_: object) -> Iterator[tuple[()]]:
    yield ()
    raise ValueError("broken on purpose")


# Your own


def look(chapter: OwnChapter) -> set[str]:
    """Return the names of the steps that are done."""
    for _ in range(60):
        chapter.update()
    return {name for name, step in chapter.steps.items() if step.done}


def test_the_list_ticks_what_was_really_done_and_nothing_before(made: Made, context: Context):
    chapter = made(OwnChapter)
    assert isinstance(chapter, OwnChapter)
    assert look(chapter) == set()
    assert chapter.race() is None  # there is none to race yet
    training = Training(Config(num_envs=4, learning_starts=8, batch_size=8), validation_episodes=2, evaluate_every=0)
    training.advance()
    save(training, context.user_dir / "models" / "mine", state=False)
    assert look(chapter) == {"train"}
    assert "mine" in chapter.why()
    context.settings.model = "mine"
    assert look(chapter) == {"train", "choose"}
    records = Records(context.user_dir)
    records.keep(landed(), time.time(), network="modern")
    assert look(chapter) == {"train", "choose"}  # another network flew
    records.keep(landed(), time.time(), network="mine")
    assert "hand" in look(chapter)
    assert "race" not in look(chapter)
    pushed = chapter.race()
    assert isinstance(pushed, Push)
    assert "race" not in look(chapter)  # opened, and not flown yet
    records.keep(landed(), time.time() + 5, network="mine")
    assert "race" in look(chapter)


# Six values


def test_six_values_and_what_comes_of_each_are_the_networks_own(made: Made):
    chapter = made(ChoiceChapter)
    agent = DeepQAgent.load(MODELS_DIR / "lander" / "modern")
    seed, spawn, decisions = MOMENTS[0]
    assert decisions == 0
    for action in (chapter.best, chapter.worst):
        chapter.begin_with(action)
        while not chapter.over:
            chapter.update()
        env = LanderEnv(1, seed, spawn, frame_skip=4, weights=Config.of(agent).reward_weights)
        decided = agent.decide(env.reset(), held=env.actions)
        assert decided.points is not None
        np.testing.assert_allclose(chapter.values, decided.points[0], rtol=1e-5)
        flown, pays = np.array([action]), []
        while env.outcome[0] == Outcome.FLYING:
            result = env.step(flown)
            pays.append(float(result.reward[0]))
            flown = agent.decide(result.observation, held=env.actions).action
        came = sum(agent.config.discount**number * pay for number, pay in enumerate(pays))
        assert chapter.results[action].came == pytest.approx(came, abs=0.5)
        assert chapter.results[action].landed == (env.outcome[0] == Outcome.LANDED)
    best, worst = chapter.results[chapter.best], chapter.results[chapter.worst]
    assert best.landed
    assert (texts.LEARN_CHOICE_SURPRISE in chapter.why()) == (best.came < worst.came)
    chapter.results[chapter.worst] = worst._replace(came=best.came + 1.0)
    assert texts.LEARN_CHOICE_SURPRISE in chapter.why()
    chapter.results[chapter.worst] = worst
    expected = 0 if not worst.landed else 1 if best.came - worst.came <= 5 else 2
    assert chapter.verdict() == expected
    assert chapter.tried
    chapter.turn()
    assert chapter.verdict() is None
