"""Who flies in Watch: a network, the rules, or the player's own file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

from ai.files.reading import brief
from ai.pilots.own import OwnPilot
from game.core import texts
from game.flight import networks, own

if TYPE_CHECKING:
    from game.flight.networks import Policy
    from game.ui.context import Context

LONGEST_NAME: Final = 24


class Flyer:
    """The pilot that flies, and the one that was chosen: ready, still waiting to be loaded, or broken.

    A broken one is named with what is wrong, and the last good one flies on.

    Attributes:
        policies: all that can be chosen.
        index: number of the chosen one among them.
        network: the pilot that flies.

    """

    def __init__(self, context: Context) -> None:
        self._context, self._settings = context, context.settings
        self.policies = self._known()
        names, model = self.policies.names, context.settings.model
        self._problem = self._wanted = ""
        self._awaited: networks.Network | None = None
        self._version = 0  # of the player's own file that flies
        self.choose(names.index(model) if model in names else 0)
        if self._problem:
            self.network = self.policies.first_fit()
        if context.pilot and context.pilot.chosen:
            self.take(context.pilot.path.name)
            self.look_again()

    @property
    def policy(self) -> Policy:
        assert self.network.policy is not None
        return self.network.policy

    @property
    def chosen(self) -> networks.Network:
        """The pilot that was chosen, whether or not it flies yet."""
        return self._awaited or self.network

    @property
    def names(self) -> list[str]:
        """What all pilots are called."""
        return [brief(networks.word(name), LONGEST_NAME) for name in self.policies.names]

    @property
    def problem(self) -> str:
        """What is wrong with the pilot that was chosen; empty if nothing is."""
        policy = self.chosen.policy
        return self._problem or (own.wrong(policy) if isinstance(policy, OwnPilot) else "")

    @property
    def sentence(self) -> str:
        if self.network.name == networks.SCRIPTED:
            return texts.WATCH_SCRIPTED
        said = texts.WATCH_OWN if isinstance(self.network.policy, OwnPilot) else texts.WATCH_FLIES
        return said.format(name=brief(self.network.name, LONGEST_NAME))

    def choose(self, index: int) -> bool:
        """Choose a pilot by its number; return whether another one flies now."""
        self.index, network = index, self.policies[self.policies.names[index]]
        self._awaited = None
        said = texts.WATCH_PROBLEM.format(name=network.name, problem=network.problem)
        self._problem = said if network.problem else ""
        if isinstance(network.policy, OwnPilot) and not network.policy.ready:
            self._awaited = network
            return False
        return network.policy is not None and self._fly(network)

    def take(self, name: str, path: Path | None = None) -> None:
        """Choose a pilot by its name, in a list over the scene; with a `path`, a file of the player's own."""
        if path:
            own.take(self._context, path)
        self._wanted = name

    def look_again(self) -> bool:
        """Follow a choice made in a list, and files that came or went; return whether another pilot flies now."""
        policies, own_flies = self._known(), isinstance(self.network.policy, OwnPilot)
        wanted, self._wanted = self._wanted or (self.network.name if own_flies else self._settings.model), ""
        same = policies.names == self.policies.names and wanted == self.network.name
        if same and policies[wanted].policy is self.network.policy:
            return False
        self.policies = policies
        known = (name for name in (wanted, self.network.name) if name in policies.names)
        return self.choose(policies.names.index(next(known, policies.names[0])))

    def update(self) -> tuple[bool, bool]:
        """Look after a file of the player's own; return whether another flies now, and whether it was saved anew."""
        pilot, anew = self.chosen.policy, False
        if isinstance(pilot, OwnPilot):
            pilot.look()
            anew, self._version = pilot.version != self._version, pilot.version
            if self._awaited and pilot.ready:
                return self._fly(self._awaited), anew
        return False, anew

    def _fly(self, network: networks.Network) -> bool:
        self.network, self._awaited = network, None
        own_flies = isinstance(network.policy, OwnPilot)
        if self._context.pilot:
            self._context.pilot.chosen = own_flies
        if not own_flies:
            self._settings.model = network.name
        return True

    def _known(self) -> networks.Policies:
        """Return all that can fly: the player's own file too, once it was chosen by name."""
        policies = networks.Policies(self._context.models_dir, self._context.user_dir)
        if pilot := self._context.pilot:
            policies.add(networks.Network(pilot.path.name, pilot))
        return policies
