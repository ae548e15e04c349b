"""Quiz scene: the player draws digits for the network and reads those of other people; both sides score."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.digits.mnist import MnistError
from ai.digits.preprocessing import preprocess_strokes
from game.core import texts
from game.core.scene import Transition
from game.digits import certainty
from game.digits.kept import mnist_test
from game.digits.pictures import picture
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.shapes import Shape
from game.drawing.tokens import FIGURE, HUMAN, INK, LINE, MUTE, NET, NIGHT0, SMALL, TITLE, Colour
from game.input.controls import Command
from game.scenes.digits.answer import write_large, write_marked
from game.scenes.digits.pad import DrawingPad, pen_row, side_in
from game.scenes.digits.quiz_rules import ROUNDS, QuizGame, QuizRound
from game.scenes.digits.scene import COLUMNS, LEAST
from game.ui.actions import Action, Table, digit_actions
from game.ui.context import Context
from game.ui.hints import Hint
from game.ui.panel import Column, Panel
from game.ui.panel_scene import PanelScene
from game.ui.virtual_pointer import PictureRow

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier

_TILE: Final = 60.0
_PITCH: Final = (71.0, 92.0)  # from one tile to the next, across and down


class QuizScene(PanelScene):
    """Quiz scene: a contest of ten rounds.

    Attributes:
        contest: the questions, the answers and the score.
        pad: the drawing pad.

    """

    def __init__(self, context: Context, classifier: DigitClassifier) -> None:
        super().__init__(context)
        self._classifier = classifier
        self._pen: PictureRow | None = None
        self._test_digits: tuple[np.ndarray, np.ndarray] = (np.zeros((0, 28, 28), np.uint8), np.zeros(0, np.uint8))
        try:
            self._test_digits = mnist_test(context.assets_dir)
        except MnistError as error:
            context.note(texts.QUIZ_NO_STRANGERS.format(problem=error))
        self.restart()

    def exit(self) -> None:
        self.pad.lift()

    def update(self) -> Transition | None:
        self.contest.look()
        return super().update()

    def lay_out(self) -> None:
        super().lay_out()
        if self._pen:
            self.pad.rect = self._pen.picture

    # The game

    def restart(self) -> None:
        """Start a new quiz."""
        self.contest = QuizGame(self._classifier, *self._test_digits, self.context.rng)
        self._ask()

    def _ask(self) -> None:
        """Prepare the next round."""
        self.pad = DrawingPad()
        self._turn()

    def _turn(self) -> None:
        """Offer what can be done now."""
        self.build()
        self.form.focus(next(each for each in self.form.widgets if each is not self._pen))

    def _go(self) -> None:
        """Submit the drawing, advance to the next round, or restart."""
        current = self.contest.round
        if current is None:
            self.restart()
        elif current.answer is not None:
            self.contest.go_on()
            self._ask()
        elif self._draws:
            image = preprocess_strokes(self.pad.strokes)
            if image.any():
                self.pad.lift()
                self.contest.submit(image)
                self._turn()
            else:
                self.context.note(texts.QUIZ_NOTHING)

    def _read(self, digit: int) -> None:
        self.contest.read(digit)
        self._turn()

    @property
    def _draws(self) -> bool:
        """Whether the player is to draw a digit now."""
        current = self.contest.round
        return current is not None and current.kind == "draw" and current.answer is None

    def actions(self) -> Table:
        table = list(super().actions())
        if self._draws:
            return [
                Action(pygame.K_z, self.pad.undo, texts.DIGITS_UNDO.lower(), gamepad=Command.HANDOVER),
                Action(Command.CHOICES, self.pad.clear, texts.DIGITS_CLEAR.lower()),
                *table,
                *(Action(key, self.pad.clear) for key in (Command.RETRY, pygame.K_DELETE)),
            ]
        current = self.contest.round
        if current is None or current.answer is not None:
            return table
        if not self.context.controls.gamepad_in_use:
            table = [Hint("0 – 9", texts.HINT_CHOOSE), self.form.confirms(""), *table[1:]]
        return [*table, *digit_actions(self._read)]

    # Rows

    def describe(self, panel: Panel) -> None:
        current, self._pen = self.contest.round, None
        left, right = panel.beside(COLUMNS, least=LEAST, apart=40.0)
        left.text(texts.QUIZ_TITLE, size=TITLE)
        left.aside(texts.QUIZ_LINE)
        left.gap()
        if self._draws:
            self._pen = left.widget(pen_row(self.pad, HUMAN))
        elif current is None or current.kind == "draw":
            left.picture(side_in, lambda canvas, _: self.pad.draw(canvas, HUMAN))
        else:
            left.picture(side_in, partial(_draw_image, current))
        question, score = right.beside((25, 33), least=160.0)
        if current is None:
            self._describe_end(question)
        else:
            self._describe_round(question, current)
        sides = zip(texts.QUIZ_SIDES, ("read", "draw"), (HUMAN, NET), strict=True)
        for column, (name, kind, colour) in zip(score.beside((1, 1), least=80.0), sides, strict=True):
            right_ones, count = self.contest.score(kind)  # type: ignore[arg-type]
            column.caption(name.upper())
            column.text(str(right_ones), size=FIGURE * 1.6, weight="light", colour=colour, tabular=True)
            column.aside(texts.QUIZ_OF.format(count=count) if count else "")
        score.gap()
        score.picture(2 * _PITCH[1], self._draw_track)

    def _describe_end(self, column: Column) -> None:
        (you, asked), (net, drawn) = self.contest.score("read"), self.contest.score("draw")
        colour = {1: HUMAN, 0: INK, -1: NET}[self.contest.lead]
        column.text(texts.QUIZ_OVER[self.contest.lead], size=TITLE, colour=colour)
        column.aside(texts.QUIZ_OVER_LINE.format(you=you, asked=asked, net=net, drawn=drawn))
        column.button(texts.QUIZ_AGAIN, self._go)

    def _describe_round(self, column: Column, current: QuizRound) -> None:
        draws = current.kind == "draw"
        column.caption(texts.QUIZ_ROUND.format(number=self.contest.place + 1, count=ROUNDS))
        question = texts.QUIZ_DRAW.format(digit=texts.NUMERALS[current.digit]) if draws else texts.QUIZ_READ
        column.text(question, size=FIGURE, weight="light")
        if current.answer is not None:
            column.add(partial(_write_verdict, current))
            column.button(texts.QUIZ_NEXT, self._go)
            return
        column.aside(texts.QUIZ_DRAW_HOW if draws else texts.QUIZ_READ_HOW)
        column.gap()
        if draws:
            column.button(texts.QUIZ_DONE, self._go)
        else:
            column.words([(str(digit), partial(self._read, digit)) for digit in range(10)])

    def _draw_track(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw what was read in each round: what the player drew above, what other people wrote below."""
        for number, each in enumerate(self.contest.rounds):
            pitch = min(_PITCH[0], box.width / (ROUNDS / 2))
            place = (box.left + number // 2 * pitch, box.top + number % 2 * _PITCH[1])
            side = min(_TILE, pitch - 8)
            area = canvas.rect(*place, side, side)
            canvas.fill(area, NIGHT0)
            if each.answer is not None and each.image is not None:
                canvas.surface.blit(picture(each.image, area.size), area)
                sign, colour = _mark(canvas, each)
                canvas.marker(sign, (place[0] + 6, place[1] + side + 13), 9, colour)
                reader = NET if each.kind == "draw" else HUMAN
                canvas.text(str(each.answer), (place[0] + 17, place[1] + side + 17), size=SMALL, colour=reader)
            edge = INK if number == self.contest.place else LINE
            pygame.draw.rect(canvas.surface, edge, area, max(1, canvas.px(1)))


def _mark(drawn_on: Canvas | Cursor, each: QuizRound) -> tuple[Shape, Colour]:
    return ("check", drawn_on.palette.good) if each.right else ("cross", drawn_on.palette.warn)


def _draw_image(current: QuizRound, canvas: Canvas, box: pygame.FRect) -> None:
    area = canvas.rect(*box.topleft, box.height, box.height)
    if current.image is not None:
        canvas.surface.blit(picture(current.image, area.size), area)
    pygame.draw.rect(canvas.surface, LINE, area, 1)


def _write_verdict(current: QuizRound, cursor: Cursor) -> None:
    """Write what was read, and whether rightly."""
    assert current.probabilities is not None
    draws, best = current.kind == "draw", int(current.probabilities.argmax())
    numeral, share = texts.NUMERALS, certainty(float(current.probabilities[best]))
    read = {"read": numeral[best], "percent": share, "digit": numeral[current.digit]}
    sign, colour = _mark(cursor, current)
    words = {
        (True, True): texts.QUIZ_NET_RIGHT,
        (True, False): texts.QUIZ_NET_WRONG,
        (False, True): texts.QUIZ_YOU_RIGHT,
        (False, False): texts.QUIZ_YOU_WRONG,
    }[draws, current.right]
    write_large(cursor, str(current.answer), (NET if draws else HUMAN) if current.right else MUTE)
    write_marked(cursor, sign, words.format(**read), colour)
    if not draws:
        cursor.aside(texts.QUIZ_NET_TOO.format(**read))
