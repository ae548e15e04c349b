"""A taste is found from answers, pays a memory anew, and brings up a network meanwhile."""

from itertools import islice

import numpy as np
import pytest

from ai.agent.n_step import NStep
from ai.lander.environment import LanderEnv, Outcome
from ai.training import upbringing as bringing_up
from ai.training.history import History
from ai.training.preferences import FIRST, NEITHER, SECOND, SUMS, PaidMemory, Paying, Taste
from ai.training.run import resume, save
from ai.training.upbringing import UPBRINGING, Asked, TasteSession, Upbringing

SMALL = UPBRINGING.changed(hidden=(8,), num_envs=32, learning_starts=64, batch_size=16, gradient_steps=1)
LIKED = np.array([0.5, 0.5, 0.5, -0.5, 3.0, -3.0, -1.0, 0.0, 0.0])


@pytest.fixture(autouse=True)
def soon(monkeypatch):
    """Ask soon, about few flights."""
    monkeypatch.setattr(bringing_up, "BEFORE", 32 * 40)
    monkeypatch.setattr(bringing_up, "EACH", 32 * 4)
    monkeypatch.setattr(bringing_up, "_STARTS", 6)
    monkeypatch.setattr(bringing_up, "_COPIES", 3)


def asked(seed=0):
    """Return an upbringing that has asked."""
    upbringing = Upbringing(SMALL, seed)
    while upbringing.question is None:
        upbringing.advance()
    return upbringing


def answered(count, wrong=0.0, ties=0.0, seed=0):
    """Return a taste that was told so often, by one who likes `LIKED`."""
    rng, taste = np.random.default_rng(seed), Taste(np.random.default_rng(seed + 1))
    differences = rng.normal(size=(count, len(SUMS)))
    worth = differences @ LIKED
    answers = np.where((worth > 0) != (rng.random(count) < wrong), FIRST, SECOND)
    taste.restore(differences, np.where(np.abs(worth) < ties, NEITHER, answers))
    return taste


def likeness(taste):
    """Return the cosine between what is believed and what is so."""
    liking = taste.weights.mean(axis=0)
    return liking @ LIKED / np.linalg.norm(liking) / np.linalg.norm(LIKED)


@pytest.mark.parametrize(("wrong", "ties", "least"), [(0.0, 0.0, 0.9), (0.1, 1.0, 0.8)])
def test_a_taste_is_found_from_forty_answers_though_some_are_wrong_and_some_cannot_be_told(wrong, ties, least):
    assert np.mean([likeness(answered(40, wrong, ties, seed)) for seed in range(3)]) > least


def test_what_is_paid_grows_with_how_far_it_is_known():
    before, few, many = (float(np.linalg.norm(answered(count).pay)) for count in (0, 5, 40))
    assert before < few < many


def test_what_all_agree_on_is_not_worth_asking():
    told = answered(40).worth_asking(np.array([np.zeros(len(SUMS)), 20 * LIKED, np.eye(len(SUMS))[-1]]))
    assert told.min() > -1e-9
    assert told[1] < told[2]


def test_sums_of_a_flight_are_what_its_ends_and_its_way_say():
    paying = Paying()
    env = LanderEnv(4, 3, "near", pay=paying)
    env.reset()
    began = np.hypot(*(env.position - env.pad - (0, env.params.stand)).T)
    sums = np.zeros((4, len(SUMS)))
    while (env.outcome == Outcome.FLYING).any():
        env.step(np.zeros(4, dtype=int))
        sums += paying.latest
    said = dict(zip(SUMS, sums.T, strict=True))
    ended = np.hypot(*(env.position - env.pad - (0, env.params.stand)).T)
    assert said["nearer"] == pytest.approx((began - ended) / 10, abs=1e-5)
    assert said["time"] == pytest.approx(env.time / 10, abs=1e-5)
    for name, outcome in (("landed", 1), ("crashed", 2), ("out", 3)):
        np.testing.assert_array_equal(said[name], env.outcome == outcome)


def test_a_memory_that_is_paid_anew_is_as_if_it_had_been_paid_so_at_once():
    rng, before, after = np.random.default_rng(5), rng_points(1), rng_points(2)
    memories, steps = [PaidMemory(500, 9) for _ in range(2)], NStep(3, 0.9)
    memories[0].pay(before)
    memories[1].pay(after)
    for _ in range(20):
        ended = rng.random(4) < 0.1
        actions, sums = rng.integers(6, size=4), rng.normal(size=(4, len(SUMS))).astype(np.float32)
        transitions, _ = steps.add(rng.normal(size=(4, 9)), actions, sums, rng.normal(size=(4, 9)), ended, ended)
        for memory in memories:
            memory.add(transitions)
    memories[0].pay(after)
    first, second = (memory.transitions.reward[: memory.size] for memory in memories)
    assert len(first) == memories[1].size
    np.testing.assert_allclose(first, second, rtol=1e-5)
    memories[0].pay(np.eye(len(SUMS))[list(SUMS).index("left")])
    assert first.sum() == pytest.approx(0.0, abs=1e-4), "to the left in the mirror is to the right"
    assert first.any()


def rng_points(seed):
    return np.random.default_rng(seed).normal(size=len(SUMS))


