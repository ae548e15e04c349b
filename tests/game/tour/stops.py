"""Every screen in each of the states that the tour looks at."""

import json
from collections.abc import Callable
from dataclasses import asdict, dataclass, field, replace

import pygame

from game.core import texts
from game.flight.logbook import LOGBOOK, Records
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.games import OpenGame
from tests.support.screens import FLOWN, OVER_OTHERS, SCREENS, crashed, opened, save_settings, shared
from tests.support.tour import stock


@dataclass(frozen=True)
class Stop:
    """A screen in one of its states: how the player's folder is filled, what is set, and what is done there."""

    screen: str
    state: str = ""
    happens: Callable[[Driver], object] = lambda _: None
    settings: dict[str, object] = field(default_factory=dict)
    prepare: Callable[[Context], object] = lambda _: None

    def __str__(self) -> str:
        return f"{self.screen}, {self.state}".removesuffix(", ")

    @property
    def walked(self) -> bool:
        """Whether it is a screen as it opens, to be walked through and left."""
        return not self.state and self.screen not in FLOWN

    def open(self, open_game: OpenGame, context: Context) -> Driver:
        """Open it at the largest size of text."""
        self.prepare(context)
        save_settings(context, text_size="largest", **self.settings)
        driver = opened(open_game, self.screen)
        self.happens(driver)
        return driver


def keys(*pressed: int, frames: int = 0) -> Callable[[Driver], None]:
    """Return what presses keys and lets frames pass."""

    def press(driver: Driver) -> None:
        driver.keys(*pressed)
        driver.skip(frames)

    return press


def listed(context: Context) -> None:
    """Fill every list, the logbook also with an entry of which much is to be said."""
    stock(context)
    fields = {"course": "ferry", "medal": 3, "outcome": "OUT_OF_BOUNDS", "human": 0.5}
    usual = Records(context.user_dir).entries()[0]
    entries = [replace(usual, **fields), usual, replace(usual, spawn="rung_3"), replace(usual, course="descent", leg=2)]
    with (context.user_dir / LOGBOOK).open("a", encoding="utf-8") as file:
        file.writelines(3 * [json.dumps(asdict(entry)) + "\n" for entry in entries])


def in_flight(driver: Driver) -> None:
    """Fly, with the main engine on."""
    driver.frames(3)
    driver.post(pygame.KEYDOWN, key=pygame.K_UP, mod=0)
    driver.frames(50)


def touched(driver: Driver) -> None:
    """Stop, and tilt the lander."""
    driver.key(pygame.K_SPACE)
    driver.post(pygame.MOUSEWHEEL, x=0, y=1)
    driver.frames(2)


def mapped(driver: Driver) -> None:
    """Colour the sky."""
    driver.top._choose_map(1)
    driver.frames(60)


STOPS = [
    *map(Stop, (*SCREENS, *FLOWN, *OVER_OTHERS)),
    *(
        Stop(name, "with much to list", keys(pygame.K_DOWN), prepare=listed)
        for name in ("LogbookScene", "MissionsScene", "NetworksScene")
    ),
    Stop("NetworksScene", "naming", lambda driver: driver.press_on(texts.RUN_RENAME), prepare=stock),
    Stop("BindingsScene", "binding", keys(pygame.K_RETURN)),
    Stop("WatchScene", "stopped", keys(pygame.K_SPACE)),
    Stop("WatchScene", "touched", touched),
    Stop("WatchScene", "under a map", mapped, {"opened": "watch"}),
    Stop("WatchScene", "explained", keys(pygame.K_SPACE, pygame.K_RETURN, pygame.K_UP, pygame.K_F1)),
    Stop("swarm", "after a while", keys(frames=400)),
    Stop("Play", "flown by the network", keys(pygame.K_TAB)),
    Stop("Play", "in flight", in_flight),
    Stop("mission", "in flight", in_flight),
    Stop("descent", "in flight", in_flight),
    Stop("daily", "in flight", in_flight),
    Stop("tutorial", "in flight", in_flight),
    Stop("Play", "guarded", in_flight, {"help": "guard"}),
    Stop("Play", "thinking", in_flight, {"show_thinking": True}),
    Stop("FlightPauseScene", "of a flight", keys(frames=90)),
    Stop("Play", "card", crashed),
    Stop("mission", "card", crashed),
    Stop("Play", "shared", shared, {"help": "guide", "three_pads": True}),
    Stop("Play", "practice", shared, {"pace": 0.7}),
]
