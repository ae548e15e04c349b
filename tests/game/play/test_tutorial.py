"""The first flight: its lessons, and what it says, which a reader does to the letter, with every device there is."""

import re
from collections.abc import Callable, Iterator

import numpy as np
import pygame
import pytest

from ai.lander.environment import Outcome
from ai.lander.pilots import ScriptedPilot
from game.core import texts
from game.core.scene import Push
from game.flight import networks
from game.flight.flight import StickHolder
from game.flight.logbook import Records
from game.flight.outcomes import crash_reason
from game.input.bindings import Held
from game.scenes.menus.menu import MenuScene
from game.scenes.menus.settings import SettingsScene
from game.scenes.play.scene import PlayScene
from game.scenes.play.tutorial import COPILOT, LESSONS, Tutorial
from game.ui.context import Context
from tests.support.drawn import Drawn
from tests.support.driver import Driver
from tests.support.flights import play
from tests.support.listener import Listener

Open = Callable[..., Driver]
PILOT = ScriptedPilot()
NAMES = [lesson.name for lesson in LESSONS if lesson.needs != COPILOT]  # the stand-in can share no stick
pytestmark = pytest.mark.usefixtures("scripted_network")


def tutorial(driver: Driver) -> Tutorial:
    challenge = play(driver).challenge
    assert isinstance(challenge, Tutorial)
    return challenge


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

    def lessons(self, most: int = 6000) -> Iterator[str]:
        """Do as the lessons say until all is done; the lessons, as they come."""
        last = ""
        for _ in range(most):
            if self.challenge.through:
                break
            if (name := self.challenge.lesson.name) != last:
                yield name
                last = name
            self.follow()
        assert self.challenge.through, self.read[-1]
        self.hold(set())
        self.driver.unseen = False

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


DEVICES = ("keys", "pad", "mouse")


def reader(open_game: Open, device: str, late: int = 0) -> Reader:
    return Reader(open_game(PlayScene, 0, challenge=Tutorial()), device, late)


def wait_for_another(driver: Driver) -> None:
    """Let what flies come to its end, and the next flight begin."""
    first = play(driver).flight
    for _ in range(1500):
        if play(driver).flight is not first:
            return
        driver.skip()
    raise AssertionError("nothing begins again")


def test_the_very_first_flight_teaches_all_of_it_and_free_flights_follow(open_game: Open, context: Context):
    driver = open_game(tutored=False)
    driver.key(pygame.K_RETURN)
    assert list(Reader(driver, "keys").lessons()) == NAMES
    scene = play(driver)
    assert scene.flight.outcome is Outcome.LANDED
    driver.frames(90)
    assert scene.ending.card is not None
    assert scene.ending.card.title == texts.TUTORIAL_DONE
    assert not Records(context.user_dir).entries()
    driver.key(pygame.K_RETURN)
    assert play(driver).challenge.free
    assert play(driver).waiting
    driver.app.close()
    assert saved(driver) == (True, True)
    settings = open_game(SettingsScene, "flights")
    assert settings.widget(texts.TUTORIAL_OPEN)._figure == texts.TUTORIAL_FLOWN


def test_only_the_very_first_flight_teaches(open_game: Open):
    driver = open_game()
    driver.keys(pygame.K_RETURN, pygame.K_RETURN)
    assert play(driver).challenge.free


def test_a_crash_is_reported_once_and_then_beside_the_next_craft(open_game: Open, monkeypatch: pytest.MonkeyPatch):
    driver = open_game(PlayScene, 0, challenge=Tutorial())
    for _ in range(2):
        driver.key(pygame.K_n)  # to the fall, and the braking
    driver.key(pygame.K_LEFT)
    first = play(driver).flight
    while not first.over:
        driver.skip()
    drawn = Drawn(monkeypatch)
    reason = crash_reason(first.env)
    while play(driver).flight is first:
        drawn.clear()
        driver.frames(1)
        assert drawn.words.count(reason) <= 1
    drawn.clear()
    driver.frames(1)
    assert drawn.words.count(reason) == 1


def test_who_rises_while_braking_is_asked_to_let_go(open_game: Open):
    driver = open_game(PlayScene, 0, challenge=Tutorial())
    challenge = tutorial(driver)
    for _ in range(2):
        driver.key(pygame.K_n)
    assert challenge.lesson.name == "brake"
    scene = play(driver)
    controls = driver.app.context.controls
    keys = {"main": controls.word(Held.MAIN)}
    assert challenge.sentence(scene.flight, controls) == texts.TUTORIAL["brake"][0].format(**keys)
    scene.flight.env.place(np.ones(1, bool), np.array([[0.0, 12.0, 0.0, 0.5, 0.0, 0.0]]))
    assert challenge.sentence(scene.flight, controls) == texts.TUTORIAL_RISES.format(**keys)


def test_a_lesson_that_is_done_is_heard(open_game: Open, context: Context):
    context.sound = sound = Listener()
    lessons = reader(open_game, "keys").lessons()
    next(lessons)
    sound.heard()
    next(lessons)
    assert sound.heard().count("choose") == 1


