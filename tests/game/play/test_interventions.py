"""How often a co-pilot stepped in, whether a guardian watched over all of a flight, and what is said of it."""

from types import SimpleNamespace

import numpy as np
import pytest

from game.scenes.play import interventions
from game.scenes.play.interventions import Interventions


def follow(shown: Interventions, assist: float | None, *, changed: bool = False) -> None:
    """Follow a step under a guardian with that assist, or under none."""
    guarded, decision = assist is not None, SimpleNamespace(assist=assist)
    flight = SimpleNamespace(
        decision=decision, shared=guarded, guarded=guarded, guard=None, overridden=changed,
        env=SimpleNamespace(position=np.zeros((1, 2))),
    )  # fmt: skip
    shown.follow(flight)


@pytest.fixture(autouse=True)
def wordless(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(interventions, "changed_by", lambda _: "changed")
    monkeypatch.setattr(interventions, "is_late", lambda _: False)


def test_changes_within_a_second_of_each_other_are_one_intervention():
    shown = Interventions()
    for changed in [False] * 90 + [True] * 4 + [False] * 90 + [True] * 4 + [False] * 20 + [True] * 4:
        follow(shown, 0.4, changed=changed)
    assert len(shown.moments) == 2


def test_a_guardian_counts_only_if_it_watched_over_the_whole_flight_alike():
    for assists, throughout in (
        ([0.4, 0.4, 0.4], 0.4),
        ([0.4, 0.5, 0.5], 0.0),
        ([None, 0.4], 0.0),
        ([0.4, None, 0.4], 0.0),
    ):
        shown = Interventions()
        for assist in assists:
            follow(shown, assist)
        assert shown.throughout == throughout, assists


def test_that_a_guardian_is_late_is_said_only_if_it_stays_late(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(interventions, "is_late", lambda _: True)
    shown, words = Interventions(), []
    for _ in range(4):
        follow(shown, 0.4, changed=True)
        words.append(shown.word)
    assert words == ["", "", "changed", "changed"]
