"""The first flight: its lessons, and what it says, which a reader does to the letter, with every device there is."""

import math
import re
from collections.abc import Callable, Iterator

import numpy as np
import pygame
import pytest

from ai.lander.environment import Outcome
from ai.lander.pilots import ScriptedPilot
from ai.lander.push import KEYS
from game.core import texts
from game.core.scene import Push
from game.flight.logbook import Records
from game.flight.outcomes import crash_reason
from game.input.bindings import Held
from game.scenes.menus.menu import MenuScene
from game.scenes.menus.settings import SettingsScene
from game.scenes.play.challenge import Wanted
from game.scenes.play.scene import PlayScene
from game.scenes.play.tutorial import COPILOT, LESSONS, Tutorial
from game.ui.context import Context
from tests.game.play.ends import ON_PAD, TOO_FAST, end, place
from tests.support.drawn import Drawn
from tests.support.driver import Driver
from tests.support.flights import begun, play
from tests.support.listener import Listener
from tests.support.player import Player

Open = Callable[..., Driver]
PILOT = ScriptedPilot()
NAMES = [lesson.name for lesson in LESSONS if lesson.needs != COPILOT]  # the stand-in can share no stick
pytestmark = pytest.mark.usefixtures("scripted_network")


def tutorial(driver: Driver) -> Tutorial:
    challenge = play(driver).challenge
    assert isinstance(challenge, Tutorial)
    return challenge


LEFT, MAIN, RIGHT = "left", "main", "right"
MARKED = ("TOO_FAST", "TOO_HIGH", "TURN_FIRST", "AWAY", "TURNS", "RISES", "LET_GO", "AGAIN", "READY")
LINES = texts.TUTORIAL | {name: (getattr(texts, f"TUTORIAL_{name}"),) for name in MARKED}
SENTENCES = [
    (name + "'" * number, re.compile(re.sub(r"\\{(\w+)\\}", r"(?P<\1>.+?)", re.escape(line))))
    for name, lines in LINES.items()
    for number, line in enumerate(lines)
    if line
]


class Reader:
    """Does with one device what is written beside the craft, `late` frames after it was read."""

    def __init__(self, driver: Driver, device: str, late: int = 0) -> None:
        self.driver, self.player, self.device, self.late = driver, Player(driver, device), device, late
        self.held: set[str] = set()
        self.read: list[tuple[str, dict[str, str]]] = []
        self.touch()
        driver.unseen = True

    @property
    def challenge(self) -> Tutorial:
        return tutorial(self.driver)

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
                return {MAIN} if env.velocity[0, 1] < -0.95 else set()  # as it is shown
            case "lean":
                return {LEFT}
            case "TURN_FIRST":
                return {self.side(keys["other"])}
            case "upright" | "upright'":  # a tap is a tenth of a second; who sees it turn back looks for longer
                apart = 24 if name == "upright" and env.angle[0] * env.angular_velocity[0] < 0 else 18
                return {self.side(keys["other"])} if len(self.read) % apart < 6 else set()
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
            if self.challenge.rules.through:
                break
            if (name := self.challenge.lesson.name) != last:
                assert play(self.driver).waiting, "its words are read before anything falls"
                yield name
                last = name
            self.follow()
        assert self.challenge.rules.through, self.read[-1]
        self.hold(set())
        self.driver.unseen = False

    def follow(self) -> None:
        """Play one frame."""
        self.read.append(self.sentence())
        name, keys = self.read[max(0, len(self.read) - 1 - self.late)]
        self.hold(self.asked(name, keys))
        if name.startswith("hand_over") and len(self.read) % 40 == 0:
            self.press_hand_over()
        self.driver.skip()

    def hold(self, wanted: set[str]) -> None:
        for name in sorted(self.held ^ wanted):
            self.tell(name, down=name in wanted)
        self.held = wanted

    def tell(self, name: str, *, down: bool) -> None:
        if self.device != "mouse":
            self.player._tell(name, down=down)
            return
        at = pygame.mouse.get_pos()
        if name != MAIN:
            at = self.driver.to_window((20 if name == LEFT else 1260, 400))
            buttons = int(MAIN in self.held), 0, int(bool(self.held & {LEFT, RIGHT}))
            pygame.event.post(pygame.Event(pygame.MOUSEMOTION, pos=at, rel=(0, 0), buttons=buttons))
        kind = pygame.MOUSEBUTTONDOWN if down else pygame.MOUSEBUTTONUP
        pygame.event.post(pygame.Event(kind, pos=at, button=1 if name == MAIN else 3))

    def press_hand_over(self) -> None:
        if self.device != "mouse":
            self.player.press("hand over")
            return
        self.driver.frames(1)
        hints = self.driver.hints()
        self.driver.click(hints.get(texts.HINT_HAND_OVER) or hints[texts.HINT_TAKE_BACK])


