"""A guardian's rescues, and whether it watched over all of a flight."""

from types import SimpleNamespace

import pytest

from game.flight.rescues import Rescues


def test_a_rescue_is_counted_only_where_the_pilots_action_was_changed():
    decision = SimpleNamespace(assist=0.4)
    rescues = Rescues()
    for changed in [False] * 90 + [True] * 4 + [False] * 90 + [True] * 4 + [False] * 20 + [True] * 4:
        rescues.follow(SimpleNamespace(decision=decision, shared=True, guarded=True, guard=None, overridden=changed))
    assert rescues.times == 2  # within a second of each other they are the same one


@pytest.mark.parametrize(
    ("assists", "throughout"),
    [([0.4, 0.4, 0.4], 0.4), ([0.4, 0.5, 0.5], 0.0), ([None, 0.4], 0.0), ([0.4, None, 0.4], 0.0)],
)
def test_a_guardian_counts_only_if_it_watched_over_the_whole_flight_alike(
    assists: list[float | None], throughout: float
):
    rescues = Rescues()
    for assist in assists:
        decision, guarded = SimpleNamespace(assist=assist), assist is not None
        rescues.follow(
            SimpleNamespace(decision=decision, shared=guarded, guarded=guarded, guard=None, overridden=False)
        )
    assert rescues.throughout == throughout
