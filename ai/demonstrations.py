"""Good landings to learn from: a person's own, or a scripted pilot's.

A flight follows from its seed and what was done in each physics step, so that is all that is kept. To learn from
it, it is flown again, with the rewards of whoever learns.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from ai.agent import DeepQAgent
from ai.config import Config
from ai.env import Floats, StepResult
from ai.ground import hilly
from ai.lander import NUM_ACTIONS, LanderEnv, Outcome
from ai.memory import NStep
from ai.pilots import Pilot
from ai.replay import MemoryCell
from ai.spawns import SPAWNS

FORMAT: Final = "tranquility demonstrations"
VERSION: Final = 1
MOST: Final = 50  # flights kept; the oldest make room, since each takes a moment to be flown again
_LONGEST: Final = 25 * 60  # physics steps of a flight


@dataclass(frozen=True)
class Demonstration:
    """A flight that landed, or the end of one, after a takeover. Raises ValueError for what can't have been flown."""

    seed: int
    actions: tuple[int, ...]  # one for each physics step from the start
    spawn: str = "random"
    begins: int = 0  # the physics step from which on it is an example
    ground: int | None = None  # seed of the hills; None for the plain
    pad: int = 0  # number of the pad landed on

    def __post_init__(self) -> None:
        whole = (self.seed, self.begins, self.pad, *self.actions)
        if not all(isinstance(number, int) and number >= 0 for number in whole):
            raise ValueError("seed, steps and actions of a demonstration are whole numbers from 0")
        if self.spawn not in SPAWNS or not 0 < len(self.actions) <= _LONGEST or max(self.actions) >= NUM_ACTIONS:
            raise ValueError(f"this is no flight: {len(self.actions)} actions from spawn {self.spawn!r}")


def takeover(hands: Sequence[bool]) -> int:
    """The step in which a person took the stick for the last time, by whether they had it in each step.

    The number of steps if they did not have it at the end: then there is nothing of theirs to learn from.
    """
    begins = len(hands)
    while begins and hands[begins - 1]:
        begins -= 1
    return begins


def demonstrate(pilot: Pilot, count: int, seed: int = 0, spawn: str = "random") -> list[Demonstration]:
    """Let a pilot fly until it has landed `count` times, each flight from a seed of its own, and return those.

    Raises ValueError for a pilot that crashes more than nine times out of ten.
    """
    found: list[Demonstration] = []
    seeds = range(seed, seed + 10 * count)
    env = LanderEnv(len(seeds), 0, spawn, frame_skip=4)
    for slot, own in enumerate(seeds):
        env.draw_from(slot, _stream(own))
    observation, flown = env.reset(), []
    while (env.outcome == Outcome.FLYING).any():
        flown.append(pilot.act(observation, held=env.actions))
        observation = env.step(flown[-1]).observation
    for slot in np.flatnonzero(env.outcome == Outcome.LANDED)[:count].tolist():
        actions = np.repeat([row[slot] for row in flown], env.frame_skip)[: env.steps[slot]]
        found.append(Demonstration(seeds[slot], tuple(actions.tolist()), spawn))
    if len(found) < count:
        raise ValueError(f"of {len(seeds)} flights, only {len(found)} landed, not {count}")
    return found


def relive(demonstration: Demonstration, config: Config) -> MemoryCell | None:
    """Fly a demonstration again, and return its transitions as `config` would have remembered them.

    None if it doesn't land, as one made under other rules may not. A transition is a decision of
    `config.frame_skip` physics steps with the action that was held longest in it.
    """
    ground = None if demonstration.ground is None else hilly(np.random.default_rng(demonstration.ground))
    env = LanderEnv(1, 0, demonstration.spawn, frame_skip=1, ground=ground, weights=config.weights)
    if demonstration.pad >= len(env.ground.pads):
        return None
    env.target[:] = demonstration.pad
    env.draw_from(0, _stream(demonstration.seed))
    observation, steps = env.reset(), NStep(config.n_step, config.discount)
    parts: list[MemoryCell] = []
    skip = config.frame_skip
    for first in range(0, len(demonstration.actions), skip):
        actions = demonstration.actions[first : first + skip]
        result, reward = _decide(env, actions)
        if first >= demonstration.begins:
            longest = np.bincount(actions).argmax()
            cells, _ = steps.add(
                observation, np.array([longest]), reward * np.float32(config.reward_scale), result.observation,
                result.terminated, result.ended,
            )  # fmt: skip
            parts.append(cells)
        observation = result.observation
    if env.landed_on[0] != demonstration.pad or not parts:
        return None
    return MemoryCell(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def teach(agent: DeepQAgent, demonstrations: Sequence[Demonstration]) -> int:
    """Put demonstrations into an agent's replay and its list of successes; return how many it could use.

    The agent learns from the list in a second pass of its own, if `config.success_pass` is on, as `taught` has it.
    """
    used = 0
    for demonstration in demonstrations:
        cells = relive(demonstration, agent.config)
        if cells is not None:
            agent.replay.add(cells)
            agent.successes.add(cells)
            used += 1
    return used


def taught(config: Config) -> Config:
    """Return the configuration that learns from demonstrations as well."""
    return config.changed(success_pass=True)


def write(path: Path, demonstrations: Sequence[Demonstration]) -> None:
    """Keep the newest demonstrations in a file, whole or not at all. Raises OSError if the disk won't have it."""
    kept = [asdict(demonstration) for demonstration in demonstrations[-MOST:]]
    temporary = path.with_name(path.name + ".part")
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary.write_text(json.dumps({"format": FORMAT, "version": VERSION, "flights": kept}) + "\n", encoding="utf-8")
    temporary.replace(path)


def read(path: Path) -> list[Demonstration]:
    """Read what `write` wrote, oldest first; nothing if there is no file yet.

    Raises ValueError, which names the file and what is wrong with it, and OSError if it can't be read.
    """
    try:
        described = json.loads(path.read_text(encoding="utf-8"))
        if described["format"] != FORMAT or described["version"] != VERSION:
            raise ValueError(f"this is no {FORMAT}, version {VERSION}")
        return [Demonstration(**flight | {"actions": tuple(flight["actions"])}) for flight in described["flights"]]
    except FileNotFoundError:
        return []
    except (ValueError, KeyError, TypeError) as error:
        raise ValueError(f"{path}: {error}") from error


def _stream(seed: int) -> np.random.Generator:
    """What a lander that flies alone from this seed draws its start from."""
    return np.random.default_rng(seed).spawn(1)[0]


def _decide(env: LanderEnv, actions: Sequence[int]) -> tuple[StepResult, Floats]:
    """Fly one physics step for each action; return the last result, and the reward of them all, (1,)."""
    reward: Any = np.zeros(1, dtype=np.float32)
    for action in actions:
        result = env.step(np.array([action]))
        reward = reward + result.reward
    return result, reward
