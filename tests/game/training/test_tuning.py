from dataclasses import fields, replace
from typing import Any

import pytest

from ai.agent.config import PRESETS, Config
from ai.lander.rewards import RewardWeights
from ai.training.sabotage import SABOTAGES, sabotaged
from game.core import texts
from game.training.dials import dials, figure, pages
from game.training.run_settings import LANDER, Tuning

DIALS = {dial.name: dial for dial in dials()}


@pytest.fixture
def heard() -> list[Any]:
    return []


@pytest.fixture
def tuning(heard: list[Any]) -> Tuning:
    return Tuning(
        PRESETS["modern"], 0, lambda name, value: heard.append((name, value)), lambda *anew: heard.append(anew)
    )


# Dials


def test_every_field_that_can_be_turned_has_a_dial_and_a_word():
    turned = {item.name for item in fields(Config)} - {"env"}
    assert {dial.field for dial in DIALS.values()} == turned
    assert {dial.part for dial in DIALS.values()} - {""} == {part.name for part in fields(RewardWeights)}
    assert turned <= set(texts.KNOBS)
    assert set(pages(DIALS.values())) == set(texts.KNOB_PAGES)
    assert all(dial.help for dial in DIALS.values())


@pytest.mark.parametrize("name", DIALS)
def test_a_configuration_takes_every_stop(name: str):
    dial = DIALS[name]
    assert len(set(dial.stops)) == len(dial.stops) > 1
    for stop in dial.stops:
        assert dial.read(dial.write(PRESETS["modern"], stop)) == stop


def test_stops_are_numbers_that_people_choose():
    assert DIALS["batch_size"].stops == (8, 16, 32, 64, 128, 256, 512, 1024)
    assert DIALS["learning_rate"].stops[:6] == (1e-5, 1.5e-5, 2e-5, 3e-5, 5e-5, 7e-5)
    assert DIALS["n_step"].stops == tuple(range(1, 21))
    assert {0.9, 0.98, 0.985, 0.99, 0.999} < set(DIALS["discount"].stops)
    assert {0.0, 0.01, 0.05} < set(DIALS["epsilon_end"].stops)
    assert DIALS["weights.time"].stops[0] == 0.0
    assert DIALS["weights.time"].stops[-1] < DIALS["weights.time"].stops[1] < 0


def test_stops_reach_from_end_to_end():
    for item in fields(Config):
        if item.metadata["low"] is not None and item.name != "hidden":
            stops = DIALS[item.name].stops
            assert (stops[0], stops[-1]) == (item.metadata["low"], item.metadata["high"])


@pytest.mark.parametrize(
    ("value", "written"),
    [
        (0.002, "0.002"), (1e-5, "0.00001"), (1.5e-6, "0.0000015"), (-0.05, "−0.05"), (0.985, "0.985"), (0.0, "0"),
        (300_000, "300\u2009000"), (8, "8"), (True, "on"), ((64, 64), "64×64"), ("leaky_relu", "leaky"),
        ("thorough", "thorough"),
    ],
)  # fmt: skip
def test_values_are_written_for_people(value: Any, written: str):
    assert figure(value) == written


# Tuning


def test_without_a_run_every_knob_changes_at_once(tuning: Tuning, heard: list[Any]):
    tuning.turn("n_step", 3)
    tuning.turn("learning_rate", 0.01)
    tuning.turn("seed", 7)
    assert (tuning.config.n_step, tuning.config.learning_rate, tuning.seed) == (3, 0.01, 7)
    assert heard == [("n_step", 3), ("learning_rate", 0.01), ("seed", 7)]
    assert not tuning.waiting


def test_in_a_run_the_live_ones_change_and_the_others_wait(tuning: Tuning, heard: list[Any]):
    tuning.set_running(True)
    tuning.turn("n_step", 3)
    tuning.turn("learning_rate", 0.01)
    tuning.turn("seed", 7)
    assert heard == [("learning_rate", 0.01)]
    assert tuning.waiting == ["n_step", "seed"]
    assert (tuning.config.n_step, tuning.seed) == (10, 0)
    tuning.apply()
    assert heard[1:] == [(PRESETS["modern"].changed(n_step=3, learning_rate=0.01), 7)]
    assert not tuning.waiting


