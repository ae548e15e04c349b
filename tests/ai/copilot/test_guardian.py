"""The guardian's rule, given what a safety critic says."""

from types import SimpleNamespace

import numpy as np
import pytest

from ai.copilot.copilot import ActionSource, CoPilot, Mode
from ai.copilot.guardian import HAND_BACK, SUREST, required_chance

DIAL = 0.4
REQUIRED = float(required_chance(DIAL))
SAFE, LOST = 0.9999, 0.2


def flying(best=4):
    """An agent to whom one action is worth the most."""
    values = np.zeros(6, np.float32)
    values[best] = 1.0
    return SimpleNamespace(q_values=lambda observation: np.tile(values, (len(observation), 1)))


def foretelling(*rows):
    """A critic that gives these chances of the observations, in turn, until it is told others."""
    critic = SimpleNamespace(rows=rows)
    critic.chances = lambda observation, surroundings=None: np.array(critic.rows, np.float32).reshape(-1, 6)
    return critic


def row(**chances):
    """Chances of the six actions: safe, unless said otherwise by a0 to a5."""
    said = np.full(6, SAFE)
    for name, chance in chances.items():
        said[int(name[1])] = chance
    return said


def guardian(*rows, assist=DIAL, best=4):
    return CoPilot(flying(best), assist, Mode.GUARDIAN, critic=foretelling(*rows))


def seen(slots=1, pads=1):
    return np.zeros((slots, pads, 9), np.float32)


def test_the_stick_is_the_pilots_while_the_flight_can_be_saved_and_then_as_little_as_helps_is_changed(subtests):
    for chances, pilot, action, source in [
        (row(), 2, 2, ActionSource.PILOT),
        (row(a2=REQUIRED), 2, 2, ActionSource.PILOT),
        (row(), 0, 0, ActionSource.PILOT),  # who asks for nothing gets it, while that is safe
        (row(a3=LOST), 3, 4, ActionSource.PILOT_MAIN),  # steering alone
        (row(a2=LOST, a1=LOST), 2, 5, ActionSource.PILOT_STEER),  # engine alone
        (row(a2=LOST, a1=LOST, a5=LOST), 2, 4, ActionSource.COPILOT),
        (row(a0=LOST, a1=LOST, a3=LOST), 0, 4, ActionSource.COPILOT),
    ]:
        with subtests.test(chances=chances, pilot=pilot, action=action, source=source):
            decision = guardian(chances).decide(seen(), [pilot])
            assert (decision.action[0], decision.source[0]) == (action, source)
            assert decision.chance[0] == pytest.approx(chances[pilot])
            assert decision.chances[0, decision.action[0]] == pytest.approx(chances[action])
            assert decision.feasible[0, action]
            assert decision.required[0] == pytest.approx(REQUIRED)


def test_where_nothing_is_safe_enough_the_best_of_the_four_is_flown():
    decision = guardian(np.array([0.1, 0.2, 0.1, 0.3, 0.5, 0.4])).decide(seen(), [2])
    assert decision.action[0] == 4
    decision = guardian(np.array([0.1, 0.2, 0.1, 0.3, 0.5, 0.6])).decide(seen(), [2])
    assert decision.action[0] == 5  # the pilot's steering with the engine is better still


@pytest.mark.parametrize("assist", [0.0, 0.1, 0.4, 0.8, 1.0])
def test_the_dial_says_what_is_asked_for(assist):
    required = required_chance(assist)
    assert 0.0 <= required <= 1.0
    just, less = (
        guardian(row(a2=chance), assist=assist).share(seen(), [2])[1][0]
        for chance in (required + 1e-6, max(0.0, required - 0.01))
    )
    assert not just
    assert less == (assist > 0.02)


def test_more_help_asks_for_more():
    assert (np.diff(required_chance(np.linspace(0.0, 1.0, 21))) >= 0).all()
    assert required_chance(0.0) == 0.0
    assert required_chance(0.4) == pytest.approx(0.99)


