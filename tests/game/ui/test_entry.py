from collections.abc import Callable
from typing import Any

import pygame
import pytest

from game.core.names import fitting
from game.core.scene import Transition
from game.input.bindings import Command
from game.ui import text_line
from game.ui.context import Context
from game.ui.entry import Entry, first_shown
from game.ui.listing import Listing
from game.ui.text_line import Fits, TextLine, digits, printable
from game.ui.widget import PointsManager
from game.ui.widgets import TextButton
from tests.support.driver import Driver
from tests.support.form_page import FormPage


class Page(FormPage):
    """An entry, a word, a list; and letters that would be commands."""

    def __init__(self, context: Context, rows: int = 20) -> None:
        super().__init__(context)
        self.commands = ""
        form, log = self.form, self.log
        self.entry = form.add(
            Entry(form.manager, (64, 100, 300, 32), "NAME", "Modern 3", log.append, limit=12, fits=fitting,
                  on_cancel=lambda: log.append("cancelled"))
        )  # fmt: skip
        self.word = form.add(TextButton(form.manager, (64, 160, 80, 24), "Save", lambda: log.append("saved")))
        self.list = form.add(
            Listing(form.manager, (64, 220, 400, 160), [(f"run {n}", f"{n} %") for n in range(rows)],
                    on_choose=log.append, on_press=lambda row: log.append(("open", row)), empty="none yet")
        )  # fmt: skip

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        outcome = super().handle_event(event)
        if not self.form.used and event.type == pygame.KEYDOWN:
            self.commands += event.unicode
        return outcome


@pytest.fixture
def page(open_game: Callable[..., Driver]) -> tuple[Driver, Page]:
    driver = open_game(Page)
    return driver, driver.top


def write(game: Driver, text: str) -> None:
    """Press keys as SDL tells of them: the key, then its letter."""
    for letter in text:
        code = pygame.key.key_code(letter) if letter.isascii() else 0
        game.post(pygame.KEYDOWN, key=code, mod=0, unicode=letter, scancode=0)
        game.post(pygame.TEXTINPUT, text=letter)
        game.post(pygame.KEYUP, key=code, mod=0, unicode=letter, scancode=0)


def line_of(text: str, limit: int = 40, fits: Fits = printable) -> TextLine:
    return TextLine(PointsManager(), (0, 0, 300, 30), text, limit, fits)


def press(line: TextLine, *keys: int, mod: int = 0) -> None:
    for key in keys:
        line.process_event(pygame.event.Event(pygame.KEYDOWN, key=key, mod=mod))


# A line


def test_the_first_letter_takes_the_place_of_a_suggestion():
    line = line_of("Modern")
    line.insert("x")
    assert (line.text, line.caret) == ("x", 1)


def test_a_moved_caret_keeps_the_suggestion():
    line = line_of("Modern")
    press(line, pygame.K_END)
    line.insert("!")
    press(line, pygame.K_HOME, pygame.K_RIGHT, pygame.K_DELETE)
    line.insert("oo")
    press(line, pygame.K_LEFT, pygame.K_BACKSPACE)
    assert line.text == "Modern!"


def test_the_ends_of_a_line_are_the_end():
    line = line_of("ab")
    press(line, pygame.K_HOME, pygame.K_LEFT, pygame.K_BACKSPACE, pygame.K_END, pygame.K_RIGHT, pygame.K_DELETE)
    assert (line.text, line.caret) == ("ab", 2)


def test_everything_can_be_selected_and_deleted():
    line = line_of("ab")
    press(line, pygame.K_END)
    press(line, pygame.K_a, mod=pygame.KMOD_LCTRL)
    press(line, pygame.K_BACKSPACE)
    assert (line.text, line.caret) == ("", 0)


@pytest.mark.parametrize(
    ("fits", "text", "kept"),
    [
        (fitting, 'a/b\\c:d*e?f<g>h|i"j.k é', "abcdefghij.k é"),
        (fitting, "a\n\tb\x00", "ab"),
        (printable, "a/b\n", "a/b"),
        (digits, "-1.5e3٣", "153"),
    ],
)
def test_only_what_fits_is_written(fits: Callable[[str], str], text: str, kept: str):
    line = line_of("", fits=fits)
    line.insert(text)
    assert line.text == kept


def test_a_line_is_never_longer_than_its_limit():
    line = line_of("abc", limit=5)
    line.place(1)
    line.insert("123456")
    assert line.text == "a12bc"