def at_lesson(open_game: Open, name: str) -> Driver:
    driver = open_game(PlayScene, 0, challenge=Tutorial())
    while tutorial(driver).lesson.name != name:
        driver.key(pygame.K_n)
    return driver


def test_the_very_first_flight_teaches_all_of_it_and_free_flights_follow(open_game: Open, context: Context):
    context.sound = sound = Listener()
    driver = open_game(tutored=False)
    driver.key(pygame.K_RETURN)
    sound.heard()
    assert list(Reader(driver, "keys", late=18).lessons()) == NAMES
    assert sound.heard().count("choose") == len(NAMES) - 1, "a lesson that is done is heard; a landing is anyway"
    scene = play(driver)
    end(driver, ON_PAD)
    assert scene.ending.card.title == texts.TUTORIAL_DONE
    assert not Records(context.user_dir).entries()
    driver.key(pygame.K_RETURN)
    assert play(driver).challenge.rules.free
    assert play(driver).waiting
    driver.app.close()
    assert saved(driver) == (True, True)
    assert context.settings.help == "off", "whose first landings count"
    settings = open_game(SettingsScene, "flights")
    assert settings.widget(texts.TUTORIAL_OPEN)._figure == texts.TUTORIAL_FLOWN


def test_a_crash_is_reported_once_and_then_beside_the_next_craft(open_game: Open, monkeypatch: pytest.MonkeyPatch):
    driver = at_lesson(open_game, "brake")
    driver.key(pygame.K_LEFT)
    first = play(driver).flight
    place(first.env, *TOO_FAST)
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


def test_who_rises_while_braking_is_asked_to_let_go_and_who_has_tipped_over_to_turn_first(open_game: Open):
    driver = at_lesson(open_game, "brake")
    flight, controls = play(driver).flight, driver.app.context.controls
    keys = {"main": controls.word(Held.MAIN)}
    for up, tilt, wanted in (
        (-2.0, 0, texts.TUTORIAL["brake"][0].format(**keys)),
        (0.5, 0, texts.TUTORIAL_RISES.format(**keys)),
        (-7.0, 61, texts.TUTORIAL_TURN_FIRST.format(other=controls.word(Held.RIGHT))),
        (-7.0, -138, texts.TUTORIAL_TURN_FIRST.format(other=controls.word(Held.LEFT))),
        (-7.0, 20, texts.TUTORIAL_TOO_FAST.format(**keys)),
    ):
        place(flight.env, 0.0, 12.0, 0.0, up, np.radians(tilt), 0.0)
        assert tutorial(driver).sentence(flight, controls) == wanted, (up, tilt)
    for aside, turn in ((-13.0, Held.RIGHT), (13.0, Held.LEFT)):
        place(flight.env, aside, 12.0, 0.0, -2.0, 0.0, 0.0)
        assert tutorial(driver).sentence(flight, controls) == texts.TUTORIAL_AWAY.format(
            inward=controls.word(turn), **keys
        )


def test_no_copilot_does_what_is_to_be_learnt(open_game: Open, context: Context):
    driver = open_game(MenuScene)
    context.settings.help = "guide"
    driver.app.scenes.apply(Push(PlayScene(driver.app.context, 0, challenge=Tutorial())))
    driver.key(pygame.K_n)
    driver.key(pygame.K_LEFT)
    driver.frames(20)
    assert not play(driver).flight.chooser.shared
    assert play(driver).flight.env.velocity[0, 1] < -0.3
    play(driver).choose_network("modern")  # in a pause
    driver.frames(5)
    assert play(driver).flight.chooser.network is not None
    assert not play(driver).flight.chooser.shared


def test_who_goes_on_watching_the_network_until_it_lands_has_watched_it_and_goes_on(open_game: Open):
    driver = at_lesson(open_game, "hand_over")
    driver.keys(pygame.K_UP, pygame.K_TAB)
    first = play(driver).flight
    while not first.over:  # the network goes on to land
        driver.skip(10)
    assert first.outcome is Outcome.LANDED
    assert tutorial(driver).rules.through


def test_who_has_landed_is_praised_until_the_next_flight_and_not_told_to_do_it_once_more(open_game: Open):
    driver = at_lesson(open_game, "land")
    driver.key(pygame.K_UP)
    lessons, first, said = tutorial(driver), play(driver).flight, set[str]()
    place(first.env, *ON_PAD)
    while play(driver).flight is first:
        driver.skip()
        if first.over and play(driver).flight is first:
            said.add(lessons.sentence(first, driver.app.context.controls))
    assert said == {texts.TUTORIAL_GOOD["land"]}
    assert lessons.lesson.name == "hand_over"


def saved(driver: Driver) -> tuple[bool, bool]:
    values = driver.saved()
    return values["tutored"], values["first_flown"]


