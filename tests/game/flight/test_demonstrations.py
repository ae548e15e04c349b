from pathlib import Path

import numpy as np
import pytest

from ai.lander.pilots import ScriptedPilot
from ai.training.config import Config
from ai.training.demonstrations import read, relive
from game.flight.demonstrations import FILE_NAME, add_demonstration, count_demonstrations
from game.flight.flight import Flight, StickHolder


def flown_by_hand(seed: int, pads: int = 1, network_until: int = 0) -> Flight:
    """A flight in which a good pilot presses the keys, after a network has had the stick for a while."""
    flight, pilot = Flight(seed, ScriptedPilot(), pads=pads), ScriptedPilot()
    if network_until:
        flight.hand_over()
    while not flight.over:
        if len(flight.recording.actions) == network_until and flight.hand is StickHolder.NETWORK:
            flight.hand_over()
        flight.step(int(pilot.act(flight.env.observe())[0]))
    return flight


@pytest.mark.parametrize(("pads", "network_until"), [(1, 0), (3, 0), (1, 120)])
def test_a_good_landing_is_kept_and_can_be_learnt_from(tmp_path: Path, pads: int, network_until: int):
    kept = sum(add_demonstration(flown_by_hand(seed, pads, network_until), tmp_path) for seed in (20, 21))
    assert kept == count_demonstrations(tmp_path) > 0
    for lesson in read(tmp_path / FILE_NAME):
        assert lesson.begins == network_until
        cells = relive(lesson, Config())
        assert cells is not None
        assert np.isfinite(cells.reward).all()


def test_a_crash_or_a_landing_of_the_networks_teaches_nothing(tmp_path: Path):
    crash = Flight(3)
    while not crash.over:
        crash.step(0)
    assert not add_demonstration(crash, tmp_path)
    landed = flown_by_hand(20, network_until=10_000)
    assert not add_demonstration(landed, tmp_path)
    assert count_demonstrations(tmp_path) == 0


def test_a_damaged_file_of_examples_is_left_as_it_is(tmp_path: Path):
    (tmp_path / FILE_NAME).write_text("{")
    flight = next(f for f in map(flown_by_hand, range(20, 26)) if f.env.landed_on[0] == 0)
    with pytest.raises(ValueError, match=FILE_NAME):
        add_demonstration(flight, tmp_path)
    assert (tmp_path / FILE_NAME).read_text() == "{"
    assert count_demonstrations(tmp_path) == 0