def test_the_clipboard_is_pasted(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(text_line, "clipboard_paste", lambda: "run/7\n")
    line = line_of("", fits=fitting)
    press(line, pygame.K_v, mod=pygame.KMOD_LCTRL)
    assert line.text == "run7"


def test_no_clipboard_is_no_text(monkeypatch: pytest.MonkeyPatch):
    def broken() -> str:
        raise pygame.error("no clipboard")

    monkeypatch.setattr(pygame.scrap, "get_text", broken)
    line = line_of("a")
    press(line, pygame.K_END)
    press(line, pygame.K_v, mod=pygame.KMOD_LCTRL)
    assert line.text == "a"


def test_a_held_key_repeats_until_it_is_let_go():
    line = line_of("x" * 30)
    press(line, pygame.K_END, pygame.K_BACKSPACE)
    for _ in range(60):
        line.update(1 / 60)
    left = len(line.text)
    assert 0 < left < 25
    line.process_event(pygame.event.Event(pygame.KEYUP, key=pygame.K_BACKSPACE, mod=0))
    for _ in range(60):
        line.update(1 / 60)
    assert len(line.text) == left


def test_shift_selects_and_a_letter_takes_its_place():
    line = line_of("Modern")
    press(line, pygame.K_END)
    press(line, pygame.K_LEFT, pygame.K_LEFT, pygame.K_LEFT, pygame.K_RIGHT, mod=pygame.KMOD_LSHIFT)
    assert line.selection == (4, 6)
    line.insert("e")
    assert (line.text, line.caret) == ("Modee", 5)
    press(line, pygame.K_HOME, mod=pygame.KMOD_RSHIFT)
    assert line.selection == (0, 5)
    press(line, pygame.K_DELETE)
    assert line.text == ""


@pytest.mark.parametrize(
    ("mod", "keys", "selection"),
    [
        (pygame.KMOD_LCTRL, [pygame.K_LEFT], (8, 8)),
        (pygame.KMOD_LCTRL, [pygame.K_LEFT, pygame.K_LEFT], (4, 4)),
        (pygame.KMOD_LALT, [pygame.K_LEFT] * 4, (0, 0)),
        (pygame.KMOD_LCTRL, [pygame.K_LEFT, pygame.K_LEFT, pygame.K_RIGHT], (7, 7)),
        (pygame.KMOD_LCTRL | pygame.KMOD_LSHIFT, [pygame.K_LEFT, pygame.K_LEFT], (4, 13)),
    ],
)
def test_arrows_go_by_words(mod: int, keys: list[int], selection: tuple[int, int]):
    line = line_of("one two three")
    press(line, pygame.K_END)
    press(line, *keys, mod=mod)
    assert line.selection == selection


def test_words_are_erased_in_both_directions_and_a_selection_alone():
    line = line_of("one two three")
    press(line, pygame.K_END)
    press(line, pygame.K_BACKSPACE, mod=pygame.KMOD_LCTRL)
    assert line.text == "one two "
    press(line, pygame.K_HOME)
    press(line, pygame.K_DELETE, mod=pygame.KMOD_LCTRL)
    assert line.text == " two "
    press(line, pygame.K_RIGHT, mod=pygame.KMOD_LSHIFT)
    press(line, pygame.K_BACKSPACE, mod=pygame.KMOD_LCTRL)
    assert line.text == "two "


def test_what_is_selected_is_copied_or_cut(monkeypatch: pytest.MonkeyPatch):
    copied: list[str] = []
    monkeypatch.setattr(pygame.scrap, "put_text", copied.append)
    line = line_of("one two")
    press(line, pygame.K_HOME)
    press(line, *[pygame.K_RIGHT] * 3, mod=pygame.KMOD_LSHIFT)
    press(line, pygame.K_c, mod=pygame.KMOD_LCTRL)
    assert (copied, line.text) == (["one"], "one two")
    press(line, pygame.K_x, mod=pygame.KMOD_LCTRL)
    assert (copied, line.text, line.caret) == (["one", "one"], " two", 0)


def test_without_a_clipboard_nothing_is_lost(monkeypatch: pytest.MonkeyPatch):
    def broken(_: str) -> None:
        raise pygame.error("no clipboard")

    monkeypatch.setattr(pygame.scrap, "put_text", broken)
    line = line_of("one")
    press(line, pygame.K_x, mod=pygame.KMOD_LCTRL)
    assert line.text == "one"


def test_composed_letters_are_shown_at_the_caret_and_are_text_once_they_are_done():
    line = line_of("ab")
    line.place(1)
    line.process_event(pygame.event.Event(pygame.TEXTEDITING, text="に", start=1, length=0))
    assert (line.text, line.shown, line.caret) == ("ab", "aにb", 2)
    press(line, pygame.K_BACKSPACE)  # which is the input method's
    assert line.shown == "aにb"
    line.process_event(pygame.event.Event(pygame.TEXTINPUT, text="日本"))
    assert (line.text, line.shown, line.caret) == ("a日本b", "a日本b", 3)


def test_composed_letters_take_the_place_of_the_selection_and_may_be_given_up():
    line = line_of("ab")
    line.process_event(pygame.event.Event(pygame.TEXTEDITING, text="に", start=1, length=0))
    assert (line.text, line.shown) == ("", "に")
    line.process_event(pygame.event.Event(pygame.TEXTEDITING, text="", start=0, length=0))
    assert line.shown == ""


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


def test_letters_are_commands_again_afterwards(page: tuple[Driver, Page]):
    game, scene = page
    game.keys(pygame.K_RETURN, pygame.K_RETURN)
    write(game, "n")
    assert (scene.commands, scene.entry.text) == ("n", "Modern 3")


@pytest.mark.parametrize(("key", "letter"), [(pygame.K_f, "f"), (pygame.K_KP_PERIOD, "."), (pygame.K_KP_MINUS, "-")])
def test_a_letter_that_is_bound_to_full_screen_is_typed_and_switches_nothing(
    page: tuple[Driver, Page], key: int, letter: str
):
    driver, scene = page
    context = driver.app.context
    context.controls.keys.bind(Command.FULLSCREEN, key)
    driver.key(pygame.K_RETURN)
    driver.key(key)
    driver.post(pygame.TEXTINPUT, text=letter)
    assert scene.entry.text == letter
    assert not context.settings.full_screen
    driver.key(pygame.K_RETURN)
    driver.key(key)  # which nobody types any more
    assert context.settings.full_screen


def test_a_pad_takes_the_suggestion_with_a(page: tuple[Driver, Page]):
    game, scene = page
    scene.entry.begin()
    game.button(pygame.CONTROLLER_BUTTON_A)
    assert scene.log == ["Modern 3"]


def test_escape_and_b_leave_it_as_it_was(page: tuple[Driver, Page]):
    game, scene = page
    game.key(pygame.K_RETURN)
    write(game, "x")
    game.key(pygame.K_ESCAPE)
    assert (scene.entry.text, scene.log) == ("Modern 3", ["cancelled"])
    scene.entry.begin()
    game.button(pygame.CONTROLLER_BUTTON_B)
    assert (scene.entry.text, scene.log) == ("Modern 3", ["cancelled"] * 2)
    assert game.top is scene


def test_the_space_that_begins_it_is_not_written(page: tuple[Driver, Page]):
    game, scene = page
    pygame.event.post(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_SPACE, mod=0, unicode=" ", scancode=0))
    pygame.event.post(pygame.event.Event(pygame.TEXTINPUT, text=" "))
    game.frames(2)
    assert scene.form.typing
    write(game, "a b")
    assert scene.entry.text == "a b"


