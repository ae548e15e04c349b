import pytest

from game.core.clock import TimeScale


def test_at_its_own_pace_every_update_is_a_step():
    pace = TimeScale()
    assert all(pace.steps() == 1 for _ in range(100))
    assert pace.between(0.4) == 0.4


def test_slow_motion_takes_about_a_second_for_a_third_of_the_steps_and_then_is_over():
    pace = TimeScale()
    pace.slow_down()
    steps = updates = 0
    while pace.slow:
        steps += pace.steps()
        updates += 1
    assert 45 <= updates <= 75
    assert 0.3 < steps / updates < 0.65
    pace.slow_down()
    pace.steps()
    pace.hurry()
    assert not pace.slow
    assert all(pace.steps() == 1 for _ in range(50))


def test_a_picture_never_runs_backward():
    """The moment that is drawn, in steps, grows from picture to picture."""
    pace = TimeScale()
    pace.slow_down()
    steps, last = 1, 0.0  # it begins with a step, that of the crash
    for update in range(120):
        steps += pace.steps() if update else 0
        for alpha in (0.0, 0.5, 0.99):
            moment = steps - 1 + pace.between(alpha)
            assert moment >= last - 1e-9
            last = moment
    assert last == pytest.approx(steps - 0.01)


def test_the_players_own_pace_holds_for_as_long_as_it_is_wished():
    pace = TimeScale(0.5)
    assert sum(pace.steps() for _ in range(200)) == 100
    pace.rate = 1.0
    assert all(pace.steps() == 1 for _ in range(10))
    assert pace.between(0.4) == 0.4
