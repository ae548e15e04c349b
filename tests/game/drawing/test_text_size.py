"""At the largest size of text, nothing leaves the view and no two texts meet, in any screen."""

import json
from dataclasses import asdict, replace

import pygame
import pytest

from game.core import texts
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import LABEL, SMALL, TEXT_SIZES, VIEW_SIZE
from game.flight.logbook import LOGBOOK, Records
from game.scenes.settings import SettingsScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.screens import FLOWN, OVER_OTHERS, SCREENS, crashed, opened, settle, shared
from tests.support.tour import stock
from tests.support.written import Written, misplaced


def wrong(written: Written, driver: Driver) -> set[tuple[str, str]]:
    """Draw a frame, and return each text in it that does not fit, and why."""
    page = written.turn(driver.app.canvas)
    driver.app.draw()
    assert page.notes
    folder = str(driver.app.context.user_dir.parent)  # as long as it happens to be
    return {(text, how) for text, how in misplaced(page) if how != "is cut short" or folder not in text}


@pytest.mark.parametrize("name", [*SCREENS, *FLOWN, *OVER_OTHERS])
def test_nothing_meets_or_leaves_at_the_largest(open_game, context: Context, written: Written, name: str):
    settle(context, text_size="largest")
    driver = opened(open_game, name)
    for window in ((1280, 720), (960, 540)):
        if window != driver.app.window.size:
            driver.resize(window)
        large = wrong(written, driver)
        if large:  # a figure over another on purpose does so at the usual size as well
            driver.write_in("normal")
            large -= wrong(written, driver)
            driver.write_in("largest")
        assert not large, window


@pytest.mark.parametrize(
    ("name", "settings", "happens"),
    [
        ("Play", {}, crashed),
        ("mission", {}, crashed),
        ("Play", {"assist": 0.6, "three_pads": True}, shared),
        ("Play", {"gravity": 0.8, "pace": 0.7, "hands": "laggy"}, shared),
        ("swarm", {}, lambda driver: driver.skip(400)),
    ],
)
def test_nor_in_the_midst_of_things(open_game, context: Context, written: Written, name: str, settings, happens):
    settle(context, text_size="largest", **settings)
    driver = opened(open_game, name)
    happens(driver)
    assert not wrong(written, driver)


@pytest.mark.parametrize("name", ["LogbookScene", "MissionsScene", "NetworksScene"])
def test_nor_where_there_is_much_to_list(open_game, context: Context, written: Written, name: str):
    stock(context)
    entry = replace(
        Records(context.user_dir).entries()[0], course="ferry", medal=3, gravity=0.8, outcome="OUT_OF_BOUNDS", human=0.5
    )
    with (context.user_dir / LOGBOOK).open("a", encoding="utf-8") as file:
        file.write(json.dumps(asdict(entry)) + "\n")
    settle(context, text_size="largest")
    driver = opened(open_game, name)
    driver.keys(pygame.K_DOWN)
    assert not wrong(written, driver)


def test_small_text_grows_most_and_order_is_kept():
    for factor in TEXT_SIZES.values():
        typeface.grow(factor)
        assert typeface.grown(LABEL) / LABEL == pytest.approx(factor)
        assert typeface.grown(88.0) == 88.0
        sizes = [typeface.grown(size / 2) for size in range(20, 100)]
        assert sizes == sorted(sizes)
    typeface.grow(1.0)


def test_text_grows_no_further_than_its_room_and_never_shrinks():
    canvas = Canvas(pygame.Surface(VIEW_SIZE))
    usual = canvas.text("Within its room", (0, 100), size=SMALL).width
    typeface.grow(1.25)
    try:
        free = canvas.text("Within its room", (0, 100), size=SMALL).width
        assert free == pytest.approx(1.25 * usual, rel=0.05)
        assert canvas.text("Within its room", (0, 100), size=SMALL, room=1.1 * usual).width <= 1.12 * usual
        for room in (0.0, 0.5 * usual):
            assert canvas.text("Within its room", (0, 100), size=SMALL, room=room).width == pytest.approx(
                usual, rel=0.03
            )
    finally:
        typeface.grow(1.0)


def test_names_that_no_font_can_write_are_written_all_the_same():
    canvas = Canvas(pygame.Surface(VIEW_SIZE))  # a folder's name can be any bytes
    assert canvas.text("a\udcff\0", (0, 100)).width == canvas.text("a??", (0, 100)).width
    for letter in "\n\r\t\x07\x1b\x85\u2028\u202e\u2066":  # nor do they begin a line, or turn the order around
        assert canvas.text(f"a{letter}b", (0, 100)) == canvas.text("a?b", (0, 100)), ascii(letter)


def test_the_size_is_changed_at_once_and_kept(open_game, context: Context):
    driver = open_game(SettingsScene)
    while driver.top.form.focused.label != texts.TEXT_SIZE:
        driver.key(pygame.K_DOWN)
    before = driver.app.canvas.text_width("Text", size=SMALL)
    driver.keys(pygame.K_RIGHT, pygame.K_RIGHT)
    assert driver.app.canvas.text_width("Text", size=SMALL) > 1.2 * before
    driver.app.settings_writer.wait()
    assert context.settings_file.load().text_size == "largest"


def test_a_size_nobody_knows_is_the_usual_one(open_game, context: Context):
    settle(context, text_size="enormous")
    assert opened(open_game, "SettingsScene").top_name == "SettingsScene"
    assert typeface.growth() == 1.0
