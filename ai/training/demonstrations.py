"""Demonstrations: good landings to learn from, a person's own or a scripted pilot's.

A flight follows from its seed and what was done in each physics step, so that is all that is kept. To learn from
it, it is flown again, with the learner's rewards.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated, Final

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.agent.n_step import NStep
from ai.agent.replay import Transition
from ai.files import (
    OneOf,
    SchemaError,
    Sized,
    Within,
    brief,
    check_header,
    read_as,
    read_json,
    sound_fields,
    write_text,
)
from ai.lander.environment import NUM_ACTIONS, LanderEnv
from ai.lander.ground import hilly
from ai.lander.spawns import SPAWNS
from ai.training.config import Config

FORMAT: Final = "tranquility demonstrations"
VERSION: Final = 1
MOST: Final = 50  # flights kept; the oldest make room, since each takes a moment to be flown again
_LONGEST: Final = 25 * 60  # physics steps of a flight
_SEEDS: Final = 2**128  # a seed is below
_PADS: Final = 1000  # far more than any ground has

_Seed = Annotated[int, Within(0, _SEEDS - 1)]
_Action = Annotated[int, Within(0, NUM_ACTIONS - 1)]


@dataclass(frozen=True)
class Demonstration:
    """A flight that landed, or the end of one, after a takeover. Raises ValueError for what can't have been flown."""

    seed: _Seed
    actions: Annotated[tuple[_Action, ...], Sized(_LONGEST, least=1)]  # one for each physics step from the start
    spawn: Annotated[str, OneOf(SPAWNS)] = "random"
    begins: _Seed = 0  # the physics step from which on it is an example
    ground: _Seed | None = None  # seed of the hills; None for the plain
    pad: Annotated[int, Within(0, _PADS - 1)] = 0  # number of the pad landed on

    def __post_init__(self) -> None:
        if problems := sound_fields(Demonstration, vars(self))[1]:
            raise ValueError(f"this is no flight: {SchemaError(problems)}")

    @property
    def digest(self) -> str:
        """A few letters that tell it from any other flight."""
        return hashlib.sha256(json.dumps(asdict(self)).encode()).hexdigest()[:16]


@dataclass(frozen=True)
class _File:
    flights: tuple[Demonstration, ...]


def takeover(hands: Sequence[bool]) -> int:
    """Return the step in which a person last took the stick, given whether they had it in each step.

    Returns the number of steps if they did not have it at the end: then there is nothing of theirs to learn from.
    """
    begins = len(hands)
    while begins and hands[begins - 1]:
        begins -= 1
    return begins


def write(path: Path, demonstrations: Sequence[Demonstration]) -> None:
    """Keep the newest demonstrations in a file, whole or not at all. Raises OSError if it cannot be written."""
    kept = [asdict(demonstration) for demonstration in demonstrations[-MOST:]]
    write_text(path, json.dumps({"format": FORMAT, "version": VERSION, "flights": kept}) + "\n")


def read(path: Path) -> list[Demonstration]:
    """Read what `write` wrote, oldest first, and no more than that keeps; nothing if there is no file yet.

    Of more than there can be, those are the newest. Raises ValueError, which names the file and what is wrong with
    it, and OSError if it can't be read.
    """
    try:
        flights = check_header(read_json(path), FORMAT, (VERSION,)).get("flights")
        newest = flights[-MOST:] if isinstance(flights, list) else flights
        return list(read_as(_File, {"flights": newest}, strict=True).flights)
    except FileNotFoundError:
        return []
    except ValueError as error:
        raise ValueError(f"{path}: {brief(error)}") from error


def relive(demonstration: Demonstration, config: Config) -> Transition | None:
    """Fly a demonstration again; return its transitions as `config` would have remembered them.

    None if it does not land, as one made under other rules may not, or has no example. A transition is a decision of
    `config.frame_skip` physics steps with the action that was held longest in it.
    """
    skip, hills, actions = config.frame_skip, None, demonstration.actions
    if demonstration.ground is not None:
        hills = hilly(np.random.default_rng(demonstration.ground))
    env = LanderEnv(1, 0, demonstration.spawn, frame_skip=1, ground=hills, weights=config.reward_weights)
    env.streams[0] = stream(demonstration.seed)
    env.target[:] = min(demonstration.pad, len(env.ground.pads) - 1)
    observation, steps, found = env.reset(), NStep(config.n_step, config.discount), list[Transition]()
    for first in range(0, len(actions), skip):
        before, held, reward = observation, actions[first : first + skip], np.zeros(1, np.float32)
        terminated, ended = np.zeros((2, 1), bool)
        for action in (*held, *[0] * (skip - len(held))):
            result = env.step(np.array([action]))
            reward += result.reward
            terminated |= result.terminated
            ended |= result.ended
        observation, longest = result.observation, np.array([np.bincount(held).argmax()])
        if first >= demonstration.begins:
            paid = reward * np.float32(config.reward_scale)
            found.append(steps.add(before, longest, paid, observation, terminated, ended)[0])
    landed = env.landed_on[0] == demonstration.pad and env.steps[0] <= len(actions)
    return Transition(*map(np.concatenate, zip(*found, strict=True))) if landed and found else None


def teach(agent: DeepQAgent, demonstrations: Sequence[Demonstration]) -> int:
    """Put demonstrations into an agent's replay and its list of successes; return how many it could use.

    The agent learns from the list in a second pass of its own, if `config.success_pass` is on.
    """
    config = Config.of(agent)
    landings = [cells for each in demonstrations if (cells := relive(each, config)) is not None]
    for cells in landings:
        agent.replay.add(cells)
        agent.successes.add(cells)
    return len(landings)


def stream(seed: int) -> np.random.Generator:
    """Return the random stream from which a lander that flies alone from this seed draws its start."""
    return np.random.default_rng(seed).spawn(1)[0]
