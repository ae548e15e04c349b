"""Made-up histories that do and do not set off each rule; runs as they were measured are in the comments."""

from dataclasses import replace
from operator import attrgetter
from typing import Any

import numpy as np
import pytest

from ai.training.config import PRESETS, Config
from ai.training.curves import Curves, caption
from ai.training.experiments import sabotaged
from ai.training.hints import HOLD, REST, RULES, STAY, Adviser, Hint
from ai.training.history import Checkpoint, History, SettingChange
from ai.training.loop import Training
from tests.support.points import HEALTHY, Curve, history, later, point_of

MODERN = PRESETS["modern"]
NAN = float("nan")


def points(**values: Any) -> Curve:
    return lambda _: replace(HEALTHY, **values)


def holding(curve: Curve, config: Config = MODERN, **options: Any) -> set[str]:
    run = Curves(history(curve, **options), config)
    return {rule.name for rule in RULES if rule.holds(run)}


def remedy(name: str, curve: Curve, config: Config = MODERN) -> dict[str, Any]:
    rule = next(rule for rule in RULES if rule.name == name)
    return dict(rule.remedy(Curves(history(curve), config)))


# Rules


CRASHES = {"success_rate": 0.0, "crashed": 0.97, "out_of_bounds": 0.02, "timed_out": 0.01}


def test_each_rule_holds_for_what_it_is_about(subtests: pytest.Subtests):
    for name, curve, config in [
        ("crashes", points(**CRASHES), MODERN),
        ("small_memory", points(), MODERN.changed(replay_size=256)),
        ("overfed", points(success_rate=0.03), MODERN.changed(num_envs=1)),
        ("random", points(epsilon=0.6), MODERN),
    ]:
        with subtests.test(name=name, config=config):
            assert holding(curve, config) == {name}
    assert holding(later(0.9, **CRASHES)) == set(), "a run that landed is not said to crash still"


def test_rules_hold_their_peace(subtests: pytest.Subtests):
    begins = {"success_rate": 0.0, "crashed": 0.6, "timed_out": 0.4, "epsilon": 0.9, "loss": 0.3, "mean_q": -0.5}
    for number, (curve, config, options) in enumerate([
        *((points(), PRESETS[base], {}) for base in PRESETS),
        (points(**begins), MODERN, {"points": 50, "decisions": 50_000}),
        (later(0.97, loss=0.3), MODERN, {}),  # modern rises and falls by a factor of 3
        (later(0.999, success_rate=0.3), MODERN, {}),  # one bad point
        (later(0.9, success_rate=0.75), MODERN, {}),
        (points(mean_q=2.9), MODERN, {}),
        (points(crashed=0.1, success_rate=0.9), MODERN, {}),
        (lambda share: replace(HEALTHY, success_rate=0.05 + 0.7 * share), MODERN, {}),  # slow, but it gets better
        (lambda share: replace(HEALTHY, stage=share > 0.9, success_rate=0.1 if share > 0.9 else 0.97), MODERN, {}),
        (lambda share: replace(HEALTHY, loss=NAN if share < 0.5 else 0.05), MODERN, {}),
        (points(loss=NAN, mean_q=NAN), MODERN, {}),  # not known, as when a run goes on
        (later(0.95, success_rate=0.3), MODERN, {}),  # a bad hundred flights
    ]):  # fmt: skip
        with subtests.test(number=number):
            assert holding(curve, config, **options) == set()


def test_no_number_stops_a_rule():
    for column in ("loss", "mean_q", "success_rate", "epsilon", "crashed", "timed_out"):
        for when in (0.0, 0.5, 0.999):
            holding(later(when, **{column: NAN}))
        holding(points(**{column: NAN}), points=1)


# Remedies


def test_remedies_follow_what_is_set(subtests: pytest.Subtests):
    sane = {"learning_rate": 2e-3, "final_learning_rate": 3e-4}
    for name, config, cure in [
        ("crashes", MODERN.changed(optimizer="sgd"), {"optimizer": "adam"}),
        ("rate_too_high", sabotaged(MODERN, "rate_times_100"), sane),
        ("overfed", MODERN.changed(num_envs=1), {"num_envs": 256}),
        ("random", MODERN.changed(epsilon_end=0.5), {"epsilon_end": 0.05}),
        ("random", PRESETS["classic"], {"epsilon_decay": 0.995}),
    ]:
        with subtests.test(name=name):
            assert remedy(name, points(), config) == cure


def test_a_configuration_takes_every_remedy():
    for preset in PRESETS.values():
        for rule in RULES:
            for knob, value in remedy(rule.name, points(), preset).items():
                assert attrgetter(knob)(preset.changed(**{knob: value})) == value, rule.name


def test_what_stays_of_a_change_leads_back_to_before_it_and_what_was_undone_is_not_blamed():
    paid = MODERN.turned("reward_weights.time", 5.0)
    change = SettingChange(200_000, "reward_weights.time", -0.4, 5.0)
    run = history(later(0.5, success_rate=0.2))
    for decisions in (0, 180_000, 380_000):
        run.append(Checkpoint(0.0, decisions, 0.5, np.zeros(3, dtype=np.float32)))
    run.append(change)
    rule = next(rule for rule in RULES if rule.holds(Curves(run, paid)))
    assert rule.name == "changed"
    assert rule.back_to(Curves(run, paid)) == 180_000
    assert rule.remedy(Curves(run, paid)) == {"reward_weights.time": -0.4}
    since = Curves(run, paid).since_change()
    run.append(replace(change, decisions=215_000, before=change.after, after=change.before, seconds=20.0))
    assert Curves(run, MODERN).blamed() == []
    assert Curves(run, MODERN).since_change() == pytest.approx(since - 100), "flights"