def test_no_copilot_does_what_is_to_be_learnt(open_game: Open, context: Context):
    driver = open_game(MenuScene)
    context.settings.assist = 1.0
    driver.app.scenes.apply(Push(PlayScene(driver.app.context, 0, challenge=Tutorial())))
    driver.key(pygame.K_n)
    driver.key(pygame.K_LEFT)
    driver.frames(20)
    assert not play(driver).flight.shared
    assert play(driver).flight.env.velocity[0, 1] < -0.3
    play(driver).choose_network("modern")  # in a pause
    driver.frames(5)
    assert play(driver).flight.network is not None
    assert not play(driver).flight.shared


def test_who_goes_on_watching_the_network_until_it_lands_has_watched_it_and_goes_on(open_game: Open):
    pupil = reader(open_game, "keys")
    driver = pupil.driver
    for name in pupil.lessons():
        if name == "take_back":
            break
    first = play(driver).flight
    wait_for_another(driver)  # the network goes on to land
    assert first.outcome is Outcome.LANDED
    assert tutorial(driver).lesson.name == "land"
    assert play(driver).flight.hand is StickHolder.HUMAN


def test_who_has_tipped_over_is_asked_to_turn_before_anything_else(open_game: Open):
    driver = open_game(PlayScene, 0, challenge=Tutorial())
    driver.key(pygame.K_UP)
    flight, controls = play(driver).flight, driver.app.context.controls
    for tilt, left in ((61, False), (-138, True), (20, None)):
        flight.env.place(np.ones(1, bool), np.array([[0.0, 6.0, 0.0, -4.0, np.radians(tilt), 0.0]]))
        words = tutorial(driver).sentence(flight, controls)
        turn = {True: Held.LEFT, False: Held.RIGHT}.get(left)
        wanted = texts.TUTORIAL_TURN_FIRST.format(other=controls.word(turn)) if turn else None
        assert words == (wanted or texts.TUTORIAL_TOO_FAST.format(main=controls.word(Held.MAIN))), tilt


def test_each_lesson_can_be_skipped(open_game: Open, context: Context):
    driver = open_game(MenuScene, tutored=False)
    driver.key(pygame.K_RETURN)
    for name in NAMES:
        if name == "take_back":
            continue  # who does not hand over has nothing to take back
        assert tutorial(driver).lesson.name == name
        driver.key(pygame.K_n)
    assert play(driver).challenge.free
    assert saved(driver) == (True, False)  # left out, and not flown


def saved(driver: Driver) -> tuple[bool, bool]:
    values = driver.saved()
    return values["tutored"], values["first_flown"]


def test_it_is_offered_until_it_is_flown_or_left_out(open_game: Open, context: Context):
    driver = open_game(MenuScene, tutored=False)
    driver.keys(pygame.K_RETURN, pygame.K_ESCAPE)
    driver.press_on(texts.PAUSE_LEAVE)
    assert driver.top_name == "MenuScene"
    driver.key(pygame.K_RETURN)
    assert tutorial(driver).lesson.name == "fire"
    assert saved(driver) == (False, False)
    driver.key(pygame.K_UP)
    driver.key(pygame.K_ESCAPE)
    assert "PauseScene" in driver.top_name
    word = next(word for word in driver.form.widgets if word.label == texts.TUTORIAL_LEAVE)
    driver.form.focus(word)
    driver.key(pygame.K_RETURN)
    assert play(driver).challenge.free
    assert saved(driver) == (True, False)


def test_without_a_network_nobody_is_asked_to_hand_over(open_game: Open, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("none", None, "it is gone"))
    pupil = reader(open_game, "keys")
    assert list(pupil.lessons()) == [name for name in NAMES if name not in ("hand_over", "take_back")]


def test_a_device_with_one_sign_for_both_turns_names_it_once(open_game: Open):
    driver = open_game(PlayScene, 0, challenge=Tutorial())
    for _ in range(3):
        driver.key(pygame.K_n)
    challenge, controls = tutorial(driver), driver.app.context.controls
    flight = play(driver).flight
    assert challenge.lesson.name == "lean"
    assert challenge.sentence(flight, controls).startswith(
        f"{controls.word(Held.LEFT)} or {controls.word(Held.RIGHT)} "
    )
    driver.move((640, 360))
    assert " or " not in challenge.sentence(flight, controls).split(".")[0]


@pytest.mark.parametrize(("device", "late"), [("keys", 18), ("pad", 0), ("mouse", 18)])
def test_who_does_all_that_is_said_to_the_letter_lands(open_game: Open, device: str, late: int):
    pupil = reader(open_game, device, late)
    assert list(pupil.lessons()) == NAMES
    assert play(pupil.driver).flight.outcome is Outcome.LANDED
    assert pupil.driver.app.context.settings.first_flown


@pytest.mark.parametrize("device", DEVICES)
def test_who_holds_on_to_the_engine_is_warned_lost_shown_why_and_goes_on_by_letting_go(open_game: Open, device: str):
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
