"""The guardian's rule: what passes, what is corrected, and that nobody can crash a flight while a plan is held."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from ai.agent.agent import DeepQAgent
from ai.copilot.copilot import CoPilot, Mode
from ai.copilot.futures import Future, Here, Lookahead, Plan
from ai.copilot.guardian import Guardian, decisions_of
from ai.lander.conditions import Conditions
from ai.lander.environment import LIMITS, LanderEnv, Outcome
from ai.lander.push import KEYS, Push
from game.core.assets import MODELS_DIR

HERE = Here(0, (0.0,) * 6)
COAST, LEFT, RIGHT, MAIN, MAIN_LEFT, MAIN_RIGHT = KEYS
GUARD, GUIDE = 0.04, 0.64
STARTS = (
    (0.4, 3.2, 0.2, -0.5, 0.1, 0.0),
    (-0.8, 3.3, 0.0, -0.4, -0.1, 0.1),
    (1.0, 3.2, -0.3, -0.6, 0.0, 0.0),
    (0.0, 3.4, 0.0, -0.7, 0.0, 0.0),
)


@pytest.fixture(scope="module")
def agent():
    return DeepQAgent.load(MODELS_DIR / "lander" / "modern")


def plan(*pushes, begin=0):
    """A plan that begins here with these pushes."""
    return Plan(begin, 0, np.array([push.shares for push in pushes]), np.zeros((len(pushes) + 1, 6)))


def lands(*pushes, lasts=True):
    return {push: Future(plan(push), lasts) for push in pushes}


def choice(asked, known, held=None, network=COAST, **options):
    """What is chosen, whose that is, and what the plan that is held then begins with."""
    guardian = Guardian()
    guardian.plan = held
    chosen = guardian.choose(HERE, asked, network, known, **options)
    assert chosen.held == (guardian.plan is not None)
    assert not chosen.held or guardian.plan.push(HERE) == chosen.push
    return chosen.push, chosen.source.name


def test_the_least_is_corrected_that_lands():
    main_held, stick = plan(MAIN_LEFT), Push.of(0.5, 1.0)
    cases = (
        ("what lands passes", RIGHT, lands(RIGHT), main_held, (RIGHT, "PILOT")),
        ("what the held plan begins with needs no future", MAIN_LEFT, {}, main_held, (MAIN_LEFT, "PILOT")),
        ("steering first", RIGHT, lands(LEFT, MAIN_RIGHT), main_held, (LEFT, "PILOT_MAIN")),
        ("then the main engine", RIGHT, lands(MAIN_RIGHT), main_held, (MAIN_RIGHT, "PILOT_STEER")),
        ("else the plan flies on", RIGHT, lands(COAST, MAIN), main_held, (MAIN_LEFT, "COPILOT")),
        ("nothing known in time", RIGHT, {}, main_held, (MAIN_LEFT, "COPILOT")),
        ("landing once is not enough", RIGHT, lands(RIGHT, lasts=False), main_held, (MAIN_LEFT, "COPILOT")),
        ("shares are kept", stick, lands(Push.of(0.5, -1.0)), main_held, (Push.of(0.5, -1.0), "PILOT_MAIN")),
        ("without a plan, any that lands", RIGHT, lands(MAIN), None, (MAIN, "COPILOT")),
        ("and rather one that lasts", RIGHT, lands(RIGHT, lasts=False) | lands(MAIN), None, (MAIN, "COPILOT")),
        ("but one that does not will do", RIGHT, lands(RIGHT, MAIN, lasts=False), None, (RIGHT, "PILOT")),
        ("nothing lands: the pilot flies", RIGHT, {}, None, (RIGHT, "PILOT")),
    )  # fmt: skip
    for what, asked, known, held, (push, source) in cases:
        assert choice(asked, known, held) == (push, source), what
    asked = choice(stick, lands(MAIN_LEFT), plan(LEFT), whole=True)
    assert asked == (MAIN_LEFT, "PILOT_MAIN")


def held_keys(saved_each, most=400, length=30, sooner=None, keys=(LEFT,)):
    """Press keys in turn, which land as late but in one decision, and are saved in each so many of them.

    Returns the steps flown, and in how many decisions in a row a key was felt at most.
    """
    guardian, steps, felt, longest = Guardian(), 0, 0, 0
    guardian.plan = plan(*(MAIN,) * length)
    while steps < 4 * most and guardian.plan.push(here := HERE._replace(steps=steps)):
        key = keys[steps // 4 % len(keys)]
        later = plan(key, *(MAIN,) * (10 if steps // 4 == sooner else length), begin=steps)
        known = {key: Future(None if steps // 4 % saved_each == 0 else later)}
        push = guardian.choose(here, key, COAST, known).push
        felt = felt + 1 if push == key else 0
        longest, steps = max(longest, felt), steps + 4
    return steps, longest


def test_held_keys_put_the_landing_off_for_three_seconds_and_no_longer():
    first = 4 * 30  # steps flown when the plan lands that was held at the first correction
    for saved_each in (2, 3, 6, 12):
        assert first + 160 < held_keys(saved_each)[0] <= first + 180, saved_each
    soonest = 4 * 16  # pushed in its fifth decision, it lands after eleven
    assert soonest + 160 < held_keys(3, sooner=5)[0] <= soonest + 180
    steps, felt = held_keys(30, keys=(LEFT, RIGHT))
    assert steps == 4 * 400, "who presses another key, and is seldom corrected, flies on"
    assert felt == 29


def test_it_asks_for_no_more_futures_than_it_needs():
    guardian = Guardian()
    guardian.plan = plan(MAIN_LEFT)
    for asked, needed in (
        (MAIN_LEFT, []),
        (RIGHT, [RIGHT, LEFT, MAIN_RIGHT]),
        (MAIN, [MAIN]),  # corrected, either way it is the held plan's
    ):
        assert guardian.needs(HERE, asked) == needed, asked
    guardian.plan = None
    assert set(guardian.needs(HERE, RIGHT)) == {*KEYS}


def test_the_dial_goes_from_one_decision_to_twelve():
    assert [decisions_of(assist) for assist in (0.0, GUARD, GUIDE, 1.0)] == [1, 1, 8, 12]


def flights(count, **rules):
    """Landers just above the pad, with little time, so that flights and their futures are short."""
    env = LanderEnv(count, 0, limits=replace(LIMITS, time=4.5), **rules)
    env.reset()
    env.place(np.ones(count, bool), np.array(STARTS[:count]))
    return env


def guarded(agent, env, ask, assist=GUARD):
    """Fly guarded; return overridden decisions, and whether a plan was ever held, (n,)."""
    copilot = CoPilot(agent, assist, Mode.GUARDIAN)
    overridden, held = np.zeros(env.num_envs, int), np.zeros(env.num_envs, bool)
    while (flying := env.outcome == Outcome.FLYING).any():
        decision = copilot.decide(env.observe(), ask(env, copilot), env=env)
        overridden += decision.overridden & flying
        held |= decision.held & flying
        env.fly(decision.action, decision.shares)
    return overridden, held


@pytest.mark.slow
def test_no_hand_can_crash_a_flight_while_a_plan_is_held(agent):
    rng = np.random.default_rng(0)

    def adversary(env, copilot):
        passes = copilot.futures(env).lasts
        rank = np.where(passes | ~passes.any(axis=1, keepdims=True), rng.random(passes.shape), np.inf)
        return rank.argmin(axis=1)

    cases = (("held right", lambda env, _: np.full(1, 2), GUARD), ("an adversary", adversary, GUIDE))
    for what, ask, assist in cases:
        env = flights(1)
        _, held = guarded(agent, env, ask, assist)
        assert held.all(), what
        assert (env.outcome == Outcome.LANDED).all(), what


@pytest.mark.slow
def test_whoever_flies_with_a_weak_stick_and_by_share_alone_is_as_safe(agent):
    env, copilot = flights(1), CoPilot(agent, GUARD, "guardian")
    weak = np.tile([0.4, -1.0], (1, 1))
    while (env.outcome == Outcome.FLYING).any():
        action, overridden = copilot.share(env.observe(), np.full(1, 4), None, weak, env)
        flown = np.array([KEYS[a].shares for a in action])
        env.fly(action, np.where(overridden[:, None], flown, weak))
    assert (env.outcome == Outcome.LANDED).all()


def test_what_is_asked_for_where_all_lands_is_flown_and_what_the_network_asks_for_never_changed(agent):
    env = flights(4)
    overridden, _ = guarded(agent, env, lambda env, _: agent.act(env.observe(), held=env.actions))
    assert overridden.sum() == 0


def test_the_dial_at_nothing_never_acts(agent, monkeypatch):
    monkeypatch.setattr(Lookahead, "plans", lambda *_: pytest.fail("a future was flown"))
    env = flights(3)
    overridden, _ = guarded(agent, env, lambda env, _: np.full(3, 1), 0.0)
    assert overridden.sum() == 0


def test_a_network_that_does_not_land_never_seizes_the_stick():
    upwards = SimpleNamespace(
        q_values=lambda seen: np.tile(np.arange(6.0), (len(seen), 1)),
        act=lambda seen, *, held=None: np.full(len(seen), 3),
    )
    env, copilot = flights(1), CoPilot(upwards, GUARD, Mode.GUARDIAN)
    for _ in range(6):
        decision = copilot.decide(env.observe(), [1], env=env)
        assert not decision.overridden[0]
        env.fly(decision.action, decision.shares)


def test_a_plan_is_void_under_other_rules(agent):
    def change_gravity(env):
        env.world.gravity = 1.05 * env.world.gravity

    def change_wind(env):
        env.conditions = Conditions(wind=0.05)

    def change_ground(env):
        env.ground = replace(env.ground)

    for change in (change_gravity, change_wind, change_ground):
        env, copilot = flights(1), CoPilot(agent, GUARD, Mode.GUARDIAN)
        copilot.decide(env.observe(), [3], env=env)
        before = copilot.guardians[0].plan
        env.fly(np.array([3]))
        change(env)
        # The same answer must not come of the old plan: nothing is known, so there is none.
        decision = copilot.decide(env.observe(), [1], env=env, known=[{}])
        assert before is not None
        assert decision.held is not None
        assert not decision.held[0]
        assert decision.action[0] == 1
        assert np.all(copilot.decide(env.observe(), [1], env=env).held)


def test_late_answers_do_not_touch_the_plan_and_forgetting_a_slot_drops_it(agent):
    env, copilot = flights(2), CoPilot(agent, GUARD, Mode.GUARDIAN)
    known = None
    while (env.outcome == Outcome.FLYING).any():
        decision = copilot.decide(env.observe(), [2, 2], env=env, known=known)
        known = [{}, {}]  # none ever comes again
        env.fly(decision.action, decision.shares)
    assert (env.outcome == Outcome.LANDED).all()
    copilot.decide(flights(2).observe(), [3, 3], env=flights(2))
    copilot.forget(np.array([True, False]))
    assert [guardian.plan is None for guardian in copilot.guardians] == [True, False]


def test_all_six_are_reported_and_what_ended_has_no_future(agent):
    env = flights(2)
    env.outcome[1] = Outcome.CRASHED
    futures = CoPilot(agent, GUIDE, Mode.GUARDIAN).futures(env)
    assert futures.landed.shape == futures.lasts.shape == (2, 6)
    assert futures.landed[0].any()
    assert not futures.landed[1].any()
    assert not (futures.lasts & ~futures.landed).any()


def test_an_environment_of_another_size_or_rhythm_is_refused(agent):
    copilot = CoPilot(agent, GUARD, Mode.GUARDIAN)
    for env in (flights(2), flights(1, frame_skip=3)):
        with pytest.raises(ValueError, match="physics steps"):
            copilot.decide(env.observe()[:1], [1], env=env)
    with pytest.raises(ValueError, match="shares"):
        copilot.share(flights(1).observe(), [1], shares=np.zeros((1, 3)))


def test_plans_taken_over_are_void_under_other_rules_as_well(agent):
    env, first = flights(1), CoPilot(agent, GUARD, Mode.GUARDIAN)
    first.decide(env.observe(), [3], env=env)
    assert first.guardians[0].plan is not None
    env.fly(np.array([3]))
    env.conditions = Conditions(wind=0.05)
    second = CoPilot(agent, GUARD, Mode.GUARDIAN)
    second.hold_plans_of(first)
    decision = second.decide(env.observe(), [1], env=env, known=[{}])
    assert decision.held is not None
    assert not decision.held[0]
