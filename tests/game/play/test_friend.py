"""A friend's flight comes in by paste and by drop at any screen, is checked, raced, taken over and answered."""

from collections.abc import Callable
from dataclasses import replace

import pygame
import pytest

from game.core import texts
from game.flight import codes
from game.flight.flight_file import Record
from game.scenes.logbook.replay import ReplayScene
from game.scenes.logbook.scene import LogbookScene
from game.scenes.menus.menu import MenuScene
from game.scenes.play.challenge import Race
from game.scenes.play.scene import PlayScene
from game.scenes.train.scene import TrainScene
from game.ui.context import Context
from tests.game.play.ends import TOO_FAST, end
from tests.support.driver import Driver
from tests.support.flights import kept, landed, play

Open = Callable[..., Driver]


@pytest.fixture
def record(context: Context) -> Record:
    return kept(context, landed(), alone=True)


@pytest.fixture
def clipboard(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What is in the clipboard: the last text."""
    held = [""]
    monkeypatch.setattr(pygame.scrap, "put_text", held.append)
    monkeypatch.setattr(pygame.scrap, "get_text", lambda: held[-1])
    return held


def page(driver: Driver) -> ReplayScene:
    assert isinstance(driver.top, ReplayScene)
    assert driver.top.friend
    return driver.top


def paste(driver: Driver, text: str, clipboard: list[str]) -> None:
    clipboard.append(text)
    driver.frames(2)
    driver.key(pygame.K_v, pygame.KMOD_LCTRL)
    driver.frames(2)


@pytest.mark.parametrize("scene", [MenuScene, PlayScene, TrainScene])
def test_a_code_is_pasted_at_any_screen(open_game: Open, record: Record, clipboard: list[str], scene):
    driver = open_game(scene)
    paste(driver, f"Beat this: “{codes.code(record)}”", clipboard)
    assert page(driver).record.recording == record.recording
    driver.key(pygame.K_ESCAPE)
    assert isinstance(driver.top, scene)


def test_a_file_is_dropped_at_any_screen(open_game: Open, context: Context, record: Record, tmp_path):
    code = tmp_path / "from a friend.txt"
    code.write_text(codes.code(record))
    for path, scene in ((code, MenuScene), (context.user_dir / "flights" / record.entry.file, PlayScene)):
        driver = open_game(scene)
        driver.frames(2)
        driver.post(pygame.DROPFILE, file=str(path))
        assert page(driver).record.recording == record.recording
        driver.key(pygame.K_ESCAPE)
        driver.frames(2)
        assert isinstance(driver.top, scene)


def test_what_is_no_flight_is_refused_in_a_sentence(
    open_game: Open, tmp_path, clipboard: list[str], monkeypatch: pytest.MonkeyPatch
):
    driver = open_game()
    path = tmp_path / "strange.bin"
    refused = texts.CODE_REFUSED
    for content, why in (
        (b"tranq4-000-over", refused["damaged"]), (b"tranq4-000", refused["cut"]),
        (b"tranq-000-over", refused["older"]), (b"hello", refused["none"]), (b"\xff\xfe", refused["none"]),
        (b"x" * 2_000_000, ""),
    ):  # fmt: skip
        path.write_bytes(content)
        driver.post(pygame.DROPFILE, file=str(path))
        assert driver.top_name == "MenuScene"
        assert driver.said.startswith("strange.bin: ")
        assert why in driver.said

    def nonsense() -> str:
        return b"\xff\xfe".decode()

    monkeypatch.setattr(pygame.scrap, "get_text", nonsense)
    driver.frames(2)
    driver.key(pygame.K_v, pygame.KMOD_LCTRL)
    assert (driver.top_name, driver.said) == ("MenuScene", texts.CODE_PASTE_EMPTY)
    monkeypatch.setattr(pygame.scrap, "get_text", lambda: clipboard[-1])
    paste(driver, "tranq4-000", clipboard)
    assert driver.said == texts.CODE_PASTE_REFUSED.format(reason=refused["cut"])


def test_the_replay_says_what_the_flight_earns_whatever_it_claims(open_game: Open, record: Record, written: list[str]):
    driver = open_game()
    claimed = replace(record, entry=replace(record.entry, score=999))
    driver.post(pygame.DROPTEXT, text=codes.code(claimed))
    driver.frames(2)
    assert texts.COURSE_FREE[1] in written
    page(driver).flight_replay.scout(10_000)
    driver.frames(2)
    assert f"{texts.COURSE_FREE[1]} · landed, {record.entry.score} points" in written


def test_it_is_answered_and_the_answer_is_a_code_of_ones_own(open_game: Open, record: Record, clipboard: list[str]):
    driver = open_game()
    driver.post(pygame.DROPTEXT, text=codes.code(record))
    driver.frames(2)
    driver.press_on(texts.FRIEND_ANSWER)
    driver.frames(3)
    scene = play(driver)
    assert isinstance(scene.challenge, Race)
    assert scene.flown.ghost.name == texts.FRIEND_NAME
    end(driver, TOO_FAST)
    driver.frames(60)
    driver.key(pygame.K_t)
    driver.press_on(texts.MORE[0])
    driver.press_on(texts.CODE_COPY)
    assert driver.said == texts.CODE_COPIED
    answer = codes.flight_in(clipboard[-1])
    assert answer.recording == scene.flight.recording
    assert answer.recording.seed == record.recording.seed
    assert answer.claim.outcome.name == scene.flight.outcome.name


def test_a_friends_code_is_sent_on_as_it_came(open_game: Open, record: Record, clipboard: list[str]):
    code = codes.code(replace(record, entry=replace(record.entry, score=999)))
    driver = open_game()
    driver.post(pygame.DROPTEXT, text=code)
    driver.frames(2)
    driver.press_on(texts.MORE[0])
    driver.frames(2)
    driver.press_on(texts.CODE_COPY)
    assert clipboard[-1] == code


def test_without_a_clipboard_that_is_said(open_game: Open, record: Record, monkeypatch: pytest.MonkeyPatch):
    def broken(*_: object) -> None:
        raise pygame.error("no clipboard")

    monkeypatch.setattr(pygame.scrap, "put_text", broken)
    monkeypatch.setattr(pygame.scrap, "get_text", broken)
    driver = open_game(LogbookScene)
    driver.frames(2)
    driver.press_on(texts.CODE_COPY)
    assert driver.said == texts.CODE_NO_CLIPBOARD
    driver.press_on(texts.CODE_PASTE)
    assert driver.said == texts.CODE_PASTE_EMPTY
