"""Falls of a replayed flight: a lane with the chance to be saved, where it fell on the way, and by what key."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from ai.common.environment import Doubles
from ai.lander.environment import ACTION_NAMES
from ai.lander.pilots import COAST
from game.core import texts
from game.core.clock import STEP
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import HUMAN, INK, LABEL, LINE, MUTE, NET, SMALL
from game.flight.chances import Fall, FlightChances, critic_of, known_for
from game.flight.flight import DECISION_STEPS, StickHolder
from game.flight.networks import Policy
from game.flight.replay import FlightReplay
from game.panels.chance_values import of_hundred, told_apart
from game.panels.timeline import Timeline
from game.ui.form import Form
from game.ui.widgets import TextButton
from game.world.camera import View
from game.world.paths import draw_stretch

HEIGHT: Final = 26.0  # of the lane, below those of the engines
_ROW: Final = 18  # height of the sentence
_SLACK: Final = 3.0  # points above and below the lane that explain it


class Falls:
    """Where the chance to be saved fell in a replayed flight; call `judge` once, and `follow` in every update.

    Args:
        form: the form that gets the sentence, a button that jumps to the fall.
        timeline: the timeline whose lowest part is the lane.
        replay: the flight.
        place: left end and top of the sentence, in points.
        on_seek: called with the step to show.

    Attributes:
        chances: the chances judged so far; None without a safety critic.
        words: what the sentence says.

    """

    def __init__(
        self,
        form: Form,
        timeline: Timeline,
        replay: FlightReplay,
        place: tuple[float, float],
        on_seek: Callable[[int], None],
    ) -> None:
        self._form, self._timeline, self._replay, self._on_seek = form, timeline, replay, on_seek
        self._place = place
        self.chances: FlightChances | None = None
        self.words = ""
        self._lane = PaintCache()
        self._buttons: list[TextButton] = []

    def judge(self, policy: Policy | None) -> None:
        """Begin to judge the flight by the critic of a network; say so if there is none."""
        if self.chances is not None or self.words:
            return
        recording = self._replay.record.recording
        critic, problem = critic_of(policy)
        changed = recording.gravity and not (critic and critic.anywhere)
        if changed or not known_for(self._replay.flight.env, critic):
            self.words = texts.CHANCE_MOON_ONLY
        elif critic is None:
            self.words = texts.FALLS_NO_CRITIC.format(problem=problem)
        else:
            self.chances = FlightChances(self._replay, critic)

    def follow(self) -> None:
        """Judge a little more, and keep the sentence about the moment that is shown."""
        if self.chances is None:
            return
        self.chances.follow()
        if not self.chances.complete:
            return
        fall = self.fall
        said = fall_words(fall) if fall else _never_fell(self.chances.chances)
        if said == self.words:
            return
        self.words = said
        if fall is None:
            return
        left, top = self._place
        box = (left, top, round(typeface.width(said, SMALL, "regular")) + 2, _ROW)
        button = TextButton(self._form.manager, box, said, self.jump, size=SMALL, colour=_colour(fall))
        if self._buttons and self._form.focused is self._buttons[0]:
            self._form.replace(self._buttons, [button])
            self._form.focus(button)
        else:
            self._form.replace(self._buttons, [button])
        self._buttons = [button]

    @property
    def fall(self) -> Fall | None:
        """The fall that the sentence is about: the latest that has begun, or else the first; None without any."""
        if self.chances is None or not self.chances.falls:
            return None
        begun = [fall for fall in self.chances.falls if fall.begins <= self._replay.at]
        return begun[-1] if begun else self.chances.falls[0]

    @property
    def any(self) -> bool:
        """Whether there is a fall to jump to."""
        return self.chances is not None and bool(self.chances.falls)

    def jump(self) -> None:
        """Show the moment at which the fall began; from there, the one at which the next began."""
        if self.chances is None or not self.chances.falls:
            return
        places = [fall.begins for fall in self.chances.falls]
        here = self.fall
        if here is not None and self._replay.at != here.begins:
            self._on_seek(here.begins)
        else:
            self._on_seek(next((place for place in places if place > self._replay.at), places[0]))

    # The picture

    def draw(self, canvas: Canvas) -> None:
        """Draw the lane, and the sentence where it leads nowhere."""
        canvas = canvas.at(*self._form.anchor)
        left, top = self._place
        if self.words and not self._buttons:
            canvas.text(self.words, (left, top + 13), size=SMALL, colour=MUTE)
        if self.chances is None:
            return
        box = self._timeline.box
        start, width = self._timeline.track
        y = box.bottom - HEIGHT
        shows = len(self.chances.chances), self.chances.complete
        self._lane.draw(canvas, (start, y - 2, width, HEIGHT), shows, self._paint_lane)
        now, name = self.chances.at(self._replay.at), texts.FALLS_LANE
        taken = 0.0 if now is None else canvas.text_width(of_hundred(now), size=LABEL, tabular=True) + 6
        if box.left + canvas.text_width(name, size=LABEL - 1) + taken <= start - 10:  # large figures need all the room
            canvas.text(name, (box.left, y + 13), size=LABEL - 1, colour=MUTE)
        if now is not None:
            canvas.dot((self._timeline.place(self._replay.at), y + _down(now)), 3.0, INK)
            figure = (start - 10, y + 13)
            canvas.text(of_hundred(now), figure, size=LABEL, colour=INK, align="right", tabular=True)
        lane = (box.left, y - _SLACK, box.width, HEIGHT)
        canvas.explain(lane, texts.EXPLAIN_FALLS, lambda: "" if now is None else _now_words(now))

    def _paint_lane(self, sheet: Canvas) -> None:
        """Draw the falls as bands, and the chance as a line over them, on a sheet of the lane."""
        assert self.chances is not None
        width, scale = sheet.size[0] / sheet.scale, sheet.scale

        def across(step: float) -> float:
            return width * min(step / self._timeline.length, 1.0)

        sheet.line((0, 2 + _down(0.0)), (width, 2 + _down(0.0)), LINE)
        for fall in self.chances.falls:
            x, end = across(fall.begins), across(fall.ends)
            band = sheet.rect(x, 2, max(end - x, 2.0), _down(0.0))
            sheet.surface.fill((*sheet.palette.warn, 56), band)
            sheet.marker("triangle_down", (max(x, 4.0), 4), 7, sheet.palette.warn)
        places = [
            (across(DECISION_STEPS * number) * scale, (2 + _down(chance)) * scale)
            for number, chance in enumerate(self.chances.chances)
        ]
        if len(places) > 1:
            draw_stretch(sheet.surface, INK, places)

    def draw_way(self, canvas: Canvas, view: View, path: Doubles, head: float) -> None:
        """Mark on a path (steps, 2) where the chance fell, and from what to what."""
        if self.chances is None:
            return
        for fall in self.chances.falls:
            stretch = view.pixels(path[fall.begins : fall.ends + 1])
            if len(stretch) < 2 or stretch[:, 1].min() < head * canvas.scale:
                continue
            warn = canvas.palette.warn
            for aside in (-0.5, 0.5):
                draw_stretch(canvas.surface, warn, (stretch + aside * canvas.scale).tolist())
            x, y = view.points(path[fall.begins]).tolist()
            canvas.marker("triangle_down", (x, y - 9), 9, warn)
            high, low = told_apart(fall.high, fall.low)
            canvas.text(texts.FALL_MARK.format(before=high, after=low), (x + 10, y - 6), size=SMALL, colour=warn)


def fall_words(fall: Fall) -> str:
    """Say by what key, from when and by how much the chance fell."""
    before, after = told_apart(fall.before, fall.after)
    keys = texts.said(ACTION_NAMES[fall.action]).capitalize()
    forms = texts.FALL_HELD if fall.held else texts.FALL_MANY
    network = fall.by is StickHolder.NETWORK
    form = forms[2 if network else int(fall.action != COAST)]
    return form.format(keys=keys, seconds=fall.since * STEP, before=before, after=after)


def _never_fell(chances: Sequence[float]) -> str:
    """Say how low the chance was at most."""
    if not chances:
        return ""
    least = int(np.argmin(chances))
    seconds = least * DECISION_STEPS * STEP
    return texts.FALLS_NONE.format(least=of_hundred(chances[least]), seconds=seconds)


def _now_words(chance: float) -> str:
    return texts.EXPLAIN_RING_NOW.format(chance=of_hundred(chance))


def _down(chance: float) -> float:
    """Return how far below the lane's upper edge a chance is drawn, in points."""
    return (HEIGHT - 6.0) * (1.0 - min(max(chance, 0.0), 1.0))


def _colour(fall: Fall) -> tuple[int, int, int]:
    return HUMAN if fall.by is StickHolder.HUMAN else NET
