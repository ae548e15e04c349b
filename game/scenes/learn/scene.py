"""Chapter scene: a chapter on one page that grows: a question, the thing to touch, what the player's try has shown."""

from __future__ import annotations

from functools import partial
from typing import Final

import pygame

from game.core import texts
from game.core.scene import Push, Replace, Route, Transition
from game.core.source import source_of
from game.drawing.tokens import HUMAN, INK, MUTE, SMALL, TITLE, Colour
from game.explain.code_listing import add_listing
from game.input.controls import Command, translate
from game.scenes.learn.path import FIRST, PATH, chapter_type, following
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.panel import Column, Panel
from game.ui.panel_scene import PanelScene

_SHARES, _LEAST, _APART = (1.0, 1.8), 240.0, 36.0  # of the columns of words and of the picture
_BODY: Final = SMALL + 1.5
_OPEN: Final[Colour] = (190, 198, 214)  # an answer that was not given, and what holds in general
_AROUND, _LOWEST = 250.0, 0.85  # points above and below the picture; the least share of its height
_LISTING: Final = 320.0  # height of a listing


class ChapterScene(PanelScene):
    """Chapter scene.

    Attributes:
        chapter: the chapter that is shown.
        begun: whether the thing to touch stands there, since a guess was given or passed over.
        guess: number of the answer that was given; None before, or without.
        finding: what the player's tries have shown; empty before.
        came: number of the answer that they have shown; None while they decide nothing.
        in_code: whether the line of code that did it stands in place of the picture.

    """

    def __init__(self, context: Context, key: str = FIRST) -> None:
        super().__init__(context)
        self.key, self.chapter = key, chapter_type(key)(context)
        self.begun, self.finding, self.in_code = False, "", False
        self.guess: int | None = None
        self.came: int | None = None
        self.build()

    def enter(self) -> None:
        self.reword()

    def close(self) -> None:
        self.context.chapter = self.key
        self.chapter.close()

    def begin(self, guess: int | None = None) -> None:
        """Go on to the thing to touch, with the number of an answer or without."""
        self.guess, self.begun = guess, True
        self.build()
        self.form.focus(self.form.widgets[0])
        self._show_picture()

    def reword(self) -> None:
        self.finding, self.came = "", None
        if self.chapter.tried:
            self._find()
        self.build()

    def _find(self) -> None:
        """Say what the tries have shown; a chapter whose question they have answered is done."""
        self.finding, self.came = self.chapter.why(), self.chapter.verdict()
        if self.came is not None:
            self.context.settings.learnt[self.key] = {"done": True}
            self.context.apply_settings()

    def actions(self) -> Table:
        onward = [Action(Command.NEXT, self._go_on, texts.LEARN_TO_CHAPTER)] if following(self.key) else []
        return [self.form.changes, *onward, self.form.goes_back(texts.HINT_BACK)]

    def _go_on(self) -> Transition:
        return Replace(Route("chapter", (following(self.key),)))

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        outcome, command = super().handle_event(event), translate(event)
        changes = self.form.focused and self.form.focused.by_arrows
        if command is Command.CONFIRM or (changes and command in (Command.LEFT, Command.RIGHT)):
            self._show_picture()
        return outcome

    def _show_picture(self) -> None:
        """Scroll to the picture that a press changes, as far as what was pressed stays in sight."""
        self.lay_out()
        focused, room = self.form.focused, self.panel.box
        if self.begun and not self.in_code and focused:
            most = min(self._picture.box.top, focused.box.top - 8.0) - room.top
            self.panel.scroll(min(most, max(self._picture.box.bottom - room.bottom, 0.0)))

    def update(self) -> Transition | None:
        chapter, before = self.chapter, self.came
        if self.begun:
            chapter.update()
        if chapter.changed and not any(widget.held for widget in self.form.widgets):  # or a drag would end
            chapter.changed = False
            self.reword()
            if self.came not in (before, None):
                self.panel.scroll(self.panel.height)  # to what the verdict has brought
        return super().update()

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
        if self.in_code:
            self._describe_listing(right)
        else:
            self._picture = right.picture(self._high, self.chapter.draw)
            right.gap(4)
            self.chapter.below(right)
        if self.begun and self.chapter.code():
            right.button(texts.LEARN_CODE[self.in_code], self._show_code, size=SMALL + 1)
        if self.finding:
            panel.gap(10)
            panel.line()
            own, general = panel.beside(_SHARES, _LEAST, _APART)
            own.text(self.finding, size=_BODY)
            general.text(words["why"], size=_BODY, colour=_OPEN)
            general.button(words["door"], lambda: Push(self.chapter.door))

    def _high(self, width: float) -> float:
        """Return the picture's height: as high as it should be, or as all else leaves room for in the window."""
        whole = self.chapter.shape * width
        return min(whole, max(self.room(self.context.reading()).height - _AROUND, _LOWEST * whole))

    def _describe_question(self, column: Column) -> None:
        column.text(self.chapter.words["predict"])
        for number, answer in enumerate(filter(None, texts.LEARN_ANSWERS[self.key])):
            column.button(answer, partial(self.begin, number), colour=_OPEN)
        column.button(texts.LEARN_NO_GUESS, self.begin, size=SMALL + 1, colour=MUTE)

    def _describe_try(self, column: Column) -> None:
        """Add what can be tried, and below it what was said, and what came of the player's tries."""
        column.text(self.chapter.words["task"], size=_BODY)
        column.gap(6)
        self.chapter.controls(column)
        column.gap(6)
        guess, came = self.guess, self.came
        if guess is not None:
            column.caption(texts.LEARN_YOU_SAID)
            column.text(texts.LEARN_ANSWERS[self.key][guess], colour=HUMAN)
        if came is not None:
            palette, right = self.context.reading().palette, came == guess
            said, judged = texts.LEARN_CAME[right], self.chapter.judged
            column.caption(f"{said} · {judged}" if judged else said)
            colour = INK if guess is None else palette.good if right else palette.warn
            column.text(texts.LEARN_ANSWERS[self.key][came], colour=colour)
        elif guess is not None and self.finding:
            column.text(texts.LEARN_UNSETTLED, colour=MUTE)

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
