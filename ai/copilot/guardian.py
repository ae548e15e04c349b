"""Guardian: it holds a plan that lands, and lets pass what another such plan begins with.

Judging only: what comes of a push is flown by `ai.copilot.futures`, beforehand and perhaps elsewhere.
"""

from __future__ import annotations

from enum import IntEnum
from math import inf
from typing import Final, NamedTuple

from ai.copilot.futures import Future, Here, Known, Plan
from ai.lander.push import KEYS, Push

_FARTHEST: Final = 12  # decisions of an action after which there must be a landing, with the dial at 1
_PATIENCE: Final = 180  # steps by which the landing may be put off, from the first correction on
_CALM: Final = 8  # decisions in a row without a correction, after which another wish lets that begin anew


class ActionSource(IntEnum):
    """Source of the action that is flown, in the order in which the sources are tried."""

    PILOT = 0  # the pilot's, untouched
    PILOT_MAIN = 1  # the pilot's main engine with the co-pilot's steering
    PILOT_STEER = 2  # the co-pilot's main engine with the pilot's steering
    COPILOT = 3  # the co-pilot's
    HANDS_OFF = 4  # the co-pilot's, because nothing is pressed


class Choice(NamedTuple):
    """What a guardian flies: what is pushed for one decision, whose that is, and whether a plan is held after it."""

    push: Push
    source: ActionSource = ActionSource.PILOT
    held: bool = False


def decisions_of(assist: float) -> int:
    """Return after how many decisions of an action there must be a landing, 1 to 12, for the dial at 0 to 1."""
    return 1 + round((_FARTHEST - 1) * assist)


class Guardian:
    """Guardian of one flight.

    Attributes:
        plan: the plan that it holds; None before it has found one, and where there is none.

    """

    def __init__(self) -> None:
        self.plan: Plan | None = None
        self._due = inf  # physics steps flown when it must have landed, as long as corrections follow each other
        self._calm = 0  # decisions in a row without a correction
        self._corrected: Push | None = None  # what was asked for at the last one

    def knows(self, here: Here, asked: Push, known: Known) -> bool:
        """Whether it is known what comes of a push: it was flown ahead, or the held plan begins with it."""
        return asked in known or (self.plan is not None and self.plan.push(here) == asked)

    def needs(self, here: Here, asked: Push, *, whole: bool = False) -> list[Push]:
        """Return the pushes whose futures `choose` may have to know."""
        offers, head = self._offers(here, asked, asked, whole)
        return [] if asked == head else [push for push in offers if push != head]

    def choose(self, here: Here, asked: Push, network: Push, known: Known, *, whole: bool = False) -> Choice:
        """Return what to fly, where the pilot pushes `asked` and the network would push `network`.

        What the pilot asks for passes if a landing plan begins with it, which is held from now on; else as little as
        will do is corrected, with all thrust if `whole`; else the plan that is held flies on. Without any plan, the
        pilot flies. What is not `known` in time counts as lost, which never is a risk while a plan is held.

        Keys that are held could so keep a craft in the air for ever: pushed, saved, pushed again. From the first
        correction on, a landing that was in sight may be put off by three seconds; what lands later passes no more.
        """
        offers, head = self._offers(here, asked, network, whole)
        futures = {push: Future(self.plan) if push == head else known.get(push, Future(None)) for push in offers}
        plans = {push: future.plan for push, future in futures.items() if future.plan and future.plan.ends <= self._due}
        if not plans:
            return Choice(asked)
        push = next((push for push in plans if futures[push].lasts), next(iter(plans)))
        self.plan = plan = plans[push]
        corrected = offers[push] is not ActionSource.PILOT
        self._calm, self._corrected = (0, asked) if corrected else (self._calm + 1, self._corrected)
        if self._calm >= _CALM and asked != self._corrected:  # a key that is held may be felt for long in between
            self._due = inf
        elif corrected or self._due < inf:
            self._due = min(self._due, plan.ends + _PATIENCE)
        return Choice(push, offers[push], held=True)

    def _offers(
        self, here: Here, asked: Push, network: Push, whole: bool
    ) -> tuple[dict[Push, ActionSource], Push | None]:
        """Return what may be flown, the least change first, and what the held plan begins with; drop one that is off.

        Where no plan is held, the network's wish takes its place, and every other action may be flown as well.
        """
        head = self.plan.push(here) if self.plan else None
        if head is None:
            self.plan, self._due = None, inf
        best, own = head or network, KEYS[asked.action] if whole else asked
        offers = {asked: ActionSource.PILOT}
        offers.setdefault(Push(own.main, best.side), ActionSource.PILOT_MAIN)
        offers.setdefault(Push(best.main, own.side), ActionSource.PILOT_STEER)
        for push in (best,) if head else (best, *KEYS):
            offers.setdefault(push, ActionSource.COPILOT)
        return offers, head