@pytest.mark.parametrize("harder", [False, True])
def test_a_change_is_not_blamed_for_what_harder_starts_have_brought(harder: bool):
    paid = MODERN.turned("reward_weights.time", 5.0)
    falls = replace(HEALTHY, success_rate=0.2, stage=int(harder))
    run = history(lambda share: falls if share > 0.55 else HEALTHY)
    change = SettingChange(200_000, "reward_weights.time", -0.4, 5.0)
    run.append(change)
    assert Curves(run, paid).blamed() == ([] if harder else [change])


def test_a_rate_that_was_turned_too_high_leads_back_to_before_that():
    run, config = history(points(**CRASHES)), MODERN.changed(learning_rate=1.0, final_learning_rate=1.0)
    rule = RULES[0]
    assert rule.name == "rate_too_high"
    for decisions in (0, 180_000, 380_000):
        run.append(Checkpoint(0.0, decisions, 0.5, np.zeros(3, dtype=np.float32)))
    assert rule.back_to(Curves(run, config)) == 0, "it was so from the start"
    for decisions, before, after in (
        (200_000, 2e-3, 1.0),
        (390_000, 1.0, 0.5),
        (395_000, "x", 1.0),
        (396_000, 0.5, "x"),
    ):
        run.append(SettingChange(decisions, "learning_rate", before, after, decisions / 1000))
        assert rule.back_to(Curves(run, config)) == (380_000 if before == "x" or after == "x" else 180_000)


# The adviser


def watch(adviser: Adviser, run: History, config: Config = MODERN, start: int = 0) -> list[Hint | None]:
    """Let an adviser see a run grow, point by point; what it shows after each."""
    growing, shown = History(), []
    numbers = [*run.points]
    for checkpoint in run.checkpoints:
        growing.append(checkpoint)
    for number, row in enumerate(numbers):
        growing.append(point_of(row))
        if number >= start:
            shown.append(adviser.advise(growing, config))
    return shown


def names(shown: list[Hint | None]) -> list[str]:
    return [hint.name if hint else "" for hint in shown]


def test_a_hint_appears_once_it_has_held_and_not_before():
    shown = names(watch(Adviser(), history(points(**CRASHES))))
    first = shown.index("crashes")
    assert set(shown[:first]) == {""}
    assert first == pytest.approx(150 + 10 * HOLD, abs=2)  # ten points a second; late after 150,000 decisions


def test_a_hint_stays_for_a_while_and_goes_when_it_is_over_and_a_flicker_shows_nothing():
    def random(share: float) -> bool:
        return 0.5 < share < 0.57 or int(400 * share) % 20 < 6

    spell = history(lambda share: replace(HEALTHY, epsilon=0.9 if random(share) else 0.1))
    shown = names(watch(Adviser(), spell))
    assert shown.count("random") == pytest.approx(10 * STAY, abs=3)
    assert shown[-1] == ""
    assert len("".join("x" if each else " " for each in shown).split()) == 1, "once"


def test_the_most_severe_comes_first():
    both = history(points(**CRASHES, epsilon=0.9))
    assert names(watch(Adviser(), both))[-1] == "crashes"


def test_a_hint_that_was_answered_does_not_come_back_at_once():
    config = MODERN.changed(epsilon_end=0.6)
    run = history(points(epsilon=0.6), seconds=40.0 + REST)
    adviser, growing, moments = Adviser(), History(), []
    for row in run.points:
        growing.append(point_of(row))
        if hint := adviser.advise(growing, config):
            assert hint.remedy == {"epsilon_end": 0.05}
            moments.append(float(row[0]))
            adviser.dismiss()
    assert len(moments) == 2
    assert moments[1] - moments[0] >= REST


def test_a_dismissed_hint_leaves_room_for_another():
    adviser = Adviser()
    run = history(points(**CRASHES, epsilon=0.9))
    assert names(watch(adviser, run, start=0))[-1] == "crashes"
    adviser.dismiss()
    growing = run.copy()
    hint = adviser.advise(growing, MODERN)
    assert hint is not None
    assert hint.name == "random"


def test_a_remedy_that_changes_nothing_is_none():
    assert watch(Adviser(), history(points(**CRASHES)))[-1] == Hint("crashes", {})


def test_another_run_begins_without_the_past():
    adviser = Adviser()
    watch(adviser, history(points(**CRASHES)))
    assert adviser.shown
    assert adviser.advise(history(points(), points=3, seconds=0.3), MODERN) is None
    assert adviser.advise(History(), MODERN) is None


# The caption of the chart of landings


def test_a_caption_says_why_none_lands_and_is_silent_where_some_do():
    for values, name in (
        ({"success_rate": NAN}, "unknown"),
        ({"success_rate": 0.0, "crashed": 0.9, "timed_out": 0.1}, "crashes"),
        ({"success_rate": 0.0, "crashed": 0.2, "timed_out": 0.8}, "hovers"),
        ({"success_rate": 0.0, "crashed": 0.2, "timed_out": 0.0, "out_of_bounds": 0.8}, "leaves"),
        ({"success_rate": 0.0, "crashed": 0.4, "timed_out": 0.2, "out_of_bounds": 0.4}, "none"),
        ({"success_rate": 0.01}, ""),
    ):
        assert caption(history(points(**values))) == name
    assert caption(History()) == ""


# A real run, a short one


@pytest.mark.slow
def test_nothing_is_said_of_a_run_that_starts_well():
    config = MODERN.changed(gradient_steps=1)
    training, run, adviser = Training(config, evaluate_every=0), History(), Adviser()
    while training.agent.decisions < 30_000:
        progress = training.advance()
        run.append(replace(progress, seconds=progress.decisions / 1_000))
        assert adviser.advise(run, config) is None, progress.decisions
