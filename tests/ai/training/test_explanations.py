"""Explanations of a live run: the memory is the one that the run stores, and the run goes on as if nobody had asked."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from ai.explain.agent_lesson import Lesson
from ai.lander.environment import Outcome
from ai.training import lander_session
from ai.training.config import PRESETS
from ai.training.lander_session import LanderSession
from ai.training.messages import FirstLanding, NetworkState, Refused

CONFIG = replace(PRESETS["modern"], num_envs=6, batch_size=16, gradient_steps=1, learning_starts=48, n_step=4,
                 hidden=(16,), replay_size=5000, spawn="near")  # fmt: skip


def run(config=CONFIG, **options):
    ticks = iter(range(10**9))
    return LanderSession.live(config, 7, clock=lambda: next(ticks) / 100, **options)


def ask(session, slot):
    (answer,) = session.send(("explain", slot))
    return answer


def test_the_memory_lies_in_the_replay_buffer():
    session = run()
    for _ in range(120):
        next(session)
    replay = session.training.agent.replay
    for slot in range(6):
        lesson = ask(session, slot)
        assert isinstance(lesson, Lesson)
        cells = replay.at(np.arange(len(replay)))
        same = (cells.state == lesson.cell.state).all(axis=1) & (cells.steps == lesson.cell.steps)
        (row,) = np.flatnonzero(same)
        for kept, own in zip(cells, lesson.cell, strict=True):
            np.testing.assert_array_equal(kept[row], own)
        flown = lesson.flown
        assert flown.slot == slot
        assert len(flown.actions) == len(flown.rewards) == lesson.cell.steps
        np.testing.assert_array_equal(flown.observations[0], lesson.cell.state)
        np.testing.assert_array_equal(flown.observations[-1], lesson.cell.next_state)
        assert flown.actions[0] == lesson.cell.action
        np.testing.assert_allclose(sum(flown.parts.values()), flown.rewards, rtol=1e-5, atol=1e-5)
        scale = CONFIG.reward_scale * CONFIG.discount ** np.arange(len(flown.rewards))
        assert lesson.cell.reward == pytest.approx(float((scale * flown.rewards).sum()), rel=1e-4, abs=1e-6)
        assert bool(flown.outcome) >= bool(lesson.cell.terminal)


def test_the_first_landing_to_learn_from_is_told_once_with_its_lesson(monkeypatch):
    # So small a run lands too seldom: what it does when it crashes stands for a landing.
    monkeypatch.setattr(lander_session, "Outcome", SimpleNamespace(LANDED=Outcome.CRASHED))
    session = run()
    told = [each for _ in range(240) for each in next(session) if isinstance(each, FirstLanding)]
    (landing,) = told
    assert landing.lesson.flown.outcome == Outcome.CRASHED
    resumed = type(session)(session.training, None, None)
    assert not [each for _ in range(60) for each in next(resumed) if isinstance(each, FirstLanding)]


def test_a_run_that_is_asked_goes_on_as_one_that_is_not():
    def networks(asked):
        session, states = run(), []
        for turn in range(100):
            states += [each.values for each in next(session) if isinstance(each, NetworkState)]
            if asked and turn % 20 == 19:
                ask(session, turn % 6)
        return states

    for one, other in zip(networks(True), networks(False), strict=False):
        np.testing.assert_array_equal(one, other)


def test_what_cannot_be_explained_is_refused_and_the_run_is_not_lost():
    session, young = run(), run()
    for _ in range(60):
        next(session)
    for _ in range(3):
        next(young)
    for asked, slot, why in ((session, 6, "no lander 6"), (session, -1, "no lander"), (young, 0, "not begun")):
        answer = ask(asked, slot)
        assert isinstance(answer, Refused)
        assert why in answer.problem
    agent = session.training.agent
    before = agent.online.values.copy()
    agent.online.values[0] = np.inf
    assert isinstance(ask(session, 0), Refused), "it has diverged"
    agent.online.values = before
    assert isinstance(ask(session, 0), Lesson)
