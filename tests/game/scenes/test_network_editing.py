"""The large network of a live run, edited by mouse, by keys and by gamepad, and the way back."""

import numpy as np
import pygame
import pytest

from ai.explain.inspection import links
from ai.training.edits import NetworkEdits
from game.core import texts
from game.scenes.train.editing import Link, NetworkEditing, Unit
from game.scenes.train.scene import TrainScene
from game.ui.virtual_pointer import VirtualPointer
from tests.support.driver import Driver
from tests.support.networks import on_a_link
from tests.support.player import Player
from tests.support.small import LANDERS as SMALL
from tests.support.small import learn, pause


def paused(driver: Driver) -> Driver:
    """A run that has begun to learn, paused, with its network large."""
    learn(driver)
    pause(driver)
    driver.press_on(texts.TRAIN_LOOK[0])
    driver.top.run.ask("undo")  # of nothing: the answer is the network as it is now
    driver.frames(3)
    return driver


@pytest.fixture
def train(train: Driver) -> Driver:
    return paused(train)


def editing(driver: Driver) -> NetworkEditing:
    found: NetworkEditing = driver.top.inside.editing
    return found


def edits(driver: Driver) -> NetworkEdits:
    found: NetworkEdits = driver.top.run.edits
    return found


def values(driver: Driver) -> bytes:
    found: bytes = driver.top.inside.network.values.tobytes()
    return found


def weight(driver: Driver, link: Link) -> float:
    return float(links(driver.top.inside.network)[link.layer].weights[link.start, link.end])


def words(driver: Driver) -> list[str]:
    return [widget.label for widget in driver.form.widgets]


def test_a_unit_is_silenced_by_the_mouse_and_is_as_it_was_bit_for_bit(train: Driver) -> None:
    before, view = values(train), train.top.inside.view
    train.click(view.centres[1][2])
    unit = int(view.columns[1].units[2])
    assert editing(train).picked == Unit(1, unit)
    train.frames(2)
    train.click(train.widget(texts.EDIT_SILENCE).box.center)
    train.frames(3)
    assert edits(train) == NetworkEdits(((1, unit, None),), 1, True, True)
    assert not links(train.top.inside.network)[1].weights[unit].any()
    assert texts.EDIT_SILENCE not in words(train), "that is done"
    train.click(train.widget(texts.EDIT_RESTORE).box.center)
    train.frames(3)
    assert edits(train) == NetworkEdits()
    assert values(train) == before
    assert not {texts.EDIT_UNDO, texts.EDIT_RESTORE, texts.EDIT_LEARN_ON} & set(words(train))


def test_a_link_is_picked_and_cut_without_a_mouse_and_undone(train: Driver) -> None:
    press = Player(train, "pad").press
    pointer = next(each for each in train.form.widgets if isinstance(each, VirtualPointer) and each.box.height > 300)
    train.form.focus(pointer)
    press("confirm")
    pointer.place.update(on_a_link(train.top.inside.view))
    press("confirm")
    link = editing(train).picked
    assert isinstance(link, Link)
    press("back")
    train.frames(2)
    before, whole = weight(train, link), values(train)
    for way_back in (texts.EDIT_UNDO, texts.EDIT_RESTORE):
        train.form.focus(train.widget(texts.EDIT_CUT))
        press("confirm")
        train.frames(3)
        assert weight(train, link) == 0 != before
        assert edits(train).weights == [tuple(link)]
        assert texts.EDIT_CUT not in words(train), "that is done"
        train.form.focus(train.widget(way_back))
        press("confirm")
        train.frames(3)
        assert values(train) == whole
        assert not edits(train).holds


def test_it_learns_on_when_it_is_asked_to_and_the_swarm_says_how_it_stands(train: Driver) -> None:
    scene = train.top
    train.click(scene.inside.view.centres[0][1])
    train.frames(2)
    train.press_on(texts.EDIT_SILENCE)
    train.press_on(texts.TRAIN_RESUME)
    train.frames(3)
    edited = values(train)
    flown = scene.run.swarm_state.decisions
    train.wait(lambda: scene.run.swarm_state.decisions > flown + 100)
    assert values(train) == edited, "it flies, and does not learn"
    train.key(pygame.K_ESCAPE)
    train.frames(3)
    assert not scene.inside.opened
    train.press_on(texts.EDIT_LEARN_ON)
    train.wait(lambda: values(train) != edited)
    assert edits(train) == NetworkEdits(way_back=True)
    assert texts.EDIT_RESTORE in words(train)
    [change] = [each for each in scene.run.history.setting_changes if each.name == "network"]
    assert change.after == 1


def test_an_earlier_moment_cannot_be_edited_nor_a_run_that_has_ended(train: Driver) -> None:
    scene = train.top
    scene.rewind.go_to(scene.run.history["decisions"][-1] / 2)
    train.frames(2)
    train.click(scene.inside.view.centres[1][2])
    assert editing(train).picked is None
    scene.rewind.clear()
    train.frames(2)
    train.click(scene.inside.view.centres[1][2])
    train.frames(2)
    assert texts.EDIT_SILENCE in words(train)
    scene.run.close()
    train.frames(3)
    assert texts.EDIT_SILENCE not in words(train)


@pytest.mark.parametrize("small_run", [(TrainScene, SMALL.changed(dueling=True))], ids=["dueling"])
def test_what_cannot_be_edited_says_why(train: Driver) -> None:
    before = values(train)
    train.click(on_a_link(train.top.inside.view, 1))
    train.frames(2)
    assert isinstance(editing(train).picked, Link)
    assert texts.EDIT_CUT not in words(train)
    train.click(train.top.inside.view.centres[2][0])
    train.frames(2)
    assert texts.EDIT_SILENCE not in words(train), "an action's value leads nowhere"
    assert np.array_equal(values(train), before)
    assert edits(train) == NetworkEdits()
