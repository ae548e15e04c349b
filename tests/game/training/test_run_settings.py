from dataclasses import fields, replace
from typing import Any

import pytest

from ai.lander.rewards import RewardWeights
from ai.training.config import PRESETS, Config
from ai.training.experiments import SABOTAGES, sabotaged
from game.core import texts
from game.training.run_kind import DIGITS, LANDERS
from game.training.run_settings import SEED, RunSettings, figure, knob_descriptions

KNOBS = {knob.name: knob for knob in knob_descriptions()}


@pytest.fixture
def heard() -> list[Any]:
    return []


@pytest.fixture
def run_settings(heard: list[Any]) -> RunSettings:
    return RunSettings(
        PRESETS["modern"], 0, lambda name, value: heard.append((name, value)), lambda *anew: heard.append(anew), LANDERS
    )


# Knobs


def test_every_field_that_can_be_turned_has_a_knob_and_a_word():
    turned = {item.name for item in fields(Config)} - {"env", "env_arguments", "preset"}
    assert {knob.field for knob in KNOBS.values()} == turned
    assert {knob.part for knob in KNOBS.values()} - {""} == {part.name for part in fields(RewardWeights)}
    assert turned <= set(texts.KNOBS)
    assert all(knob.help for knob in KNOBS.values())


def test_a_page_shows_sixteen_knobs_at_most_the_first_of_all_among_them():
    for kind in (LANDERS, DIGITS):
        known = {knob.name for knob in kind.knob_descriptions} | {SEED}
        assert set(kind.first) <= set(kind.page) <= known
        assert len(set(kind.page)) == len(kind.page) <= 16


def test_a_configuration_takes_every_stop():
    for name, knob in KNOBS.items():
        assert len(set(knob.stops)) == len(knob.stops) > 1, name
        for stop in knob.stops:
            assert knob.read(knob.write(PRESETS["modern"], stop)) == stop, name


def test_stops_are_numbers_that_people_choose():
    assert KNOBS["batch_size"].stops == (8, 16, 32, 64, 128, 256, 512, 1024)
    assert KNOBS["learning_rate"].stops[:6] == (1e-5, 1.5e-5, 2e-5, 3e-5, 5e-5, 7e-5)
    assert KNOBS["n_step"].stops == tuple(range(1, 21))
    assert {0.9, 0.98, 0.985, 0.99, 0.999} < set(KNOBS["discount"].stops)
    assert {0.0, 0.01, 0.05} < set(KNOBS["epsilon_end"].stops)
    assert KNOBS["reward_weights.time"].stops[0] == 0.0
    assert KNOBS["reward_weights.time"].stops[-1] < KNOBS["reward_weights.time"].stops[1] < 0


def test_stops_reach_from_end_to_end():
    for item in fields(Config):
        if item.metadata["low"] is not None and item.name != "hidden":
            stops = KNOBS[item.name].stops
            assert (stops[0], stops[-1]) == (item.metadata["low"], item.metadata["high"])


def test_values_are_written_for_people():
    for value, written in {
        0.002: "0.002", 1e-5: "0.00001", 1.5e-6: "0.0000015", -0.05: "−0.05", 0.985: "0.985", 0.0: "0",
        300_000: "300\u00a0000", 8: "8", True: "on", (64, 64): "64×64", "leaky_relu": "leaky", "thorough": "thorough",
    }.items():  # fmt: skip
        assert figure(value) == written


# Tuning


def test_without_a_run_every_knob_changes_at_once(run_settings: RunSettings, heard: list[Any]):
    run_settings.turn("n_step", 3)
    run_settings.turn("learning_rate", 0.01)
    run_settings.turn("seed", 7)
    assert (run_settings.config.n_step, run_settings.config.learning_rate, run_settings.seed) == (3, 0.01, 7)
    assert heard == [("n_step", 3), ("learning_rate", 0.01), ("seed", 7)]
    assert not run_settings.waiting


def test_in_a_run_the_live_ones_change_and_the_others_wait(run_settings: RunSettings, heard: list[Any]):
    run_settings.set_running(True)
    run_settings.turn("n_step", 3)
    run_settings.turn("learning_rate", 0.01)
    run_settings.turn("seed", 7)
    assert heard == [("learning_rate", 0.01)]
    assert run_settings.waiting == ["n_step", "seed"]
    assert (run_settings.config.n_step, run_settings.seed) == (PRESETS["modern"].n_step, 0)
    run_settings.apply()
    assert heard[1:] == [(PRESETS["modern"].changed(n_step=3, learning_rate=0.01), 7)]
    assert not run_settings.waiting


