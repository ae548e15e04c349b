"""Reads Watch, Train and Digits in the states they can be in: who flies or reads, what goes on, what came of it."""

from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pygame
import pytest

from ai.lander.environment import Outcome
from game.core import texts
from game.core.worker import WorkerState
from game.digits import certainty
from game.flight import networks
from game.scenes.digits.reader import best_two
from game.scenes.digits.scene import DigitsScene
from game.scenes.train.digits import DigitTrainingScene
from game.scenes.train.scene import TrainScene
from game.scenes.watch.scene import COUNTS, WatchScene
from game.training.run import TrainingRun
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.pen import draw, strokes
from tests.support.reading import COUNTS as EARNED
from tests.support.reading import FLEW, OnlyFlies, Reading, Weighs, pattern

Open = Callable[..., Driver]
NOBODYS = [
    pattern(text) for text in (*FLEW, texts.YOU_FLY, *texts.YOU_SHARE.values(), *texts.NOT_COUNTED.values(), *EARNED)
]
NETWORKS = {"weighs": Weighs(), "only flies": OnlyFlies(), networks.SCRIPTED: OnlyFlies()}
BROKEN = "its target is missing"


class Stored:
    """Stands in for what lies on the disk; the last one is damaged."""

    names = (*NETWORKS, "broken")

    def __init__(self, *_: object) -> None: ...

    def __getitem__(self, name: str) -> networks.Network:
        return networks.Network(name, NETWORKS.get(name), "" if name in NETWORKS else BROKEN)

    def first_fit(self) -> networks.Network:
        return self["weighs"]


@pytest.mark.parametrize("count", [1, 16])
@pytest.mark.parametrize("name", Stored.names)
def test_watch_says_who_flies_and_how_many_have_landed(open_game: Open, context: Context, monkeypatch, name, count):
    monkeypatch.setattr(networks, "Policies", Stored)
    reading = Reading(open_game(WatchScene, count, seed=2), monkeypatch)
    driver, watch = reading.driver, reading.driver.top
    watch._model_choice.choose(Stored.names.index(name))
    swarm = watch.swarm
    for stopped in (False, True):
        watch.playback.stopped = stopped
        for frames in (1, 7):
            check_watch(reading, flies="weighs" if name == "broken" else name, broken=name == "broken")
            driver.skip(frames)
    watch.playback.stopped = False
    lost = np.zeros((count, 6))
    lost[:, :4] = -swarm.env.limits.half_width + 0.1, 12, -8, 0
    swarm.env.place(np.ones(count, bool), lost)
    driver.skip(12)
    assert (swarm.env.outcome == Outcome.OUT_OF_BOUNDS).all()
    check_watch(reading, flies="weighs" if name == "broken" else name, broken=name == "broken")
    assert swarm.lost == count
    watch.playback.stopped = True
    driver.choice("64").choose(2)
    check_watch(reading, flies="weighs" if name == "broken" else name, broken=name == "broken")


def check_watch(reading: Reading, flies: str, broken: bool) -> None:
    words, watch = set(reading.page().words), reading.driver.top
    scripted, count, swarm = flies == networks.SCRIPTED, COUNTS[watch._count], watch.swarm
    who = {texts.WATCH_SCRIPTED, texts.WATCH_STOPPED, *(texts.WATCH_FLIES.format(name=each) for each in Stored.names)}
    flying = texts.WATCH_SCRIPTED if scripted else texts.WATCH_FLIES.format(name=flies)
    assert who & words == {texts.WATCH_STOPPED if watch.playback.stopped else flying}
    assert {texts.HINT_GO, texts.HINT_STOP} & words == {texts.HINT_GO if watch.playback.stopped else texts.HINT_STOP}
    assert set(map(landers, COUNTS)) & words == {landers(count)}
    weighs = flies == "weighs"
    assert (texts.DECISION_TITLE in words) == weighs == (texts.DECISION_SCRIPTED_TITLE not in words)
    assert (texts.Q_WEIGHS_NOTHING in words) == (not weighs)
    counted = texts.WATCH_COUNTS.format(landed=swarm.landed, lost=swarm.lost)
    assert (counted in words) == (swarm.landed + swarm.lost > 0)
    assert any(BROKEN in word for word in words) == broken
    assert not [word for word in words if any(says.match(word) for says in NOBODYS)]


