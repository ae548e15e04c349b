from collections.abc import Callable
from itertools import product

import numpy as np
import pygame
import pytest

from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import INK, SMALL
from game.ui.context import Context
from game.ui.form import DOWN, LEFT, RIGHT, UP, neighbour
from game.ui.listing import shortened
from game.ui.panel import Panel
from game.ui.panel_scene import PanelScene
from game.ui.rows import ChoiceRow
from game.ui.widget import PointsManager
from tests.support.driver import Driver

COLUMNS = [pygame.Rect(x, y, 80, 20) for x in (0, 200) for y in (0, 40, 80)]


class Page(PanelScene):
    """One of each widget."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self.log: list[object] = []
        self.build()

    def describe(self, panel: Panel) -> None:
        log = self.log
        self.word = panel.button("Go", lambda: log.append("go"))
        self.toggle = panel.toggle("Switch", False, log.append)
        self.slider = panel.slider("Rate", 0.5, (0.0, 1.0), log.append, step=0.1, figure=str)
        self.choice = panel.choice("", ["one", "two", "three"], 0, log.append)


@pytest.fixture
def page(open_game: Callable[..., Driver]) -> tuple[Driver, Page]:
    driver = open_game(Page)
    return driver, driver.top


def test_arrows_follow_a_column_and_go_on_in_the_next(subtests: pytest.Subtests):
    for start, direction, end in [
        (0, DOWN, 1),
        (2, DOWN, 3),
        (0, UP, 5),
        (1, RIGHT, 4),
        (4, LEFT, 1),
        (4, RIGHT, 4),
        (5, DOWN, 0),
    ]:
        with subtests.test(start=start, direction=direction, end=end):
            assert neighbour(COLUMNS, start, direction) == end


def test_tab_visits_every_widget_and_comes_round(page: tuple[Driver, Page]):
    game, scene = page
    seen = []
    for _ in range(5):
        seen.append(scene.form.focused)
        game.key(pygame.K_TAB)
    assert seen == [scene.word, scene.toggle, scene.slider, scene.choice, scene.word]
    game.key(pygame.K_TAB, pygame.KMOD_LSHIFT)
    assert scene.form.focused is scene.word


def test_keyboard_works_every_widget(page: tuple[Driver, Page]):
    game, scene = page
    game.keys(pygame.K_RETURN, pygame.K_DOWN, pygame.K_SPACE, pygame.K_DOWN, pygame.K_RIGHT, pygame.K_LEFT)
    game.keys(pygame.K_DOWN, pygame.K_RIGHT, pygame.K_RETURN, pygame.K_RETURN)
    assert scene.log == ["go", True, pytest.approx(0.6), pytest.approx(0.5), 1, 2, 0]


def test_pad_works_every_widget(page: tuple[Driver, Page]):
    game, scene = page
    down, right = pygame.CONTROLLER_BUTTON_DPAD_DOWN, pygame.CONTROLLER_BUTTON_DPAD_RIGHT
    for button in (pygame.CONTROLLER_BUTTON_A, down, right, pygame.CONTROLLER_BUTTON_A, down, right, down, right):
        game.button(button)
    assert scene.log == ["go", True, pytest.approx(0.6), 1]


def test_mouse_works_every_widget(page: tuple[Driver, Page]):
    game, scene = page
    game.click((scene.word.box.left + 6, scene.word.box.centery))
    game.click(scene.toggle.box.center)
    game.click((scene.slider._track[0], scene.slider.box.centery))
    game.click(scene.choice._places[1].center)
    assert scene.log == ["go", True, 0.0, 1]


def test_a_click_on_the_label_of_a_slider_sets_nothing(page: tuple[Driver, Page]):
    game, scene = page
    game.click((scene.slider.box.left + 4, scene.slider.box.centery))
    assert scene.slider.value == 0.5


def test_a_drag_goes_on_outside_and_a_press_let_go_outside_does_nothing(page: tuple[Driver, Page]):
    game, scene = page
    (left, right), y = scene.slider._track, scene.slider.box.centery
    for start, end in (
        ((left + 50, y), (right + 60, 600)),
        ((scene.word.box.left + 6, scene.word.box.centery), (600, 600)),
    ):
        game.post(pygame.MOUSEBUTTONDOWN, pos=game.to_window(start), button=1)
        game.move(end)
        game.post(pygame.MOUSEBUTTONUP, pos=game.to_window(end), button=1)
        game.move((left + 50, y))
        assert scene.slider.value == 1.0
    assert "go" not in scene.log


def test_a_held_direction_repeats(page: tuple[Driver, Page]):
    game, scene = page
    scene.form.focus(scene.slider)
    game.post(pygame.KEYDOWN, key=pygame.K_RIGHT, mod=0, unicode="", scancode=0)
    game.frames(60)
    assert scene.slider.value == 1.0
    game.post(pygame.KEYDOWN, key=pygame.K_LEFT, mod=0, unicode="", scancode=0)
    game.post(pygame.KEYUP, key=pygame.K_RIGHT, mod=0, unicode="", scancode=0)
    game.frames(20)  # who turns round waits once more
    assert scene.slider.value == pytest.approx(0.9)
    game.frames(40)
    assert scene.slider.value == 0.0
    game.post(pygame.KEYUP, key=pygame.K_LEFT, mod=0, unicode="", scancode=0)


def test_a_ring_shows_for_keys_and_not_for_the_mouse(page: tuple[Driver, Page]):
    game, scene = page
    game.key(pygame.K_DOWN)
    game.frames(2)
    assert scene.toggle.ringed
    game.move(scene.slider.box.center)
    game.frames(2)
    assert scene.slider.focused
    assert not scene.slider.ringed


# The canvas


@pytest.fixture
def canvas() -> Canvas:
    return Canvas(pygame.Surface((1000, 800)))


def test_text_is_as_large_as_asked_in_any_window():
    for window, size in product([(1280, 720), (1920, 1080), (1000, 800), (640, 360)], [11.5, 34.0, 88.0]):
        canvas = Canvas(pygame.Surface(window))
        canvas.surface.fill((0, 0, 0))
        box = canvas.text("HHH", (100, 300), size=size)
        assert box.width == pytest.approx(canvas.text_width("HHH", size=size))
        ink = np.argwhere(pygame.surfarray.array3d(canvas.surface).max(axis=2) > 100)
        left, top = ink.min(axis=0) / canvas.scale + canvas.view.topleft
        right, bottom = (ink.max(axis=0) + 1) / canvas.scale + canvas.view.topleft
        pixel, tall = 1.5 / canvas.scale, size * canvas.type / canvas.scale
        assert bottom == pytest.approx(300, abs=pixel), window  # the baseline
        assert bottom - top == pytest.approx(0.72 * tall, abs=0.03 * tall + pixel), window  # Manrope's capitals
        assert box.left - pixel <= left
        assert right <= box.right + pixel


def test_a_text_of_any_length_is_drawn_no_wider_than_a_screen():
    canvas, letters = Canvas(pygame.Surface((1920, 1080))), 1_000_000
    for size in (SMALL, 44.0):
        for letter in "Wi":
            canvas.text(letter * letters, (40, 100), size=size)
            surface, _ = typeface.render(letter * letters, size * canvas.scale, "regular", INK)
            assert surface.get_width() <= 16_384  # SDL's scaling wrote past its memory when it was ten times as wide
    assert canvas.text_width("a" * 1000 + "b") == canvas.text_width("a" * letters)


@pytest.mark.parametrize("letters", [3, 30, 100_000])
def test_a_shortened_text_is_the_longest_that_fits_and_soon_found(
    canvas: Canvas, letters: int, monkeypatch: pytest.MonkeyPatch
):
    text = "Tranquility "[: max(letters, 1) - 1] + "x" * letters
    looked, width = [], Canvas.text_width
    monkeypatch.setattr(Canvas, "text_width", lambda *given, **more: looked.append(1) or width(*given, **more))
    found = shortened(canvas, text, SMALL, 200)
    assert len(looked) < 25
    assert shortened(canvas, text, SMALL, 1) == "…", "no room at all"
    assert canvas.text_width(found, size=SMALL) <= 200
    if found != text:
        assert found[-1] == "…"
        assert text.startswith(found[:-1])
        assert canvas.text_width(text[: len(found)] + "…", size=SMALL) > 200


def test_tabular_figures_keep_their_width(canvas: Canvas):
    widths = {round(canvas.text_width(text, size=34, tabular=True), 6) for text in ("11.1", "84.0", "00.7")}
    assert len(widths) == 1


def test_texts_are_kept_and_forgotten_with_the_size():
    canvas = Canvas(pygame.Surface((1280, 720)))
    canvas.text("kept", (0, 50))
    first = typeface.render("kept", 15.0, "regular", (232, 236, 244))[0]
    canvas.text("kept", (0, 90))
    assert typeface.render("kept", 15.0, "regular", (232, 236, 244))[0] is first
    canvas.attach(pygame.Surface((1920, 1080)))
    assert typeface.render.cache_info().currsize == 0


def test_a_choice_of_too_many_shows_the_chosen_one_and_opens_a_list():
    opened: list[bool] = []
    manager = PointsManager()
    names = [f"network {number}" for number in range(30)]
    choice = ChoiceRow("Flown by", names, 0, lambda _: None, on_open=lambda: opened.append(True), all_word="all 30")
    choice.join(manager)
    for width, shown in ((400.0, {0, -1}), (4000.0, set(range(30)))):
        choice.lay(Cursor(64.0, 250.0, width))
        assert choice._places.keys() == shown
        assert all(place.right <= 64 + width + 12 for place in choice._places.values())
    choice.lay(Cursor(64.0, 250.0, 400.0))
    for place, count in ((choice._places[0], 0), (choice._places[-1], 1)):
        manager.mouse_position = round(place.centerx), round(place.centery)
        choice.press()
        assert len(opened) == count
    choice.ringed = True  # by keys
    choice.press()
    assert len(opened) == 2
    for _ in range(40):
        choice.shift(1)
    assert choice.index == 29