def test_what_a_lesson_asks_for_counts_in_a_row_only():
    lessons, flight, heard = Tutorial(), begun(0, PILOT), list[str]()
    place_craft = lessons.start(Wanted(0, PILOT)).place
    assert place_craft is not None
    place_craft(flight)
    for action in [3] * 23 + [0] + [3] * 24:  # of 24 steps
        flight.step(KEYS[action])
        heard.append(lessons.follow(flight))
    assert heard == [""] * 47 + ["choose"]


def test_it_is_offered_until_it_is_flown_or_left_out(open_game: Open, context: Context):
    driver = open_game(MenuScene, tutored=False)
    driver.keys(pygame.K_RETURN, pygame.K_ESCAPE)
    driver.press_on(texts.PAUSE_LEAVE)
    assert driver.top_name == "MenuScene"
    driver.key(pygame.K_RETURN)
    assert tutorial(driver).lesson.name == "fire"
    assert saved(driver) == (False, False)
    driver.keys(pygame.K_UP, pygame.K_ESCAPE)
    driver.press_on(texts.TUTORIAL_LEAVE)
    assert play(driver).challenge.rules.free
    assert saved(driver) == (True, False)


def test_without_a_network_nobody_is_asked_to_hand_over():
    lessons, names = Tutorial(), []
    lessons.start(Wanted(0))
    while not lessons.rules.through:
        names.append(lessons.lesson.name)
        lessons.skip()
    assert names == [name for name in NAMES if name != "hand_over"]


def test_a_device_with_one_sign_for_both_turns_names_it_once(open_game: Open):
    driver = at_lesson(open_game, "lean")
    challenge, controls, flight = tutorial(driver), driver.app.context.controls, play(driver).flight
    left, right = controls.word(Held.LEFT), controls.word(Held.RIGHT)
    assert challenge.sentence(flight, controls).startswith(f"{left} or {right} ")
    driver.move((640, 360))
    assert " or " not in challenge.sentence(flight, controls).split(".")[0]


@pytest.mark.parametrize("late", [0, 18])
@pytest.mark.parametrize(("angle", "spin"), [(-0.3, 0.0), (-0.6, -0.4), (0.5, -0.9), (6.6, 0.0)])
def test_who_is_told_to_stand_upright_is_told_what_is_seen(open_game: Open, angle: float, spin: float, late: int):
    pupil = Reader(at_lesson(open_game, "upright"), "keys", late)
    env = play(pupil.driver).flight.env
    pupil.follow()
    place(env, 0.0, 20.0, 0.0, 2.0, angle, spin)
    said = []
    while pupil.challenge.lesson.name == "upright" and not pupil.challenge.praise:
        leans, turns = math.sin(env.angle[0]), float(env.angular_velocity[0])
        pupil.follow()
        name, keys = pupil.read[-1]
        said += [name] if name not in said[-1:] else []
        if name == "upright":
            assert pupil.side(keys["other"]) == (RIGHT if leans > 0 else LEFT), "against the tilt that is shown"
        elif name == "upright'":
            assert pupil.side(keys["other"]) == (RIGHT if turns > 0 else LEFT), "against the turn"
        else:
            assert name == "praise" or (name == "TURNS" and leans * turns < 0), "it does turn back"
        assert len(pupil.read) < 360
    assert len(said) <= 8, said  # not to and fro


def test_a_lesson_that_restarts_leans_as_the_player_did(open_game: Open):
    for lean in (-0.3, 0.3):
        driver = at_lesson(open_game, "lean")
        lessons, flight = tutorial(driver), play(driver).flight
        driver.key(pygame.K_LEFT)
        place(flight.env, 0.0, 14.0, 0.0, 0.0, lean, 0.0)
        while lessons.lesson.name == "lean":
            driver.skip()
        driver.key(pygame.K_r)
        assert play(driver).flight is not flight
        assert play(driver).flight.env.angle[0] == lean


@pytest.mark.slow
@pytest.mark.parametrize("device", ["pad", "mouse"])
def test_who_does_all_that_is_said_to_the_letter_lands(open_game: Open, device: str):
    pupil = Reader(open_game(PlayScene, 0, challenge=Tutorial()), device)
    assert list(pupil.lessons()) == NAMES
    assert pupil.challenge.flown


def test_who_holds_on_to_the_engine_is_warned_lost_shown_why_and_goes_on_by_letting_go(open_game: Open):
    pupil = Reader(at_lesson(open_game, "brake"), "keys")
    pupil.driver.frames(2)
    pupil.hold({MAIN})
    seen, why = [], ""
    for _ in range(600):
        pupil.driver.skip()
        seen.append(pupil.sentence()[0])
        why = why or pupil.challenge.why
    assert seen.index("TOO_HIGH") < seen.index("AGAIN")
    assert "at the top" in why
    assert seen[-1] == "LET_GO"
    assert play(pupil.driver).waiting
    pupil.hold(set())
    assert pupil.challenge.why
    while pupil.challenge.lesson.name == "brake":
        pupil.follow()
    assert not pupil.challenge.why  # what went wrong before is done with