def test_undo_takes_back_what_waits_and_leaves_what_holds(tuning: Tuning, heard: list[Any]):
    tuning.set_running(True)
    tuning.turn("learning_rate", 0.01)
    tuning.turn("hidden", (32, 32))
    tuning.undo()
    assert tuning.draft == tuning.config == PRESETS["modern"].changed(learning_rate=0.01)
    assert heard == [("learning_rate", 0.01)]


def test_what_waits_holds_once_the_run_is_over(tuning: Tuning, heard: list[Any]):
    tuning.set_running(True)
    tuning.turn("n_step", 3)
    tuning.set_running(False)
    assert tuning.config.n_step == 3
    assert heard == [("n_step", 3)]


def test_a_preset_waits_whole_in_a_run(tuning: Tuning, heard: list[Any]):
    tuning.set_running(True)
    tuning.load(("classic", ""))
    assert tuning.config == PRESETS["modern"]
    assert "learning_rate" in tuning.waiting
    assert not heard
    tuning.undo()
    assert tuning.named == ("modern", "")
    tuning.load(("classic", ""))
    tuning.apply()
    assert heard == [(PRESETS["classic"], 0)]
    assert tuning.named == ("classic", "")


def test_a_sabotage_of_live_knobs_alone_takes_effect_at_once(tuning: Tuning, heard: list[Any]):
    tuning.set_running(True)
    tuning.load(("modern", "no_target"))
    assert heard == [("target_rate", 1.0)]
    assert not tuning.waiting
    assert not tuning.changed


def test_knobs_that_a_preset_puts_aside_can_be_had_back(tuning: Tuning, heard: list[Any]):
    tuning.turn("n_step", 3)
    tuning.load(("classic", ""))
    assert tuning.config == PRESETS["classic"]
    tuning.undo()
    assert tuning.config == PRESETS["modern"].changed(n_step=3)
    assert tuning.named == ("modern", "")
    assert heard[-1][0] in DIALS


def test_a_preset_puts_nothing_aside_where_nothing_was_turned(tuning: Tuning):
    tuning.load(("classic", ""))
    assert tuning.put_aside is None


def test_an_impossible_value_changes_nothing_and_is_explained(tuning: Tuning, heard: list[Any]):
    tuning.turn("learning_rate", -1.0)
    assert tuning.config == tuning.draft == PRESETS["modern"]
    assert tuning.problem.startswith("Learning rate lies between")
    assert not heard
    tuning.turn("learning_rate", 0.01)
    assert not tuning.problem
    tuning.load(("classic", ""))
    tuning.turn("replay_size", 500)
    assert tuning.problem == "Forget at once is at most Replay, 500, not 1000"
    assert tuning.config == PRESETS["classic"]


def test_parts_of_the_reward_are_named_apart(tuning: Tuning, heard: list[Any]):
    tuning.turn("weights.time", -0.6)
    assert heard == [("weights.time", -0.6)]
    assert tuning.config.weights == replace(PRESETS["modern"].weights, time=-0.6)


def test_a_configuration_from_elsewhere_is_named_after_what_is_nearest(tuning: Tuning, heard: list[Any]):
    tuning.set_config(PRESETS["classic"].changed(discount=0.95), 3)
    assert (tuning.named, tuning.seed, tuning.changed) == (("classic", ""), 3, True)
    assert LANDER.nearest(sabotaged(PRESETS["modern"], "no_shaping")) == ("modern", "no_shaping")
    assert not heard


def test_a_run_that_begins_with_what_was_chosen_keeps_its_name(tuning: Tuning):
    tuning.turn("discount", 0.9)
    tuning.turn("n_step", 1)  # nearer to a sabotage than to modern
    tuning.set_config(tuning.config, tuning.seed)
    assert tuning.named == ("modern", "")


@pytest.mark.parametrize("name", SABOTAGES)
def test_every_sabotage_has_its_words(name: str):
    assert LANDER.word(("modern", name)) == texts.SABOTAGES[name][0]
    assert len(texts.SABOTAGES[name]) == 3
    assert LANDER.sentence(("modern", name))
