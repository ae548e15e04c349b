"""Reads every word of a flight in every state it can be in: who flies, who flew, what counts and why never disagree."""

from collections.abc import Callable
from datetime import date
from functools import cache

import numpy as np
import pygame
import pytest

from ai.lander.environment import PARAMS, Outcome
from ai.lander.missions import MISSIONS
from game.core import texts
from game.core.scene import Push
from game.flight import networks
from game.flight.days import Days
from game.flight.flight import Flight, StickHolder
from game.flight.flight_file import Entry
from game.flight.logbook import Records
from game.flight.replay import FlightReplay
from game.scenes.logbook.replay import ReplayScene
from game.scenes.logbook.scene import LogbookScene, entry_row, who_and_when
from game.scenes.play.challenge import FlownMission, against
from game.scenes.play.daily import DailyStart
from game.scenes.play.scene import PlayScene
from game.scenes.play.starts import fly_on
from game.scenes.play.tutorial import Tutorial
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.flights import begun, challenge_of, fly_out, kept, play
from tests.support.reading import OnlyFlies, Reading, Weighs, flew, pattern
from tests.support.screens import save_settings

Open = Callable[..., Driver]


@cache
def flown(mission: str, hand: StickHolder) -> Flight:
    flight = begun(3, Weighs(), mission=mission)
    if hand is StickHolder.NETWORK:
        flight.chooser.hand_over()
    return fly_out(flight)


def recorded(context: Context, *, mission: str = "", hand: StickHolder = StickHolder.HUMAN) -> ReplayScene:
    return ReplayScene(context, kept(context, flown(mission, hand), course=mission, alone=hand is StickHolder.HUMAN))


def raced(replay: ReplayScene) -> PlayScene:
    return PlayScene(replay.context, replay.record.recording.seed, challenge=against(replay.record))


def flown_on(context: Context, **more: object) -> PlayScene:
    replay = recorded(context, **more)
    flight_replay = FlightReplay(replay.record)
    flight_replay.scout(40)
    flight_replay.go_to(30)
    return fly_on(replay.context, replay.record, flight_replay)


SCENES: dict[str, Callable[[Context], PlayScene]] = {
    "free": lambda context: PlayScene(context, 4),
    "mission": lambda context: PlayScene(context, 0, challenge=FlownMission(MISSIONS["brake"])),
    "daily": lambda context: PlayScene(context, 0, challenge=DailyStart(date(2026, 1, 1), Days(context.user_dir))),
    "duel": lambda context: PlayScene(context, 4, rival=Weighs(), rival_name="it"),
    "race": lambda context: raced(recorded(context)),
    "race a mission": lambda context: raced(recorded(context, mission="brake")),
    "flown on": flown_on,
    "flown on a network's": lambda context: flown_on(context, hand=StickHolder.NETWORK),
    "flown on a mission": lambda context: flown_on(context, mission="brake"),
    "tutorial": lambda context: PlayScene(context, 0, challenge=Tutorial()),
}
FREE: dict[str, dict[str, object]] = {
    "three pads": {"three_pads": True},
    "slow": {"pace": 0.5},
    "guided": {"help": "guide"},
    "guided, three pads": {"help": "guide", "three_pads": True},
}
WAYS = ("by hand", "hands off", "handed over", "handed over and back", "dial to and fro")
MORE: tuple[dict[str, object], ...] = ({}, {"help": "guard"}, {"help": "guide"}, {"pace": 0.5})
# Every way of flying a free flight with help and a mission without; all else in one way each, turn and turn about.
STATES = [("free", MORE[1], way) for way in WAYS] + [("mission", {}, way) for way in WAYS[1:]]
REST = [("free", more) for more in FREE.values()]
REST += [(scene, MORE[number % len(MORE)]) for number, scene in enumerate(SCENES)]
STATES += [(scene, more, WAYS[number % len(WAYS)]) for number, (scene, more) in enumerate(REST)]
LOST = [Outcome.CRASHED, Outcome.OUT_OF_BOUNDS, Outcome.TIMED_OUT]
LOSSES = [(*state, LOST[number % len(LOST)]) for number, state in enumerate(STATES[-len(SCENES) :])]
NO_LANDINGS = [pattern(text) for text in (*texts.MEDALS, texts.SCORE, texts.SCORE_BEST, texts.MEDAL_NEXT)]


