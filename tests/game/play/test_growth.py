"""Check flights that are asked for, help that fades, and the words for both, in the game."""

import json
from collections.abc import Callable
from dataclasses import asdict, replace
from types import SimpleNamespace

import numpy as np
import pygame
import pytest

from ai.copilot.alone import Estimate
from ai.lander.missions import MISSIONS
from game.core import texts
from game.core.settings import Settings
from game.flight import fading
from game.flight.becoming import KINDS, Change
from game.flight.flight_file import Entry
from game.flight.logbook import LOGBOOK, Records
from game.flight.rescues import Rescues
from game.flight.skill import said
from game.input.controls import Command
from game.scenes.logbook.scene import LogbookScene
from game.scenes.play import growth
from game.scenes.play.challenge import Challenge, FlownMission
from game.scenes.play.choices import ChoicesScene
from game.scenes.play.scene import PlayScene
from game.scenes.play.tutorial import Tutorial
from game.ui.context import Context
from game.ui.widgets import Toggle
from tests.support.driver import Driver
from tests.support.flights import play

Open = Callable[..., Driver]
HELPED = Entry(0.0, "LANDED", 7.0, 3.0, 0.4, 0.5, barred="helped")
OWN = Entry(0.0, "LANDED", 7.0, 3.0, 0.4, 1.0, alone=True)


def fly(open_game: Open, context: Context, entries: list[Entry], *, fades: bool = True, **settings: object) -> Driver:
    """Open Play with this logbook, and help at 40 %."""
    context.user_dir.mkdir(exist_ok=True)
    (context.user_dir / LOGBOOK).write_text("".join(json.dumps(asdict(entry)) + "\n" for entry in entries))
    context.settings.assist = 0.4
    fading.switch(context.settings, on=fades)
    for name, value in settings.items():
        setattr(context.settings, name, value)
    context.settings_file.save(context.settings)
    driver = open_game(PlayScene, seed=4)
    driver.frames(2)
    return driver


def land(driver: Driver) -> None:
    """Set the craft down on the pad, and wait for the card."""
    place(driver, 0, 1.2, 0, -0.3, 0, 0)


def place(driver: Driver, *start: float) -> None:
    env = play(driver).flight.env
    play(driver).flown.waiting = False
    start = (start[0] + env.ground.pads[0].x, start[1] + env.ground.pads[0].top, *start[2:])
    env.place(np.ones(1, bool), np.array([start]))
    driver.wait(lambda: play(driver).ending.card is not None)


def growth_of(driver: Driver) -> tuple[str, ...]:
    card = play(driver).ending.card
    assert card is not None
    return card.growth


@pytest.mark.parametrize("way", ["key", "button", "click"])
def test_a_check_flight_is_asked_for_and_can_be_skipped(
    open_game: Open, context: Context, written: list[str], way: str
):
    driver = fly(open_game, context, [HELPED] * 4)
    seed = play(driver).flight.recording.seed
    assert play(driver).credit.check
    assert texts.CHECK_BEGIN in written
    assert texts.CHECK_SKIP in driver.hints()
    if way == "key":
        driver.key(pygame.K_n)
    elif way == "button":
        driver.button(driver.app.context.controls.buttons.codes(Command.NEXT)[0])
    else:
        driver.click(driver.hints()[texts.CHECK_SKIP])
    assert not play(driver).credit.check
    assert play(driver).flight.recording.seed == seed
    assert texts.CHECK_SKIP not in driver.hints()
    driver.key(pygame.K_n)
    assert not play(driver).credit.check


def test_it_is_not_asked_for_once_it_has_begun_nor_without_the_switches(open_game: Open, context: Context):
    driver = fly(open_game, context, [HELPED] * 4)
    driver.post(pygame.KEYDOWN, key=pygame.K_UP, mod=0, unicode="", scancode=0)
    driver.frames(3)
    assert play(driver).credit.check
    assert texts.CHECK_SKIP not in driver.hints()
    driver = fly(open_game, context, [HELPED] * 4, fades=False)
    assert not play(driver).credit.check


def test_the_card_says_what_a_check_was_against_and_what_help_does(open_game: Open, context: Context):
    driver = fly(open_game, context, [OWN] * 24 + [HELPED] * 9)
    assert play(driver).credit.check
    land(driver)
    entry = Records(context.user_dir).entries()[-1]
    assert (entry.landed, entry.alone) == (True, True)
    check, fade = growth_of(driver)
    assert check == texts.CHECK_RESULT[1].format(before=10, after=10)
    assert fade == texts.FADE_LINE.format(share=10, before=40, after=30)
    assert driver.app.context.settings.assist == 0.3
    assert driver.saved()["assist"] == 0.3


def test_the_dial_does_not_move_during_a_flight(open_game: Open, context: Context):
    driver = fly(open_game, context, [OWN] * 24)
    driver.post(pygame.KEYDOWN, key=pygame.K_UP, mod=0, unicode="", scancode=0)
    for _ in range(30):
        driver.frames(1)
        assert driver.app.context.settings.assist == 0.4


