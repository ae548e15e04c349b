"""A line to type in, and a list to choose from, as rows of a panel."""

from collections.abc import Callable
from typing import Any

import pygame
import pytest

from game.core.scene import Transition
from game.core.shelf import fitting
from game.input.bindings import Command
from game.ui.context import Context
from game.ui.panel import Panel
from game.ui.panel_scene import PanelScene
from tests.support.driver import Driver

ROWS = 20


class Page(PanelScene):
    """An entry, a word, a list; and letters that would be commands."""

    def __init__(self, context: Context, rows: int = ROWS) -> None:
        super().__init__(context)
        self.log: list[object] = []
        self.commands, self._count = "", rows
        self.build()

    def describe(self, panel: Panel) -> None:
        log = self.log
        self.entry = panel.entry("Modern 3", log.append, lambda: log.append("cancelled"), 12, fitting)
        self.word = panel.button("Save", lambda: log.append("saved"))
        self.list = panel.listing(
            [(f"run {n}", f"{n} %") for n in range(self._count)],
            lambda row: log.append(("open", row)),
            "none yet",
            on_choose=log.append,
        )

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        outcome = super().handle_event(event)
        if not self.form.used and event.type == pygame.KEYDOWN:
            self.commands += event.unicode
        return outcome


@pytest.fixture
def page(open_game: Callable[..., Driver]) -> tuple[Driver, Page]:
    driver = open_game(Page)
    driver.frames(1)
    return driver, driver.top


def write(game: Driver, text: str) -> None:
    """Press keys as SDL tells of them: the key, then its letter."""
    for letter in text:
        code = pygame.key.key_code(letter) if letter.isascii() else 0
        game.post(pygame.KEYDOWN, key=code, mod=0, unicode=letter, scancode=0)
        game.post(pygame.TEXTINPUT, text=letter)
        game.post(pygame.KEYUP, key=code, mod=0, unicode=letter, scancode=0)


# An entry


def test_enter_begins_letters_replace_the_suggestion_and_enter_accepts(page: tuple[Driver, Any]):
    game, scene = page
    game.key(pygame.K_RETURN)
    assert scene.form.typing
    write(game, "was ad?")
    assert scene.entry.text == "was ad"
    game.key(pygame.K_RETURN)
    assert scene.log == ["was ad"]
    assert not scene.form.typing
    assert scene.form.focused is scene.entry  # W, A, S and D have moved nothing
    assert scene.commands == ""
    write(game, "j")
    assert (scene.commands, scene.entry.text) == ("j", "was ad")  # letters are commands again


def test_a_letter_that_is_bound_to_full_screen_is_typed_and_switches_nothing(page: tuple[Driver, Page]):
    driver, scene = page
    context = driver.app.context

    def full_screen() -> bool:
        return context.settings.full_screen

    for key, letter in ((pygame.K_f, "f"), (pygame.K_KP_PERIOD, "."), (pygame.K_KP_MINUS, "-")):
        context.controls.keys.bind(Command.FULLSCREEN, key)
        driver.key(pygame.K_RETURN)
        driver.key(key)
        driver.post(pygame.TEXTINPUT, text=letter)
        assert scene.entry.text == letter
        assert not full_screen()
        driver.key(pygame.K_RETURN)
        driver.key(key)  # which nobody types any more
        assert full_screen()
        driver.key(key)


def test_a_pad_takes_the_suggestion_and_escape_and_b_leave_it_as_it_was(page: tuple[Driver, Page]):
    game, scene = page
    scene.entry.begin()
    game.button(pygame.CONTROLLER_BUTTON_A)
    assert scene.log == ["Modern 3"]
    game.key(pygame.K_RETURN)
    write(game, "x")
    game.key(pygame.K_ESCAPE)
    scene.entry.begin()
    game.button(pygame.CONTROLLER_BUTTON_B)
    assert (scene.entry.text, scene.log) == ("Modern 3", ["Modern 3", "cancelled", "cancelled"])
    assert game.top is scene


