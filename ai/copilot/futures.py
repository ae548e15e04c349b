"""Futures: from a moment in flight, push something, let the network fly on, and see whether it lands.

The game is the simulation, exact and repeatable, so a future that was seen to land is a plan: a list of what to push,
decision by decision, that lands again, bit for bit. Values of a network alone and in a batch may differ in their last
bits; so a plan is flown as it is written down, and never decided anew.
"""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np

from ai.environment import Bools, Doubles, T, finished
from ai.lander.environment import LanderEnv, LanderParams, Outcome
from ai.lander.moment import Moment
from ai.lander.pilots import Pilot
from ai.lander.push import KEYS, Push
from ai.lander.route import Route
from ai.lander.rules import ACTION_SHARES
from engine import DT

DECISION_STEPS: Final = 4  # physics steps of a decision, whatever rate a network was trained with
LONGEST: Final = 30.0  # seconds after which a future that has not landed counts as one that does not
SPARE: Final = 1.5  # seconds before time is out, from which on a landing does not count
RESTLESS: Final = 4.0  # seconds on the ground after which a future that has not landed counts as one that does not
_MOST: Final = round(LONGEST / DT) // DECISION_STEPS  # decisions
_STUCK: Final = round(RESTLESS / DT) // DECISION_STEPS
_STANDS: Final = 2  # steps still on both feet, after which a craft is taken to land if nothing is pushed
_THERE: Final = 0.3  # metres and radians within which it is then where it stood

Opening = tuple[Push, ...]  # what is pushed in the first decisions of a future, before the network has the stick


@dataclass(frozen=True, eq=False)
class Plan:
    """Future that was seen to land: what to push, decision by decision, and where that leads.

    It is flown until the craft stands. The rest of the half second for which it must stand, nothing is pushed; to fly
    that ahead as well, with contacts in every step, would take half as long as all before.

    Attributes:
        begin: physics steps flown when it begins.
        target: number of the pad that the network flew to in it.
        shares: what is pushed in its k decisions, as shares of thrust, (k, 2).
        states: x, y, angle, and their changes each second, before every decision that was flown and after the last,
            (k + 1, 6), or fewer where it stands.

    """

    begin: int
    target: int
    shares: Doubles
    states: Doubles

    @property
    def ends(self) -> int:
        """Physics steps flown when it has landed."""
        return self.begin + DECISION_STEPS * len(self.shares)

    def push(self, here: Here) -> Push | None:
        """Return what it pushes next for a lander that is `here`; None for one that is not on it."""
        number, between = divmod(here.steps - self.begin, DECISION_STEPS)
        if between or number < 0:
            return None
        flown = len(self.states) - 1
        if number < flown:
            on_it = tuple(self.states[number].tolist()) == here.state
            return Push.of(*self.shares[number].tolist()) if on_it else None
        stands = flown < len(self.shares) and np.abs(self.states[-1, :3] - here.state[:3]).max() < _THERE
        return Push() if stands else None


class Here(NamedTuple):
    """Where one lander is, as far as its plan has to know."""

    steps: int
    state: tuple[float, ...]  # x, y, angle, and their changes each second

    @classmethod
    def of(cls, env: LanderEnv, slot: int = 0) -> Here:
        """Return where a lander of an environment is."""
        return cls.all(env)[slot]

    @classmethod
    def all(cls, env: LanderEnv) -> list[Here]:
        """Return where every lander of an environment is."""
        rows = zip(env.steps.tolist(), _states(env).tolist(), strict=True)
        return [cls(steps, tuple(state)) for steps, state in rows]


def _states(env: LanderEnv) -> Doubles:
    state, body = env.world.state, env.lander.index
    return np.concatenate([state.pose[:, body], state.velocity[:, body]], axis=1)


@dataclass(frozen=True)
class Future:
    """What comes of pushing something now; a pilot may push what `passes`."""

    plan: Plan | None  # after one decision of it; None if the network does not land then
    lasts: bool = True  # whether it lands after as many decisions of it as the dial asks for, too

    @property
    def passes(self) -> bool:
        """Whether the network lands, however briefly it is pushed."""
        return self.plan is not None and self.lasts


