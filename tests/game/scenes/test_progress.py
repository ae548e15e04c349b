"""Sound for all and for none; and progress that is put away after a question."""

import time
from collections.abc import Callable
from pathlib import Path

import pygame
import pytest

from ai.lander.spawns import LADDER
from game.audio.mixer import Sound
from game.core import texts
from game.core.settings import Settings
from game.flight.days import Attempt, Days
from game.flight.logbook import Records
from game.flight.progress import put_away
from game.scenes.menus.settings import SettingsScene
from game.scenes.play.challenge import Wanted
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


def files(folder: Path) -> dict[str, bytes]:
    """The files of progress in a folder."""
    found = [folder / "logbook.jsonl", folder / "days.jsonl", *(folder / "flights").glob("*")]
    return {str(path.relative_to(folder)): path.read_bytes() for path in found if path.exists()}


def test_progress_is_put_away_after_a_question_and_it_is_said_where(open_game: Open, context: Context):
    save_settings(context, learnt={"neuron": 3}, rung=4, wider_pads=True)
    fly(context)
    Days(context.user_dir).note(Attempt("2026-11-20", score=70))
    before = files(context.user_dir)
    player = Player(open_game(SettingsScene, "flights"), "pad")
    free = FreeFlight(context.settings)  # a flight that is paused meanwhile
    player.choose(texts.PROGRESS_RESET)
    assert player.top_name == "QuestionDialog"
    player.choose(texts.PROGRESS_NO)
    assert files(context.user_dir) == before
    player.choose(texts.PROGRESS_RESET)
    player.choose(texts.PROGRESS_YES)
    [box] = context.user_dir.glob("progress-*")
    assert str(box) in player.said
    player.frames(3)
    assert (files(context.user_dir), files(box)) == ({}, before)
    assert Records(context.user_dir).entries() == []
    saved = player.saved()
    assert (saved["learnt"], saved["rung"], saved["wider_pads"]) == ({}, -1, True)
    assert free.start(Wanted(0)).recording.spawn == LADDER.spawn(0)
    fly(context, 1)
    assert len(Records(context.user_dir).entries()) == 1
    second = put_away(context.user_dir, context.settings)
    assert (files(box), len(files(second))) == (before, 2)


@pytest.mark.parametrize("fails", ["logbook.jsonl", "flights"])
def test_a_disk_that_refuses_keeps_everything_where_it_is(
    context: Context, fails: str, monkeypatch: pytest.MonkeyPatch
):
    context.settings.learnt = {"neuron": 3}
    fly(context)
    before, rename = files(context.user_dir), Path.rename

    def refuse(path: Path, target: Path) -> Path:
        if path.name == fails and target.parent.name.startswith("progress"):
            raise OSError(28, "No space left on device")
        return rename(path, target)

    monkeypatch.setattr(Path, "rename", refuse)
    with pytest.raises(OSError, match="No space left"):
        put_away(context.user_dir, context.settings)
    assert files(context.user_dir) == before
    assert context.settings.learnt == {"neuron": 3}
    assert [*context.user_dir.glob("progress-*")] == []


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