def test_nothing_is_not_accepted(page: tuple[Driver, Page]):
    game, scene = page
    game.keys(pygame.K_RETURN, pygame.K_BACKSPACE)
    write(game, "  ")
    game.key(pygame.K_RETURN)
    assert scene.log == []
    assert scene.form.typing


@pytest.mark.parametrize("key", [pygame.K_DOWN, pygame.K_TAB])
def test_down_and_tab_leave_with_what_was_typed(page: tuple[Driver, Page], key: int):
    game, scene = page
    game.key(pygame.K_RETURN)
    write(game, "mine")
    game.key(key)
    assert scene.form.focused is scene.word
    game.key(pygame.K_RETURN)
    assert (scene.entry.text, scene.log) == ("mine", ["saved"])


def test_the_mouse_places_the_caret_and_a_nudge_does_not_take_the_focus(page: tuple[Driver, Page]):
    game, scene = page
    game.click((70, 116))
    assert scene.form.typing
    game.click((65, 116))
    game.move((80, 172))
    write(game, "a")
    assert scene.entry.text == "aModern 3"
    game.click((80, 172))
    assert scene.log == ["saved"]
    game.frames(2)
    assert not scene.entry.typing


def test_dragging_selects_and_two_clicks_select_a_word(page: tuple[Driver, Page]):
    game, scene = page
    left, right, y = 65, 300, 116
    down, up = pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP
    game.post(down, pos=game.to_window((left, y)), button=1)
    assert scene.entry.line.selection == (0, 8)  # all of a suggestion
    game.move((right, 600))
    game.move((left, 600))
    assert scene.entry.line.selection == (0, 0)
    game.move((right, 600))
    game.post(up, pos=game.to_window((right, 600)), button=1)
    assert scene.entry.line.selection == (0, 8)
    game.move((left, y))
    assert scene.entry.line.selection == (0, 8)  # the button is up
    game.frames(60)
    for _ in range(2):
        game.click((left + 20, y))
    assert scene.entry.line.selection == (0, 6)
    write(game, "x")
    assert scene.entry.text == "x 3"


