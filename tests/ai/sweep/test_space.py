"""Search spaces from the knobs' own ranges, by name, by group and from a file."""

import json
from dataclasses import asdict

import numpy as np
import pytest

from ai.digits.config import DIGIT_PRESETS
from ai.files import read_as
from ai.sweep.plan import Dimension, knob_dimension, knob_space, read_space
from ai.training.config import PRESETS

MODERN = PRESETS["modern"]


def test_a_knob_is_searched_in_its_own_range_and_scale():
    assert knob_dimension(MODERN, "learning_rate") == Dimension(1e-5, 1.0, log=True)
    assert knob_dimension(MODERN, "n_step") == Dimension(1, 20, whole=True)
    assert knob_dimension(MODERN, "double").choices == (False, True)
    assert [128, 128] in knob_dimension(MODERN, "hidden").choices


def test_a_group_stands_for_its_knobs_that_change_anything():
    space = knob_space(MODERN, ["memory"])
    assert "replay_size" in space
    assert "priority_exponent" not in space, "replay is not prioritised, so it changes nothing"
    assert "tau" in knob_space(MODERN, ["memory", "tau"])
    assert "updates" not in knob_space(MODERN, ["updates"])  # a former name is read
    assert knob_space(DIGIT_PRESETS["modern"], ["images"])


@pytest.mark.parametrize("name", ["no_such_knob", "env", "reward_weights"])
def test_a_knob_that_cannot_be_searched_is_named(name):
    with pytest.raises(ValueError, match=name):
        knob_space(MODERN, [name])


def test_a_file_narrows_ranges_and_lists_choices(tmp_path):
    file = tmp_path / "space.json"
    file.write_text(
        json.dumps({"learning_rate": {"low": 1e-4, "high": 1e-2}, "n_step": {}, "hidden": [[16], [32, 32]]})
    )
    space = read_space(MODERN, file)
    assert space["learning_rate"] == Dimension(1e-4, 1e-2, log=True)
    assert space["n_step"] == knob_dimension(MODERN, "n_step")
    assert space["hidden"].choices == ([16], [32, 32])


@pytest.mark.parametrize(
    "asked",
    [
        {"learning_rate": {"low": -1}},
        {"learning_rate": {"low": 1e-2, "high": 1e-3}},
        {"learning_rate": {"lowest": 1e-3}},
        {"learning_rate": {"low": "x"}},
        {"optimizer": ["no such"]},
        {"hidden": [16]},
        {"n_step": [1.5]},
        {"n_step": 3},
        {"unknown": {}},
        [],
        {},
    ],
)
def test_a_file_that_makes_no_sense_is_refused(tmp_path, asked):
    file = tmp_path / "space.json"
    file.write_text(json.dumps(asked))
    with pytest.raises(ValueError, match=r"\w"):
        read_space(MODERN, file)


@pytest.mark.parametrize("name", ["learning_rate", "n_step", "hidden", "epsilon_decisions", "double"])
def test_values_and_places_are_inverse_and_drawn_within_the_range(name):
    dimension = knob_dimension(MODERN, name)
    assert read_as(Dimension, json.loads(json.dumps(asdict(dimension)))) == dimension
    rng = np.random.default_rng(0)
    for _ in range(50):
        value = dimension.draw(rng)
        place = dimension.place(value)
        assert 0.0 <= place <= 1.0
        again = dimension.at(place)
        assert again == value or np.isclose(again, value)
        MODERN.changed(**{name: tuple(value) if isinstance(value, list) else value})