def test_help_fades_no_longer_once_the_player_turns_the_dial_and_the_game_says_so_once(
    open_game: Open, context: Context
):
    driver = fly(open_game, context, [OWN] * 24 + [HELPED] * 9)
    driver.key(pygame.K_n)
    driver.key(pygame.K_MINUS)
    assert driver.said == texts.FADE_ENDS
    assert not driver.app.context.settings.fade  # its switch says so
    driver.app.notes.show("")
    driver.key(pygame.K_PLUS)
    assert driver.said == ""
    chosen = driver.app.context.settings.assist
    land(driver)
    assert growth_of(driver) == ()
    assert driver.app.context.settings.assist == chosen


def test_fading_is_switched_on_among_the_choices_and_begins_at_the_dials_place(open_game: Open, context: Context):
    driver = fly(open_game, context, [OWN] * 3, fades=False, assist=0.7)
    driver.key(pygame.K_c)
    assert isinstance(driver.top, ChoicesScene)
    driver.press_on(texts.CHOICES_MORE)
    (toggle,) = [
        each for each in driver.form.widgets if isinstance(each, Toggle) and each.label == texts.FADE_CHOICE[0]
    ]
    driver.click((toggle.box.right - 20, toggle.box.centery))
    settings = driver.app.context.settings
    assert (settings.fade, settings.faded_to) == (True, 0.7)


def test_the_logbook_says_the_estimate_by_kind_of_start(open_game: Open, context: Context, written: list[str]):
    fly(open_game, context, [OWN] * 24)
    driver = open_game(LogbookScene)
    driver.frames(3)
    assert texts.BECOMING_ESTIMATE.format(share=10, low=9, high=10) in written
    assert texts.BECOMING_NONE not in written


@pytest.mark.parametrize("last", KINDS)
def test_the_logbook_opens_on_the_kind_flown_last(open_game: Open, context: Context, last: str):
    kinds = {
        "plain": OWN,
        "ladder": replace(OWN, spawn="rung_3"),
        "hills": replace(OWN, pads=3),
        "missions": replace(OWN, course="brake"),
    }
    fly(open_game, context, [*kinds.values(), kinds[last]])
    driver = open_game(LogbookScene)
    driver.frames(2)
    choice = driver.choice(texts.BECOMING_KINDS[last])
    assert choice.options[choice.index] == texts.BECOMING_KINDS[last]


@pytest.mark.parametrize(
    ("challenge", "seen"), [(None, True), (FlownMission(MISSIONS["brake"]), True), (Tutorial(), False)]
)
def test_the_curve_is_shown_for_flights_of_its_kind_alone(
    open_game: Open, context: Context, written: list[str], challenge: Challenge | None, seen: bool
):
    fly(open_game, context, [OWN] * 24)
    driver = open_game(PlayScene, 4, challenge=challenge)
    driver.frames(2)
    driver.key(pygame.K_c)
    written.clear()
    driver.frames(3)
    assert isinstance(driver.top, ChoicesScene)
    assert any(texts.BECOMING_TITLE in each for each in written) is seen


def test_a_rescue_is_counted_only_where_the_pilots_action_was_changed():
    decision = SimpleNamespace(assist=0.4)
    rescues = Rescues()
    for changed in [False] * 90 + [True] * 4 + [False] * 90 + [True] * 4 + [False] * 20 + [True] * 4:
        rescues.follow(SimpleNamespace(decision=decision, shared=True, guarded=True, guard=None, overridden=changed))
    assert rescues.times == 2  # within a second of each other they are the same one


def test_words_for_few_flights_and_for_many():
    assert said(Estimate(0.5, 0.1, 0.9, alone=2)) == texts.BECOMING_TOO_FEW.format(count=2)
    assert said(Estimate(0.7, 0.52, 0.88, alone=20)) == texts.BECOMING_ESTIMATE.format(share=7, low=5, high=9)
    assert said(Estimate(0.99, 0.98, 1.0, alone=20)) == texts.BECOMING_SURE.format(share=10)


def test_the_first_checks_are_not_compared_with_what_is_not_known():
    wide, less = Estimate(0.5, 0.1, 0.9, alone=20), Estimate(0.6, 0.2, 0.95, alone=20)
    change, settings = Change("plain", wide, less), Settings(assist=0.4, fade=True, faded_to=0.4)
    assert growth.follow(change, settings, check=True, landed=True) == (texts.CHECK_FIRST[1],)
    assert growth.follow(change, settings, check=False, landed=True) == ()
    assert growth.follow(None, settings, check=True, landed=True) == ()


@pytest.mark.parametrize(
    ("assists", "throughout"),
    [([0.4, 0.4, 0.4], 0.4), ([0.4, 0.5, 0.5], 0.0), ([None, 0.4], 0.0), ([0.4, None, 0.4], 0.0)],
)
def test_a_guardian_counts_only_if_it_watched_over_the_whole_flight_alike(
    assists: list[float | None], throughout: float
):
    rescues = Rescues()
    for assist in assists:
        decision, guarded = SimpleNamespace(assist=assist), assist is not None
        rescues.follow(
            SimpleNamespace(decision=decision, shared=guarded, guarded=guarded, guard=None, overridden=False)
        )
    assert rescues.throughout == throughout