def test_enter_and_escape_are_the_input_methods_while_it_composes(page: tuple[Driver, Page]):
    game, scene = page
    game.key(pygame.K_RETURN)
    game.post(pygame.TEXTEDITING, text="に", start=1, length=0)
    game.keys(pygame.K_RETURN, pygame.K_ESCAPE, pygame.K_DOWN, pygame.K_TAB)
    assert scene.form.typing
    assert scene.log == []
    game.post(pygame.TEXTINPUT, text="日")
    game.key(pygame.K_RETURN)
    assert scene.log == ["日"]


def test_a_composition_ends_with_the_typing(page: tuple[Driver, Page]):
    game, scene = page
    game.key(pygame.K_RETURN)
    game.post(pygame.TEXTEDITING, text="に", start=1, length=0)
    game.click((80, 172))
    game.frames(2)
    assert (scene.entry.typing, scene.entry.line.composition) == (False, "")


def test_a_key_that_is_held_as_typing_ends_changes_nothing_more(page: tuple[Driver, Page]):
    game, scene = page
    game.keys(pygame.K_RETURN, pygame.K_END)
    game.post(pygame.KEYDOWN, key=pygame.K_BACKSPACE, mod=0, unicode="", scancode=0)
    game.click((80, 172))
    game.frames(60)
    assert scene.entry.text == "Modern "


def test_a_long_text_keeps_its_caret_in_sight():
    text = "m" * 40
    first = first_shown(text, 40, 15, 300)
    assert first > 0
    assert first_shown(text, 38, 15, 300, first) == first  # it stands still while the caret moves within it
    assert first_shown(text, 0, 15, 300, first) == 0
    assert first_shown(text[:3], 3, 15, 300, first) == 0


# A listing


def test_arrows_choose_and_lead_on_at_the_ends(page: tuple[Driver, Page]):
    game, scene = page
    scene.form.focus(scene.list)
    game.keys(pygame.K_DOWN, pygame.K_DOWN, pygame.K_UP, pygame.K_RETURN)
    assert scene.log == [1, 2, 1, ("open", 1)]
    game.keys(pygame.K_UP, pygame.K_UP)
    assert scene.form.focused is scene.word
    assert scene.list.index == 0


def test_pages_and_ends_scroll_the_list(page: tuple[Driver, Page]):
    game, scene = page
    scene.form.focus(scene.list)
    game.key(pygame.K_PAGEDOWN)
    assert (scene.list.index, scene.list.first) == (5, 1)
    game.key(pygame.K_END)
    assert (scene.list.index, scene.list.first) == (19, 15)
    game.key(pygame.K_HOME)
    assert (scene.list.index, scene.list.first) == (0, 0)


def test_the_wheel_scrolls_what_the_mouse_is_over(page: tuple[Driver, Page]):
    game, scene = page
    game.move((100, 300))
    game.post(pygame.MOUSEWHEEL, y=-3, x=0)
    assert (scene.list.first, scene.list.index) == (3, 0)
    game.post(pygame.MOUSEWHEEL, y=100, x=0)
    assert scene.list.first == 0
    game.move((100, 600))
    game.post(pygame.MOUSEWHEEL, y=-3, x=0)
    assert scene.list.first == 0


def test_a_click_chooses_and_a_second_one_opens(page: tuple[Driver, Page]):
    game, scene = page
    third = (100, 220 + 2 * 32 + 16)
    game.click(third)
    assert scene.log == [2]
    game.click(third)
    assert scene.log == [2, ("open", 2)]


def test_an_empty_list_is_harmless(open_game: Callable[..., Driver]):
    game = open_game(Page, rows=0)
    scene = game.top
    scene.form.focus(scene.list)
    game.keys(pygame.K_DOWN, pygame.K_RETURN, pygame.K_END)
    game.click((100, 240))
    game.frames(2)
    assert scene.log == []
    assert game.top is scene
