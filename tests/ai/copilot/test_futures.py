import pickle
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from ai.agent.agent import DeepQAgent
from ai.copilot.futures import DECISION_STEPS, Here, Lookahead
from ai.lander.anywhere import AnywhereEnv
from ai.lander.descent import LegStart, leg_of
from ai.lander.environment import LIMITS, LanderEnv, Outcome
from ai.lander.ground import Ground, Pad
from ai.lander.missions import MISSIONS
from ai.lander.moment import Moment
from ai.lander.push import KEYS, Push
from ai.lander.route import Route
from ai.lander.rules import nearest_action
from game.core.assets import MODELS_DIR

LOW = (0.5, 4.0, 0.2, -0.8, 0.1, 0.0)  # a start just above the pad


@pytest.fixture(scope="module")
def agent():
    return DeepQAgent.load(MODELS_DIR / "lander" / "modern")


def low(frame_skip=1, start=LOW, **rules):
    env = LanderEnv(1, 0, frame_skip=frame_skip, **rules)
    env.reset()
    env.place(np.ones(1, bool), np.array([start]))
    return env


def fly(env, plan):
    """Fly a plan to its end; return whether it lands, and until it stands is where the plan says, to the last bit."""
    while env.outcome[0] == Outcome.FLYING:
        push = plan.push(Here.of(env))
        if push is None:
            return False
        for _ in range(DECISION_STEPS // env.frame_skip):
            env.fly(np.array([push.action]), np.array([push.shares]))
    return env.outcome[0] == Outcome.LANDED


def test_looked_at_one_by_one_pushes_come_to_what_they_do_in_a_batch(agent):
    moment, ahead, kinds = Moment.of(low()), Lookahead(agent), set()
    for decisions in (1, 4, 12):
        for push, future in zip(KEYS, ahead.futures(moment, [(0, key) for key in KEYS], decisions), strict=True):
            *sooner, last = filter(None, ahead.look(moment, push, decisions))
            assert (last.plan is None, last.passes) == (future.plan is None, future.passes), (push, decisions)
            assert all(each.passes for each in sooner)
            kinds.add((last.plan is None, last.passes))
    assert (False, False) in kinds, "what lands, but does not last"


def test_a_plan_flies_again_bit_for_bit_wherever_it_was_made(agent):
    anywhere = DeepQAgent.load(MODELS_DIR / "lander" / "anywhere")
    missions = {name: (anywhere, MISSIONS[name].begin()) for name in ("wind", "ferry")}
    plain = {"moon": (agent, low()), "turned": (agent, low(start=(1.0, 5.0, -0.5, -0.5, 0.4, 0.3)))}
    for name, (pilot, env) in {**plain, **missions}.items():
        moment = pickle.loads(pickle.dumps(Moment.of(env)))  # as it gets to another process
        before = env.snapshot()
        stick = Push.of(0.4, -0.3)
        asked = (KEYS[0], KEYS[4], stick)
        found = Lookahead(pilot).futures(moment, [(0, push) for push in asked])
        assert any(future.plan for future in found), name
        for push, future in zip(asked, found, strict=True):
            if future.plan:
                env.restore(before)
                assert future.plan.push(Here.of(env)) == push, name
                assert fly(env, future.plan), (name, push)
                assert env.outcome[0] == Outcome.LANDED, (name, push)


def test_a_plan_made_in_mid_touch_takes_over_the_contacts(agent):
    env = low(start=(0.0, 2.75, 0.0, -0.6, 0.05, 0.0))
    while env.world.contacts is None:
        env.fly(np.array([0]))
    for _ in range(5):
        env.fly(np.array([0]))
    plan = Lookahead(agent).plans(Moment.of(env), [(0, (KEYS[2],)), (0, (KEYS[0],))])
    assert plan[0]
    before = env.snapshot()
    for each in filter(None, plan):
        env.restore(before)
        assert fly(env, each)
        assert env.outcome[0] == Outcome.LANDED


def test_landers_of_many_worlds_are_flown_as_each_would_be_alone():
    anywhere = DeepQAgent.load(MODELS_DIR / "lander" / "anywhere")
    env = AnywhereEnv(6, 4, "near", frame_skip=1)
    env.reset()
    plans = Lookahead(anywhere).plans(Moment.of(env), [(slot, (KEYS[3],)) for slot in range(6)])
    assert sum(plan is not None for plan in plans) >= 4
    while (env.outcome == Outcome.FLYING).any():
        pushes = [
            plan.push(Here.of(env, slot)) if plan and not env.outcome[slot] else None for slot, plan in enumerate(plans)
        ]
        given = [push or KEYS[0] for push in pushes]
        for _ in range(DECISION_STEPS):
            env.fly(np.array([push.action for push in given]), np.array([push.shares for push in given]))
    for slot, plan in enumerate(plans):
        assert plan is None or env.outcome[slot] == Outcome.LANDED


def test_a_landing_counts_only_with_time_to_spare(agent):
    env = low()
    (plan,) = Lookahead(agent).plans(Moment.of(env), [(0, (KEYS[3],))])
    seconds = len(plan.shares) / 15
    for time, lands in ((seconds + 1.6, True), (seconds + 1.0, False)):
        env.limits = replace(LIMITS, time=time)
        (again,) = Lookahead(agent).plans(Moment.of(env), [(0, (KEYS[3],))])
        assert bool(again) == lands, time


def test_any_pad_will_do_and_the_one_that_is_meant_comes_first(agent):
    ground = Ground((Pad(-6.0, 1.6, 6.0), Pad(6.0, 1.6, 4.4, 3)))
    env = low(ground=ground, start=(5.0, 6.0, 0.0, -0.5, 0.0, 0.0))
    for target in (1, 0):
        env.target[:] = target
        (plan,) = Lookahead(agent).plans(Moment.of(env), [(0, (KEYS[3],))])
        assert target in (plan.target, 0)
    env = low(ground=ground, start=(6.0, 2.9, 0.0, -0.5, 0.0, 0.0), limits=replace(LIMITS, time=4.5))
    env.target[:] = 0  # there is no time to get there
    assert Lookahead(agent).plans(Moment.of(env), [(0, (KEYS[0],))])[0].target == 1


def test_what_comes_first_can_be_several_pushes(agent):
    env = low(start=(0.0, 8.0, 0.0, 0.0, 0.0, 0.0))
    lookahead = Lookahead(agent)
    (future,) = lookahead.futures(Moment.of(env), [(0, KEYS[1])], 4, before=(KEYS[5], KEYS[3]))
    pushed = [Push.of(*shares).action for shares in future.plan.shares.tolist()]
    assert pushed[:3] == [5, 3, 1]
    for _ in range(2 * DECISION_STEPS):
        env.fly(np.array([pushed[env.steps[0] // DECISION_STEPS]]))
    assert future.plan.push(Here.of(env)) == KEYS[1]  # so it serves as the future of a later moment
    falling = low(start=(0.0, 5.0, 0.0, -2.5, 0.0, 0.0))
    once, long = (lookahead.futures(Moment.of(falling), [(0, KEYS[0])], many)[0] for many in (1, 12))
    assert once.passes
    assert not long.passes
    assert long.plan


def test_a_leg_of_a_descent_is_flown_along_its_route(agent):
    leg = leg_of(3, LegStart())
    env = leg.begin(12.0)
    route, led = Route(leg.route), []
    ahead = SimpleNamespace(observe=lambda *at: led.append(at) or route.observe(*at))
    plans = Lookahead(agent, ahead).plans(Moment.of(env), [(0, (key,)) for key in (KEYS[0], KEYS[3])])
    assert len(led) >= len(plans[1].states) - 1
    assert all(plans)
    assert fly(env, plans[1])
    assert env.outcome[0] == Outcome.LANDED


def test_one_that_is_elsewhere_is_not_on_the_plan(agent):
    env = low()
    (plan,) = Lookahead(agent).plans(Moment.of(env), [(0, (KEYS[3],))])
    assert plan.push(Here.of(env))
    env.fly(np.array([3]))
    assert plan.push(Here.of(env)) is None  # between two decisions
    for _ in range(3):
        env.fly(np.array([4]))
    assert plan.push(Here.of(env)) is None


def test_a_push_of_shares_has_the_nearest_action():
    for key in KEYS:
        assert Push.of(*key.shares) == key
    assert Push.of(0.3, -0.9).action == nearest_action(0.3, -0.9)


def test_one_that_stands_has_not_landed_before_all_that_comes_first_is_pushed(agent):
    env = low(start=(0.0, 2.57, 0.0, 0.0, 0.0, 0.0))
    while env.still_steps[0] < 5:
        env.fly(np.zeros(1, int))
    assert env.outcome[0] == Outcome.FLYING
    (plan,) = Lookahead(agent).plans(Moment.of(env), [(0, (KEYS[0], KEYS[0], KEYS[0], *(KEYS[3],) * 12))])
    pushed = [Push.of(*shares).action for shares in plan.shares[:15].tolist()]
    assert pushed == [0] * 3 + [3] * 12
