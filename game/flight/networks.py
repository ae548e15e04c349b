"""Networks that can fly: the shipped ones, the player's own, and a scripted pilot."""

from __future__ import annotations

import logging
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, Protocol, runtime_checkable

from ai.agent.decision import Decision
from ai.environment import Floats, Ints
from ai.files.reading import brief
from ai.lander.environment import NUM_ACTIONS, NUM_FEATURES
from ai.lander.pilots import Pilot
from ai.lander.sensing import SURROUNDINGS
from game.core import texts
from game.core.shelf import Kept, looks_like_item

DECISION_STEPS: Final = 4  # physics steps per decision of a policy that does not say
DEFAULT: Final = "modern"
ANYWHERE: Final = "anywhere"  # flies in place of a shipped network where it is not as on the moon
SCRIPTED: Final = "scripted"
LANDER: Final = "lander"  # folder of the networks that come with the game
PLAYERS: Final = "models"  # folder of the player's own networks
PARTS: Final = ("config.json", "online", "target")  # a folder with none of these files is not a network
Policy = Pilot  # who flies: a network, a scripted pilot, or the player's own
_log = logging.getLogger("tranquility")


@runtime_checkable
class QPolicy(Policy, Protocol):
    """Flyer that also gives its Q-values and decisions."""

    def q_values(self, observation: Floats) -> Floats:
        """Return Q-values (n, 6) for observations (n, 9)."""

    def decide(self, observation: Floats, *, held: Ints | None = None) -> Decision:
        """Return the decisions of `act`, with the values they are based on."""


def decide(policy: Policy, observation: Floats, held: Ints | None = None) -> Decision:
    """Return a flyer's decisions for observations (n, 9), to fly and to show; `held` (n,) are the previous actions."""
    if isinstance(policy, QPolicy):
        return policy.decide(observation, held=held)
    action = policy.act(observation, held=held)
    return Decision(observation, action, action)


def decision_steps(policy: Policy | None) -> int:
    """Return after how many physics steps a policy decides anew: as many as it was trained with, or four."""
    usual = getattr(getattr(policy, "config", None), "frame_skip", DECISION_STEPS)
    steps = getattr(policy, "run_settings", {}).get("frame_skip", usual)
    return steps if isinstance(steps, int) and steps > 0 else DECISION_STEPS


@dataclass(frozen=True)
class Network:
    """Network by name. `policy` is None if it could not be read, and `problem` then says why.

    Of one that flies, `problem` is a sentence on the one whose place it takes.
    """

    name: str
    policy: Policy | None = None
    problem: str = ""


kept: Final = Kept[Network](most=3)


def word(name: str) -> str:
    """Return a network's name for the player, and words for the scripted pilot and for the one that flies anywhere."""
    return {SCRIPTED: texts.NETWORK_SCRIPTED, ANYWHERE: texts.NETWORK_ANYWHERE}.get(name, name)


def who(policy: object) -> str:
    """Return who flies, as the subject of a sentence: the network, or the player's own pilot by its file's name."""
    path = getattr(policy, "path", None)
    return path.name if path else texts.THE_NETWORK


def sentence(text: str, flyer: str, **more: object) -> str:
    """Return a sentence on who flies, as `who` or `flew` name them."""
    words = text.format(who=flyer, **more)
    return words if words.startswith(flyer) and flyer != texts.THE_NETWORK else words[:1].upper() + words[1:]


def flew(name: str) -> str:
    """Return who flew, as the subject of a sentence, by the name in a line of the logbook."""
    return name if name.endswith(".py") else texts.THE_NETWORK


def titled(name: str) -> str:
    """Return a network, or a pilot, as a sentence calls it."""
    if name.endswith(".py"):
        return name
    return texts.NETWORK_EVERYWHERE if name == ANYWHERE else texts.NETWORK_TITLED.format(name=word(name))


