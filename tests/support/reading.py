"""Reads what the pages of a flight say, and holds it against the flight itself."""

import re
from itertools import pairwise

import numpy as np
import pygame
import pytest

from ai.agent.decision import Decision, decide
from game.core import texts
from game.drawing.canvas import Canvas
from game.flight.flight import StickHolder
from tests.support.driver import Driver
from tests.support.flights import play


class Weighs:
    """A network that wants the main engine while it falls."""

    def q_values(self, observation: np.ndarray) -> np.ndarray:
        falls = observation[:, 3] < -0.5
        return np.where(falls[:, None], [0, 1, 1, 9, 5, 5], [9, 6, 6, 0, 1, 1]).astype(np.float32)

    def decide(self, observation: np.ndarray, *, held: np.ndarray | None = None) -> Decision:
        return decide(observation, self.q_values(observation), held)

    def act(self, observation: np.ndarray, *, held: np.ndarray | None = None) -> np.ndarray:
        return self.decide(observation, held=held).action


class OnlyFlies:
    """A network that can have the stick, but not share it: it doesn't weigh actions."""

    def act(self, observation: np.ndarray, *, held: np.ndarray | None = None) -> np.ndarray:
        return np.zeros(len(observation), int)


WHO = {
    texts.YOU_FLY: "person",
    texts.YOU_FLY_HELP.format(key="+"): "person",
    texts.JOINED.format(words=texts.YOU_FLY, more=texts.WITHOUT_HELP): "person",
    **dict.fromkeys(texts.YOU_SHARE.values(), "both"),
    "The network flies": "network",
    "The network flies.  Tab  takes back": "network",
}
COUNTS = [
    *texts.MEDALS[1:],
    texts.MEDAL_GOLD,
    texts.SCORE_BEST,
    texts.MEDAL_NEXT,
    texts.MISSION_GOAL,
]
COUNTS_NOT = [*texts.NOT_COUNTED.values(), texts.MEDALS[0]]
FLEW = {texts.YOU_FLEW: "you", "The network flew": "network"}


def pattern(text: str) -> re.Pattern[str]:
    return re.compile(re.sub(r"\\{\w+(:[^}]*)?\\}", ".+", re.escape(text)) + r"($|  ·  )")


SAYS = [(pattern(text), counts) for counts, group in ((True, COUNTS), (False, COUNTS_NOT)) for text in group]


class Page:
    """What one picture says."""

    def __init__(self, words: list[str]) -> None:
        self.words = words
        parts = [part for word in words for part in word.split(texts.DIAL_JOIN)]
        self.who = {WHO[part] for part in parts if part in WHO}
        self.counts = {counts for part in parts for says, counts in SAYS if says.match(part)}
        self.shares = [
            int(found[2]) * (1 if found[1] == "you" else -1)
            for part in parts
            if (found := re.fullmatch(r"(you|the network) (\d+) %", part))
        ]
        self.flew = {FLEW[part] for part in parts if part in FLEW}
        named = [re.fullmatch(r"(\d+) %", part) for before, part in pairwise(parts) if before == "The network flew"]
        self.by_network = next((int(found[1]) for found in named if found), 0)  # percent of the flight, on its card


class Reading:
    """A driver that reads every page it turns."""

    def __init__(self, driver: Driver, monkeypatch: pytest.MonkeyPatch) -> None:
        self.driver, self.words, write = driver, list[str](), Canvas.text

        def text(canvas: Canvas, string: str, *args: object, **more: object) -> pygame.FRect:
            self.words.append(string)
            return write(canvas, string, *args, **more)

        monkeypatch.setattr(Canvas, "text", text)
        driver.unseen = True

    def page(self, frames: int = 1) -> Page:
        """Let frames pass, and draw and read the last one."""
        if frames > 1:
            self.driver.frames(frames - 1)
        self.words.clear()
        self.driver.unseen = False
        self.driver.frames(1)
        self.driver.unseen = True
        return Page([*self.words])

    def check(self, frames: int = 1) -> Page:
        """Read a page of the flight, and compare it with the flight itself."""
        page, flight = self.page(frames), play(self.driver).flight
        assert len(page.counts) < 2, page.words
        if flight.over:
            assert not page.who, page.words
            if play(self.driver).ending.shown == 1:  # the card is there
                assert abs(page.by_network / 100 - (1 - flight.share)) <= 0.01, page.words
        else:
            shared = flight.chooser.copilot is not None and flight.chooser.copilot.assist > 0
            truth = "network" if flight.chooser.hand is StickHolder.NETWORK else "both" if shared else "person"
            assert page.who <= {truth}, page.words  # or what is more urgent is said, or the craft waits
            if truth == "person":
                assert not any("assist" in word or "guards" in word for word in page.words), page.words
        for share in page.shares:
            assert abs(abs(share) / 100 - (flight.share if share > 0 else 1 - flight.share)) <= 0.01
        hint = texts.HINT_TAKE_BACK if flight.chooser.hand is StickHolder.NETWORK else texts.HINT_HAND_OVER
        shown = {texts.HINT_TAKE_BACK, texts.HINT_HAND_OVER} & set(page.words)
        assert shown <= ({hint} if flight.chooser.network and not flight.over else set()), page.words
        return page


def flew(hands: list[StickHolder]) -> str:
    kinds = set(hands)
    return "both" if len(kinds) > 1 else "you" if kinds == {StickHolder.HUMAN} else "network"
