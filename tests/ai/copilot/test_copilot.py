from types import SimpleNamespace

import numpy as np
import pytest

from ai.copilot.copilot import GUARDIAN_MARGIN, CoPilot, Mode
from ai.copilot.guardian import ActionSource
from ai.lander.pilots import COAST


def valuer(*rows):
    """An agent that has these opinions of its observations, in turn."""
    return SimpleNamespace(q_values=lambda observation: np.array(rows, dtype=np.float32).reshape(len(observation), 6))


def seen(count=1, pads=None):
    return np.zeros((count, 9) if pads is None else (count, pads, 9), dtype=np.float32)


def by_the_book(values, pilot, assist):
    """The rule of one decision as the paper has it."""
    above = values - values.min()
    alpha = 0.0 if pilot == COAST else 1.0 - assist
    best = int(above.argmax())
    for action in (pilot, pilot // 3 * 3 + best % 3, best // 3 * 3 + pilot % 3, best):
        if above[action] >= (1.0 - alpha) * above.max():
            return action
    raise AssertionError


def test_tolerance_is_the_rule_of_the_paper():
    rng = np.random.default_rng(0)
    values, pilot = rng.normal(size=(500, 6)).astype(np.float32), rng.integers(0, 6, 500)
    for assist in (0.0, 0.25, 0.5, 0.75, 1.0):
        action, overridden = CoPilot(valuer(values), assist).share(seen(500), pilot)
        expected = [by_the_book(v, p, assist) for v, p in zip(values, pilot, strict=True)]
        np.testing.assert_array_equal(action, expected, err_msg=str(assist))
        np.testing.assert_array_equal(overridden, action != pilot)


def test_the_pilot_keeps_as_much_as_is_safe():
    for values, pilot, action, rule in (
        ((0, 0, 0, 9, 10, 0), 3, 3, ActionSource.PILOT),
        ((0, 0, 0, 0, 10, 0), 3, 4, ActionSource.PILOT_MAIN),
        ((0, 0, 0, 0, 10, 0), 1, 4, ActionSource.PILOT_STEER),
        ((0, 0, 0, 0, 10, 0), 2, 4, ActionSource.COPILOT),
        ((0, 0, 0, 0, 10, 0), 0, 4, ActionSource.HANDS_OFF),
        ((10, 0, 0, 0, 0, 0), 0, 0, ActionSource.PILOT),
    ):
        decision = CoPilot(valuer(values), 0.8).decide(seen(), [pilot])
        assert (decision.action[0], decision.source[0]) == (action, rule), rule


@pytest.mark.parametrize("mode", Mode)
def test_either_rule_leaves_what_is_good_enough_and_corrects_the_rest(mode):
    rng = np.random.default_rng(1)
    values, pilot = rng.normal(size=(50, 6)), rng.integers(1, 6, 50)
    action, overridden = CoPilot(valuer(values), 0.0, mode).share(seen(50), pilot)
    np.testing.assert_array_equal(action, pilot, "assist of nothing flies what is pressed")
    assert not overridden.any()
    action, _ = CoPilot(valuer(values), 1.0, mode).share(seen(50), pilot)
    np.testing.assert_array_equal(action, values.argmax(axis=1), "full assist flies the best")
    ruined = CoPilot(valuer(np.full((6, 6), np.nan)), 1.0, mode)
    action, overridden = ruined.share(seen(6), np.arange(6))
    np.testing.assert_array_equal(action, np.arange(6), "a ruined network leaves the stick to the pilot")
    assert not overridden.any()


@pytest.mark.parametrize("mode", Mode)
def test_of_several_pads_what_harms_on_the_way_to_every_one_is_overridden(mode):
    left, right = (0, 1, -1, 0, 1, -1), (0, -1, 1, 0, -1, 1)
    copilot = CoPilot(valuer(left, right), 0.9, mode)
    for pilot in (1, 2):  # pads ask for different things
        action, overridden = copilot.share(seen(1, 2), [pilot])
        assert (action[0], overridden[0]) == (pilot, False)
    left, right = (-3, -3, -3, 0, 2, 1), (-3, -3, -3, 0, 1, 2)
    action, overridden = CoPilot(valuer(left, right), 0.9, mode).share(seen(1, 2), [1])
    assert action[0] >= 3
    assert overridden[0]


LEFT, RIGHT = (0, 0.02, -0.02, 0, 0.02, -0.02), (0, -0.02, 0.02, 0, -0.02, 0.02)


def test_a_pilot_who_heads_for_one_pad_is_understood():
    copilot = CoPilot(valuer(LEFT, RIGHT), 0.9, "guardian")
    first = copilot.decide(seen(1, 2), [1])
    assert first.likely.shape == (1, 2)
    for _ in range(30):
        copilot.share(seen(1, 2), [1])
    decision = copilot.decide(seen(1, 2), [2])  # now that the left one is meant, this must be a slip
    assert decision.likely[0, 0] > 0.9
    assert decision.action[0] == 1
    copilot.forget()
    assert copilot.decide(seen(1, 2), [2]).action[0] == 2


def test_only_the_slots_asked_for_are_forgotten():
    copilot = CoPilot(valuer(LEFT, RIGHT, LEFT, RIGHT), 0.9)
    for _ in range(30):
        copilot.share(seen(2, 2), [1, 1])
    copilot.forget(np.array([True, False]))
    likely = copilot.decide(seen(2, 2), [COAST, COAST]).likely
    assert likely[0].tolist() == [0.5, 0.5]
    assert likely[1, 0] > 0.9


def test_hands_off_flies_to_the_likeliest_pad_or_to_the_nearest():
    copilot = CoPilot(valuer(LEFT, RIGHT), 0.2)
    observation = seen(1, 2)
    observation[0, :, 0] = (3.0, -1.0)
    assert copilot.share(observation, [COAST])[0][0] % 3 == 2
    for _ in range(30):
        copilot.share(observation, [1])
    assert copilot.share(observation, [COAST])[0][0] % 3 == 1


def test_the_margin_of_the_guardian_falls_with_assist_and_is_in_points_of_reward():
    rng = np.random.default_rng(3)
    values, pilot = rng.normal(scale=0.1, size=(1000, 6)), rng.integers(1, 6, 1000)
    shares = [
        CoPilot(valuer(values), assist, "guardian").share(seen(1000), pilot)[1].mean()
        for assist in (0.0, 0.2, 0.5, 0.8, 1.0)
    ]
    assert shares == sorted(shares)
    assert shares[0] == 0.0
    assert shares[-1] > 0.8
    for scale, points in ((1.0, 4.0), (0.01, 400.0), (2.0, 2.0)):
        copilot = CoPilot(valuer((0, 0, 0, 4, 0, 0)), 0.5, "guardian")
        copilot.reward_scale = scale
        assert copilot.share(seen(), [1])[1][0] == (points > GUARDIAN_MARGIN)


def test_what_makes_no_sense_is_refused():
    copilot = CoPilot(valuer(np.zeros(6)))
    with pytest.raises(ValueError, match="assist runs from 0 to 1"):
        copilot.assist = 1.5
    with pytest.raises(ValueError, match="guard"):
        CoPilot(valuer(np.zeros(6)), 0.5, "guard")
    with pytest.raises(ValueError, match="0 to 5"):
        copilot.share(seen(), [6])
    with pytest.raises(ValueError, match="whole numbers"):
        copilot.share(seen(), [1, 2])