def folders(models_dir: Path, user_dir: Path) -> dict[str, Path]:
    """Return every folder that looks like a lander's network, by name: those of the game, then the player's own.

    A player's network with the name of a shipped one gets another name. The one that lands anywhere is left out, as it
    reads more than nine numbers: `chosen` has it where it is of use.
    """
    found: dict[str, Path] = {}
    for parent in (models_dir / LANDER, user_dir / PLAYERS):
        try:
            inside = sorted(path for path in parent.iterdir() if looks_like_item(path, PARTS))
        except OSError:
            continue
        if parent == models_dir / LANDER:
            inside = [path for path in inside if path.name != ANYWHERE]
        # The default network comes first, not in alphabetical order.
        for path in sorted(inside, key=lambda path: path.name != DEFAULT):
            taken = path.name in found or path.name == SCRIPTED
            found[texts.NETWORK_YOURS.format(name=path.name) if taken else path.name] = path
    return found


def load(name: str, folder: Path, features: int = NUM_FEATURES) -> Network:
    """Read one network with so many inputs. Never raises: `problem` of the answer says what is wrong.

    The last few are kept, as long as none of their files changes: every scene that flies begins with reading one.
    """
    network = kept.get(
        folder, lambda: _fresh(name, folder, features), more=features, sound=lambda read: read.policy is not None
    )
    return replace(network, name=name)


def _fresh(name: str, folder: Path, features: int) -> Network:
    from ai.nn import ModelFormatError
    from ai.training.config import load_agent

    try:
        agent, _ = load_agent(folder)
    except ModelFormatError as error:
        return Network(name, problem=brief(error.problem))
    except OSError as error:
        return Network(name, problem=brief(error.strerror or error))
    except Exception as error:  # a player's folder can hold anything, and none of it may end the game
        _log.exception("reading %s", folder)
        return Network(name, problem=brief(f"{type(error).__name__}: {error}"))
    if (agent.num_features, agent.num_actions) != (features, NUM_ACTIONS):
        lander = {"lander_features": features, "lander_actions": NUM_ACTIONS}
        problem = texts.NETWORK_ELSEWHERE.format(features=agent.num_features, actions=agent.num_actions, **lander)
        return Network(name, problem=problem)
    return Network(name, agent)


def chosen(models_dir: Path, user_dir: Path, name: str = "", elsewhere: bool = False) -> Network:
    """Read the network of that name, or the shipped default if the name is empty or gone.

    Where it is not as on the moon (`elsewhere`), the one that lands anywhere takes the place of a shipped one, or
    `problem` says why it cannot.
    """
    policies, shipped = Policies(models_dir, user_dir), models_dir / LANDER
    wanted = name if name in policies.folders else DEFAULT
    network = policies[wanted]
    if not elsewhere or policies.folders.get(wanted, shipped / DEFAULT).parent != shipped:
        return network
    anywhere = load(ANYWHERE, shipped / ANYWHERE, NUM_FEATURES + len(SURROUNDINGS))
    if anywhere.policy:
        return anywhere
    said = texts.WATCH_PROBLEM.format(name=texts.NETWORK_EVERYWHERE, problem=anywhere.problem)
    return replace(network, problem=network.problem or said[:1].upper() + said[1:])


class Policies:
    """All flyers by name, the scripted pilot last. A network is read on first use; `read` has those read so far."""

    def __init__(self, models_dir: Path, user_dir: Path) -> None:
        self._missing = texts.NETWORK_MISSING.format(path=models_dir / LANDER / DEFAULT)
        self.folders = folders(models_dir, user_dir)
        missing = [] if DEFAULT in self.folders else [DEFAULT]
        self.names = [*missing, *self.folders, SCRIPTED]
        self.read: dict[str, Network] = {}

    def __getitem__(self, name: str) -> Network:
        """Return the network of that name, a damaged one too; raises KeyError if there is none."""
        if name not in self.read:
            self.read[name] = self._load(name)
        return self.read[name]

    def add(self, network: Network) -> None:
        """Offer one more, that has been read already."""
        self.names.append(network.name)
        self.read[network.name] = network

    def first_fit(self) -> Network:
        """Return the first network that can fly; the scripted pilot always can."""
        return next(network for name in self.names if (network := self[name]).policy)

    def _load(self, name: str) -> Network:
        from ai.lander.pilots import ScriptedPilot

        if name == SCRIPTED:
            return Network(SCRIPTED, ScriptedPilot())
        if name == DEFAULT and name not in self.folders:
            return Network(DEFAULT, problem=self._missing)
        return load(name, self.folders[name])
