"""At the largest size of text, nothing leaves the view and no two texts meet, in any screen."""

import json
from collections.abc import Callable
from dataclasses import asdict, replace

import pygame
import pytest

from ai.lander.missions import MISSIONS
from game.core import texts
from game.core.scene import Push, Scene
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import LABEL, SMALL, TEXT, TEXT_SIZES, TITLE, VIEW_SIZE
from game.flight.logbook import LOGBOOK, Records
from game.play.challenge import FlownMission
from game.scenes.menu import MenuScene
from game.scenes.play import PlayScene
from game.scenes.settings import SettingsScene
from game.scenes.watch import WatchScene
from game.ui.context import Context
from tests.game.scenes.test_walks import OVER_OTHERS, SCREENS
from tests.support.driver import Driver
from tests.support.tour import stock

FLOWN: dict[str, Callable[[Context], Scene]] = {
    "Play": lambda context: PlayScene(context, 3),
    "swarm": lambda context: WatchScene(context, 16, seed=2),
    "mission": lambda context: PlayScene(context, 0, challenge=FlownMission(MISSIONS["wind"])),
}
# A capital's height and what hangs below the line, in sizes of the type: where ink is.
ABOVE, BELOW = 0.72, 0.2
Written = list[tuple[str, pygame.FRect]]


def write_down(driver: Driver, monkeypatch: pytest.MonkeyPatch) -> Written:
    """Draw a frame, and return every text in it, with the box of its ink."""
    written: Written = []
    text, view = Canvas.text, driver.app.canvas

    def noted(canvas: Canvas, string: str, position: tuple[float, float], **more) -> pygame.FRect:
        box = text(canvas, string, position, **more)
        if canvas is view and string.strip() and more.get("alpha", 1.0) > 0.05:
            size = typeface.grown(more.get("size", TEXT))
            height = ABOVE * size + BELOW * min(size, TITLE)  # large texts are figures: nothing hangs below
            written.append((string, pygame.FRect(box.x, position[1] - ABOVE * size, box.width, height)))
        return box

    with monkeypatch.context() as patch:
        patch.setattr(Canvas, "text", noted)
        driver.frames()
    return written


def wrong(written: Written) -> set[tuple[str, str]]:
    found = set()
    view = pygame.FRect((0, 0), VIEW_SIZE)
    for number, (string, box) in enumerate(written):
        if not view.contains(box):
            found.add((string, "leaves the view"))
        for other, its_box in written[number + 1 :]:
            if other != string and box.inflate(-2, -2).colliderect(its_box.inflate(-2, -2)):
                found.add((string, other))
    return found


def crashed(driver: Driver) -> None:
    """Fall, and wait for the card."""
    driver.frames(3)
    driver.key(pygame.K_UP)
    while not driver.top.flight.over:
        driver.frames(10)
    driver.frames(240)


def shared(driver: Driver) -> None:
    """Fly with the network's help among hills."""
    driver.frames(3)
    driver.post(pygame.KEYDOWN, key=pygame.K_UP, mod=0)
    driver.frames(60)


def opened(open_game, context: Context, name: str, size: str) -> Driver:
    context.settings.reduced_motion, context.settings.text_size, context.settings.tutored = True, size, True
    context.settings_file.save(context.settings)
    if name in OVER_OTHERS:
        driver = open_game(MenuScene)
        driver.app.scenes.apply(Push(OVER_OTHERS[name](driver.top)))
    else:
        driver = open_game({**SCREENS, **FLOWN}[name])
    driver.frames(10)
    return driver


@pytest.mark.parametrize("name", [*SCREENS, *FLOWN, *OVER_OTHERS])
@pytest.mark.parametrize("window", [(1280, 720), (960, 540)])
def test_nothing_meets_or_leaves_at_the_largest(open_game, context: Context, monkeypatch, name: str, window):
    driver = opened(open_game, context, name, "largest")
    if window != (1280, 720):
        driver.resize(window)
    large = wrong(write_down(driver, monkeypatch))
    if large:  # a figure over another on purpose does so at the usual size as well
        driver.app.context.settings.text_size = "normal"
        driver.app.apply_settings()
        large -= wrong(write_down(driver, monkeypatch))
    assert not large


@pytest.mark.parametrize(("name", "settings", "happens"), [
    ("Play", {}, crashed),
    ("mission", {}, crashed),
    ("Play", {"assist": 0.6, "three_pads": True}, shared),
    ("Play", {"gravity": 0.8, "pace": 0.7, "hands": "laggy"}, shared),
    ("swarm", {}, lambda driver: driver.skip(400)),
])  # fmt: skip
def test_nor_in_the_midst_of_things(open_game, context: Context, monkeypatch, name: str, settings, happens):
    for setting, value in settings.items():
        setattr(context.settings, setting, value)
    driver = opened(open_game, context, name, "largest")
    happens(driver)
    assert not wrong(write_down(driver, monkeypatch))


@pytest.mark.parametrize("name", ["LogbookScene", "MissionsScene", "NetworksScene"])
def test_nor_where_there_is_much_to_list(open_game, context: Context, monkeypatch, name: str):
    stock(context)
    entry = replace(
        Records(context.user_dir).entries()[0], course="ferry", medal=3, gravity=0.8, outcome="OUT_OF_BOUNDS", human=0.5
    )
    with (context.user_dir / LOGBOOK).open("a", encoding="utf-8") as file:
        file.write(json.dumps(asdict(entry)) + "\n")
    driver = opened(open_game, context, name, "largest")
    driver.keys(pygame.K_DOWN)
    assert not wrong(write_down(driver, monkeypatch))


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


def test_the_size_is_changed_at_once_and_kept(open_game, context: Context):
    driver = open_game(SettingsScene)
    while driver.top.form.focused.label != texts.TEXT_SIZE:
        driver.key(pygame.K_DOWN)
    before = driver.app.canvas.text_width("Text", size=SMALL)
    driver.keys(pygame.K_RIGHT, pygame.K_RIGHT)
    assert driver.app.canvas.text_width("Text", size=SMALL) > 1.2 * before
    driver.app.settings_writer.wait()
    assert context.settings_file.load().text_size == "largest"


def test_a_size_nobody_knows_is_the_usual_one(open_game, context: Context, monkeypatch):
    driver = opened(open_game, context, "SettingsScene", "enormous")
    assert typeface.growth() == 1.0
    assert write_down(driver, monkeypatch)
