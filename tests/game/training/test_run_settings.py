from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from ai.training.config import PRESETS
from ai.training.experiments import sabotaged
from game.core import texts
from game.training.library import Library
from game.training.run import TrainingRun
from game.training.run_kind import DIGITS, LANDERS, RunKind
from game.training.run_settings import RunSettings, figure, help_of, label

MODERN, CLASSIC = PRESETS["modern"], PRESETS["classic"]


class Stub(TrainingRun):
    """Run that is alive when it is told so, and notes what it is asked for."""

    alive: Any = False

    def __init__(self, kind: RunKind, folder: Path) -> None:
        super().__init__(kind, Library(folder))
        self.config = kind.presets["modern"]
        self.heard: list[Any] = []

    def ask(self, _: str, *change: Any) -> None:
        if self.alive:
            self.heard.append(change)
            self.config = self.config.turned(*change)


@pytest.fixture
def run(tmp_path: Path) -> Stub:
    return Stub(LANDERS, tmp_path)


@pytest.fixture
def settings(run: Stub) -> RunSettings:
    return RunSettings(run, MODERN)


# Knobs


@pytest.mark.parametrize("kind", [LANDERS, DIGITS])
def test_a_configuration_takes_every_stop_of_at_most_sixteen_knobs_with_their_words(kind: RunKind, tmp_path: Path):
    assert set(kind.first) <= set(kind.knobs)
    assert len(kind.knobs) <= 16
    settings = RunSettings(Stub(kind, tmp_path), kind.presets["classic"])
    for name, (stops, chapter) in kind.knobs.items():
        assert label(name)
        assert help_of(kind.of, name)
        assert not chapter or chapter in texts.LEARN
        sizes = [abs(stop) for stop in stops if isinstance(stop, int | float)]
        assert sizes == sorted(set(sizes)), name
        for stop in stops:
            settings.ask(kind.presets["modern" if name == "convolutions" else "classic"])
            settings.turn(name, stop)
            # Some are too large for what else is set; the panel then says so.
            assert settings.read(name) == stop or settings.problem, name


def test_values_are_written_for_people():
    for value, written in {
        0.002: "0.002", 1e-5: "0.00001", 1.5e-6: "0.0000015", -0.05: "−0.05", 0.985: "0.985", 0.0: "0",
        300_000: "300\u00a0000", 8: "8", True: "on", (64, 64): "64×64", "leaky_relu": "leaky", "thorough": "thorough",
    }.items():  # fmt: skip
        assert figure(value) == written


# Tuning


def test_without_a_run_nothing_waits(settings: RunSettings, run: Stub):
    settings.turn("n_step", 3)
    settings.turn("learning_rate", 0.01)
    assert settings.in_force == settings.asked == MODERN.changed(n_step=3, learning_rate=0.01)
    assert settings.changed
    assert not settings.waits
    assert not run.heard


def test_in_a_run_the_live_ones_change_the_others_wait_and_undo_leaves_what_is_in_force(
    settings: RunSettings, run: Stub
):
    run.alive = True
    settings.turn("learning_rate", 0.01)
    settings.turn("reward_weights.time", -0.6)
    settings.turn("n_step", 3)
    assert run.heard == [("learning_rate", 0.01), ("reward_weights.time", -0.6)]
    assert settings.waits
    settings.undo()
    weights = replace(MODERN.reward_weights, time=-0.6)
    assert settings.asked == settings.in_force == MODERN.changed(learning_rate=0.01, reward_weights=weights)
    settings.turn("n_step", 3)
    run.alive = False
    assert not settings.waits


def test_a_preset_waits_whole_in_a_run_unless_all_of_it_is_live(settings: RunSettings, run: Stub):
    run.alive = True
    settings.load("classic")
    assert (settings.waits, settings.preset, run.heard) == (True, "classic", [])
    settings.undo()
    assert (settings.preset, settings.changed) == ("modern", False)
    settings.turn("discount", 0.8)
    settings.load("modern")
    assert run.heard == [("discount", 0.8), ("discount", MODERN.discount)]
    assert not settings.waits


def test_an_impossible_value_changes_nothing_and_is_explained(settings: RunSettings, run: Stub):
    run.alive = True
    settings.turn("learning_rate", -1.0)
    assert settings.asked == MODERN
    assert settings.problem.startswith("Learning rate lies between")
    assert not run.heard
    settings.turn("learning_rate", 0.01)
    assert settings.problem == ""
    settings.load("classic")
    settings.turn("replay_size", 500)
    assert settings.problem == "Forget at once is at most Replay, 500, not 1000"
    assert settings.asked == CLASSIC


def test_a_configuration_from_elsewhere_is_named_after_what_it_began_as(settings: RunSettings):
    settings.ask(CLASSIC.changed(discount=0.95))
    assert (settings.preset, settings.changed) == ("classic", True)
    settings.ask(sabotaged(MODERN, "no_shaping"))
    assert settings.preset == "modern"
    settings.ask(MODERN.changed(preset="somebody's"))
    assert settings.preset == "modern"
