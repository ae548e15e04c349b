"""Rows and columns: a panel lays itself out, wraps, reflows, scrolls, and knows where each thing stands."""

from itertools import pairwise, product

import pygame
import pytest

from game.core import texts
from game.core.scene import Pop
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.prose import lines
from game.drawing.tokens import LABEL, TEXT, TEXT_SIZES, VIEW_SIZE
from game.ui.context import Context
from game.ui.form import Form
from game.ui.panel import Panel
from game.ui.panel_scene import PanelScene
from tests.support.driver import Driver
from tests.support.screens import save_settings
from tests.support.written import Written, words_written

LONG = "One switch fires the engine, and the jets steer by themselves, so that a single key is enough to land. " * 2
WINDOWS = [(1280, 720), (1920, 1080), (2560, 1080), (800, 600), (720, 1280), (640, 360)]


class Page(PanelScene):
    """One of each row, in two columns."""

    def __init__(self, context: Context) -> None:
        super().__init__(context, Pop)
        self.log: list[object] = []
        self.figure = "1.0"
        self.build()

    def describe(self, panel: Panel) -> None:
        panel.title("Rows")
        panel.choice("", ["first", "second", "third"], 0, self.log.append)
        left, right = panel.beside((1, 1), 300)
        left.caption("GROUP")
        left.text(LONG)
        left.pair("altitude", lambda: self.figure)
        left.bar(lambda: 0.5)
        left.toggle("Switch", False, self.log.append, "what it does")
        right.slider("Rate", 0.5, (0.0, 1.0), self.log.append, step=0.1, figure="{:.1f}".format)
        right.button("Press", lambda: self.log.append("pressed"), "what it does", figure="2 of 3")
        right.words([("yes", lambda: self.log.append("yes")), ("no", lambda: self.log.append("no"))])
        right.line()


@pytest.fixture
def page(open_game, context: Context) -> Driver:
    save_settings(context)
    driver: Driver = open_game(Page)
    driver.frames(2)
    return driver


def test_no_tooltip_repeats_the_words_it_covers(page: Driver):
    page.app.draw()
    assert not page.app.canvas.explained


def boxes(driver: Driver) -> dict[str, pygame.Rect]:
    return {widget.label: widget.box for widget in driver.form.widgets}


def test_a_cursor_measures_exactly_what_it_draws():
    canvas = Canvas(pygame.Surface(VIEW_SIZE)).reading
    ends = []
    for drawn in (None, canvas):
        cursor = Cursor(40, 40, 210, canvas.scale, drawn)
        cursor.caption("GROUP")
        cursor.text(LONG)
        cursor.pair("a label that is far too long to stand beside", "123.4")
        cursor.bar(0.3)
        cursor.beside([lambda column: column.pair(LONG, "1"), lambda column: column.aside("short")], (2, 1), 60)
        ends.append(cursor.y)
    assert ends[0] == ends[1] > 300


@pytest.mark.parametrize("width", [400.0, 60.0])
def test_words_beside_a_figure_are_written_once_however_narrow_the_column(
    width: float, monkeypatch: pytest.MonkeyPatch
):
    written = words_written(monkeypatch)
    canvas = Canvas(pygame.Surface(VIEW_SIZE)).reading
    Cursor(40, 40, width, canvas.scale, canvas).pair("label", "1234567 m/s")
    assert written == ["label", "1234567 m/s"]


def test_nothing_leaves_its_column_not_even_a_word_without_a_space():
    canvas = Canvas(pygame.Surface(VIEW_SIZE)).reading
    for width in (60.0, 137.0, 400.0):
        for text in (LONG, "x" * 200, f"short {'long' * 40} short", "", "a\n\nb"):
            found = lines(text, TEXT, "regular", width, canvas.scale)
            assert "".join(found).replace(" ", "") == text.replace(" ", "").replace("\n", "")
            assert all(canvas.text_width(line) <= width * 1.02 for line in found)
        if width > 100:  # wider than each word
            assert " ".join(lines(LONG, TEXT, "regular", width, canvas.scale)) == LONG.strip()
    assert lines("a\n\nb", TEXT, "regular", 100.0, 1.0) == ("a", "", "b")


def test_a_number_and_its_unit_stay_on_a_line_and_so_does_what_a_text_ties_together():
    said = "it landed 27 % (91\u00a0to\u00a0100 %) of its flights, at 3.4 m/s, 12 kg, in 40 s"
    for width in range(140, 500, 7):
        found = lines(said, TEXT, "regular", float(width), 1.0)
        assert " ".join(found) == said.replace("\u00a0", " ")
        whole = ("27 %", "(91 to 100 %)", "3.4 m/s", "12 kg", "40 s")
        assert all(any(each in line for line in found) for each in whole), (width, found)


