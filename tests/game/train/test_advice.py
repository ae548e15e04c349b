"""The hint on the training screen, with a run that flew better before."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np

from ai.training.config import PRESETS
from ai.training.hints import RULES, Hint
from ai.training.history import Checkpoint, History, SettingChange
from game.core import texts
from game.scenes.train.advice import Advice
from game.ui.context import Context
from game.ui.form import Form
from game.ui.panel import Column
from tests.support.points import HEALTHY


def test_every_hint_has_words() -> None:
    assert set(texts.HINTS) == {rule.name for rule in RULES}


def test_while_something_else_waits_no_hint_asks() -> None:
    settings, run = SimpleNamespace(waits=False), SimpleNamespace(twin=None)
    advice: Any = Advice(run, settings)
    advice.adviser.shown = Hint("overfed", {"num_envs": 256})
    assert advice.shown
    settings.waits = True
    assert not advice.shown
    settings.waits, run.twin = False, run
    assert not advice.shown


def test_a_remedy_sets_knobs_and_goes_back(context: Context) -> None:
    turned: list[tuple[str, float]] = []
    asked: list[tuple[str, int]] = []
    history = History()
    run = SimpleNamespace(
        history=history, config=PRESETS["modern"].turned("reward_weights.time", 5.0), alive=True, twin=None,
        network_state=0, ask=lambda *order: asked.append(order),
    )  # fmt: skip
    settings = SimpleNamespace(waits=False, turn=lambda *knob: turned.append(knob))
    advice = Advice(run, settings)
    history.append(Checkpoint(20.0, 200_000, 0.97, np.zeros(3, np.float32)))
    history.append(Checkpoint(39.0, 390_000, 0.2, np.zeros(3, np.float32)))
    for number in range(400):  # it lands hardly any more since its pay was changed
        success = 0.97 if number < 300 else 0.2
        history.append(replace(HEALTHY, seconds=number / 10, decisions=1000.0 * number, episodes=9.0 * number,
                               success_rate=success))  # fmt: skip
        if number == 300:
            history.append(SettingChange(300_000, "reward_weights.time", -0.4, 5.0, seconds=30.0))
        run.network_state += 1
        advice.update()
    assert advice.shown
    assert advice.shown.name == "changed"
    form = Form(context)
    advice.describe(Column(form, []), advice.shown)
    apply, _dismiss = form.widgets
    apply.press()
    assert asked == [("restore", 200_000)]
    assert turned == [("reward_weights.time", -0.4)]
    assert not advice.shown
    run.alive = False
    advice.update()
    assert not advice.shown
