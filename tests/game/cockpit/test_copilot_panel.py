import numpy as np
import pygame
import pytest

from ai.copilot.copilot import Mode
from game.core import texts
from game.drawing.canvas import Canvas
from game.explain.landings import Landing, Landings, RecentLandings
from game.flight.flight import Flight
from game.scenes.play.copilot_panel import CopilotPanel
from tests.support.drawn import Drawn, read_panel
from tests.support.reading import Weighs


class Wavers(Weighs):
    """A network that wants something else in every step that it is asked in, most of what it flies."""

    def q_values(self, observation: np.ndarray) -> np.ndarray:
        return np.sin(1e4 * observation[:, :1] * np.arange(1, 7)).astype(np.float32)


def test_the_panel_shows_what_is_flown_from_the_first_step_after_a_hand_over(subtests: pytest.Subtests):
    for before in range(8):
        with subtests.test(before=before):
            flight = Flight(3, Wavers(), shares=False)
            copilot_panel = CopilotPanel(flight.env.ground)
            for _ in range(before):
                flight.step(3)
                copilot_panel.follow(flight)
            flight.hand_over()
            seen = set()
            for _ in range(20):
                flight.step(0)
                copilot_panel.follow(flight)
                flown = flight.recording.actions[-1]
                assert copilot_panel.shown
                assert copilot_panel.values is not None
                assert copilot_panel.values.flown == np.argmax(copilot_panel.values.points) == flown
                seen.add(flown)
            assert len(seen) > 1


class Damaged(Wavers):
    """One whose values are not numbers."""

    def q_values(self, observation: np.ndarray) -> np.ndarray:
        return np.full((len(observation), 6), np.nan, np.float32)


@pytest.mark.parametrize("shares", [False, True])
def test_values_that_are_not_numbers_are_called_that_and_no_figure_is_made_up(
    shares: bool, monkeypatch: pytest.MonkeyPatch
):
    flight = Flight(3, Damaged())
    flight.help(0.5, Mode.TOLERANCE)
    if not shares:
        flight.hand_over()
    copilot_panel = CopilotPanel(flight.env.ground)
    flight.step(3)
    copilot_panel.follow(flight)
    drawn = Drawn(monkeypatch)
    copilot_panel.draw(Canvas(pygame.Surface((1280, 720))), 0.5)
    panel = read_panel(drawn)
    assert panel.expected == "–"
    assert {row.figure for row in panel.rows} == {"–"}
    assert {row.fraction for row in panel.rows} == {0.0}
    assert set(texts.VALUES_DAMAGED) <= set(drawn.words)


def test_rows_that_are_not_known_anew_stay_for_half_a_second():
    unknown, recent = (Landing.UNKNOWN,) * 6, RecentLandings()
    first = Landings((Landing.LOST, *unknown[1:]), (0, Landing.LOST), 3, 0.1)
    assert recent.fill(first) == first
    assert first.coasting == (0.1, False)
    assert Landings((Landing.LANDS, *unknown[1:]), (0, Landing.LANDS), 3, 0.8).coasting == (0.8, True)
    assert Landings(unknown, (0, Landing.UNKNOWN), 3, 0.8).coasting is None
    later = Landings((Landing.UNKNOWN, Landing.LANDS, *unknown[2:]), (1, Landing.LANDS), 1, 0.1)
    assert recent.fill(later).after == (Landing.LOST, Landing.LANDS, *unknown[2:])
    shown = [recent.fill(Landings(unknown, (2, Landing.UNKNOWN), 1, 0.1)).after[:2] for _ in range(8)]
    assert shown[:7] == [(Landing.LOST, Landing.LANDS)] * 7
    assert shown[7] == (Landing.UNKNOWN, Landing.LANDS)
