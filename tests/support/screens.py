"""Every screen there is, ways to open it, and what can happen there in a few keys."""

import time
from collections.abc import Callable
from datetime import date
from functools import partial

import numpy as np
import pygame

from ai.digits.classifier import DigitClassifier
from ai.digits.preprocessing import Image, preprocess_strokes
from ai.lander.missions import MISSIONS
from game.core.assets import MODELS_DIR
from game.core.scene import Push, Scene
from game.flight import codes
from game.flight.days import Days
from game.flight.flight_file import Record
from game.scenes.digits.inside import DigitInsideScene
from game.scenes.digits.scene import DigitsScene
from game.scenes.learn.list import LearnScene
from game.scenes.learn.one_file import OneFileScene
from game.scenes.learn.path import FIRST, PATH
from game.scenes.learn.scene import ChapterScene
from game.scenes.lesson.scene import LessonScene
from game.scenes.logbook.replay import ReplayScene
from game.scenes.logbook.scene import LogbookScene
from game.scenes.menus.dialogs import NameDialog, QuestionDialog
from game.scenes.menus.keys import BindingsScene
from game.scenes.menus.menu import FlightsScene, MenuScene
from game.scenes.menus.settings import SettingsScene
from game.scenes.networks.scene import NetworksScene
from game.scenes.physics.exhibit import Exhibit
from game.scenes.physics.exhibits import EXHIBITS
from game.scenes.physics.scene import PhysicsScene
from game.scenes.physics.step_scene import PhysicsStepScene
from game.scenes.play.challenge import FlownMission
from game.scenes.play.daily import DailyStart
from game.scenes.play.descent import Descent
from game.scenes.play.missions import MissionsScene
from game.scenes.play.pause import FlightPauseScene, PauseScene
from game.scenes.play.scene import PlayScene
from game.scenes.play.tutorial import Tutorial
from game.scenes.train.digits import digit_training
from game.scenes.train.scene import TrainScene
from game.scenes.watch.scene import WatchScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.flights import kept, landed, play
from tests.support.lessons import lesson_of
from tests.support.tastes import raised

Make = Callable[[Context], Scene]


def friend(context: Context) -> ReplayScene:
    """The page of a friend's flight."""
    flight = codes.claimed(flown(context))
    return ReplayScene(context, codes.record_of(flight, time.time()), flight)


SCREENS: dict[str, Make] = {
    "MenuScene": MenuScene,
    "FlightsScene": FlightsScene,
    "MissionsScene": MissionsScene,
    "WatchScene": lambda context: WatchScene(context, seed=1),
    "TrainScene": TrainScene,
    "TasteScene": raised,
    "DigitsScene": DigitsScene,
    "DigitInsideScene": lambda context: DigitInsideScene(context, reader(), seven()),
    "PhysicsScene": PhysicsScene,
    "PhysicsStepScene": lambda context: PhysicsStepScene(context, fallen()),
    "LearnScene": LearnScene,
    "ChapterScene": ChapterScene,
    "OneFileScene": OneFileScene,
    "LessonScene": lambda context: LessonScene(context, lesson_of("modern")),
    "LogbookScene": LogbookScene,
    "SettingsScene": SettingsScene,
    "BindingsScene": BindingsScene,
    "NetworksScene": NetworksScene,
    "ReplayScene": lambda context: ReplayScene(context, flown(context)),
}


def daily(context: Context) -> PlayScene:
    """The start of a day."""
    return PlayScene(context, 0, challenge=DailyStart(date(2026, 11, 22), Days(context.user_dir)))


FLOWN: dict[str, Make] = {
    "sound": lambda context: SettingsScene(context, "sound"),
    "controls": lambda context: SettingsScene(context, "controls"),
    "flights": lambda context: SettingsScene(context, "flights"),
    "friend": friend,
    "DigitTrainingScene": digit_training,
    "daily": daily,
    "Play": lambda context: PlayScene(context, 3),
    "inside, sums": lambda context: inside(context, "sums"),
    "inside, dreams": lambda context: inside(context, "dreams"),
    "swarm": lambda context: WatchScene(context, seed=2, many=True),
    "mission": lambda context: PlayScene(context, 0, challenge=FlownMission(MISSIONS["wind"])),
    "tutorial": lambda context: PlayScene(context, 0, challenge=Tutorial()),
    "descent": lambda context: PlayScene(context, 3, challenge=Descent()),
    **{f"chapter, {key}": partial(ChapterScene, key=key) for key in PATH if key != FIRST},
}
OVER_OTHERS: dict[str, Callable[[Scene], Scene]] = {
    "FlightPauseScene": lambda below: FlightPauseScene(below.context, below),
    "PauseScene": lambda below: PauseScene(below.context, below, retry=lambda: None),
    "QuestionDialog": lambda below: QuestionDialog(below, "?", "", [("yes", lambda: None), ("no", lambda: None)]),
    "NameDialog": lambda below: NameDialog(below, "?", "name", lambda _: ""),
}


def reader(name: str = "classic") -> DigitClassifier:
    """A network that reads digits."""
    return DigitClassifier.load(MODELS_DIR / "digits" / name)


def fallen(steps: int = 100) -> Exhibit:
    """An exhibit in which much touches and overlaps."""
    heap = EXHIBITS["heap"](9.81, {"count": 40.0})
    for _ in range(steps):
        heap.step()
    return heap


def seven() -> Image:
    """A seven as networks read it."""
    return preprocess_strokes([np.array([(0.2, 0.2), (0.8, 0.2), (0.4, 0.9)]) * 500])


def inside(context: Context, tab: str) -> DigitInsideScene:
    """Another tab of Look inside than the first."""
    scene = DigitInsideScene(context, reader(), seven())
    scene.choose(getattr(scene, tab))
    return scene


def flown(context: Context) -> Record:
    """A flight in the player's logbook."""
    return kept(context, landed(), time.time(), alone=True)


def save_settings(context: Context, **settings: object) -> None:
    """Save settings for the next game: without motion, and these."""
    for name, value in {"reduced_motion": True, "tutored": True, **settings}.items():
        setattr(context.settings, name, value)
    context.settings_file.save(context.settings)


def opened(open_game: Callable[..., Driver], name: str, below: Make = MenuScene, frames: int = 5) -> Driver:
    """Open a screen; one that stands over others does so over the menu, or what is given."""
    below = FLOWN["Play"] if name == "FlightPauseScene" else below
    driver = open_game(below if name in OVER_OTHERS else {**SCREENS, **FLOWN}[name])
    if name in OVER_OTHERS:
        driver.app.scenes.apply(Push(OVER_OTHERS[name](driver.top)))
    driver.frames(frames)
    return driver


def crashed(driver: Driver) -> None:
    """Fall from low above the pad, and wait for the card."""
    driver.frames(3)
    driver.key(pygame.K_UP)
    env = play(driver).flight.env
    x, y = env.pad[0].tolist()
    env.place(np.ones(1, bool), np.array([[x, y + env.params.stand + 2.0, 0.0, -6.0, 0.0, 0.0]]))
    while play(driver).ending.shown < 1:
        driver.skip()


def shared(driver: Driver) -> None:
    """Fly with the network's help among hills."""
    driver.frames(3)
    driver.post(pygame.KEYDOWN, key=pygame.K_UP, mod=0)
    driver.frames(60)
