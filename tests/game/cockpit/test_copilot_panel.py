import numpy as np
import pygame
import pytest

from ai.lander.environment import Cause, Outcome
from ai.lander.push import KEYS
from game.core import texts
from game.drawing.canvas import Canvas
from game.explain.readouts import FELT, Readout, at_touch, flight_readouts
from game.flight.flight import Flight
from game.flight.outcomes import cause_of, outcome_card, struck_side
from game.scenes.play.copilot_panel import CopilotPanel
from tests.support.drawn import Drawn, read_panel
from tests.support.flights import begun
from tests.support.reading import Weighs


class Wavers(Weighs):
    """A network that wants something else in every step that it is asked in, most of what it flies."""

    def q_values(self, observation: np.ndarray) -> np.ndarray:
        return np.sin(1e4 * observation[:, :1] * np.arange(1, 7)).astype(np.float32)


def test_the_panel_shows_what_is_flown_from_the_first_step_after_a_hand_over():
    for before in range(8):
        flight = begun(3, Wavers(), shares=False)
        copilot_panel = CopilotPanel()
        for _ in range(before):
            flight.step(KEYS[3])
            copilot_panel.follow(flight)
        flight.chooser.hand_over()
        seen = set()
        for _ in range(20):
            flight.step()
            copilot_panel.follow(flight)
            flown = flight.recording.pushes[-1].action
            assert copilot_panel.shown
            assert copilot_panel.values.flown == np.argmax(copilot_panel.values.points) == flown, before
            seen.add(flown)
        assert len(seen) > 1


class Damaged(Wavers):
    """One whose values are not numbers."""

    def q_values(self, observation: np.ndarray) -> np.ndarray:
        return np.full((len(observation), 6), np.nan, np.float32)


def test_values_that_are_not_numbers_are_called_that_and_no_figure_is_made_up(monkeypatch: pytest.MonkeyPatch):
    flight = begun(3, Damaged())
    flight.chooser.hand_over()
    copilot_panel = CopilotPanel()
    flight.step(KEYS[3])
    copilot_panel.follow(flight)
    drawn = Drawn(monkeypatch)
    copilot_panel.draw(Canvas(pygame.Surface((1280, 720))))
    panel = read_panel(drawn)
    assert panel.expected == "–"
    assert {row.figure for row in panel.rows} == {"–"}
    assert {row.fraction for row in panel.rows} == {0.0}
    assert set(texts.VALUES_DAMAGED) <= set(drawn.words)


# The reason of a crash names what was beyond its limit, and the read-outs mark the same.

FIGURES = {cause: name for cause, (name, _) in FELT.items()}


def dropped(start: tuple[float, ...]) -> tuple[Flight, dict[str, Readout]]:
    """Let a craft fall from a start; return its flight, and the read-outs that stay at the end."""
    flight, last = begun(1), dict[str, Readout]()
    flight.env.place(np.ones(1, bool), np.array([start]))
    while not flight.over:
        last = flight_readouts(flight.env)
        flight.step()
    return flight, at_touch(last, flight.env)


def test_every_crash_has_a_marked_figure_that_agrees_with_its_reason():
    rng, seen = np.random.default_rng(0), 0
    for _ in range(40):
        pad = begun(1).env.ground.pads[0]
        aside = rng.choice([-1, 1]) * (pad.width / 2 + rng.uniform(-0.5, 2.0))
        flight, readouts = dropped((
            pad.x + aside, pad.top + rng.uniform(2, 5), rng.uniform(-3, 3), -rng.uniform(0, 5),
            rng.uniform(-0.6, 0.6), rng.uniform(-1, 1),
        ))  # fmt: skip
        cause = cause_of(flight.env)
        if flight.outcome is not Outcome.CRASHED or flight.intact or cause not in FIGURES:
            continue
        seen += 1
        if struck_side(flight.env):
            assert not all(readouts[name].within for name in ("descent", "drift"))
        else:
            named = readouts[FIGURES[cause]]
            assert named.within is False
            if cause is not Cause.TILTED:
                figure = float(outcome_card(flight.env).reason.split("at ")[-1].split()[0])
                assert float(named.figure) == pytest.approx(figure, abs=0.051)
    assert seen > 20


def test_one_that_tipped_over_came_down_as_fast_as_its_read_out_says():
    pad = begun(1).env.ground.pads[0]
    flight, readouts = dropped((pad.x, pad.top + 4, 0.0, -4.0, 1.5, 1.5))
    card = outcome_card(flight.env)
    assert cause_of(flight.env) is Cause.TILTED
    assert f"at {readouts['descent'].figure} m/s" in card.reason


def test_a_landing_and_a_soft_touch_mark_nothing():
    pad = begun(1).env.ground.pads[0]
    for x in (pad.x, pad.x + pad.width):
        flight, readouts = dropped((x, pad.top + 1.5, 0.0, -0.2, 0.0, 0.0))
        assert not flight.wrecked
        assert all(readouts[name].within for name in FIGURES.values())
