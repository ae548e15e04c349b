"""Chapter scene: one chapter of the path, in four pages: predict, try, see why, in the code."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Final

import pygame

from game.core import texts
from game.core.scene import Push, Replace, Route, Transition
from game.core.source import Source, source_of
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.prose import draw_wrapped, line_count
from game.drawing.sky import NightSky
from game.drawing.tokens import HUMAN, INK, MARGIN, MUTE, NET, SMALL, TEXT, VIEW_SIZE, Colour
from game.input.controls import Command
from game.learn.chapter import STAGE, Code
from game.learn.path import FIRST, PATH, chapter_type, following
from game.learn.progress import PAGES, Progress
from game.panels.code_listing import draw_listing
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.form_scene import FormScene
from game.ui.widget import Widget
from game.ui.widgets import Choice, TextButton
from game.ui.words import row_width

_PREDICT, _TRY, _WHY, _CODE = range(len(PAGES))
_COLUMN: Final = (MARGIN, 188.0, 344.0)  # left, first baseline and width of the text
_TABS: Final = (MARGIN, 120)
_BODY, _LEADING = SMALL + 1.5, 20.0
_GAP: Final = 12.0  # points between the lead and the question
_BELOW: Final = 20.0  # points between a text's last baseline and the buttons below it
_ANSWER: Final = 38  # points from one answer to the next
_FUNCTION: Final = 30  # points from one function's name to the next
_NOTES: Final = 230.0  # width of what stands beside lines of code
_FOOT: Final = 628
_OPEN: Final = (190, 198, 214)  # an answer that was not given


class ChapterScene(FormScene):
    """Chapter scene.

    Attributes:
        chapter: the chapter that is shown.
        page: which of `PAGES` is shown, by its index.

    """

    def __init__(self, context: Context, key: str = FIRST) -> None:
        super().__init__(context)
        self._progress = Progress(context.settings)
        self._sky = NightSky(context.rng, ember=0.4, stars=60)
        self.chapter = chapter_type(key)(context, self.form.manager)
        page = self._progress.page(key)
        # One that is done asks for a guess again. Of any other, a try from an earlier visit is gone with its numbers.
        self.page = _PREDICT if self._progress.done(key) else min(page, _TRY)
        self._function, self._told = 0, ""
        tabs = (*_TABS, row_width(texts.LEARN_PAGES, TEXT), 26)
        self._tabs = self.form.add(Choice(self.form.manager, tabs, "", texts.LEARN_PAGES, self.page, self.turn_to))
        self._widgets: list[Widget] = []
        self._listing = PaintCache()
        context.settings.chapter = key
        self._code = self._read_code()
        self._progress.note(key, page=self.page)
        self._offer()
        self.form.focus(self._widgets[0])

    def close(self) -> None:
        """Save the progress, and let the chapter release what it holds."""
        self.chapter.close()
        self.context.apply_settings()

    @property
    def key(self) -> str:
        """Key of the chapter."""
        return self.chapter.key

    def turn_to(self, page: int) -> None:
        """Show another page, and keep that it was opened."""
        self.page = self._tabs.index = page
        self._progress.note(self.key, page=page)
        if page == _WHY and self.chapter.tried:
            self._progress.note(self.key, done=True)
        self._told = self.chapter.why(self._progress.guess(self.key)) if self.chapter.tried else ""
        self.context.apply_settings()
        self._code = self._read_code()
        on_tabs = self.form.focused is self._tabs
        self._offer()
        if not on_tabs:
            self.form.focus(self._widgets[0])

    def _read_code(self) -> Sequence[Code]:
        """Return the code with the numbers of this moment: those that run on can't be read."""
        return self.chapter.code() if self.page == _CODE else ()

    def restart(self) -> None:
        """Begin the chapter's picture anew."""
        self.chapter.restart()
        self._offer()

    def actions(self) -> Table:
        """Move, press, turn the page; the chapter's own keys; go back."""
        own = self.chapter.actions() if self.page == _TRY else ()
        again = [Action(Command.RETRY, self.restart, texts.LEARN_AGAIN)] if self.page == _TRY else []
        on = texts.LEARN_NEXT_PAGE
        if self.page == len(PAGES) - 1:
            on = texts.LEARN_NEXT_CHAPTER if following(self.key) else ""
        return [
            self.form.moves,
            self.form.changes,
            *own,
            *again,
            Action(Command.NEXT, self._go_on, on),
            Action(Command.PREVIOUS, partial(self._turn, -1)),
            self.form.goes_back(texts.HINT_BACK),
        ]

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Offer a mouse event over the picture to the chapter first."""
        mouse = event.type in (pygame.MOUSEMOTION, pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP)
        if mouse and self.page != _CODE and self.chapter.handle_event(event):
            return None
        return super().handle_event(event)

    def update(self) -> Transition | None:
        """Advance the chapter, unless its question still stands."""
        if self.page != _PREDICT:
            self.chapter.update()
        if self.chapter.changed:
            self.chapter.changed = False
            self._offer()
            if self.page == _WHY and self._told:  # what is told there is of all that was tried by now
                self._told = self.chapter.why(self._progress.guess(self.key))
        if self.page == _WHY and self.chapter.tried and not self._told:
            self.turn_to(_WHY)  # what was begun on the page before has come to its end
        return self.form.update()

    # What can be pressed

    def _offer(self) -> None:
        pages = {_PREDICT: self._answers, _TRY: self.chapter.widgets, _CODE: self._functions}
        new = [*(pages[self.page]() if self.page in pages else ()), *self._foot()]
        self.form.replace(self._widgets, new)
        self._widgets = new

    def _answers(self) -> list[Widget]:
        guess = self._progress.guess(self.key)
        answers = [answer for answer in texts.LEARN_ANSWERS[self.key] if answer]
        left, _, width = _COLUMN
        end = self._end(self.chapter.words["lead"]) + _LEADING + _GAP
        top = self._below(self._end(self.chapter.words["predict"], end, TEXT), _ANSWER * len(answers))
        return [
            TextButton(self.form.manager, (left, top + _ANSWER * number, width, _ANSWER), answer,
                       partial(self._guess, number), colour=HUMAN if number == guess else _OPEN)
            for number, answer in enumerate(answers)
        ]  # fmt: skip

    def _functions(self) -> list[Widget]:
        codes = self._code
        left, _, width = _COLUMN
        top = self._below(self._end(self.chapter.words["code"]), _FUNCTION * len(codes))
        return [
            TextButton(self.form.manager, (left, top + _FUNCTION * number, width, _FUNCTION),
                       code.function.__qualname__, partial(self._show_function, number), size=SMALL, weight="code",
                       colour=NET if number == self._function else MUTE)
            for number, code in enumerate(codes)
        ]  # fmt: skip

    @staticmethod
    def _end(text: str, first: float = _COLUMN[1], size: float = _BODY) -> float:
        """Return the last baseline of a text in the column."""
        return first + _LEADING * (line_count(text, size, _COLUMN[2]) - 1)

    @staticmethod
    def _below(baseline: float, height: float) -> float:
        """Return the top of buttons that stand below a text, and above the foot of the page."""
        return min(baseline + _BELOW, STAGE.bottom - height)

    def _foot(self) -> list[Widget]:
        manager, after = self.form.manager, following(self.key)
        labels = (*texts.LEARN_ON, texts.LEARN_TO_CHAPTER if after else texts.LEARN_TO_LIST)
        foot: list[Widget] = [TextButton(manager, (MARGIN, _FOOT, 344, 30), labels[self.page], self._go_on, colour=INK)]
        if self.page >= _WHY:
            label = self.chapter.words["door"]
            foot.append(TextButton(manager, (STAGE.left, _FOOT, STAGE.width, 30), label, self._through_door))
        return foot

    def _guess(self, number: int) -> None:
        self._progress.note(self.key, guess=number)
        self.turn_to(_TRY)
        self.form.focus(self._widgets[0])

    def _show_function(self, number: int) -> None:
        self._function = number
        self._offer()

    def _turn(self, pages: int) -> None:
        if 0 <= self.page + pages < len(PAGES):
            self.turn_to(self.page + pages)

    def _go_on(self) -> Transition | None:
        if self.page < len(PAGES) - 1:
            self._turn(1)
            return None
        after = following(self.key)
        return Replace(Route("chapter", (after,))) if after else self.form.goes_back("").run()

    def _through_door(self) -> Transition:
        return Push(self.chapter.door)

    # The picture

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the page."""
        self._sky.draw(canvas)
        number = list(PATH).index(self.key) + 1
        canvas.text(texts.LEARN_PLACE.format(number=number, count=len(PATH)), (MARGIN, 38), size=SMALL, colour=MUTE)
        canvas.text(self.chapter.words["title"], (MARGIN, 76), size=30, weight="light")
        canvas.text(self.chapter.words["question"], (MARGIN, 104), colour=MUTE, room=VIEW_SIZE[0] - 2 * MARGIN)
        if self.page == _CODE:
            self._draw_code(canvas)
        else:
            self.chapter.draw(canvas, alpha)
            [self._draw_predict, self._draw_try, self._draw_why][self.page](canvas)
        self.form.draw(canvas)
        self.draw_hints(canvas)

    def _write(self, canvas: Canvas, text: str, y: float, colour: Colour = INK, size: float = _BODY) -> float:
        left, _, width = _COLUMN
        return draw_wrapped(canvas, text, (left, y), width, size=size, colour=colour, leading=_LEADING)

    def _draw_predict(self, canvas: Canvas) -> None:
        y = self._write(canvas, self.chapter.words["lead"], _COLUMN[1], MUTE)
        self._write(canvas, self.chapter.words["predict"], y + _GAP, size=TEXT)

    def _draw_try(self, canvas: Canvas) -> None:
        self._write(canvas, self.chapter.words["task"], _COLUMN[1])

    def _draw_why(self, canvas: Canvas) -> None:
        left, y, _ = _COLUMN
        told = self._told or (texts.LEARN_STILL_LEARNS if self.chapter.running else texts.LEARN_TRY_FIRST)
        guess = self._progress.guess(self.key)
        if guess is None:
            y = self._write(canvas, told, y)
        else:
            came = self.chapter.verdict() if self._told else None
            top, colour = y - _LEADING, MUTE if came is None else canvas.palette.good if came == guess else HUMAN
            if came is not None:
                canvas.marker("check" if came == guess else "cross", (left - 26, y - 5), 10, colour)
            said = texts.LEARN_GUESSED.format(guess=self._progress.answer(self.key))
            y = self._write(canvas, f"{said} {self._verdict(guess, came)}".rstrip(), y, colour) + 4
            y = self._write(canvas, told, y)
            canvas.line((left - 12, top + 4), (left - 12, y - 14), colour, 2)
        self._write(canvas, self.chapter.words["why"], y + 10, MUTE)

    def _verdict(self, guess: int, came: int | None) -> str:
        """Return whether this try has come as was guessed."""
        if came is None:
            return texts.LEARN_UNDECIDED[self.key] if self._told and self.key in texts.LEARN_UNDECIDED else ""
        if came == guess:
            return texts.LEARN_AGREES
        return texts.LEARN_DIFFERS.format(answer=texts.LEARN_ANSWERS[self.key][came])

    def _draw_code(self, canvas: Canvas) -> None:
        self._write(canvas, self.chapter.words["code"], _COLUMN[1])
        code = self._code[self._function]
        source = source_of(code.function)
        if source is None:
            canvas.text(texts.LEARN_NO_SOURCE, (STAGE.left, _COLUMN[1]), size=_BODY, colour=MUTE, room=STAGE.width)
            return
        current, notes = placed(source, code)
        box, room = pygame.FRect(0, 0, *STAGE.size), _NOTES if notes else 0.0
        self._listing.draw(
            canvas,
            STAGE,
            (source, current, tuple(notes.items())),
            lambda sheet: draw_listing(sheet, box, source, current, notes, notes_width=room),
        )


def placed(source: Source, code: Code) -> tuple[int | None, Mapping[int, str]]:
    """Return the number of the lit line, and what stands beside lines by their numbers."""
    notes = {source.line_of(mark): note for mark, note in code.notes.items()}
    return source.line_of(code.current) if code.current else None, notes
