"""Reads what the first flight says and does it to the letter, with every device there is."""

import re
from collections.abc import Callable

import pygame
import pytest

from ai.lander.environment import Outcome
from ai.lander.pilots import ScriptedPilot
from game.core import texts
from game.input.bindings import Held
from game.scenes.play.scene import PlayScene
from game.scenes.play.tutorial import Tutorial
from tests.support.driver import Driver
from tests.support.flights import play

pytestmark = pytest.mark.usefixtures("scripted_network")
PILOT = ScriptedPilot()
LEFT, MAIN, RIGHT = "left", "main", "right"
MARKED = ("TOO_FAST", "TOO_HIGH", "TOO_TILTED", "TURN_FIRST", "WATCHED", "AWAY", "STANDS", "LET_GO", "AGAIN", "READY")
LINES = texts.TUTORIAL | {name: (getattr(texts, f"TUTORIAL_{name}"),) for name in MARKED}
SENTENCES = [
    (name, re.compile(re.sub(r"\\{(\w+)\\}", r"(?P<\1>.+?)", re.escape(line))))
    for name, lines in LINES.items()
    for line in lines
    if line
]
KEYS = {MAIN: pygame.K_UP, LEFT: pygame.K_LEFT, RIGHT: pygame.K_RIGHT}
BUTTONS = {MAIN: 1, LEFT: 3, RIGHT: 3}


class Reader:
    """Does with one device what is written beside the craft, `late` frames after it was read."""

    def __init__(self, driver: Driver, device: str, late: int = 0) -> None:
        self.driver, self.device, self.late = driver, device, late
        self.held: set[str] = set()
        self.read: list[tuple[str, dict[str, str]]] = []
        self.touch()
        driver.unseen = True

    @property
    def challenge(self) -> Tutorial:
        challenge = play(self.driver).challenge
        assert isinstance(challenge, Tutorial)
        return challenge

    def touch(self) -> None:
        """Let the game know which device is in use."""
        if self.device == "pad":
            self.driver.axis(pygame.CONTROLLER_AXIS_RIGHTY, 0)
            self.driver.app.context.controls.used_pad = 0
        elif self.device == "mouse":
            self.driver.move((640, 300))
            self.driver.move((644, 300))

    def sentence(self) -> tuple[str, dict[str, str]]:
        """Return which sentence is written, and the keys that it names."""
        scene = play(self.driver)
        controls, flown = self.driver.app.context.controls, scene.flown
        words = self.challenge.sentence(scene.flight, controls, waiting=flown.waiting, stuck=flown.stuck)
        for name, pattern in SENTENCES:
            if found := pattern.fullmatch(words):
                return name, found.groupdict()
        assert words in texts.TUTORIAL_GOOD.values(), words
        return "praise", {}

    def side(self, sign: str) -> str:
        """Return which way a turn goes that is named so."""
        controls = self.driver.app.context.controls
        signs = {side: controls.word(held) for side, held in ((LEFT, Held.LEFT), (RIGHT, Held.RIGHT))}
        if signs[LEFT] == signs[RIGHT]:
            both = texts.TUTORIAL_POINT if self.device == "mouse" else texts.TUTORIAL_PUSH
            signs = {side: text.format(key=signs[LEFT]) for side, text in zip((LEFT, RIGHT), both, strict=True)}
        return next(side for side, each in signs.items() if each == sign)

    def asked(self, name: str, keys: dict[str, str]) -> set[str]:
        """Return what a sentence asks to be held down."""
        env = play(self.driver).flight.env
        match name:
            case "fire" | "TOO_FAST" | "READY":
                assert keys["main"] == self.driver.app.context.controls.word(Held.MAIN)
                return {MAIN}
            case "brake":
                return {MAIN} if env.velocity[0, 1] < -0.8 else set()
            case "lean":
                return {LEFT}
            case "upright" | "TOO_TILTED" | "TURN_FIRST":
                return {self.side(keys["other"])}
            case "AWAY":
                side = self.side(keys["inward"])
                leans = env.angle[0] * (1 if side == LEFT else -1)
                return {MAIN} if leans > 0.3 else {side}
            case "land":
                action = int(PILOT.act(env.observe())[0])
                return ({MAIN} if action >= 3 else set()) | {("", LEFT, RIGHT)[action % 3]} - {""}
        return set()

    def follow(self) -> None:
        """Play one frame."""
        self.read.append(self.sentence())
        name, keys = self.read[max(0, len(self.read) - 1 - self.late)]
        self.hold(self.asked(name, keys))
        if name in ("hand_over", "take_back") and len(self.read) % 40 == 0:
            self.press_hand_over()
        self.driver.skip()

    def hold(self, wanted: set[str]) -> None:
        for name in sorted(self.held ^ wanted):
            self.tell(name, down=name in wanted)
        self.held = wanted

    def tell(self, name: str, *, down: bool) -> None:
        if self.device == "keys":
            pygame.event.post(pygame.Event(pygame.KEYDOWN if down else pygame.KEYUP, key=KEYS[name], mod=0))
        elif self.device == "mouse":
            at = self.driver.to_window((20 if name == LEFT else 1260, 400)) if name != MAIN else pygame.mouse.get_pos()
            if name != MAIN:
                pygame.event.post(pygame.Event(pygame.MOUSEMOTION, pos=at, rel=(0, 0), buttons=(0, 0, 0)))
            kind = pygame.MOUSEBUTTONDOWN if down else pygame.MOUSEBUTTONUP
            pygame.event.post(pygame.Event(kind, pos=at, button=BUTTONS[name]))
        elif name == MAIN:
            kind = pygame.CONTROLLERBUTTONDOWN if down else pygame.CONTROLLERBUTTONUP
            pygame.event.post(pygame.Event(kind, button=pygame.CONTROLLER_BUTTON_A, instance_id=0))
        else:
            value = (-32000 if name == LEFT else 32000) if down else 0
            axis = pygame.CONTROLLER_AXIS_LEFTX
            pygame.event.post(pygame.Event(pygame.CONTROLLERAXISMOTION, axis=axis, value=value, instance_id=0))

    def press_hand_over(self) -> None:
        driver = self.driver
        if self.device == "keys":
            driver.key(pygame.K_TAB)
        elif self.device == "pad":
            driver.button(pygame.CONTROLLER_BUTTON_Y)
        else:
            driver.frames(1)
            hints = driver.hints()
            driver.click(hints.get(texts.HINT_HAND_OVER) or hints[texts.HINT_TAKE_BACK])