def test_columns_stand_side_by_side_or_one_below_the_other():
    for width, beside in ((700, True), (500, False)):
        cursor, lefts, tops = Cursor(0, 0, width), [], []

        def part(column: Cursor, lefts: list[float] = lefts, tops: list[float] = tops) -> None:
            lefts.append(column.left)
            tops.append(column.y)
            column.take(50)

        cursor.beside([part, part], (1, 1), 300)
        assert (lefts[1] > lefts[0]) is beside
        assert (tops[1] > tops[0]) is not beside
        assert cursor.y == (50 if beside else 112)


def test_text_can_be_read_and_stays_in_any_window_at_any_size(page: Driver):
    for size, text_size in product(WINDOWS, TEXT_SIZES):
        page.resize(size)
        page.write_in(text_size)
        page.frames(3)
        canvas = page.app.canvas.reading
        assert canvas.scale * LABEL >= 12 * TEXT_SIZES[text_size]  # pixels
        panel = page.top.panel
        assert panel.box.right <= canvas.view.right, (size, text_size)
        widgets = boxes(page).values()
        assert all(panel.box.left - 1 <= box.left and box.right <= panel.box.right + 1 for box in widgets)
        for above, below in pairwise(sorted(widgets, key=lambda box: (box.left, box.top))):
            assert not above.inflate(-2, -2).colliderect(below.inflate(-2, -2)), (size, text_size)


def test_larger_text_is_larger_by_its_factor_and_takes_more_lines(page: Driver, monkeypatch: pytest.MonkeyPatch):
    written, heights = Written(monkeypatch.setattr), {}
    for text_size in TEXT_SIZES:
        page.write_in(text_size)
        page.frames(3)
        notes = written.turn(page.app.canvas)
        page.app.draw()
        heights[text_size] = {note.text: note.box.height for note in notes.notes}
    for text_size, factor in TEXT_SIZES.items():
        for text in ("Rows", "Switch", "what it does"):
            assert heights[text_size][text] / heights["normal"][text] == pytest.approx(factor, rel=0.02)
    assert LONG[:60] not in "".join(heights["largest"]) or len(heights["largest"]) > len(heights["normal"])


def test_a_panel_without_room_scrolls_to_what_is_in_focus_and_by_the_wheel(page: Driver):
    page.resize((640, 360))
    page.frames(2)
    panel = page.top.panel
    assert panel.overflows
    for _ in page.form.widgets:
        page.key(pygame.K_DOWN)
        page.frames(1)
        focused = page.form.focused
        assert panel.box.inflate(2, 2).contains(focused.box), focused.label
    page.form.focus(page.form.widgets[0])
    page.frames(1)
    assert panel.scrolled == 0
    page.post(pygame.MOUSEWHEEL, x=0, y=-1)
    assert panel.scrolled > 0
    page.post(pygame.MOUSEWHEEL, x=0, y=9)
    assert panel.scrolled == 0


def test_what_is_scrolled_away_is_not_pressed(page: Driver):
    page.resize((640, 360))
    page.frames(2)
    press = page.widget("Press")
    assert press.box.top > page.top.panel.box.bottom
    page.click(press.box.center)
    assert page.top.log == []


def test_every_widget_is_clicked_where_it_stands(page: Driver):
    for size in WINDOWS[:5]:
        page.resize(size)
        page.frames(2)
        page.top.log.clear()
        for label in ("Press", "yes", "no"):
            page.click((page.widget(label).box.left + 8, page.widget(label).box.top + 16))
        page.click(page.widget("Switch").box.center)
        assert page.top.log[:3] == ["pressed", "yes", "no"], size
        assert isinstance(page.top.log[3], bool)


def test_the_end_of_a_column_leads_to_the_next_and_the_last_to_the_first(page: Driver):
    page.form.focus(page.widget("Switch"))  # the last of its column
    for label in ("Rate", "Press", "yes"):
        page.key(pygame.K_DOWN)
        assert page.form.focused.label == label
    page.key(pygame.K_RIGHT)
    assert page.form.focused.label == "no"


def test_hints_take_as_many_lines_as_they_need(page: Driver):
    page.resize((640, 360))
    page.write_in("largest")
    page.frames(2)
    canvas = page.app.canvas.reading
    for row in page.top.hint_rows(canvas):
        assert row.boxes(canvas)[-1].right <= canvas.view.right
    assert texts.HINT_BACK in page.hints()


def test_rows_are_described_anew_and_the_focus_stays(page: Driver):
    page.form.focus(page.widget("Press"))
    page.top.build()
    assert page.form.focused.label == "Press"
    assert page.form is not None
    assert isinstance(page.form, Form)