@pytest.mark.parametrize(
    ("scene", "settings", "way", "outcome"), [*((*state, Outcome.LANDED) for state in STATES), *LOSSES]
)
def test_header_panel_hints_card_and_logbook_say_the_same(
    open_game: Open, context: Context, monkeypatch, scene: str, settings: dict, way: str, outcome: Outcome
):
    reading = begin(open_game, context, monkeypatch, scene, settings)
    driver = reading.driver
    reading.check(2)
    set_off(reading, way)
    reading.check(20)
    end(driver, outcome)
    if scene == "tutorial" and outcome is not Outcome.LANDED:  # it begins again, and says why
        page = reading.page()
        assert not page.who
        assert challenge_of(driver).why in page.words
        return
    page = reading.check(140 if "pace" in settings else 70)  # at half speed the card takes twice as long to come
    if play(driver).challenge and not play(driver).challenge.rules.kept:
        return
    entry = Records(context.user_dir).entries()[-1]
    assert entry.outcome == outcome.name
    assert entry.alone == (not entry.bar)
    who = flew(play(driver).flight.recording.hands)
    both = texts.LOGBOOK_SHARED.format(who=texts.THE_NETWORK)
    assert who_and_when(entry).endswith(both if who == "both" else who)
    if outcome is Outcome.LANDED:
        assert entry.alone == (False not in page.counts)
        assert not entry.bar or any(barred(entry) in word for word in page.words), page.words
        won = [medal for medal in (1, 2, 3) if any(word.endswith(texts.MEDALS[medal]) for word in page.words)]
        assert won == [entry.medal] * bool(entry.medal)
        assert texts.SCORE_BEST.format(count=entry.score) not in page.words or entry.alone
    else:
        title = texts.OUTCOMES[outcome.name][0]
        titles = {word for word in page.words if word in {each for each, _ in texts.OUTCOMES.values()}}
        assert {title} <= titles <= {title, *texts.RIVAL_RESULTS.values()}
        assert not [word for word in page.words if any(says.match(word) for says in NO_LANDINGS)]
        assert (entry.medal, entry.score, entry_row(entry)[2]) == (0, 0, title)
        assert False not in page.counts or entry.bar
    assert_book_agrees(reading, entry)


def begin(open_game: Open, context: Context, monkeypatch: pytest.MonkeyPatch, scene: str, settings: dict) -> Reading:
    monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("stand-in", Weighs()))
    save_settings(context, **settings)
    reading = Reading(open_game(SCENES[scene]), monkeypatch)
    flight = reading.driver.top.flight
    assert (flight.chooser.copilot is not None) == (
        flight.chooser.network is not None and flight.chooser.shares
    )  # or nothing is shared here
    return reading


def set_off(reading: Reading, way: str) -> None:
    driver = reading.driver
    if way != "handed over":
        driver.post(pygame.KEYDOWN, key=pygame.K_UP, mod=0, unicode="", scancode=0)
        reading.check(4)
    if way in ("hands off", "handed over and back"):
        driver.post(pygame.KEYUP, key=pygame.K_UP, mod=0, unicode="", scancode=0)
    if way.startswith("handed over"):
        driver.key(pygame.K_TAB)
        reading.check(10)
    if way == "handed over and back":
        driver.key(pygame.K_TAB)
    if way == "dial to and fro":
        driver.keys(pygame.K_PLUS, pygame.K_PLUS)
        reading.check(10)
        driver.keys(*[pygame.K_MINUS] * 12)


def end(driver: Driver, outcome: Outcome) -> None:
    """Bring the flight to an end of that kind."""
    play(driver).flown.waiting = False
    env = play(driver).flight.env
    x, y = env.pad[0].tolist()
    driver.post(pygame.KEYUP, key=pygame.K_UP, mod=0, unicode="", scancode=0)
    state = {
        Outcome.LANDED: (x, y + PARAMS.stand + 0.002, 0, 0, 0, 0),
        Outcome.CRASHED: (x, y + PARAMS.stand + 0.1, 0, -9, 0, 0),
        Outcome.OUT_OF_BOUNDS: (-env.limits.half_width + 0.1, 15, -8, 0, 0, 0),
        Outcome.TIMED_OUT: (x, 15, 0, 0, 0, 0),
    }[outcome]
    env.place(np.ones(1, bool), np.array([state]))
    if outcome is Outcome.TIMED_OUT:
        env.steps[:] = round(60 * env.limits.time) - 3
    for _ in range(400):
        driver.skip()
        if play(driver).flight.over:
            break
    assert play(driver).flight.outcome is outcome


