"""Choices screen: options for the next flights, and a chart of the player's own skill."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import pygame

from game.cockpit.cockpit import MODES
from game.core import texts
from game.core.scene import Pop, Scene
from game.core.settings import GRAVITY_SHARES, PACES, TOP_RUNG, Settings
from game.drawing.canvas import Canvas, Point
from game.drawing.prose import draw_wrapped
from game.drawing.shapes import Shape
from game.drawing.tokens import FAINT, FIGURE, HUMAN, INK, LABEL, MARGIN, MUTE, SMALL, TITLE
from game.flight import fading
from game.flight.demonstrations import count_demonstrations
from game.flight.handicap import HANDS
from game.flight.logbook import RECENT_OWN
from game.flight.skill import Skill
from game.input.controls import Command
from game.panels.becoming_band import draw_curve
from game.play.growth import said
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.form_scene import FormScene
from game.ui.still_picture import StillPicture
from game.ui.widget import Widget
from game.ui.widgets import Choice, Slider, TextButton, Toggle

_WIDTH: Final = 560
_LABELS: Final = 142
_FIRST: Final = 136
_ROW: Final = 40
_HELP: Final = 18  # from the last row to the sentence on the one in focus
_HELP_ROOM: Final = 700  # points, for two lines
_TOGGLES: Final = 34
_TOGGLE_ROW: Final = 50
_CHART: Final = pygame.Rect(800, 152, 372, 150)
_SHOWN: Final = 60  # latest flights on the chart
_SKILL_TOGGLES: Final = 512  # below the figures


class ChoicesScene(FormScene):
    """Choices scene over a flight. Each choice is saved the moment it is made; Escape or Fly goes back.

    A challenge fixes most options, so it offers fewer choices; `curve` is whether the player's skill has a curve for
    flights like the one below.
    """

    def __init__(
        self, context: Context, below: Scene, skill: Skill, *, begun: bool, challenge: bool = False, curve: bool = True
    ) -> None:
        super().__init__(context)
        self._skill, self._begun, self._challenge, self._curve = skill, begun, challenge, curve
        self._behind = StillPicture(below, dimmed=0.7)
        self._taught = count_demonstrations(context.user_dir)
        form = self.form
        self._rows: dict[Widget, Callable[[], str]] = {}
        if not self._challenge:
            self._add_help()
            self._add_starts()
            self._add_slider("gravity", GRAVITY_SHARES, texts.CHOICES_GRAVITY, lambda: texts.CHOICES_GRAVITY_HELP)
        self._add_slider("pace", PACES, texts.PACE, lambda: texts.CHOICES_PACE_HELP)
        toggles = {
            "teach": texts.CHOICES_TEACH,
            "explain": texts.CHOICES_EXPLAIN,
        }
        if self._challenge:
            del toggles["teach"]
        top = _FIRST + len(self._rows) * _ROW + _TOGGLES
        for row, (name, (label, hint)) in enumerate(toggles.items()):
            box = (MARGIN, top + row * _TOGGLE_ROW, _WIDTH, 48)
            value = getattr(context.settings, name)
            form.add(Toggle(form.manager, box, label, value, self._changes(name), hint=hint))
        if not self._challenge:
            self._add_skill_toggles()
        form.add(TextButton(form.manager, (MARGIN, 624, 96, 32), texts.CHOICES_FLY, Pop, size=18))

    def _add_help(self) -> None:
        """Add the rows for how much the network helps, and when."""
        settings = self.context.settings
        word = self.context.controls.word
        keys = {"less": word(Command.SLOWER), "more": word(Command.FASTER)}
        self._add_slider(
            "assist",
            (0.0, 1.0),
            texts.CHOICES_ASSIST,
            lambda: texts.CHOICES_ASSIST_HELP[_helped(settings)].format(**keys),
        )
        self._choice(
            texts.CHOICES_MODE,
            texts.CHOICES_MODES,
            _index(MODES, settings.copilot),
            lambda index: self._changes("copilot")(MODES[index]),
            lambda: texts.CHOICES_MODES_HELP[_index(MODES, settings.copilot)],
        )

    def _add_skill_toggles(self) -> None:
        """Add the switches for what follows the player's skill, below its chart."""
        settings, form = self.context.settings, self.form
        resting = settings.fade and not fading.active(settings)
        label, hint = texts.FADE_CHOICE
        hint = texts.FADE_RESTING if resting else hint
        box = pygame.Rect(_CHART.left, _SKILL_TOGGLES, _CHART.width, 48)
        form.add(Toggle(form.manager, box, label, settings.fade, self._switch_fading, hint=hint))
        label, hint = texts.CHOICES_CHECK
        box = box.move(0, _TOGGLE_ROW)
        value = settings.check_flights
        form.add(Toggle(form.manager, box, label, value, self._changes("check_flights"), hint=hint))

    def _switch_fading(self, on: bool) -> None:
        fading.switch(self.context.settings, on=on)
        self.context.apply_settings()

    def _add_starts(self) -> None:
        """Add the rows for the next flight's pads, the handicap on its keys, and its start."""
        settings, hands = self.context.settings, list(HANDS)
        self._choice(
            texts.CHOICES_PADS,
            texts.CHOICES_PADS_WORDS,
            int(settings.three_pads),
            lambda index: self._changes("three_pads")(bool(index)),
            lambda: texts.CHOICES_PADS_HELP[settings.three_pads],
        )
        words = [texts.CHOICES_HANDS_WORDS[name] for name in hands]
        self._choice(
            texts.CHOICES_HANDS,
            words,
            _index(hands, settings.hands),
            lambda index: self._changes("hands")(hands[index]),
            lambda: texts.CHOICES_HANDS_HELP.get(settings.hands, ""),
        )
        change, limits = self._changes("rung"), (0.0, float(TOP_RUNG))
        slider = Slider(
            self.form.manager, self._box, texts.CHOICES_LADDER, max(0.0, settings.rung), limits,
            lambda rung: change(round(rung)), step=1.0, figure=_rung,
        )  # fmt: skip
        self._rows[self.form.add(slider)] = lambda: texts.CHOICES_LADDER_HELP

    def actions(self) -> Table:
        """Change a choice, or go back; the key that opened this scene closes it too."""
        return [self.form.changes, self.form.goes_back(texts.HINT_BACK), Action(Command.CHOICES, Pop)]

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the blurred flight below, the rows and the skill chart."""
        self._behind.draw(canvas)
        canvas.text(texts.CHOICES_TITLE, (MARGIN, 96), size=34, weight="light")
        self.form.draw(canvas)
        if self.form.focused in self._rows:
            y = _FIRST + len(self._rows) * _ROW + _HELP
            draw_wrapped(canvas, self._rows[self.form.focused](), (MARGIN, y), _HELP_ROOM, colour=MUTE, leading=17)
        if self._begun and not self._challenge:
            canvas.text(texts.CHOICES_LATER, (MARGIN + 112, 645), size=SMALL, colour=MUTE)
        if self._curve:
            self._draw_skill(canvas)
        self.draw_hints(canvas)

    @property
    def _kind(self) -> str:
        """Kind of start of the flight below, or of the next one, one of `game.flight.becoming.KINDS`."""
        if self._challenge:
            return "missions"
        settings = self.context.settings
        return "hills" if settings.three_pads else "ladder" if settings.rung < TOP_RUNG else "plain"

    @property
    def _box(self) -> tuple[int, int, int, int]:
        """Box of the next row."""
        return MARGIN, _FIRST + len(self._rows) * _ROW, _WIDTH, _ROW - 6

    def _add_slider(self, name: str, limits: tuple[float, float], label: str, help_: Callable[[], str]) -> None:
        form, value = self.form, getattr(self.context.settings, name)
        slider = Slider(form.manager, self._box, label, value, limits, self._changes(name), step=0.1, figure=_percent)
        self._rows[form.add(slider)] = help_

    def _choice(self, label: str, words: tuple[str, ...] | list[str], index: int,
                change: Callable[[int], None], help_: Callable[[], str]) -> None:  # fmt: skip
        form = self.form
        choice = Choice(form.manager, self._box, label, words, index, change, label_width=_LABELS, size=14)
        self._rows[form.add(choice)] = help_

    def _changes(self, name: str) -> Callable[[object], None]:
        def change(value: object) -> None:
            setattr(self.context.settings, name, round(value, 2) if isinstance(value, float) else value)
            self.context.apply_settings()

        return change

    def _draw_skill(self, canvas: Canvas) -> None:
        """Draw how often the player would land alone, for the kind of start that is chosen."""
        left, top, width, height = _CHART
        kind, becoming = self._kind, self._skill.becoming
        canvas.text(
            f"{texts.BECOMING_TITLE} · {texts.BECOMING_KINDS[kind].upper()}",
            (left, top - 24), size=LABEL, colour=MUTE, weight="medium", room=width + 40,
        )  # fmt: skip
        for share in (0.0, 0.5, 1.0):
            y = top + height * (1 - share)
            canvas.line((left, y), (left + width, y), FAINT, alpha=0.7)
            canvas.text(str(round(10 * share)), (left + width + 12, y + 4), size=LABEL, colour=MUTE)
        curve = becoming.curves[kind][-_SHOWN:]
        step = width / max(20, len(curve))

        def place(number: float, share: float) -> Point:
            return left + step * (number - 0.5), top + height * (1 - share)

        if curve:
            draw_curve(canvas, curve, place)
            for number, entry in enumerate(becoming.flights[kind][-_SHOWN:], 1):
                if entry.alone:
                    good = canvas.palette.good if entry.landed else canvas.palette.warn
                    mark: Shape = "check" if entry.landed else "cross"
                    canvas.marker(mark, (place(number, 0.0)[0], top + height + 16), 7, good)
            line = said(becoming.estimate(kind))
        else:
            line = texts.BECOMING_NONE
        draw_wrapped(canvas, line, (left, top + height + 44), width, colour=INK if curve else MUTE, most=2)
        self._draw_figures(canvas, top + height + 112)

    def _draw_figures(self, canvas: Canvas, y: float) -> None:
        left, own = _CHART.left, self._skill.own[-RECENT_OWN:]
        if own:
            figure = canvas.text(str(sum(own)), (left, y), size=FIGURE, weight="light", colour=HUMAN)
            canvas.text(texts.SKILL_FIGURE.format(count=len(own)), (figure.right + 10, y), size=SMALL, colour=MUTE)
        for row, (value, words) in enumerate(
            ((self._skill.best, texts.SKILL_BEST), (self._taught, texts.SKILL_TAUGHT))
        ):
            if value:
                figure = canvas.text(str(value), (left, y + 44 + 36 * row), size=TITLE, weight="light", colour=INK)
                canvas.text(words, (figure.right + 10, y + 44 + 36 * row), size=SMALL, colour=MUTE)


def _index(names: tuple[str, ...] | list[str], name: str) -> int:
    return names.index(name) if name in names else 0


def _helped(settings: Settings) -> int:
    """Return which help is on: 0 none, 1 a co-pilot's, 2 a guardian's."""
    return (1 + _index(MODES, settings.copilot)) * (settings.assist > 0)


def _rung(rung: float) -> str:
    return texts.CHOICES_RUNG.format(number=round(rung) + 1) if rung < TOP_RUNG else texts.CHOICES_TOP


def _percent(share: float, zero: str = texts.CHOICES_ASSIST_OFF) -> str:
    return texts.SOUND_SHARE.format(percent=round(100 * share)) if share else zero