def landers(count: int) -> str:
    return texts.WATCH_LANDERS.format(count=count)


STATES = [None, *WorkerState]
LINES = {
    TrainScene: (texts.TRAIN_BEGINS, texts.TRAIN_LINE),
    DigitTrainingScene: (texts.DIGIT_RUN_LOADING, texts.DIGIT_RUN_LINE),
}
BUTTON = dict.fromkeys([WorkerState.RUNNING, WorkerState.STARTING], texts.TRAIN_PAUSE) | {
    WorkerState.PAUSED: texts.TRAIN_RESUME
}


@pytest.mark.parametrize("make", [TrainScene, DigitTrainingScene])
def test_a_run_that_goes_on_rests_ended_or_failed_is_offered_what_fits(open_game: Open, monkeypatch, make):
    reading = Reading(open_game(make), monkeypatch)
    driver, scene = reading.driver, reading.driver.top
    learner = scene.run
    current: list[WorkerState | None] = [None]
    monkeypatch.setattr(TrainingRun, "state", property(lambda _: current[0]))
    for state in (*STATES, *reversed(STATES)):
        current[0] = state
        quiet = {name: lambda *_: None for name in ("pause", "resume", "stop", "close", "step", "send", "set_pace")}
        learner._worker = state and SimpleNamespace(
            state=state, problem="the disk is full", gone=True, poll=list, **quiet
        )
        words = set(reading.page(12).words)
        offered = {texts.TRAIN_START, texts.TRAIN_PAUSE, texts.TRAIN_RESUME} & words
        assert offered == {BUTTON.get(state, texts.TRAIN_START)}, state
        assert any("the disk is full" in word for word in words) == (state is WorkerState.FAILED), state
        begins, invites = LINES[make]
        assert {begins, invites} & words == {begins if learner.alive else invites}, state
        if make is DigitTrainingScene:
            assert (texts.DIGIT_RUN_STOP in words) == learner.alive, state
    learner._worker = None
    assert driver.top is scene


VERDICTS = [pattern(text) for text in (texts.DIGITS_SURE, texts.DIGITS_LIKELY, texts.DIGITS_DISPUTED)]


def test_one_verdict_is_said_of_a_drawing_and_it_is_that_of_the_figures(open_game: Open, monkeypatch):
    reading = Reading(open_game(DigitsScene), monkeypatch)
    driver = reading.driver
    assert texts.DIGITS_EMPTY in reading.page(3).words
    said: set[str] = set()
    for digit, style in [(1, 0), (3, 0), (5, 0), (8, 0), (4, 0)]:
        for much in (1, None):  # the first stroke alone, and then all of it
            driver.key(pygame.K_c)
            driver.frames(4)
            draw(driver, strokes(digit, style)[:much])
            for _ in range(2):
                said |= check_digits(reading)
                driver.key(pygame.K_n)  # the other network
                driver.frames(4)
    assert len(said) > 1
    driver.key(pygame.K_c)
    assert texts.DIGITS_EMPTY in reading.page(6).words


def check_digits(reading: Reading) -> set[str]:
    words, scene = reading.page(6).words, reading.driver.top
    assert texts.DIGITS_EMPTY not in words
    first, second = best_two(scene.probabilities)
    share = certainty(scene.probabilities[first])
    verdicts = [word for word in words if any(says.match(word) for says in VERDICTS)]
    rivals = [word for word in words if pattern(texts.DIGITS_OR).match(word)]
    unsure = "?" in words and not verdicts
    assert len(verdicts) == (not unsure)
    assert all(word.endswith(share) for word in verdicts)
    assert all(f" {second}," in word for word in rivals)
    assert unsure or str(first) in words
    return {verdicts[0].partition(",")[0]} if verdicts else {"unsure"}