def barred(entry: Entry) -> str:
    return texts.NOT_COUNTED[entry.bar].format(who=texts.THE_NETWORK)


def assert_book_agrees(reading: Reading, entry: Entry) -> None:
    """Open the logbook at that flight: it reads as the card read."""
    reading.driver.app.scenes.apply(Push(LogbookScene(reading.driver.app.context)))
    page = reading.page(2)
    assert reading.driver.top.chosen == entry
    if entry.bar:
        assert any(word.endswith(barred(entry)) for word in page.words), page.words
    else:
        assert not page.counts
    if entry.landed:
        points = texts.LOGBOOK_UNCOUNTED if entry.bar else "{points}"
        assert points.format(points=entry.score) in page.words


@pytest.mark.parametrize("network", [OnlyFlies(), None])
def test_nobody_is_said_to_help_who_can_not(open_game: Open, context: Context, monkeypatch, network: object):
    save_settings(context, help="guide")
    monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("stand-in", network, "it is gone"))
    reading = Reading(open_game(PlayScene, 4), monkeypatch)
    reading.check(3)
    reading.driver.key(pygame.K_UP)
    assert reading.check(20).who == {"person"}
    end(reading.driver, Outcome.LANDED)
    assert reading.check(70).flew == set(), "nobody but you"
    assert Records(context.user_dir).entries()[-1].alone


def test_where_nobody_may_help_nobody_does_and_it_is_said(open_game: Open, context: Context, monkeypatch):
    reading = begin(open_game, context, monkeypatch, "daily", {"help": "guide"})
    driver = reading.driver
    driver.key(pygame.K_TAB)
    assert driver.said == texts.FLOWN_ALONE
    play(driver).choose_network("stand-in")  # in a pause
    driver.keys(pygame.K_TAB, pygame.K_PLUS)
    assert play(driver).flight.chooser.hand is StickHolder.HUMAN
    assert reading.check(3).who == {"person"}


def test_the_choices_say_what_letting_go_does(open_game: Open, context: Context, monkeypatch):
    for helped in (True, False):
        reading = begin(open_game, context, monkeypatch, "free", {"help": "guide" if helped else "off"})
        reading.driver.key(pygame.K_c)
        words = " ".join(reading.page(2).words)
        assert (texts.HELP_MEANS["guide"] in words) is ("you fall" not in words) is helped
        reading.driver.keys(*[pygame.K_DOWN] * 2)
        reading.driver.keys(*[pygame.K_LEFT if helped else pygame.K_RIGHT] * 3)
        words = " ".join(reading.page(2).words)
        assert (texts.HELP_MEANS["guide"] in words) is ("you fall" not in words) is not helped


def test_a_replay_says_who_flew_from_its_first_moment_on(open_game: Open, monkeypatch):
    for hand in StickHolder:
        reading = Reading(open_game(recorded, hand=hand), monkeypatch)
        reading.driver.key(pygame.K_SPACE)
        for step in (0, 1, 20):
            reading.driver.top.go_to(step)
            assert reading.page().flew == {"you" if hand is StickHolder.HUMAN else "network"}


def test_a_change_after_the_end_changes_nothing_of_what_was_flown(open_game: Open, context: Context, monkeypatch):
    reading = begin(open_game, context, monkeypatch, "free", {})
    reading.driver.key(pygame.K_UP)
    end(reading.driver, Outcome.LANDED)
    before = reading.check(70)
    for name, value in {"help": "guide", "pace": 0.5}.items():
        setattr(reading.driver.app.context.settings, name, value)
    after = reading.check(4)
    assert (after.flew, after.counts) == (before.flew, before.counts) == (set(), set()), "nobody but you"
