"""Digits scene: a drawing pad, what the networks read in it, and why."""

from __future__ import annotations

from functools import partial
from typing import Final

import pygame

from ai.digits.classifier import DIGITS
from ai.digits.preprocessing import stages
from game.core import texts
from game.core.scene import Transition, push
from game.digits import certainty
from game.digits.pictures import AMBER, Numbers, Picture, picture
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import HUMAN, LINE, MUTE, SMALL, TITLE
from game.input.controls import Command
from game.scenes.digits.answer import DigitBars, write_answer, write_legend
from game.scenes.digits.fixing import FixRunner
from game.scenes.digits.pad import DrawingPad, pen_row
from game.scenes.digits.reader import LiveReading, Reading, Verdict, best_two
from game.training.library import NAMES, called
from game.ui.actions import Action, Table, digit_actions
from game.ui.context import Context
from game.ui.panel import Column, Panel
from game.ui.panel_scene import PanelScene

_LEAST, _APART = 170.0, 32.0  # points: the narrowest pad that stands beside its answer, and between the two
_ANSWER: Final = 130.0  # points for the answer beside its reasons
_MORE: Final = "digits"  # name in the settings of what stays open
_WHY: Final = 300.0  # side of a picture
_TILE: Final = 80.0


class DigitsScene(PanelScene):
    """Digits scene. `chosen` is the name of the network that is explained first.

    Attributes:
        pad: the drawing pad.
        live: reads and explains the drawing.
        fixing: teaches a network a drawing that it misreads.

    """

    def __init__(self, context: Context, chosen: str = NAMES[0]) -> None:
        super().__init__(context)
        self.pad = DrawingPad()
        self.live = LiveReading(self.pad, chosen)
        self._why, self._stages = Picture(AMBER), PaintCache()
        self._fix_of = -1  # revision of the drawing that was fixed last
        self.fixing = FixRunner(context.user_dir, context.models_dir)
        for name in dict.fromkeys((*NAMES, chosen)):
            self._load(name)
        if chosen not in self.live.classifiers:
            self.live.chosen = next(iter(self.live.classifiers), chosen)
        self._take_anew()

    def enter(self) -> None:
        self.fixing.refresh()
        if self.chosen not in self.fixing.networks:
            self.live.chosen = NAMES[0]
        self._take_anew()

    def exit(self) -> None:
        self.pad.lift()

    def close(self) -> None:
        self.fixing.close()

    @property
    def chosen(self) -> str:
        """Name of the network that is explained."""
        return self.live.chosen

    @property
    def reading(self) -> Reading:
        """The latest reading of the drawing."""
        return self.live.reading

    @property
    def canvas_rect(self) -> pygame.Rect:
        """The drawing area, in the window's pixels."""
        return self.context.reading().rect(*self.pad.rect)

    @property
    def probabilities(self) -> Numbers | None:
        """The chosen network's probabilities (10,); None while nothing is drawn, or it can't be loaded."""
        return self.live.probabilities

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        if event.type == pygame.WINDOWFOCUSLOST:
            self.pad.lift()
        return super().handle_event(event)

    def actions(self) -> Table:
        return [
            self.form.goes_back(texts.HINT_BACK),
            Action(pygame.K_z, self.pad.undo, texts.DIGITS_UNDO.lower(), gamepad=Command.HANDOVER),
            Action(Command.RETRY, self.pad.clear),
            *digit_actions(self._correct),
        ]

    def lay_out(self) -> None:
        super().lay_out()
        self.pad.rect = self._pen.picture

    def update(self) -> Transition | None:
        self.live.update()
        if self.fixing.poll():
            self._load(self.fixing.name)
            self._take_anew()
        self._bars.values = self.reading.probabilities[self.chosen].tolist() if self._drawn else [0.0] * DIGITS
        return super().update()

    # Rows

    def describe(self, panel: Panel) -> None:
        left, right = panel.beside((48, 60), least=_LEAST, apart=_APART)
        left.text(texts.DIGITS_TITLE, size=TITLE)
        self._pen = left.widget(pen_row(self.pad))
        left.words([
            (texts.DIGITS_CLEAR, self.pad.clear),
            (texts.INSIDE_TITLE, self._look_inside),
            (texts.DIGITS_TRAIN, partial(push, "digit_training")),
            self.unfolding(_MORE),
        ])  # fmt: skip
        answer, why = right.beside((22, 33), least=_ANSWER, apart=24.0)
        answer.add(self._write_answer)
        self._bars = answer.widget(DigitBars(self._correct))
        answer.add(self._write_fix)
        if self.chosen in self.fixing.networks and self.fixing.networks[self.chosen].fixed():
            answer.button(texts.DIGITS_UNDO_FIX, self._undo_fix, size=SMALL)
        why.add(self._write_why)
        if self.context.settings.is_open(_MORE):
            self._describe_more(why)

    def _describe_more(self, column: Column) -> None:
        live = self.live
        names = [name for name in self.fixing.networks if name in live.classifiers or name not in live.problems]
        if names:  # not where all are damaged
            now = names.index(self.chosen) if self.chosen in names else 0
            column.choice(texts.DIGITS_READER, list(map(called, names)), now, lambda index: self._choose(names[index]))
            column.gap()
        column.caption(texts.DIGITS_SEES)
        column.picture(_TILE, self._draw_stages)

    def _write_answer(self, cursor: Cursor) -> None:
        if self.chosen in self.reading.probabilities:
            write_answer(cursor, self.reading, self.chosen)
        for name, problem in self.live.problems.items():
            cursor.styled(texts.DIGITS_PROBLEM.format(name=called(name), problem=problem), SMALL, cursor.palette.warn)

    def _write_fix(self, cursor: Cursor) -> None:
        if self._drawn:
            first, second = fix_lines(self.fixing, same=self._fix_of == self.pad.revision)
            cursor.styled(first, SMALL, HUMAN)
            cursor.aside(second)

    def _write_why(self, cursor: Cursor) -> None:
        why, legend = self.live.why, texts.DIGITS_WHY_LEGEND if self._drawn else ()
        words = ""
        if self._drawn:
            first, second = best_two(self.reading.probabilities[self.chosen])
            words = texts.DIGITS_WHY.format(digit=first, other=second)
        cursor.caption(words)
        size = min(cursor.width, _WHY)
        box = cursor.take(size)
        if self._drawn and cursor.canvas and why is not None:
            self._why.draw(cursor.canvas, box, why)
        write_legend(cursor, zip(legend, (HUMAN, MUTE), strict=False))

    @property
    def _drawn(self) -> bool:
        """Whether there is something that the chosen network reads."""
        return self.reading.verdict(self.chosen) is not Verdict.EMPTY

    def _draw_stages(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw ink in its box, with strokes as wide as MNIST's, and by its centre of mass, which is read."""
        reading, tile = self.reading, min(_TILE, box.width / 4)

        def paint(sheet: Canvas) -> None:
            prepared = stages(self.pad.ink())
            for number, image in enumerate((prepared.fitted, prepared.thinned, reading.image)):
                area = sheet.rect(1.2 * number * tile, 0, tile, tile)
                sheet.surface.blit(picture(image, area.size), area)
                pygame.draw.rect(sheet.surface, LINE, area, 1)

        self._stages.draw(canvas, box, reading, paint)

    # Networks

    def _load(self, name: str) -> None:
        """Load a network with the player's fixes, or with fewer of them if some are damaged."""
        if network := self.fixing.networks.get(name):
            self.live.load(name, *network.versions())

    def _take_anew(self) -> None:
        """Read the drawing with networks that have changed, and show what can be done with them."""
        self.live.anew()
        self.build()

    def _choose(self, name: str) -> None:
        """Choose another network; if it can't be loaded, the last one stays."""
        if name not in self.live.classifiers:
            self._load(name)
        if name in self.live.classifiers:
            self.live.chosen = name
        self._take_anew()

    def _correct(self, digit: int) -> None:
        """Teach the chosen network that what is drawn is this digit."""
        self.live.catch_up()
        if self._drawn:
            self.fixing.begin(self.chosen, self.reading.image, digit)
            self._fix_of = self.pad.revision

    def _undo_fix(self) -> None:
        if self.fixing.undo(self.chosen):
            self._load(self.chosen)
            self._take_anew()

    def _look_inside(self) -> Transition | None:
        """Show what the chosen network makes of the drawing."""
        if self.probabilities is None:
            self.context.note(texts.DIGITS_EMPTY)
            return None
        return push("digit_inside", self.live.classifiers[self.chosen], self.reading.image)


def fix_lines(fixing: FixRunner, *, same: bool) -> tuple[str, str]:
    """Return how to correct an answer, or a fix's progress or result; `same`: whether its drawing is unchanged."""
    step, fixed = fixing.step, fixing.fixed
    if fixing.busy:
        now = texts.DIGITS_FIXING_NOW.format(percent=certainty(step.probability)) if step else ""
        return texts.DIGITS_FIXING.format(digit=fixing.digit), now
    if fixing.problem and same:
        return texts.DIGITS_NOT_FIXED, fixing.problem
    if fixed is None or not same:
        return texts.DIGITS_FIX_HOW, ""
    before, now = map(certainty, fixed.probability)
    first = texts.DIGITS_FIXED.format(digit=fixed.digit, before=before, now=now)
    return first, texts.DIGITS_FIX_COST.format(before=100 * fixed.accuracy[0], after=100 * fixed.accuracy[1])
