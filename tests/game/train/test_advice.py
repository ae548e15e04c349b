"""The hint on the training screen, with a run that flew better before."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ai.training.config import PRESETS
from ai.training.hints import RULES, Hint
from ai.training.history import Checkpoint, History, SettingChange
from game.core import texts
from game.scenes.train.advice import Advice
from game.ui.context import Context
from game.ui.form import Form
from game.ui.panel import Panel
from game.ui.widget import Widget
from tests.support.points import HEALTHY, point_of

MODERN = PRESETS["modern"]


@pytest.fixture
def broken() -> History:
    """A run that lands hardly any more since its pay was changed."""
    run = History()
    for number in range(400):
        success = 0.97 if number < 300 else 0.2
        run.append(replace(HEALTHY, seconds=number / 10, decisions=1000.0 * number, episodes=9.0 * number,
                           success_rate=success))  # fmt: skip
    run.append(Checkpoint(20.0, 200_000, 0.97, np.zeros(3, np.float32)))
    run.append(Checkpoint(39.0, 390_000, 0.2, np.zeros(3, np.float32)))
    return run


def test_every_hint_has_words() -> None:
    assert set(texts.HINTS) == {rule.name for rule in RULES}


def words_of(advice: Advice, context: Context) -> dict[str, Widget]:
    form = Form(context)
    if advice.shown:
        advice.describe(Panel(form))
    return {each.label: each for each in form.widgets}


def advised(run: Any, turn: Any = lambda *_: None) -> Any:
    advice: Any = Advice(run, turn)
    return advice


def test_while_something_else_waits_no_hint_asks(context: Context) -> None:
    advice = advised(SimpleNamespace(history=History(), config=MODERN))
    advice.adviser.shown = Hint("overfed", {"num_envs": 256})
    assert advice.shown
    advice.silence(True)
    assert not advice.shown
    advice.silence(False)
    assert list(words_of(advice, context)) == [texts.HINT_APPLY, texts.HINT_DISMISS]


def test_a_remedy_is_applied_the_way_back_too(context: Context, broken: History) -> None:
    turned: list[tuple[str, float]] = []
    gone_to: list[int] = []
    growing = History()
    run = SimpleNamespace(
        history=growing,
        config=MODERN.turned("reward_weights.time", 5.0),
        ask=lambda _, decisions: gone_to.append(decisions),
    )
    advice = advised(run, lambda name, value: turned.append((name, value)))
    for checkpoint in broken.checkpoints:
        growing.append(checkpoint)
    for number, row in enumerate(broken.points):
        now = point_of(row)
        seen = {name: getattr(now, name) for name in ("seconds", "decisions", "episodes", "success_rate")}
        growing.append(replace(HEALTHY, **seen))
        if number == 300:
            growing.append(SettingChange(300_000, "reward_weights.time", -0.4, 5.0, seconds=30.0))
        advice.follow()
    assert advice.adviser.shown.name == "changed"
    words_of(advice, context)[texts.HINT_APPLY].press()
    assert gone_to == [200_000]
    assert turned == [("reward_weights.time", -0.4)]
    assert not advice.shown
