"""Quiz scene: the player draws digits for the network and reads strangers' digits; both sides score."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.digits.mnist import MnistError
from ai.digits.preprocessing import preprocess_strokes
from game.core import texts
from game.core.scene import Transition
from game.digits import percent
from game.digits.kept import mnist_test
from game.digits.pictures import picture
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.sky import NightSky
from game.drawing.tokens import (
    FIGURE,
    HUMAN,
    INK,
    LABEL,
    LINE,
    MUTE,
    NET,
    NIGHT0,
    SMALL,
    TEXT,
    TITLE,
    Colour,
)
from game.input.controls import Command
from game.scenes.digits.answer import LEFT
from game.scenes.digits.pad import DrawingPad, make_pen
from game.scenes.digits.quiz_rules import ROUNDS, QuizGame, QuizRound
from game.ui.actions import Action, Table, digit_actions
from game.ui.context import Context
from game.ui.form_scene import FOOT, FormScene
from game.ui.hints import Hint, HintRow
from game.ui.widget import OnPress, Widget
from game.ui.widgets import TextButton

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier

_PAD: Final = pygame.Rect(40, 86, 504, 504)
_QUESTION: Final = 132.0  # baselines of the question and of the result
_VERDICT: Final = 308.0
_COLUMN: Final = 236.0  # width of the text
_DIGITS: Final = "0123456789"
_KEYPAD: Final = (LEFT, 176.0)  # ten buttons to answer with
_WORDS: Final = 404.0
_SCORES: Final = (900.0, 1082.0)  # left edges of both sides' scores
_TILE: Final = 60.0
_PITCH: Final = 71.0
_TRACK: Final = (900.0, 250.0)  # corner of the track of finished rounds


class QuizScene(FormScene):
    """Quiz scene: a contest of ten rounds.

    Attributes:
        contest: the questions, the answers and the score.
        pad: the drawing pad.

    """

    def __init__(self, context: Context, classifier: DigitClassifier) -> None:
        super().__init__(context)
        self._classifier = classifier
        self._sky = NightSky(np.random.default_rng(14), ember=0.2, stars=24)
        self._strangers: tuple[np.ndarray, np.ndarray] = (np.zeros((0, 28, 28), np.uint8), np.zeros(0, np.uint8))
        try:
            self._strangers = mnist_test(context.assets_dir)
        except MnistError as error:
            context.note(texts.QUIZ_NO_STRANGERS.format(problem=error))
        self._laid = ""
        self._shown: list[Widget] = []
        self.restart()

    def exit(self) -> None:
        """End the current stroke."""
        self.pad.lift()

    @property
    def canvas_rect(self) -> pygame.Rect:
        """The drawing area, in the window's pixels."""
        return self.context.in_window(self.pad.rect)

    def update(self) -> Transition | None:
        """Look for digits of strangers, and animate the widgets."""
        self.contest.look()
        return super().update()

    def restart(self) -> None:
        """Start a new quiz."""
        self.contest = QuizGame(self._classifier, *self._strangers, self.context.rng)
        self._ask()

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Handle drawing, and pass any other event to the actions and the widgets."""
        return None if self._draws and self.pad.handle_event(event) else super().handle_event(event)

    def actions(self) -> Table:
        """Undo and clear while a digit is drawn, or choose one by its key; go on; go back."""
        table = list(super().actions())
        if self._draws:
            return [
                Action(pygame.K_z, self._undo, texts.DIGITS_UNDO.lower(), gamepad=Command.HANDOVER),
                Action(Command.CHOICES, self._clear, texts.DIGITS_CLEAR.lower()),
                *table,
                *(Action(key, self._clear) for key in (Command.RETRY, pygame.K_DELETE)),
            ]
        current = self.contest.round
        if current is None or current.answer is not None:
            return table
        if not self.context.controls.gamepad_in_use:
            table = [Hint("0 – 9", texts.HINT_CHOOSE), self.form.confirms(""), *table[1:]]
        return [*table, *digit_actions(self._read)]

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        """Return the hints below the pad."""
        return [HintRow(self.hints, (_PAD.left, FOOT[1]))]

    @property
    def _draws(self) -> bool:
        """Whether the player is to draw a digit now."""
        current = self.contest.round
        return current is not None and current.kind == "draw" and current.answer is None

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the question, the pad or a stranger's digit, and the score."""
        self._sky.draw(canvas)
        canvas.text(texts.QUIZ_TITLE, (_PAD.left, 45), size=TITLE)
        canvas.text(texts.QUIZ_LINE, (_PAD.left, 68), size=SMALL, colour=MUTE)
        current = self.contest.round
        if current is None:
            self.pad.draw(canvas, HUMAN)
            self._draw_end(canvas)
        else:
            if current.kind == "draw":
                self.pad.draw(canvas, HUMAN)
            elif current.image is not None:
                area = canvas.rect(*_PAD)
                canvas.surface.blit(picture(current.image, area.size), area)
                pygame.draw.rect(canvas.surface, LINE, area, 1)
            self._draw_question(canvas, current)
        self._draw_score(canvas)
        self.form.draw(canvas)
        self.draw_hints(canvas)

    # The game

    def _ask(self) -> None:
        """Prepare the next round."""
        self.pad = DrawingPad(_PAD)
        self._lay()

    def _go(self) -> None:
        """Submit the drawing, advance to the next round, or restart."""
        current = self.contest.round
        if current is None:
            self.restart()
        elif current.answer is not None:
            self.contest.go_on()
            self._ask()
        elif current.kind == "draw":
            self._submit()

    def _submit(self) -> None:
        image = preprocess_strokes(self.pad.strokes)
        if image.any():
            self.pad.lift()
            self.contest.submit(image)
            self._lay()
        else:
            self.context.note(texts.QUIZ_NOTHING)

    def _read(self, digit: int) -> None:
        self.contest.read(digit)
        self._lay()

    def _undo(self) -> None:
        self.pad.undo()

    def _clear(self) -> None:
        self.pad.clear()

    # Words

    def _word(self, label: str, place: tuple[float, float], press: OnPress, size: float = TEXT) -> TextButton:
        width = max(typeface.width(label, size, "regular"), 28)
        return TextButton(self.form.manager, (*place, width, size * 1.25 + 9), label, press, size=size, weight="light")

    def _lay(self) -> None:
        """Replace the buttons by those of the current phase."""
        current = self.contest.round
        if current and current.kind == "read" and current.answer is None:
            label = _DIGITS
        else:
            label = texts.QUIZ_AGAIN if not current else texts.QUIZ_DONE if current.answer is None else texts.QUIZ_NEXT
        if label == self._laid:
            return
        words: list[Widget] = self._keypad() if label == _DIGITS else [self._word(label, (LEFT, _WORDS), self._go)]
        if label == texts.QUIZ_DONE:
            words.append(make_pen(self.form.manager, lambda: self.pad))
        self.form.replace(self._shown, words)
        self.form.focus(words[0])
        self._laid, self._shown = label, words

    def _keypad(self) -> list[Widget]:
        """Return a button for each digit."""
        left, top = _KEYPAD
        return [
            self._word(digit, (left + 46 * (number % 5), top + 52 * (number // 5)), partial(self._read, number), FIGURE)
            for number, digit in enumerate(_DIGITS)
        ]

    # The picture

    def _draw_question(self, canvas: Canvas, current: QuizRound) -> None:
        number = texts.QUIZ_ROUND.format(number=self.contest.place + 1, count=ROUNDS)
        canvas.text(number, (LEFT, _QUESTION - 40), size=LABEL, colour=MUTE, weight="medium", tabular=True)
        draws = current.kind == "draw"
        question = texts.QUIZ_DRAW.format(digit=texts.NUMERALS[current.digit]) if draws else texts.QUIZ_READ
        canvas.text(question, (LEFT, _QUESTION), size=FIGURE, weight="light")
        if current.answer is None:
            how = texts.QUIZ_DRAW_HOW if draws else texts.QUIZ_READ_HOW
            draw_wrapped(canvas, how, (LEFT, _QUESTION + 28), _COLUMN, colour=MUTE, leading=18)
            return
        assert current.probabilities is not None
        best = int(current.probabilities.argmax())
        numeral = texts.NUMERALS
        share = percent(float(current.probabilities[best]))
        read = {"read": numeral[best], "percent": share, "digit": numeral[current.digit]}
        whose, colour = (NET, canvas.palette.good) if current.right else (MUTE, canvas.palette.warn)
        shown = str(current.answer)
        canvas.text(
            shown,
            (LEFT - 6, 262),
            size=124,
            weight="extralight",
            colour=(whose if draws else HUMAN) if current.right else MUTE,
        )
        words = {
            (True, True): texts.QUIZ_NET_RIGHT,
            (True, False): texts.QUIZ_NET_WRONG,
            (False, True): texts.QUIZ_YOU_RIGHT,
            (False, False): texts.QUIZ_YOU_WRONG,
        }[draws, current.right].format(**read)
        canvas.marker("check" if current.right else "cross", (LEFT + 5, _VERDICT - 5), 10, colour)
        canvas.text(words, (LEFT + 18, _VERDICT), size=TEXT, colour=colour, tabular=True)
        if not draws:
            canvas.text(texts.QUIZ_NET_TOO.format(**read), (LEFT, _VERDICT + 26), size=SMALL, colour=MUTE)

    def _draw_end(self, canvas: Canvas) -> None:
        (you, asked), (net, drawn) = self.contest.score("read"), self.contest.score("draw")
        canvas.text(
            texts.QUIZ_OVER[self.contest.lead],
            (LEFT, _QUESTION),
            size=TITLE,
            colour={1: HUMAN, 0: INK, -1: NET}[self.contest.lead],
        )
        told = texts.QUIZ_OVER_LINE.format(you=you, asked=asked, net=net, drawn=drawn)
        draw_wrapped(canvas, told, (LEFT, _QUESTION + 28), _COLUMN, colour=MUTE, leading=18)

    def _draw_score(self, canvas: Canvas) -> None:
        sides: tuple[tuple[int, int], ...] = (self.contest.score("read"), self.contest.score("draw"))
        for (right, count), x, name, colour in zip(sides, _SCORES, texts.QUIZ_SIDES, (HUMAN, NET), strict=True):
            canvas.text(name.upper(), (x, 92), size=LABEL, colour=MUTE, weight="medium")
            figure = canvas.text(
                str(right), (x - 2, 146), size=FIGURE * 1.6, weight="light", colour=colour, tabular=True
            )
            if count:
                words = texts.QUIZ_OF.format(count=count)
                canvas.text(words, (figure.right + 8, 146), size=SMALL, colour=MUTE, tabular=True)
        left, top = _TRACK
        for number, each in enumerate(self.contest.rounds):
            row, column = number % 2, number // 2  # what the player drew above, what strangers wrote below
            place = (left + column * _PITCH, top + row * (_TILE + 34))
            _draw_tile(canvas, each, place, current=number == self.contest.place)


def _draw_tile(canvas: Canvas, each: QuizRound, place: tuple[float, float], *, current: bool) -> None:
    """Draw what was read in a round, and whether rightly; of one that is to come, only its place."""
    area = canvas.rect(*place, _TILE, _TILE)
    edge: Colour = INK if current else LINE
    canvas.fill(area, NIGHT0)
    if each.answer is not None and each.image is not None:
        canvas.surface.blit(picture(each.image, area.size), area)
        sign, colour = ("check", canvas.palette.good) if each.right else ("cross", canvas.palette.warn)
        canvas.marker(sign, (place[0] + 6, place[1] + _TILE + 13), 9, colour)  # type: ignore[arg-type]
        canvas.text(
            str(each.answer),
            (place[0] + 17, place[1] + _TILE + 17),
            size=SMALL,
            tabular=True,
            colour=NET if each.kind == "draw" else HUMAN,
        )
    pygame.draw.rect(canvas.surface, edge, area, max(1, canvas.px(1)))
