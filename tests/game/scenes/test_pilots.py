"""The player's own pilots in the game: made, edited, measured and flown in Watch as they are saved."""

import errno
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pygame
import pytest

from ai.pilots import folder as pilot_folder
from ai.pilots.own import OwnPilot
from game.core import texts
from game.flight import networks, own
from game.scenes.networks import files
from game.scenes.networks.scene import NetworksScene
from game.scenes.play.scene import PlayScene
from game.scenes.watch.scene import WatchScene
from game.ui.context import Context
from game.ui.listing import ListRow
from tests.support.driver import Driver
from tests.support.inline_worker import InlineWorker
from tests.support.reading import Reading

Open = Callable[..., Driver]
GOOD = "def act(o):\n    return 4"


@pytest.fixture
def edited(monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """The files that the editor was opened on."""
    opened: list[Path] = []
    monkeypatch.setattr(files, "edit", opened.append)
    return opened


def test_an_editor_is_opened_on_the_file_and_none_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    called = []

    class Opened:
        def __init__(self, command, **_):
            called.append(command)

        def wait(self):
            pass

    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setattr(subprocess, "Popen", Opened)
    files.edit(tmp_path / "pilot.py")
    assert called == [["xdg-open", str(tmp_path / "pilot.py")]]
    monkeypatch.undo()
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(OSError, match="xdg-open"):
        files.edit(tmp_path / "pilot.py")


def scene(driver: Driver) -> WatchScene:
    assert isinstance(driver.top, WatchScene)
    return driver.top


def open_pilots(driver: Driver, name: str = "") -> None:
    """Open the list of networks over Watch, with a file chosen."""
    driver.app.scenes.apply(scene(driver)._open_networks())
    driver.frames(1)
    if name:
        choose(driver, name)


def choose(driver: Driver, name: str) -> None:
    listed = driver.top
    listed._choose_row(next(n for n, each in enumerate(listed.items) if each.name == name))
    driver.frames(1)


def test_from_watch_to_a_new_pilot_that_flies_as_it_is_saved(watching: Driver, context: Context, edited: list[Path]):
    watching.key(pygame.K_SPACE)
    open_pilots(watching)
    assert isinstance(watching.top, NetworksScene)
    watching.press_on(texts.PILOTS_NEW)
    [path] = edited
    assert path == context.user_dir / "pilots" / "pilot.py"
    path.write_text(GOOD)
    watching.press_on(texts.RUN_CHOOSE)
    watch = scene(watching)
    assert not watch.playback.stopped, "what was stopped goes on"
    watching.wait(lambda: watch.flyer.network.name == "pilot.py")
    pilot = watch.flyer.network.policy
    assert isinstance(pilot, OwnPilot)
    pilot._patience = 60.0
    watching.wait(lambda: watch.decision.action[0] == 4)
    assert texts.WATCH_OWN.format(name="pilot.py") == watch.flyer.sentence
    assert context.settings.model != "pilot.py"  # the next game asks again
    path.write_text("def act(o):\n    return 1 / 0 if o[1] < 99 else 0")
    watching.wait(lambda: pilot.problem)
    assert pilot.problem == "line 2: ZeroDivisionError: division by zero"
    assert watch.decision.action[0] == 4
    assert watch.flyer.problem.endswith("The last good one flies on.")
    watching.frames(5)
    watch.swarm.landed, watch.swarm.lost = 3, 4
    path.write_text("def act(o):\n    return 2")
    watching.wait(lambda: watch.decision.action[0] == 2)
    watching.frames(1)
    assert (watch.swarm.landed, watch.swarm.lost) == (0, 0), "another version's flights are not this one's"


def test_a_file_that_cannot_be_loaded_leaves_the_last_pilot_flying(watching: Driver, context: Context):
    pilot_folder.PilotFolder(context.user_dir).new().write_text("def act(:")
    open_pilots(watching)
    watching.press_on(texts.RUN_CHOOSE)
    watch = scene(watching)
    watching.wait(lambda: "SyntaxError" in watch.flyer.problem)
    assert watch.flyer.network.name == "scripted"
    assert watch.flyer.problem.startswith("pilot.py: line 1: SyntaxError")


def test_no_file_flies_before_it_was_chosen_in_this_game(open_game: Open, context: Context):
    pilot_folder.PilotFolder(context.user_dir).new()
    context.settings.model = "pilot.py"
    driver = open_game(WatchScene, seed=2)
    assert "pilot.py" not in scene(driver).flyer.policies.names
    assert context.pilot is None


@pytest.mark.parametrize("fails", ["editor", "disk"])
def test_what_goes_wrong_with_a_new_file_is_reported(
    watching: Driver, context: Context, monkeypatch: pytest.MonkeyPatch, written: list[str], fails: str
):
    def refuse(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left")

    monkeypatch.setattr(*((files, "edit") if fails == "editor" else (pilot_folder, "write_text")), refuse)
    open_pilots(watching)
    watching.press_on(texts.PILOTS_NEW)
    folder = context.user_dir / "pilots"
    message = watching.said
    if fails == "editor":
        assert message == texts.PILOTS_NO_EDITOR.format(path=folder / "pilot.py")
    else:
        assert message == texts.PILOTS_NOT_WRITTEN.format(path=folder, reason="No space left")
        assert not watching.top.files.read()


def test_it_is_measured_and_that_is_said_until_the_file_is_saved_again(
    watching: Driver, context: Context, monkeypatch: pytest.MonkeyPatch, written: list[str]
):
    monkeypatch.setattr(own, "STARTS", 3)
    monkeypatch.setattr(files, "Worker", InlineWorker)
    path = pilot_folder.PilotFolder(context.user_dir).new()
    open_pilots(watching)
    written.clear()
    watching.press_on(texts.PILOTS_MEASURE)
    watching.wait(lambda: watching.top.files._worker is None)
    assert texts.PILOTS_MEASURING.format(count=3) in written
    (measured,) = pilot_folder.PilotFolder(context.user_dir).measured()
    assert (measured.name, measured.landed <= 0.8) == ("pilot", True)
    assert watching.the(ListRow).rows[0][:2] == ("pilot.py", f"{100 * measured.landed:.1f} %")
    os.utime(path, (measured.when + 9, measured.when + 9))
    watching.top.enter()
    assert watching.the(ListRow).rows[0][:2] == ("pilot.py", "–"), "it was saved since"
    watching.form.focus(watching.the(ListRow))
    watching.key(pygame.K_RETURN)
    assert watching.top_name == "WatchScene", "a press on its name takes it"


def test_a_measurement_says_how_far_it_is_and_keeps_what_came(context: Context, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(own, "STARTS", 4)
    path = pilot_folder.PilotFolder(context.user_dir).new()
    path.write_text("def act_many(o): return [3] * len(o)")
    shares = [each for turn in own.measure(context.user_dir, path) for each in turn]
    assert shares[-1] == 1.0
    assert shares == sorted(shares)
    assert 0 < shares[0] < 0.1
    assert [each.landed for each in pilot_folder.PilotFolder(context.user_dir).measured()] == [0]


def test_a_measurement_is_cancelled_in_the_place_of_its_word(watching: Driver, context: Context):
    pilot_folder.PilotFolder(context.user_dir).new().write_text("def act(o):\n    while True: pass")
    open_pilots(watching)
    watching.frames(1)
    place = watching.widget(texts.PILOTS_MEASURE).box.topleft
    watching.press_on(texts.PILOTS_MEASURE)
    watching.frames(1)
    assert watching.widget(texts.PILOTS_CANCEL).box.topleft == place
    watching.press_on(texts.PILOTS_CANCEL)
    assert watching.top.files._worker is None
    assert watching.widget(texts.PILOTS_MEASURE).box.topleft == place


def test_what_is_wrong_with_a_measured_file_is_reported(watching: Driver, context: Context, monkeypatch):
    monkeypatch.setattr(files, "Worker", InlineWorker)
    pilot_folder.PilotFolder(context.user_dir).new().write_text("def act(o): return 9")
    open_pilots(watching)
    watching.press_on(texts.PILOTS_MEASURE)
    watching.wait(lambda: watching.top.files._worker is None)
    assert "whole number from 0 to 5" in watching.said
    assert pilot_folder.PilotFolder(context.user_dir).measured() == []


def test_play_hands_over_to_it_and_it_is_no_record(
    open_game: Open, context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = pilot_folder.PilotFolder(context.user_dir).new()
    path.write_text("def act(o): return 0")
    driver = open_game(PlayScene, 3)
    driver.keys(pygame.K_ESCAPE)
    play = driver.app.scenes.stack[0]
    assert isinstance(play, PlayScene)
    driver.press_on(texts.PAUSE_NETWORK.format(name=networks.word(play.network.name)))
    choose(driver, "pilot.py")
    driver.press_on(texts.RUN_CHOOSE)
    driver.keys(pygame.K_ESCAPE)
    assert driver.top is play
    assert play.network.name == "pilot.py"
    assert play.flight.chooser.copilot is None  # it has no values to share the stick by
    context.settings.help = "guard"
    reading = Reading(driver, monkeypatch)
    driver.key(pygame.K_c)
    reading.page(2)
    assert "pilot.py can fly, but cannot help you" in " ".join(reading.words)
    driver.unseen = False
    driver.key(pygame.K_ESCAPE)
    context.settings.help = "off"
    driver.wait(lambda: context.pilot and context.pilot.ready, 60)
    driver.key(pygame.K_TAB)
    driver.wait(lambda: play.flight.over, 60)
    assert play.flight.chooser.guard is None
    assert play.credit.bar == "handed_over"
    path.write_text("def act(:")
    driver.wait(lambda: "SyntaxError" in driver.said, 30)
    play.choose_network("modern")
    assert play.network.name == "modern"
