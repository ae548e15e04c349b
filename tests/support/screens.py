"""Every screen there is, ways to open it, and what can happen there in a few keys."""

import time
from collections.abc import Callable
from functools import partial

import pygame

from ai.digits.classifier import DigitClassifier
from ai.lander.missions import MISSIONS
from game.core.assets import MODELS_DIR
from game.core.scene import Push, Scene
from game.flight.flight_file import Record
from game.flight.skill import Skill
from game.learn.path import FIRST, PATH
from game.play.challenge import FlownMission
from game.scenes.bindings import BindingsScene
from game.scenes.chapter import ChapterScene
from game.scenes.choices import ChoicesScene
from game.scenes.dialog import ListDialog, NameDialog, QuestionDialog
from game.scenes.digit_training import DigitTrainingScene
from game.scenes.digits import DigitsScene
from game.scenes.dream import DreamScene
from game.scenes.learn import LearnScene
from game.scenes.logbook import LogbookScene
from game.scenes.menu import MenuScene
from game.scenes.missions import MissionsScene
from game.scenes.pause import PauseScene
from game.scenes.physics import PhysicsScene
from game.scenes.play import PlayScene
from game.scenes.quiz import QuizScene
from game.scenes.replay import ReplayScene
from game.scenes.runs import NetworksScene
from game.scenes.settings import SettingsScene
from game.scenes.train import TrainScene
from game.scenes.watch import WatchScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.flights import kept, play, scripted

Make = Callable[[Context], Scene]

SCREENS: dict[str, Make] = {
    "MenuScene": MenuScene,
    "MissionsScene": MissionsScene,
    "WatchScene": lambda context: WatchScene(context, seed=1),
    "TrainScene": TrainScene,
    "DigitsScene": DigitsScene,
    "DigitTrainingScene": DigitTrainingScene,
    "DreamScene": lambda context: DreamScene(context, reader()),
    "QuizScene": lambda context: QuizScene(context, reader()),
    "PhysicsScene": PhysicsScene,
    "LearnScene": LearnScene,
    "ChapterScene": ChapterScene,
    "LogbookScene": LogbookScene,
    "SettingsScene": SettingsScene,
    "BindingsScene": BindingsScene,
    "NetworksScene": NetworksScene,
    "ReplayScene": lambda context: ReplayScene(context, flown(context)),
}
FLOWN: dict[str, Make] = {
    "Play": lambda context: PlayScene(context, 3),
    "swarm": lambda context: WatchScene(context, 16, seed=2),
    "mission": lambda context: PlayScene(context, 0, challenge=FlownMission(MISSIONS["wind"])),
    **{f"chapter, {key}": partial(ChapterScene, key=key) for key in PATH if key != FIRST},
}
OVER_OTHERS: dict[str, Callable[[Scene], Scene]] = {
    "PauseScene": lambda below: PauseScene(below.context, below, retry=lambda: None),
    "ChoicesScene": lambda below: ChoicesScene(below.context, below, Skill([]), begun=False),
    "QuestionDialog": lambda below: QuestionDialog(below, "?", "", [("yes", lambda: None), ("no", lambda: None)]),
    "NameDialog": lambda below: NameDialog(below, "?", "name", lambda _: ""),
    "ListDialog": lambda below: ListDialog(below, "?", [("a",), ("b",)], lambda _: None),
}


def reader() -> DigitClassifier:
    """A network that reads digits."""
    return DigitClassifier.load(MODELS_DIR / "digits" / "classic")


def flown(context: Context) -> Record:
    """A flight in the player's logbook."""
    return kept(context, scripted(), time.time(), alone=True)


def settle(context: Context, **settings: object) -> None:
    """Save settings for the next game: without motion, and these."""
    for name, value in {"reduced_motion": True, "tutored": True, **settings}.items():
        setattr(context.settings, name, value)
    context.settings_file.save(context.settings)


def opened(open_game: Callable[..., Driver], name: str, below: Make = MenuScene, frames: int = 5) -> Driver:
    """Open a screen; one that stands over others does so over the menu, or what is given."""
    driver = open_game(below if name in OVER_OTHERS else {**SCREENS, **FLOWN}[name])
    if name in OVER_OTHERS:
        driver.app.scenes.apply(Push(OVER_OTHERS[name](driver.top)))
    driver.frames(frames)
    return driver


def crashed(driver: Driver) -> None:
    """Fall, and wait for the card."""
    driver.frames(3)
    driver.key(pygame.K_UP)
    while not play(driver).flight.over:
        driver.skip(10)
    driver.skip(240)


def shared(driver: Driver) -> None:
    """Fly with the network's help among hills."""
    driver.frames(3)
    driver.post(pygame.KEYDOWN, key=pygame.K_UP, mod=0)
    driver.frames(60)
