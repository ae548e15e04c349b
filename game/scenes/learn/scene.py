"""Chapter scene: a chapter on one page that grows: a question, the thing to touch, what the player's try has shown."""

from __future__ import annotations

import re
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
from game.scenes.learn.path import FIRST, PATH, Progress, chapter_type, following
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.panel import Column, Panel, Row
from game.ui.panel_scene import PanelScene
from game.ui.widget import OnPress

_SHARES, _LEAST, _APART = (1.0, 1.8), 240.0, 36.0  # of the columns of words and of the picture
_BODY: Final = SMALL + 1.5
_OPEN: Final[Colour] = (190, 198, 214)  # an answer that was not given
_AROUND, _LOWEST = 210.0, 0.85  # points above and below the picture; the least share of its height
_LISTING: Final = 320.0  # height of a listing
_INDENT: Final = 18.0  # of a verdict, behind its line
_FOOT: Final = 10.0  # points between the page and the ways on below it
_FEW: Final = 340  # letters of an explanation, some four lines, before the rest of it is asked for
_MORE: Final = "learn"  # name in the settings of what stays open


class ChapterScene(PanelScene):
    """Chapter scene.

    Attributes:
        chapter: the chapter that is shown.
        begun: whether the thing to touch stands there, since a guess was given or passed over.
        finding: what the player's tries have shown; empty before.
        came: number of the answer that they have shown; None while they decide nothing.
        in_code: whether the line of code that did it stands in place of the picture.
        foot: the ways on, which stay in sight below the page however far it has grown.

    """

    def __init__(self, context: Context, key: str = FIRST) -> None:
        super().__init__(context)
        self._progress, self.explained = Progress(context.settings), Explained()
        self.chapter = chapter_type(key)(context)
        # One that is done asks for a guess again.
        self.begun = self._progress.guess(key) is not None and not self._progress.done(key)
        self.finding, self.in_code, self._grown = "", False, False
        self.came: int | None = None
        self._progress.note(key)
        self.build()

    def enter(self) -> None:
        self.reword()

    def close(self) -> None:
        self.chapter.close()
        self.context.apply_settings()

    @property
    def key(self) -> str:
        """Key of the chapter."""
        return self.chapter.key

    def begin(self, guess: int | None = None) -> None:
        """Go on to the thing to touch, with the number of an answer or without."""
        if guess is not None:
            self._progress.note(self.key, guess=guess)
        self.begun = True
        self.context.apply_settings()
        self.build()
        self.form.focus(self.form.widgets[0])

    def reword(self) -> None:
        if self.chapter.tried:
            self._find()
        self.build()

    def _find(self) -> None:
        """Say what the tries have shown; a chapter whose question they have answered is done."""
        self.finding, came = self.chapter.why(), self.chapter.verdict()
        if came is not None:
            self.came = came
            self._progress.note(self.key, done=True)
            self.context.apply_settings()

    def _restart(self) -> None:
        """Begin the chapter's picture anew; what was shown stays."""
        if self.begun and not self.chapter.problem:
            self.chapter.restart()
            self.build()

    def actions(self) -> Table:
        return [
            self.form.changes,
            *([Action(Command.RETRY, self._restart, texts.LEARN_AGAIN)] if self.begun else []),
            *([self.explained.action()] if self.chapter.explains and self._picture else []),
            self.form.goes_back(texts.HINT_BACK),
        ]

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        return None if self.explained.handle_event(event) else super().handle_event(event)

    def update(self) -> Transition | None:
        chapter = self.chapter
        if self.begun and not chapter.problem:
            chapter.update()
        if chapter.news:
            chapter.news, chapter.changed, before = False, chapter.changed or not self.finding, self.came
            self._find()
            self._grown |= self.came != before
        if chapter.changed and not any(widget.held for widget in self.form.widgets):  # or a drag would end
            self.build()
            chapter.changed = False
        if self._grown and not any(widget.held for widget in self.form.widgets):
            self._grown = False
            self.panel.scroll(self.panel.height)  # to what the verdict has brought
        self.explained.update()
        return super().update()

    def _go_on(self) -> Transition | None:
        after = following(self.key)
        return Replace(Route("chapter", (after,))) if after else self.form.goes_back("").run()

    # Rows

    def describe(self, panel: Panel) -> None:
        number, words = list(PATH).index(self.key) + 1, self.chapter.words
        panel.title(f"{number}   {words['title']}", TITLE + 6)
        panel.text(words["question"], colour=MUTE)
        panel.gap(6)
        left, right = panel.beside(_SHARES, _LEAST, _APART)
        left.text(words["lead"], size=_BODY, colour=MUTE)
        left.gap(8)
        (self._describe_try if self.begun else self._describe_question)(left)
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
        if self.begun and not self.chapter.problem and self.chapter.code():
            right.button(texts.LEARN_CODE[self.in_code], self._show_code, size=SMALL + 1)
        if self.finding:
            panel.gap(10)
            panel.line()
            self._describe_finding(panel)
        self.foot = Panel(self.form)
        self.foot.words(self._ways())

    def room(self, canvas: Canvas) -> pygame.FRect:
        whole = super().room(canvas)
        return pygame.FRect(*whole.topleft, whole.width, whole.height - self.foot.height - _FOOT)

    def lay_out(self) -> None:
        canvas = self.context.reading()
        whole = super().room(canvas)
        self.foot.lay_out(whole, canvas.scale)  # for its height
        high = self.foot.height
        self.foot.lay_out(pygame.FRect(whole.left, whole.bottom - high, whole.width, high), canvas.scale)
        super().lay_out()

    def _leave_room(self, cursor: Cursor) -> None:
        """Leave room for the picture: as high as it should be, or as all else leaves room for in the window."""
        if cursor.canvas is None and cursor.seen:
            whole = self.chapter.shape * cursor.width
            self._high = min(whole, max(cursor.seen.height - _AROUND, _LOWEST * whole))
        cursor.take(self._high)

    def _describe_question(self, column: Column) -> None:
        column.text(self.chapter.words["predict"])
        guess = self._progress.guess(self.key)
        for number, answer in enumerate(filter(None, texts.LEARN_ANSWERS[self.key])):
            column.button(answer, partial(self.begin, number), colour=HUMAN if number == guess else _OPEN)

    def _describe_try(self, column: Column) -> None:
        column.text(self.chapter.words["task"], size=_BODY)
        column.gap(6)
        if not self.chapter.problem:
            self.chapter.controls(column)
        column.gap(6)
        column.add(self._write_verdict)  # below the controls, which hold still when it changes

    def _describe_finding(self, panel: Panel) -> None:
        """Add what the player's tries have shown, and why: the first sentences, and then all of them."""
        own, general = panel.beside(_SHARES, _LEAST, _APART)
        own.text(lambda: self.finding, size=_BODY)
        whole = f"{self.chapter.words['why']} {self.chapter.words.get('differs', '')}".rstrip()
        few = _first_sentences(whole)
        opened = self.context.settings.is_open(_MORE)
        general.text(whole if opened else few, size=_BODY, colour=MUTE)
        if few != whole:
            general.button(*self.unfolding(_MORE), size=SMALL + 1)

    def _ways(self) -> list[tuple[str, OnPress]]:
        """Return the ways on."""
        if not self.begun:
            return [(texts.LEARN_NO_GUESS, self.begin)]
        return [
            (texts.LEARN_TO_CHAPTER if following(self.key) else texts.LEARN_TO_LIST, self._go_on),
            (self.chapter.words["door"], lambda: Push(self.chapter.door)),
        ]

    def _write_verdict(self, cursor: Cursor) -> None:
        """Write what was said, and beside it what came of the player's tries."""
        guess, came, top = self._progress.guess(self.key), self.came, cursor.y
        if guess is None and came is None:
            return
        palette, colour = cursor.palette, MUTE
        if came is not None:
            colour = palette.good if came == guess else palette.warn if guess is not None else INK
        card = cursor.in_style(TEXT, HUMAN)
        card.left, card.width = cursor.left + _INDENT, cursor.width - _INDENT
        if guess is not None:
            card.caption(texts.LEARN_YOU_SAID)
            card.text(self._progress.answer(self.key))
            card.gap(6)
        if came is not None or self.finding:
            card.caption(texts.LEARN_UNSETTLED if came is None else texts.LEARN_CAME[came == guess])
            place = (card.right - 14, card.y + 0.6 * card.size)
            if came is not None and guess is not None and cursor.canvas:
                cursor.canvas.marker("check" if came == guess else "cross", place, 16, colour)
            card.colour, card.width = INK if came is not None else MUTE, card.width - 36
            card.text(texts.LEARN_UNDECIDED[self.key] if came is None else texts.LEARN_ANSWERS[self.key][came])
        if cursor.canvas:
            cursor.canvas.fill(cursor.canvas.rect(cursor.left, top, 3, card.y - top), colour)
        cursor.y = card.y + 1.5 * STEP

    def _show_code(self) -> None:
        """Show the code, or the picture again."""
        self.in_code = not self.in_code
        self.build()

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
        self.foot.draw(canvas)
        if self._picture:
            before = canvas.surface.get_clip()
            canvas.surface.set_clip(canvas.rect(*self._picture.box).clip(canvas.rect(*self.panel.box)).clip(before))
            self.chapter.draw(canvas, self._picture.box, alpha)
            canvas.surface.set_clip(before)
        self.explained.draw(canvas)


def _first_sentences(words: str) -> str:
    """Return the sentences at the beginning of a text that are few letters together, one at least."""
    sentences = re.split(r"(?<=[.!?]) ", words)
    few = sentences.pop(0)
    while sentences and len(few) + 1 + len(sentences[0]) <= _FEW:
        few += f" {sentences.pop(0)}"
    return few