def test_flights_that_are_compared_begin_alike_and_are_flown_as_they_are_shown():
    upbringing = asked()
    first, second = upbringing.question
    np.testing.assert_array_equal(first.poses[0], second.poses[0])
    assert any(first.actions[: len(second.actions)].tolist() != second.actions.tolist() for _ in range(1))
    for flight in (first, second):
        assert len(flight.poses) == len(flight.actions) + 1
        assert flight.outcome != Outcome.FLYING
        ends = [flight.sums[list(SUMS).index(name)] for name in ("landed", "crashed", "out")]
        assert ends == [flight.outcome == outcome for outcome in (1, 2, 3)]


def test_it_learns_for_a_while_after_an_answer_and_rests_until_the_next():
    upbringing = asked()
    while not upbringing.resting:
        upbringing.advance()
    decisions, steps = upbringing.agent.decisions, upbringing.agent.gradient_steps
    upbringing.advance()
    assert (upbringing.agent.decisions, upbringing.agent.gradient_steps) == (decisions, steps)
    upbringing.answer(FIRST)
    upbringing.advance()
    assert upbringing.agent.decisions == decisions + 32
    assert upbringing.agent.gradient_steps > steps


def test_the_question_comes_back_with_the_answer_that_is_taken_back():
    upbringing = asked()
    question = upbringing.question
    with pytest.raises(ValueError, match="nothing"):
        upbringing.take_back()
    upbringing.answer(SECOND)
    assert upbringing.question is not question
    upbringing.take_back()
    assert upbringing.question is question
    assert not len(upbringing.taste.answers)
    np.testing.assert_array_equal(upbringing.agent.paying.points, upbringing.taste.pay)


def test_the_same_seed_and_answers_give_the_same_network():
    both = [asked(4) for _ in range(2)]
    for upbringing in both:
        upbringing.answer(FIRST)
        for _ in range(6):
            upbringing.advance()
    first, second = both
    np.testing.assert_array_equal(first.agent.network.values, second.agent.network.values)
    np.testing.assert_array_equal(first.taste.samples, second.taste.samples)


def test_answers_and_network_go_on_from_a_folder(tmp_path):
    upbringing = asked()
    upbringing.answer(FIRST)
    for _ in range(5):
        upbringing.advance()
    save(upbringing, tmp_path / "kept")
    History(TasteSession.columns).write(tmp_path / "kept")
    again = resume(Upbringing, tmp_path / "kept")
    assert not again.lost
    np.testing.assert_array_equal(again.taste.answers, [FIRST])
    np.testing.assert_array_equal(again.taste.differences, upbringing.taste.differences)
    np.testing.assert_array_equal(again.agent.network.values, upbringing.agent.network.values)
    assert not again.resting
    with pytest.raises(ValueError, match="another kind"):
        again.load_state(upbringing.state() | {"answers": np.array([9])})


def test_a_session_asks_and_takes_answers_to_what_it_asked():
    session = TasteSession.live(SMALL, 0)
    messages = [message for turn in islice(session, 200) for message in turn if isinstance(message, Asked)]
    assert messages[0].question is None
    assert messages[-1].question is not None
    [then] = [message for message in session.send(("choose", 0, FIRST)) if isinstance(message, Asked)]
    assert then.answers == 1
    assert then.liking.shape == (len(SUMS),)
    assert not [message for message in session.send(("choose", 0, FIRST)) if isinstance(message, Asked)]
    session.close()


def test_answers_given_in_a_row_are_each_learned_from():
    upbringing = asked()
    while not upbringing.resting:
        upbringing.advance()
    decisions = upbringing.agent.decisions
    for _ in range(2):
        upbringing.answer(FIRST)
    assert len(upbringing.taste.answers) == 2
    while not upbringing.resting:
        upbringing.advance()
    assert upbringing.agent.decisions == decisions + 2 * bringing_up.EACH


def test_each_start_is_asked_about_once():
    upbringing, starts = asked(), set()
    for _ in range(bringing_up.POOL):
        starts.add(upbringing.question[0].poses[0].tobytes())
        upbringing.answer(FIRST)
    assert len(starts) == bringing_up.POOL
    assert upbringing.question is None, "others are flown first"


def test_a_landing_is_remembered_to_its_last_decision():
    upbringing, decisions = Upbringing(SMALL), 0
    env = upbringing.env
    env.place(np.ones(32, bool), np.tile([0.0, env.params.pad_top + env.params.stand, 0, 0, 0, 0], (32, 1)))
    while not upbringing._landings:
        env.step(np.zeros(32, np.intp))
        upbringing._watch()
        decisions += 1
    assert all(len(actions) == decisions for _, actions in upbringing._landings)


def test_where_one_has_landed_one_does_what_it_did_and_the_others_do_not():
    upbringing = asked()
    start, actions = np.array([0.0, 5.0, 0.0, -0.3, 0.0, 0.0]), np.array([3, 0, 1, 3, 2, 0, 3])
    upbringing._landings.append((start, actions))
    pairs = upbringing._scout()[0]
    flights = [pairs[0][0], *(pair[1] for pair in pairs[:2])]
    again = [flight.actions[: len(actions)].tolist() == actions.tolist() for flight in flights]
    assert again == [False, False, True]
    assert all(flight.poses[0] == pytest.approx([0.0, 5.0, 0.0]) for flight in flights)
