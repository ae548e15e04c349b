"""Chapter scene: one chapter of the path, in three pages: predict, try, see why."""

from __future__ import annotations

from functools import partial
from typing import Final

import pygame

from game.core import texts
from game.core.scene import Push, Replace, Route, Transition
from game.core.source import source_of
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import HUMAN, INK, MUTE, SMALL, STEP, TEXT, TITLE, Colour
from game.explain.code_listing import add_listing
from game.explain.explained import Explained
from game.input.controls import Command
from game.scenes.learn.path import FIRST, PAGES, PATH, Progress, chapter_type, following
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.panel import Column, Panel, Row
from game.ui.panel_scene import PanelScene
from game.ui.widget import OnPress

PREDICT, TRY, WHY = range(len(PAGES))
_SHARES, _LEAST, _APART = (1.0, 1.8), 240.0, 36.0  # of the columns of words and of the picture
_BODY: Final = SMALL + 1.5
_OPEN: Final[Colour] = (190, 198, 214)  # an answer that was not given
_AROUND, _LOWEST = 250.0, 0.85  # points above and below the picture; the least share of its height
_LISTING: Final = 420.0  # height of a listing
_INDENT: Final = 18.0  # of a verdict, behind its line


class ChapterScene(PanelScene):
    """Chapter scene.

    Attributes:
        chapter: the chapter that is shown.
        page: which of `PAGES` is shown, by its index.
        in_code: whether "see why" shows the line of code that did it, in place of the picture.

    """

    def __init__(self, context: Context, key: str = FIRST) -> None:
        super().__init__(context)
        self._progress, self.explained = Progress(context.settings), Explained()
        self.chapter = chapter_type(key)(context)
        # One that is done asks for a guess again.
        guessed = self._progress.guess(key) is not None and not self._progress.done(key)
        self.page = TRY if guessed else PREDICT
        self.in_code = False
        self._why, self._came = self._progress.shown(key)
        context.settings.chapter = key
        self._progress.note(key)
        self.turn_to(self.page)

    def enter(self) -> None:
        self.reword()

    def close(self) -> None:
        self.chapter.close()
        self.context.apply_settings()

    @property
    def key(self) -> str:
        """Key of the chapter."""
        return self.chapter.key

    def turn_to(self, page: int) -> None:
        """Show another page; "see why" makes a chapter done whose question a try has answered."""
        on_tabs = page != self.page and self.form.focused is self._tabs
        self.page, self.in_code = page, False
        self.panel.scrolled = 0.0
        self.reword()
        if page == WHY and self._why:
            self._progress.show(self.key, self._why, self._came)
            self._progress.note(self.key, done=self._came is not None or self._progress.done(self.key))
        self.context.apply_settings()
        if not on_tabs:
            self.form.focus(self.form.widgets[1])

    def reword(self) -> None:
        """Describe the page with the numbers of this moment: of what runs on they could not be read otherwise."""
        self._why, self._came = self._progress.shown(self.key)
        self._tried = self.chapter.tried
        if self._tried:
            self._why, came = self.chapter.why(), self.chapter.verdict()
            self._came = self._came if came is None else came
        self.build()

    def _restart(self) -> None:
        """Begin the chapter's picture anew."""
        if not self.chapter.problem:
            if self.chapter.tried:  # what was shown stays
                self.reword()
                self._progress.show(self.key, self._why, self._came)
            self.chapter.restart()
            self.build()

    def actions(self) -> Table:
        again = [Action(Command.RETRY, self._restart, texts.LEARN_AGAIN)] if self.page == TRY else []
        last = texts.LEARN_NEXT_CHAPTER if following(self.key) else ""
        on = last if self.page == WHY else texts.LEARN_NEXT_PAGE
        return [
            self.form.moves,
            self.form.changes,
            *again,
            Action(Command.NEXT, self._go_on, on),
            Action(Command.PREVIOUS, partial(self._turn, -1)),
            *([self.explained.action()] if self.chapter.explains else []),
            self.form.goes_back(texts.HINT_BACK),
        ]

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        return None if self.explained.handle_event(event) else super().handle_event(event)

    def update(self) -> Transition | None:
        if self.page != PREDICT and not self.chapter.problem:
            self.chapter.update()
        if self.page == WHY and self.chapter.tried and (self.chapter.changed or not self._tried):
            self.turn_to(WHY)  # what was begun on the page before has come to its end
        elif self.chapter.changed:
            self.build()
        self.chapter.changed = False
        self.explained.update()
        return super().update()

    def _guess(self, number: int) -> None:
        self._progress.note(self.key, guess=number)
        self.turn_to(TRY)

    def _turn(self, pages: int) -> None:
        if 0 <= self.page + pages < len(PAGES):
            self.turn_to(self.page + pages)

    def _go_on(self) -> Transition | None:
        if self.page < WHY:
            self._turn(1)
            return None
        after = following(self.key)
        return Replace(Route("chapter", (after,))) if after else self.form.goes_back("").run()

    # Rows

    def describe(self, panel: Panel) -> None:
        number, words = list(PATH).index(self.key) + 1, self.chapter.words
        panel.title(f"{number}   {words['title']}", TITLE + 6)
        panel.text(words["question"], colour=MUTE)
        panel.gap(6)
        self._tabs = panel.choice("", texts.LEARN_PAGES, self.page, self.turn_to)
        panel.gap(6)
        left, right = panel.beside(_SHARES, _LEAST, _APART)
        [self._describe_predict, self._describe_try, self._describe_why][self.page](left)
        self._picture: Row | None = None
        self._high = 0.0
        if self.chapter.problem:
            right.text(self.chapter.problem, colour=MUTE)
        elif self.in_code:
            self._describe_listing(right)
        else:
            self._picture = right.add(self._leave_room)
            right.gap(4)
            self.chapter.below(right)
        panel.gap(10)
        labels = (*texts.LEARN_ON, texts.LEARN_TO_CHAPTER if following(self.key) else texts.LEARN_TO_LIST)
        further: list[tuple[str, OnPress]] = []
        if self.page == WHY:
            if not self.chapter.problem and self.chapter.code():
                further.append((texts.LEARN_CODE[self.in_code], self._show_code))
            further.append((words["door"], lambda: Push(self.chapter.door)))
        panel.words([(labels[self.page], self._go_on), *further])

    def _leave_room(self, cursor: Cursor) -> None:
        """Leave room for the picture: as high as it should be, or as all else leaves room for in the window."""
        if cursor.canvas is None and cursor.seen:
            whole = self.chapter.shape * cursor.width
            self._high = min(whole, max(cursor.seen.height - _AROUND, _LOWEST * whole))
        cursor.take(self._high)

    def _describe_predict(self, column: Column) -> None:
        column.text(self.chapter.words["lead"], size=_BODY, colour=MUTE)
        column.gap(8)
        column.text(self.chapter.words["predict"])
        guess = self._progress.guess(self.key)
        for number, answer in enumerate(filter(None, texts.LEARN_ANSWERS[self.key])):
            column.button(answer, partial(self._guess, number), colour=HUMAN if number == guess else _OPEN)

    def _describe_try(self, column: Column) -> None:
        column.text(lambda: self.chapter.words["task"], size=_BODY)
        column.gap(6)
        if not self.chapter.problem:
            self.chapter.controls(column)

    def _describe_why(self, column: Column) -> None:
        guess = self._progress.guess(self.key)
        if guess is not None:
            column.add(partial(self._write_verdict, guess))
        waits = texts.LEARN_STILL_RUNS if self.chapter.running else texts.LEARN_TRY_FIRST
        column.text(self._why or waits, size=_BODY)
        column.gap(8)
        for name in ("why", "differs"):
            column.text(self.chapter.words.get(name, ""), size=_BODY, colour=MUTE)
            column.gap(8)

    def _write_verdict(self, guess: int, cursor: Cursor) -> None:
        """Write the card of a guess: what was said, and what came of the player's tries."""
        answers, came, top = texts.LEARN_ANSWERS[self.key], self._came, cursor.y
        open_words = texts.LEARN_UNDECIDED.get(self.key, "") if self._why else ""
        colour = MUTE
        if came is not None and cursor.canvas:
            colour = cursor.canvas.palette.good if came == guess else cursor.canvas.palette.warn
        card = cursor.in_style(TEXT, HUMAN)
        card.left, card.width = cursor.left + _INDENT, cursor.width - _INDENT
        card.gap(4)
        card.caption(texts.LEARN_YOU_SAID)
        card.text(self._progress.answer(self.key))
        card.gap(8)
        said = answers[came] if came is not None else open_words
        if said:
            card.caption(texts.LEARN_UNSETTLED if came is None else texts.LEARN_CAME[came == guess])
            place = (card.right - 14, card.y + 0.6 * card.size)
            if came is not None and cursor.canvas:
                cursor.canvas.marker("check" if came == guess else "cross", place, 16, colour)
            card.colour, card.width = INK if came is not None else MUTE, card.width - 36
            card.text(said)
            card.gap(4)
        if cursor.canvas:
            cursor.canvas.fill(cursor.canvas.rect(cursor.left, top, 3, card.y - top), colour)
        cursor.y = card.y + 2 * STEP

    def _show_code(self) -> None:
        """Show the code, or the picture again."""
        self.in_code = not self.in_code
        self.reword()

    def _describe_listing(self, column: Column) -> None:
        code = self.chapter.code()
        assert code is not None, "it was asked for"
        source = source_of(code.function)
        if source is None:
            column.text(texts.LESSON_NO_SOURCE, size=_BODY, colour=MUTE)
            return
        line = source.line_of(code.line)
        add_listing(column, _LISTING, lambda: (source, line, {line: code.note}))

    def draw(self, canvas: Canvas, alpha: float) -> None:
        super().draw(canvas, alpha)
        if self._picture:
            before = canvas.surface.get_clip()
            canvas.surface.set_clip(canvas.rect(*self._picture.box).clip(canvas.rect(*self.panel.box)).clip(before))
            self.chapter.draw(canvas, self._picture.box, alpha)
            canvas.surface.set_clip(before)
        self.explained.draw(canvas)