Open = Callable[..., Driver]
DEVICES = ("keys", "pad", "mouse")


def reader(open_game: Open, device: str, late: int = 0) -> Reader:
    return Reader(open_game(PlayScene, 0, challenge=Tutorial()), device, late)


def to_the_landing(pupil: Reader, most: int = 6000) -> None:
    for _ in range(most):
        pupil.follow()
        if pupil.challenge.through:
            break
    assert pupil.challenge.flown, pupil.read[-1]
    assert play(pupil.driver).flight.outcome is Outcome.LANDED


@pytest.mark.parametrize(("device", "late"), [("keys", 18), ("pad", 0), ("mouse", 18)])
def test_who_does_all_that_is_said_to_the_letter_lands(open_game: Open, device: str, late: int):
    pupil = reader(open_game, device, late)
    to_the_landing(pupil)
    assert pupil.driver.app.context.settings.first_flown


@pytest.mark.parametrize("device", DEVICES)
def test_who_holds_on_to_the_engine_is_warned_lost_told_why_and_goes_on_by_letting_go(open_game: Open, device: str):
    pupil = reader(open_game, device)
    pupil.driver.frames(2)
    pupil.hold({MAIN})
    seen, why = [], ""
    for _ in range(600):
        pupil.driver.skip()
        seen.append(pupil.sentence()[0])
        why = why or pupil.challenge.why
    assert seen.index("TOO_HIGH") < seen.index("AGAIN")
    assert "at the top" in why
    assert seen[-1] == "fall"  # which says to let go of everything
    assert play(pupil.driver).waiting
    pupil.hold(set())
    pupil.driver.skip(30)
    assert not play(pupil.driver).waiting
    assert play(pupil.driver).flight.env.velocity[0, 1] < -0.3
    assert pupil.challenge.why
    while pupil.challenge.lesson.name == "fall":
        pupil.follow()
    assert not pupil.challenge.why  # what went wrong before is done with
