"""Sound for all and for none; and progress that is put away after a question, and brought back."""

import time
from collections.abc import Callable

import pygame
import pytest

from ai.lander.spawns import LADDER
from game.audio.mixer import Sound
from game.core import texts
from game.core.names import LibraryError
from game.core.settings import Settings
from game.flight.days import Attempt, Days
from game.flight.logbook import Records
from game.flight.progress import Progress
from game.scenes.menus.settings import SettingsScene
from game.scenes.play.free import FreeFlight
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.flights import kept, landed
from tests.support.player import Player
from tests.support.screens import save_settings

Open = Callable[..., Driver]


def fly(context: Context, flights: int = 2) -> None:
    for _ in range(flights):
        kept(context, landed(), time.time(), alone=True)


def files(context: Context) -> dict[str, bytes]:
    paths = [path for path in context.user_dir.rglob("*") if path.is_file()]
    return {
        str(path.relative_to(context.user_dir)): path.read_bytes()
        for path in paths
        if ".trash" not in path.parts and not path.name.startswith((".", "settings"))
    }


def test_progress_is_put_away_after_a_question_and_brought_back(open_game: Open, context: Context):
    save_settings(context, learnt={"neuron": 3}, chapter="plane", wider_pads=True)
    fly(context)
    before = files(context)
    player = Player(open_game(SettingsScene, "flights"), "pad")
    player.choose(texts.PROGRESS_RESET)
    assert player.top_name == "QuestionDialog"
    assert texts.PROGRESS_FLIGHTS.format(count=2) in player.top.more
    player.choose(texts.PROGRESS_NO)
    assert files(context) == before
    player.choose(texts.PROGRESS_RESET)
    player.choose(texts.PROGRESS_YES)
    player.frames(3)
    assert files(context) == {}
    assert Records(context.user_dir).entries() == []
    saved = player.saved()
    assert (saved["learnt"], saved["chapter"], saved["tutored"], saved["wider_pads"]) == ({}, "", False, True)
    player.choose(texts.PROGRESS_RESTORE)
    player.frames(3)
    assert files(context) == before
    assert player.saved()["learnt"] == {"neuron": 3}
    assert texts.PROGRESS_RESTORE not in [widget.label for widget in player.form.widgets]


def test_what_is_flown_since_stays_after_what_comes_back(context: Context):
    context.settings.learnt = {"neuron": 3}
    fly(context, 2)
    first = Records(context.user_dir).entries()
    progress = Progress(context.user_dir, context.settings)
    progress.reset()
    fly(context, 1)
    context.settings.chapter = "backwards"
    later = Records(context.user_dir).entries()
    assert progress.restorable
    progress.restore()
    assert Records(context.user_dir).entries() == first + later
    assert {entry.file for entry in first + later} == Records(context.user_dir).kept()
    assert (context.settings.learnt, context.settings.chapter) == ({"neuron": 3}, "backwards")
    assert not progress.restorable


def test_the_ladder_and_the_days_are_put_away_and_come_back(context: Context):
    context.settings.rung = 4
    free = FreeFlight(context.settings)  # a flight that is paused meanwhile
    Days(context.user_dir).note(Attempt("2026-11-20", score=70))
    progress = Progress(context.user_dir, context.settings)
    progress.reset()
    assert (context.settings.rung, dict(Days(context.user_dir).attempts)) == (-1, {})
    assert free.chosen()[2] == LADDER.spawn(0)
    Days(context.user_dir).note(Attempt("2026-11-22", score=90))
    progress.restore()
    assert context.settings.rung == 4
    assert {day: each.score for day, each in Days(context.user_dir).attempts.items()} == {
        "2026-11-20": 70,
        "2026-11-22": 90,
    }


def test_a_disk_that_refuses_keeps_everything_where_it_is(context: Context, monkeypatch: pytest.MonkeyPatch):
    context.settings.learnt = {"neuron": 3}
    fly(context)
    before = files(context)

    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("game.flight.progress.write_text", full)
    with pytest.raises(LibraryError, match="No space left"):
        Progress(context.user_dir, context.settings).reset()
    assert files(context) == before
    assert context.settings.learnt == {"neuron": 3}


def test_one_volume_turns_all_others_down_and_mute_turns_all_off():
    sound = Sound()
    for settings, gain in (
        (Settings(effects_volume=1.0), 1.0),
        (Settings(effects_volume=1.0, master_volume=0.5), 0.25),
        (Settings(effects_volume=1.0, muted=True), 0.0),
    ):
        sound.follow(settings)
        assert sound.gains["effects"] == pytest.approx(gain)
        assert set(sound.gains.values()) == {0.0} or not settings.muted


@pytest.mark.parametrize("scene", [SettingsScene, lambda context: PlayScene(context, 3)])
def test_a_key_mutes_everywhere_and_says_so(open_game: Open, context: Context, scene):
    save_settings(context)
    game = open_game(scene)
    for muted, said in ((True, texts.SOUND_NOW_OFF), (False, texts.SOUND_NOW_ON)):
        game.key(pygame.K_F10)
        assert (context.settings.muted, game.said) == (muted, said)
        assert game.saved()["muted"] is muted
