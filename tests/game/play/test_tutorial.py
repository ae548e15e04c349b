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
from tests.support.player import DEVICES, Player

Open = Callable[..., Driver]
PILOT = ScriptedPilot()
KEYS = ("main", "left", "right")
NAMES = [lesson.name for lesson in LESSONS if lesson.needs != COPILOT]  # the stand-in can share no stick
pytestmark = pytest.mark.usefixtures("scripted_network")


def tutorial(driver: Driver) -> Tutorial:
    challenge = play(driver).challenge
    assert isinstance(challenge, Tutorial)
    return challenge


def obey(scene: PlayScene, name: str) -> int:
    """The action that does what a lesson asks; nothing while a new flight waits for the keys to be let go."""
    if scene.waiting and scene.flown.stuck:
        return 0
    fall = -scene.flight.env.velocity[0, 1]
    simple = {"fire": 3, "fall": 0, "brake": 3 * (fall > 0.7), "lean": 1, "hand_over": 0, "take_back": 0}
    return int(simple[name]) if name in simple else int(PILOT.act(scene.flight.env.observe())[0])


def learn(pupil: Player) -> Iterator[str]:
    """Do as told until all is done; the lessons, as they come."""
    last, held = "", set[str]()
    for step in range(2500):
        pupil.app.window.minimised = step % 10 > 0  # drawing is most of the work
        challenge, env = tutorial(pupil), play(pupil).flight.env
        if challenge.through:
            break
        if (name := challenge.lesson.name) != last:
            yield name
            last = name
        action = 3 * (env.velocity[0, 1] < -1) if challenge.praise else obey(play(pupil), name)
        wanted = {key for key, on in zip(KEYS, (action >= 3, action % 3 == 1, action % 3 == 2), strict=True) if on}
        for key in held ^ wanted:
            pupil.hold(key, down=key in wanted)
        held = wanted
        if name in ("hand_over", "take_back") and not challenge.praise:
            pupil.press("hand over")
        pupil.frames(1)
    assert tutorial(pupil).through, last
    pupil.app.window.minimised = False
    for key in held:
        pupil.hold(key, down=False)


def wait_for_another(driver: Driver) -> None:
    """Let what flies come to its end, and the next flight begin."""
    first = play(driver).flight
    for _ in range(1500):
        if play(driver).flight is not first:
            return
        driver.skip()
    raise AssertionError("nothing begins again")


@pytest.mark.parametrize("device", DEVICES)
def test_the_very_first_flight_teaches_all_of_it_and_free_flights_follow(
    open_game: Open, context: Context, device: str
):
    driver = pupil = Player(open_game(tutored=False), device)
    pupil.press("confirm")
    assert list(learn(pupil)) == NAMES
    scene = play(driver)
    assert scene.flight.outcome is Outcome.LANDED
    driver.frames(90)
    assert scene.ending.card is not None
    assert scene.ending.card.title == texts.TUTORIAL_DONE
    assert not Records(context.user_dir).entries()
    pupil.press("confirm")
    assert play(driver).challenge.free
    assert play(driver).waiting
    driver.app.close()
    assert saved(driver) == (True, True)
    settings = open_game(SettingsScene, "flights")
    assert settings.widget(texts.TUTORIAL_OPEN)._figure() == texts.TUTORIAL_FLOWN


def test_only_the_very_first_flight_teaches(open_game: Open):
    driver = open_game()
    driver.keys(pygame.K_RETURN, pygame.K_RETURN)
    assert play(driver).challenge.free


def test_a_crash_is_told_of_once_and_then_beside_the_next_craft(open_game: Open, monkeypatch: pytest.MonkeyPatch):
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


def test_who_rises_while_braking_is_told_to_let_go(open_game: Open):
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
    pupil = Player(open_game(PlayScene, 0, challenge=Tutorial()), "keys")
    lessons = learn(pupil)
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
    driver = pupil = Player(open_game(PlayScene, 0, challenge=Tutorial()), "keys")
    for name in learn(pupil):
        if name == "take_back":
            break
    first = play(driver).flight
    wait_for_another(driver)  # the network goes on to land
    assert first.outcome is Outcome.LANDED
    assert tutorial(driver).lesson.name == "land"
    assert play(driver).flight.hand is StickHolder.HUMAN


def test_who_has_tipped_over_is_told_to_turn_before_anything_else(open_game: Open):
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
    pupil = Player(open_game(PlayScene, 0, challenge=Tutorial()), "keys")
    assert list(learn(pupil)) == [name for name in NAMES if name not in ("hand_over", "take_back")]


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