Known = Mapping[Push, Future]  # what comes of each push that was looked at


@dataclass(frozen=True, eq=False)
class Futures:
    """Futures of n landers after each action with all its thrust; a flight that has ended has none.

    Attributes:
        known: what comes of each action, for every lander, (n).

    """

    known: Sequence[Known]

    @property
    def landed(self) -> Bools:
        """Whether the network lands after one decision of an action, (n, 6)."""
        return np.array([[key in known and known[key].plan is not None for key in KEYS] for known in self.known])

    @property
    def lasts(self) -> Bools:
        """Whether it lands after as many decisions of it as the dial asks for, too, (n, 6)."""
        return np.array([[key in known and known[key].passes for key in KEYS] for known in self.known])


Flying = Generator[None, None, T]  # yields after each decision, and returns what comes of it


class Lookahead:
    """Futures of a network, flown in batches. It keeps its environment for the next ones over the same ground.

    Args:
        pilot: the network that flies on, as it flies alone: to the pad that is its target, or along a `route`.
        route: how it is led around rock on a leg of a descent; None in any other flight.

    """

    def __init__(self, pilot: Pilot, route: Route | None = None) -> None:
        self.pilot, self.route = pilot, route
        self._env: LanderEnv | None = None
        self._built = ""  # what that is built of

    def futures(
        self, moment: Moment, asked: Sequence[tuple[int, Push]], decisions: int = 1, before: Opening = ()
    ) -> list[Future]:
        """Return what comes of pushing something, for each lander (its row of `moment`) and push in `asked`.

        It `lasts` if the network lands after so many `decisions` of it as well. What is pushed `before` comes first:
        so futures of decisions to come are flown ahead.
        """
        openings = [(row, (*before, *(push,) * many)) for many in sorted({1, decisions}) for row, push in asked]
        plans, count = self.plans(moment, openings), len(asked)
        return [Future(once, long is not None) for once, long in zip(plans[:count], plans[-count:], strict=True)]

    def look(
        self, moment: Moment, push: Push, decisions: int = 1, before: Opening = ()
    ) -> Generator[Future | None, None, None]:
        """Fly what comes of one push for one lander; yield None after each decision, so that one can leave off.

        The future is yielded once it is known. If the network lands after all `decisions`, that plan comes first: it
        begins with the push as well, so there is no need to wait for the one after a single decision, which follows.
        """
        longest: Plan | None = None
        if decisions > 1:
            (longest,) = yield from self._plans(moment, [(0, (*before, *(push,) * decisions))])
            if longest:
                yield Future(longest)
        (plan,) = yield from self._plans(moment, [(0, (*before, push))])
        yield Future(plan or longest, decisions == 1 or longest is not None)

    def plans(self, moment: Moment, asked: Sequence[tuple[int, Opening]]) -> list[Plan | None]:
        """Return for each lander and opening in `asked` a plan that lands, or None.

        A landing on any pad counts; of several plans, that to the target is returned, else that to the nearest pad.
        """
        return finished(self._plans(moment, asked))

    def _plans(self, moment: Moment, asked: Sequence[tuple[int, Opening]]) -> Flying[list[Plan | None]]:
        pads = [_pads_of(moment, row) for row in range(len(moment))]
        plans: list[Plan | None] = [None] * len(asked)
        for tried in slice(1), slice(1, None):  # most land where they were meant to; the other pads are for the rest
            rows = [(index, row) for index, (row, _) in enumerate(asked) if plans[index] is None]
            if left := [(index, pad) for index, row in rows for pad in pads[row][tried]]:
                found = yield from self._fly(moment, [(*asked[index], pad) for index, pad in left])
                for (index, _), (plan, landed) in zip(left, found, strict=True):
                    plans[index] = plans[index] or (plan if landed else None)
        return plans

    def ways(self, moment: Moment, asked: Sequence[tuple[int, Opening]]) -> Flying[list[tuple[Plan, bool]]]:
        """Fly each lander and opening in `asked` to its target; yield after each decision, return way and landing.

        A way that does not land is written down like a plan, but is none.
        """
        return self._fly(moment, [(row, opening, int(moment.target[row])) for row, opening in asked])

    def _fly(self, moment: Moment, asked: Sequence[tuple[int, Opening, int]]) -> Flying[list[tuple[Plan, bool]]]:
        """Fly landers with openings to pads, until all have ended; return what was flown, and whether it landed."""
        start = moment.take(np.array([row for row, _, _ in asked]))
        start.target[:] = [pad for _, _, pad in asked]
        env = self._begin(start)
        flies, (landed, stands) = np.ones(len(asked), dtype=bool), np.zeros((2, len(asked)), dtype=bool)
        begun = np.array([len(opening) for _, opening, _ in asked])
        flown, grounded = np.zeros((2, len(asked)), dtype=np.intp)  # decisions, in all and at last on the ground
        shares: list[Doubles] = []
        states = [_states(env)]
        while flies.any():
            seen = self.route.observe(env, self.pilot) if self.route else env.observe_for(self.pilot)
            action = self.pilot.act(seen, held=env.actions).copy()
            share = ACTION_SHARES[action]
            for lander, (_, opening, _) in enumerate(asked):
                if len(shares) < len(opening):
                    action[lander], share[lander] = (push := opening[len(shares)]).action, push.shares
            env.fly(action, share)
            shares.append(share)
            states.append(_states(env))
            flown += flies
            yield
            late = env.time > env.limits.time - SPARE
            grounded = np.where(env.feet_down.any(axis=1), grounded + 1, 0)
            landed |= flies & (env.outcome == Outcome.LANDED) & ~late
            flies &= (env.outcome == Outcome.FLYING) & ~late & (grounded < _STUCK) & (len(shares) < _MOST)
            if not env.conditions.moves:
                stands |= flies & (env.still_steps >= _STANDS) & env.ground.ends[env.touched] & (flown >= begun)
                flies &= ~stands
        flight = np.array(shares), np.array(states)
        found, rest = [], -(-(int(np.max(env.limits.rest_steps)) - _STANDS) // DECISION_STEPS)
        for lander, (row, _, pad) in enumerate(asked):
            way = [part[: flown[lander] + more, lander].copy() for more, part in enumerate(flight)]
            if stands[lander]:
                way[0] = np.concatenate([way[0], np.zeros((rest, 2))])
            plan = Plan(int(moment.steps[row]), pad, *way)
            found.append((plan, bool(landed[lander] or stands[lander])))
        return found

    def _begin(self, moment: Moment) -> LanderEnv:
        """Put a moment into an environment, and return it; it is made anew where the one before does not fit."""
        if self._env is None or self._env.num_envs != len(moment) or self._built != moment.built:
            self._env, self._built = roomy(len(moment), moment), moment.built
        moment.put(self._env)
        return self._env


def roomy(slots: int, moment: Moment) -> LanderEnv:
    """Return an environment into which any moment over the same ground can be put, with an air for each slot."""
    # Where each lander has a craft of its own, the usual one is built.
    params = LanderParams(**{name: value for name, value in moment.state["params"].items() if not np.ndim(value)})
    env = LanderEnv(slots, 0, frame_skip=DECISION_STEPS, params=params, ground=moment.ground)
    drag = np.tile(env.world.params.quadratic_drag, (slots, 1, 1))
    env.world.params = replace(env.world.params, quadratic_drag=drag)
    return env


def _pads_of(moment: Moment, row: int) -> list[int]:
    """Return the pads a lander may land on by their numbers, its target first, then the nearest first."""
    ground, target = moment.ground, int(moment.target[row])
    if ground.at_once == 1:
        return [target]
    away = np.abs(ground.middles[:, 0] - moment.state["bodies"]["pose"][row, 0, 0])
    others = [int(pad) for pad in away.argsort() if ground.ends[pad] and pad != target]
    return [target, *others]
