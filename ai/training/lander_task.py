"""The lander as a task to learn, and how its pilots are measured."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import asdict, dataclass, replace
from typing import Any, Final

import numpy as np

from ai.agent.symmetry import Symmetry
from ai.common.environment import Doubles, Env, Ints
from ai.files import MOST
from ai.lander.environment import LIMITS, NUM_ACTIONS, NUM_FEATURES, LanderEnv, Outcome
from ai.lander.pilots import Pilot
from ai.lander.rules import MIRROR_ACTIONS, MIRROR_FEATURES, MIRROR_SIGNS, engines_switched
from ai.lander.spawns import CURRICULA, SPAWNS, TEACH_HARD
from ai.training.config import Config
from ai.training.schedule import touchdown_limits
from ai.training.state import State, rebuilt
from ai.training.task import checked_score

# What changes of landers as they fly; the rest of their snapshot follows from the settings, and from their sites.
_CHANGED: Final = ("landers", "bodies", "contacts", "gravity", "strictness", "landings")
# Shapes of what is known of each contact (`engine.contacts.Contacts`).
_CONTACTS: Final = {
    "normal": (2,), "points": (2, 2), "depth": (2,), "feature": (2,), "valid": (2,), "world": (), "pair": (),
    "body": (2,), "friction": (), "restitution": (), "impulse": (3,), "approach": (3,), "age": (), "colour": (),
}  # fmt: skip
LANDER_SYMMETRY: Final = Symmetry(MIRROR_SIGNS, MIRROR_FEATURES, MIRROR_ACTIONS)


@dataclass(frozen=True)
class Evaluation:
    """Evaluation of a pilot over a number of flights without random actions."""

    episodes: int
    success: float  # shares of the flights
    crash: float
    out_of_bounds: float
    time_out: float
    mean_return: float
    mean_time: float | None  # seconds, of the landings; None without any
    mean_fuel: float | None  # seconds of main engine, of the landings
    switches: float  # times a second that an engine goes on or off, of all flights
    hard: float | None = None  # share of further flights, from hard starts, that landed; None where none were flown

    def to_json(self) -> dict[str, float | None]:
        """Return the values as JSON can hold them."""
        return asdict(self)

    def better_than(self, other: Evaluation | None) -> bool:
        """Whether more flights landed, random and hard starts together, or as many and the mean return is higher.

        Where hard starts were not flown, the mean return decides, and each flight that did not land counts a thousand
        points less. Then a tenth of a second outweighs one landing in 500, too much where nearly all land.
        """
        if other is None:
            return True
        if self.hard is None or other.hard is None:
            return self.mean_return + 1000 * self.success > other.mean_return + 1000 * other.success
        return (self.success + self.hard, self.mean_return) > (other.success + other.hard, other.mean_return)

    @property
    def figure(self) -> str:
        """Share that landed, as text."""
        return f"{self.success:.1%}"

    def __str__(self) -> str:
        took = "" if self.mean_time is None else f", in {self.mean_time:.1f} s on average"
        return f"{self.figure} of {self.episodes} validation flights landed{took}"


def evaluate(pilot: Pilot, episodes: int, seed: int, spawn: str = "random", frame_skip: int = 4) -> Evaluation:
    """Fly `episodes` flights at once, without exploration, from spawns that follow from `seed`."""
    return evaluation_of(flown(pilot, LanderEnv(episodes, seed, spawn, frame_skip)))


def evaluation_of(going: Generator[None, None, Evaluation]) -> Evaluation:
    """Fly what `flown` or `LanderTask.trial` began to its end, and return the evaluation."""
    while True:
        try:
            next(going)
        except StopIteration as done:
            evaluation: Evaluation = done.value
            return evaluation


def flown(pilot: Pilot, env: LanderEnv) -> Generator[None, None, Evaluation]:
    """Evaluate a pilot on one new flight in each slot of `env`, one decision at a time."""
    return (yield from counted(pilot, env)).evaluation()


@dataclass(frozen=True)
class FlightSums:
    """Counts and sums of a number of flights; those of two parts of all flights add up."""

    outcomes: tuple[int, ...]  # flights by outcome
    returns: float
    landing_seconds: float
    landing_fuel: float  # seconds of main engine, of the landings
    switches: int  # engines that went on or off
    seconds: float  # of all flights

    def plus(self, other: FlightSums) -> FlightSums:
        """Return the sums of both."""
        outcomes = tuple(map(sum, zip(self.outcomes, other.outcomes, strict=True)))
        return FlightSums(
            outcomes, self.returns + other.returns, self.landing_seconds + other.landing_seconds,
            self.landing_fuel + other.landing_fuel, self.switches + other.switches, self.seconds + other.seconds,
        )  # fmt: skip

    def evaluation(self) -> Evaluation:
        """Return the means."""
        episodes, landed = sum(self.outcomes), self.outcomes[Outcome.LANDED]
        share = {outcome: self.outcomes[outcome] / episodes for outcome in Outcome}
        return Evaluation(
            episodes,
            share[Outcome.LANDED],
            share[Outcome.CRASHED],
            share[Outcome.OUT_OF_BOUNDS],
            share[Outcome.TIMED_OUT],
            self.returns / episodes,
            self.landing_seconds / landed if landed else None,
            self.landing_fuel / landed if landed else None,
            self.switches / self.seconds,
        )


def counted(pilot: Pilot, env: LanderEnv) -> Generator[None, None, FlightSums]:
    """Fly one new flight in each slot of `env`, one decision at a time, and return what came of them."""
    env.reset()
    return (yield from _counted(pilot, env, slice(None)))


def _counted(pilot: Pilot, env: LanderEnv, told: slice) -> Generator[None, None, FlightSums]:
    """Fly all slots of `env` from where they are to the end, and return what came of the slots `told`."""
    observation = env.observe()
    returns: Doubles = np.zeros(env.num_envs)
    switches: Ints = np.zeros(env.num_envs, dtype=np.intp)
    while (flying := env.outcome == Outcome.FLYING).any():
        held = env.actions
        # Asked for every slot, whether it still flies or not: each keeps its row, as a pilot with a memory needs.
        actions = np.where(flying, pilot.act(observation, held=held), held)
        switches += engines_switched(held, actions)
        result = env.step(actions)
        observation = result.observation
        returns += result.reward
        yield
    outcomes, seconds, fuel = env.outcome[told], env.time[told], env.fuel[told]
    landed = outcomes == Outcome.LANDED
    return FlightSums(
        tuple(int((outcomes == outcome).sum()) for outcome in Outcome),
        float(returns[told].sum()),
        float(seconds[landed].sum()),
        float(fuel[landed].sum()),
        int(switches[told].sum()),
        float(seconds.sum()),
    )


class LanderTask:
    """Task of learning to land."""

    num_features, num_actions = NUM_FEATURES, NUM_ACTIONS
    evaluate_every, validation_episodes, test_episodes = 100_000, 500, 1000

    def __init__(self, config: Config) -> None:
        self.config = config
        self.symmetry: Symmetry | None = LANDER_SYMMETRY
        self.action_chances: Doubles | None = _action_chances(config)

    def make_env(self, rng: np.random.Generator) -> LanderEnv:
        """Make the landers to train with."""
        config = self.config
        spawn = CURRICULA.get(config.spawn, config.spawn)
        return LanderEnv(config.num_envs, rng, spawn, config.frame_skip, weights=config.reward_weights)

    def apply_live(self, config: Config, env: Env) -> None:
        """Take over the live knobs of another configuration, here and in the landers."""
        self.config = config
        self.action_chances = _action_chances(config)
        if isinstance(env, LanderEnv):
            env.weights = config.reward_weights

    def update_env(self, decisions: int, env: Env) -> None:
        """Tighten the limits of a touchdown over the schedule, from the real ones to a share of them."""
        if isinstance(env, LanderEnv):
            env.limits = LIMITS.stricter(touchdown_limits(self.config, decisions))

    def env_state(self, env: Env) -> State:
        """Return all that the landers go on from."""
        assert isinstance(env, LanderEnv)
        snapshot = env.snapshot()
        return {
            "flights": {name: snapshot[name] for name in _CHANGED},
            "streams": [stream.bit_generator.state for stream in env.streams],
        }

    def restore_env(self, env: Env, state: State) -> str:
        """Let new landers go on from what `env_state` gave; they can be restored whole."""
        assert isinstance(env, LanderEnv)
        new = env.snapshot()
        told, flying = state["flights"], {name: new[name] for name in _CHANGED if name != "contacts"}
        flights = {name: rebuilt(template, told[name]) for name, template in flying.items()}
        flights["contacts"] = _contacts(env, new["contacts"], told["contacts"])
        landers = flights["landers"]
        outside = not np.isin(landers["target"], range(len(env.ground.pads))).all()
        if outside or not np.isin(landers["outcome"], tuple(Outcome)).all() or not 0 <= flights["landings"] <= MOST:
            raise ValueError("flights are of other landers, or of none")
        env.restore(new | flights)
        for stream, told in zip(env.streams, state["streams"], strict=True):
            stream.bit_generator.state = told
        return ""

    def evaluate(self, pilot: Pilot, episodes: int, seed: int) -> Evaluation:
        """Fly what `trial` says to its end."""
        return evaluation_of(self.trial(pilot, episodes, seed))

    def trial(self, pilot: Pilot, episodes: int, seed: int) -> Generator[None, None, Evaluation]:
        """Fly so many flights at once from random spawns, one decision at a time.

        Where hard starts are taught, half as many from such ones fly beside them: much cheaper than after them.
        """
        beside = (episodes + 1) // 2 if self.config.spawn in TEACH_HARD else 0
        env = LanderEnv(episodes + beside, seed, "random", self.config.frame_skip)
        if not beside:
            return (yield from flown(pilot, env))
        env.reset()
        rng, hard = np.random.default_rng(seed), slice(episodes, None)
        starts = np.array([SPAWNS["hard"](rng) for _ in range(beside)])
        env.place(np.arange(env.num_envs) >= episodes, starts)
        score = (yield from _counted(pilot, env, slice(episodes))).evaluation()
        return replace(score, hard=float((env.outcome[hard] == Outcome.LANDED).mean()))

    def read_score(self, values: dict[str, Any]) -> Evaluation:
        """Read what `Evaluation.to_json` gave; raises ValueError for anything else."""
        return Evaluation(**checked_score(values, ("mean_time", "mean_fuel", "hard")))


def _contacts(env: LanderEnv, new: State, told: Any) -> State:
    """Return what a snapshot remembers of contacts, from a file; raises KeyError, TypeError or ValueError."""
    gravity, kept = rebuilt(new["gravity"], told["gravity"]), told["contacts"]
    if not kept:
        return {"gravity": gravity, "contacts": {}}
    count, worlds = len(kept["world"]), env.world
    integers = ("world", "pair", "body", "feature", "age", "colour")
    contacts = {}
    for name, shape in _CONTACTS.items():
        kind = bool if name == "valid" else np.intp if name in integers else float
        contacts[name] = rebuilt(np.empty((count, *shape), kind), kept[name])
    most = {"world": env.num_envs, "pair": len(worlds.pairs), "body": len(worlds.bodies)}
    if any((contacts[name] < 0).any() or (contacts[name] >= limit).any() for name, limit in most.items()):
        raise ValueError("contacts are of none of the landers")
    return {"gravity": gravity, "contacts": contacts}


def _action_chances(config: Config) -> Doubles:
    main = config.random_main
    return np.array([1 - main] * 3 + [main] * 3) / 3