def test_the_space_that_begins_it_is_not_written_and_nothing_is_not_accepted(page: tuple[Driver, Page]):
    game, scene = page
    pygame.event.post(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_SPACE, mod=0, unicode=" ", scancode=0))
    pygame.event.post(pygame.event.Event(pygame.TEXTINPUT, text=" "))
    game.frames(2)
    assert scene.entry.text == "Modern 3"
    game.key(pygame.K_BACKSPACE)
    write(game, "  ")
    game.key(pygame.K_RETURN)
    assert scene.log == []
    assert scene.form.typing
    write(game, "a b")
    assert scene.entry.text == "  a b"


def test_a_click_begins_and_a_nudge_of_the_mouse_does_not_take_the_focus(page: tuple[Driver, Page]):
    game, scene = page
    word = scene.word.box.left + 6, scene.word.box.centery
    game.click(scene.entry.box.center)
    game.move(word)
    write(game, "a")
    assert scene.entry.text == "a"
    game.click(word)
    assert (scene.log, scene.entry.typing, scene.entry.text) == (["saved"], False, "a")


def test_keys_edit_the_text_at_its_caret_and_never_beyond_its_limit(page: tuple[Driver, Page]):
    game, scene = page
    end, home, left, right = pygame.K_END, pygame.K_HOME, pygame.K_LEFT, pygame.K_RIGHT
    back, delete = pygame.K_BACKSPACE, pygame.K_DELETE
    for keys, letters, text in (
        ((delete,), "", ""),
        ((end, back), "4", "Modern 4"),
        ((home, back, right, delete, delete), "a", "Maern 3"),
        ((left, left), "/?e", "Moderne 3"),
        ((end, right), "abcdefgh", "Modern 3abcd"),
        ((home,), "abcdefgh", "abcdModern 3"),
    ):
        scene.entry.begin()
        game.frames(1)
        game.keys(*keys)
        write(game, letters)
        assert scene.entry.text == text
        game.key(pygame.K_ESCAPE)
        assert scene.entry.text == "Modern 3"


def test_what_is_pasted_is_fitted_and_what_is_no_text_changes_nothing(
    page: tuple[Driver, Page], monkeypatch: pytest.MonkeyPatch
):
    game, scene = page
    scene.entry.begin()
    game.frames(1)
    for clipboard, text in ((b"\xff\xfe", "Modern 3"), (b"run/7\n", "run7")):
        monkeypatch.setattr(pygame.scrap, "get_text", clipboard.decode)
        game.post(pygame.KEYDOWN, key=pygame.K_v, mod=pygame.KMOD_LCTRL, unicode="", scancode=0)
        assert scene.entry.text == text


# A listing


def test_arrows_choose_and_lead_on_at_the_ends(page: tuple[Driver, Page]):
    game, scene = page
    scene.form.focus(scene.list)
    game.keys(pygame.K_DOWN, pygame.K_DOWN, pygame.K_UP, pygame.K_RETURN)
    assert scene.log == [1, 2, 1, ("open", 1)]
    game.keys(pygame.K_UP, pygame.K_UP)
    assert scene.form.focused is scene.word
    assert scene.list.index == 0


def test_pages_and_ends_and_the_wheel_scroll_the_list(page: tuple[Driver, Page]):
    game, scene = page
    scene.form.focus(scene.list)
    room = scene.list.room
    for key, index, first in (
        (pygame.K_PAGEDOWN, room, 1),
        (pygame.K_END, ROWS - 1, ROWS - room),
        (pygame.K_HOME, 0, 0),
    ):
        game.key(key)
        assert (scene.list.index, scene.list.first) == (index, first)
    for place, notches, first in ((scene.list.box.center, -3, 3), (scene.list.box.center, 100, 0), ((100, 700), -3, 0)):
        game.move(place)
        game.post(pygame.MOUSEWHEEL, y=notches, x=0)
        assert (scene.list.first, scene.list.index) == (first, 0)


def test_a_click_chooses_and_a_second_one_opens(page: tuple[Driver, Page]):
    game, scene = page
    scene.list.scroll(-1)
    third = scene.list.box.left + 20, scene.list.baseline(2) - 4
    game.click(third)
    assert scene.log == [2]
    game.click(third)
    game.click((third[0], scene.list.box.bottom - 4))  # below the last whole row
    assert scene.log == [2, ("open", 2)]