def test_a_guardian_that_has_stepped_in_gives_the_stick_back_when_that_is_safer():
    copilot = guardian(row(a3=LOST))
    assert copilot.share(seen(), [3])[1][0]
    halved = 1.0 - 0.5 * (1.0 - REQUIRED)  # after one rescue it accepts half the risk
    back = 1.0 - HAND_BACK * (1.0 - halved)
    for chance, kept in (
        (REQUIRED + 0.001, True),
        (back - 0.001, True),
        (back + 0.001, False),
        (halved + 0.001, False),
    ):
        copilot.critic.rows = (row(a3=chance),)
        assert copilot.share(seen(), [3])[1][0] == kept


def test_with_every_rescue_it_accepts_half_the_risk_but_never_asks_for_more_than_can_be_known():
    copilot = guardian(row())
    for rescues in range(12):
        copilot.critic.rows = (row(),)
        for _ in range(80):  # gives the stick back
            copilot.share(seen(), [3])
        asked = copilot.decide(seen(), [3]).required[0]
        assert asked == pytest.approx(min(1.0 - (1.0 - REQUIRED) * 0.5**rescues, SUREST))
        copilot.critic.rows = (row(a3=LOST),)
        assert copilot.share(seen(), [3])[1][0]
    copilot.forget()
    copilot.critic.rows = (row(),)
    assert copilot.decide(seen(), [3]).required[0] == pytest.approx(REQUIRED)


def test_flights_are_remembered_apart():
    copilot = guardian(row(a3=LOST), row())
    assert copilot.share(seen(2), [3, 3])[1].tolist() == [True, False]
    asked = copilot.decide(seen(2), [3, 3]).required
    assert asked[0] > asked[1]
    copilot.forget(np.array([True, False]))
    assert copilot.decide(seen(2), [3, 3]).required.tolist() == pytest.approx([REQUIRED, REQUIRED])


def test_of_several_pads_one_where_the_flight_can_be_saved_is_enough():
    lost = np.full(6, LOST)
    assert not guardian(lost, row()).share(seen(1, 2), [3])[1][0]
    assert not guardian(row(), lost).share(seen(1, 2), [3])[1][0]
    assert guardian(row(a3=LOST), lost).share(seen(1, 2), [3])[0][0] == 4


def test_among_hills_it_steps_in_only_where_another_action_is_much_better():
    """The network itself may miss a narrow pad: what the dial asks for is then out of reach, whatever is done."""
    best = 0.96
    for chance, kept in ((1.0 - 1.4 * (1.0 - best), False), (1.0 - 1.6 * (1.0 - best), True)):
        rows = np.full(6, best)
        rows[3] = chance
        assert guardian(rows, rows).share(seen(1, 2), [3])[1][0] == kept
        assert guardian(rows).share(seen(), [3])[1][0]  # over a plain, what is asked for can be reached


def test_where_no_pad_that_is_meant_can_be_reached_another_will_do():
    """A pilot who heads for the first pad until it is lost; the second lies below."""
    copilot = guardian(row(), row(), best=4)
    copilot.agent = SimpleNamespace(q_values=lambda _: np.array([[0, 0, 9, 0, 0, 0], [9, 0, 0, 0, 0, 0.0]], np.float32))
    for _ in range(40):
        decision = copilot.decide(seen(1, 2), [2])
    assert decision.likely[0, 0] > 0.9
    copilot.critic.rows = (np.full(6, LOST), row(a2=LOST))
    decision = copilot.decide(seen(1, 2), [2])
    assert decision.action[0] == 0  # the way to the second pad
    assert decision.chances[0, 0] == pytest.approx(SAFE)


def test_what_the_critic_cannot_judge_stays_the_pilots():
    decision = guardian(np.full(6, np.nan)).decide(seen(), [2])
    assert decision.action[0] == 2
    assert not decision.overridden[0]


def test_without_a_critic_the_values_guard_and_the_reason_is_said():
    copilot = CoPilot(flying(), DIAL, Mode.GUARDIAN)
    decision = copilot.decide(seen(), [2])
    assert copilot.critic is None
    assert copilot.critic_problem
    assert decision.chances is None
    assert decision.chance is None


def test_tolerance_asks_no_critic():
    copilot = CoPilot(flying(), 0.9, Mode.TOLERANCE, critic=foretelling(row()))
    decision = copilot.decide(seen(), [2])
    assert decision.action[0] == 4
    assert decision.chances is None
