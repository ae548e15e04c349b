from collections.abc import Callable

import pygame
import pytest

from game.core.collection import fitting
from game.core.scene import Pop, Scene, Transition
from game.drawing.canvas import Canvas
from game.input.bindings import Command
from game.ui import entry
from game.ui.context import Context
from game.ui.entry import EditedLine, Entry, digits, printable
from game.ui.form import Form
from game.ui.listing import Listing
from game.ui.widgets import TextButton
from tests.support.driver import Driver


class Page(Scene):
    """An entry, a word, a list; and letters that would be commands."""

    def __init__(self, context: Context, rows: int = 20) -> None:
        super().__init__(context)
        self.log: list[object] = []
        self.commands = ""
        self.form = form = Form(context, on_back=Pop)
        log = self.log
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
        outcome = self.form.handle_event(event)
        if not self.form.used and event.type == pygame.KEYDOWN:
            self.commands += event.unicode
        return outcome

    def update(self) -> Transition | None:
        return self.form.update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        canvas.surface.fill((0, 0, 0))
        self.form.draw(canvas)


@pytest.fixture
def page(open_game: Callable[..., Driver]) -> tuple[Driver, Page]:
    driver = open_game(Page)
    return driver, driver.top  # type: ignore[return-value]


def write(game: Driver, text: str) -> None:
    """Press keys as SDL tells of them: the key, then its letter."""
    for letter in text:
        code = pygame.key.key_code(letter) if letter.isascii() else 0
        game.post(pygame.KEYDOWN, key=code, mod=0, unicode=letter, scancode=0)
        game.post(pygame.TEXTINPUT, text=letter)
        game.post(pygame.KEYUP, key=code, mod=0, unicode=letter, scancode=0)


def press(line: EditedLine, *keys: int, mod: int = 0) -> None:
    for key in keys:
        line.take(pygame.event.Event(pygame.KEYDOWN, key=key, mod=mod))


# A line


def test_the_first_letter_takes_the_place_of_a_suggestion():
    line = EditedLine("Modern")
    line.insert("x")
    assert (line.text, line.caret) == ("x", 1)


def test_a_moved_caret_keeps_the_suggestion():
    line = EditedLine("Modern")
    press(line, pygame.K_END)
    line.insert("!")
    press(line, pygame.K_HOME, pygame.K_RIGHT, pygame.K_DELETE)
    line.insert("oo")
    press(line, pygame.K_LEFT, pygame.K_BACKSPACE)
    assert line.text == "Modern!"


def test_the_ends_of_a_line_are_the_end():
    line = EditedLine("ab")
    press(line, pygame.K_HOME, pygame.K_LEFT, pygame.K_BACKSPACE, pygame.K_END, pygame.K_RIGHT, pygame.K_DELETE)
    assert (line.text, line.caret) == ("ab", 2)


def test_everything_can_be_selected_and_deleted():
    line = EditedLine("ab")
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
    line = EditedLine("", fits=fits)
    line.insert(text)
    assert line.text == kept


def test_a_line_is_never_longer_than_its_limit():
    line = EditedLine("abc", limit=5)
    line.place(1)
    line.insert("123456")
    assert line.text == "a12bc"


def test_the_clipboard_is_pasted(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(entry, "_clipboard", lambda: "run/7\n")
    line = EditedLine("", fits=fitting)
    press(line, pygame.K_v, mod=pygame.KMOD_LCTRL)
    assert line.text == "run7"


def test_no_clipboard_is_no_text(monkeypatch: pytest.MonkeyPatch):
    def broken() -> str:
        raise pygame.error("no clipboard")

    monkeypatch.setattr(pygame.scrap, "get_text", broken)
    line = EditedLine("a")
    press(line, pygame.K_END)
    press(line, pygame.K_v, mod=pygame.KMOD_LCTRL)
    assert line.text == "a"


def test_a_held_key_repeats_until_it_is_let_go():
    line = EditedLine("x" * 30)
    press(line, pygame.K_END, pygame.K_BACKSPACE)
    for _ in range(60):
        line.update()
    left = len(line.text)
    assert 0 < left < 25
    line.take(pygame.event.Event(pygame.KEYUP, key=pygame.K_BACKSPACE, mod=0))
    for _ in range(60):
        line.update()
    assert len(line.text) == left


# An entry


def test_enter_begins_letters_replace_the_suggestion_and_enter_accepts(page: tuple[Driver, Page]):
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


def test_a_long_text_keeps_its_caret_in_sight():
    line = EditedLine("m" * 40)
    assert entry.first_shown(line.text, 40, 15, 300) > 0
    assert entry.first_shown(line.text, 0, 15, 300) == 0


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