def test_undo_takes_back_what_waits_and_leaves_what_holds(run_settings: RunSettings, heard: list[Any]):
    run_settings.set_running(True)
    run_settings.turn("learning_rate", 0.01)
    run_settings.turn("hidden", (32, 32))
    run_settings.turn("seed", 7)
    run_settings.undo()
    assert (run_settings.waiting, run_settings.draft_seed) == ([], 0)
    assert run_settings.draft == run_settings.config == PRESETS["modern"].changed(learning_rate=0.01)
    assert heard == [("learning_rate", 0.01)]


def test_what_waits_holds_once_the_run_is_over(run_settings: RunSettings, heard: list[Any]):
    run_settings.set_running(True)
    run_settings.turn("n_step", 3)
    run_settings.set_running(False)
    assert run_settings.config.n_step == 3
    assert heard == [("n_step", 3)]


def test_a_preset_waits_whole_in_a_run(run_settings: RunSettings, heard: list[Any]):
    run_settings.set_running(True)
    run_settings.load(("classic", ""))
    assert run_settings.config == PRESETS["modern"]
    assert "learning_rate" in run_settings.waiting
    assert not heard
    run_settings.undo()
    assert run_settings.named == ("modern", "")
    run_settings.load(("classic", ""))
    run_settings.apply()
    assert heard == [(PRESETS["classic"], 0)]
    assert run_settings.named == ("classic", "")


def test_a_sabotage_of_live_knobs_alone_takes_effect_at_once(run_settings: RunSettings, heard: list[Any]):
    run_settings.set_running(True)
    run_settings.load(("modern", "short_sight"))
    assert heard == [("discount", 0.8)]
    assert not run_settings.waiting
    assert not run_settings.changed


def test_knobs_that_a_preset_puts_aside_can_be_had_back(run_settings: RunSettings, heard: list[Any]):
    run_settings.turn("n_step", 3)
    run_settings.load(("classic", ""))
    assert run_settings.config == PRESETS["classic"]
    run_settings.undo()
    assert run_settings.config == PRESETS["modern"].changed(n_step=3)
    assert run_settings.named == ("modern", "")
    assert heard[-1][0] in KNOBS


def test_an_impossible_value_changes_nothing_and_is_explained(run_settings: RunSettings, heard: list[Any]):
    run_settings.turn("learning_rate", -1.0)
    assert run_settings.config == run_settings.draft == PRESETS["modern"]
    assert run_settings.problem.startswith("Learning rate lies between")
    assert not heard
    run_settings.turn("learning_rate", 0.01)
    assert run_settings.problem == ""
    run_settings.load(("classic", ""))
    run_settings.turn("replay_size", 500)
    assert run_settings.problem == "Forget at once is at most Replay, 500, not 1000"
    assert run_settings.config == PRESETS["classic"]


def test_parts_of_the_reward_are_named_apart(run_settings: RunSettings, heard: list[Any]):
    run_settings.turn("reward_weights.time", -0.6)
    assert heard == [("reward_weights.time", -0.6)]
    assert run_settings.config.reward_weights == replace(PRESETS["modern"].reward_weights, time=-0.6)


def test_a_configuration_from_elsewhere_is_named_after_what_it_began_as(run_settings: RunSettings, heard: list[Any]):
    run_settings.set_config(PRESETS["classic"].changed(discount=0.95), 3)
    assert (run_settings.named, run_settings.seed, run_settings.changed) == (("classic", ""), 3, True)
    assert LANDERS.named(sabotaged(PRESETS["modern"], "no_shaping")) == ("modern", "no_shaping")
    assert not heard


def test_a_run_that_begins_with_what_was_chosen_keeps_its_name(run_settings: RunSettings):
    run_settings.turn("discount", 0.9)
    run_settings.turn("layer_normalisation", False)  # nearer to a sabotage than to modern
    run_settings.set_config(run_settings.config, run_settings.seed)
    assert run_settings.named == ("modern", "")


def test_every_sabotage_has_its_words():
    for name in SABOTAGES:
        assert len(texts.SABOTAGES[name]) == 2
        title, watch = LANDERS.said(("modern", name))
        assert (title, bool(watch)) == (texts.SABOTAGES[name][0], True)
