"""Your flights: help, pads, start and hands of the next flights; all else stands under More."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pygame

from game.core import texts
from game.core.scene import Pop, Scene
from game.core.settings import GRAVITY_SHARES, PACES, TOP_RUNG, Settings
from game.drawing.shapes import Shape
from game.drawing.tokens import FAINT, INK, LABEL, MUTE
from game.flight import fading
from game.flight.demonstrations import count_demonstrations
from game.flight.handicap import HANDS
from game.flight.logbook import RECENT_OWN
from game.flight.skill import Skill, said
from game.input.controls import Command
from game.panels.becoming_band import draw_curve
from game.scenes.play.cockpit import MODES
from game.scenes.play.help_words import GUARDIAN, HELP, OTHER, choose, means, word_of
from game.ui.actions import Action, Table
from game.ui.panel_scene import PanelScene
from game.ui.still_picture import StillPicture

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas, Point
    from game.ui.context import Context
    from game.ui.panel import Column, Panel

_LEAST: Final = 360.0  # points of a column
_CHART: Final = 190.0  # points of the chart's height, with its figures
_SHOWN: Final = 60  # latest flights on the chart
_ENOUGH: Final = 10  # flights from which on the chart is shown


class ChoicesScene(PanelScene):
    """Choices over a flight. Each is saved the moment it is made; Escape goes back.

    A challenge fixes most of them, so it offers fewer; `help` are the settings that its own choice of help changes,
    and `curve` is whether the player's skill has a curve for flights like the one below.
    """

    def __init__(
        self,
        context: Context,
        below: Scene,
        skill: Skill,
        *,
        begun: bool,
        challenge: bool = False,
        curve: bool = True,
        helped: Settings | None = None,
    ) -> None:
        super().__init__(context)
        self._skill, self._begun, self._challenge = skill, begun, challenge
        self._helped = helped or context.settings
        flights = sum(map(len, skill.becoming.flights.values()))
        self._curve = curve and flights >= _ENOUGH
        self._behind = StillPicture(getattr(below, "bare", below), dimmed=0.7)
        self._taught = count_demonstrations(context.user_dir)
        self.build()

    def describe(self, panel: Panel) -> None:
        """Add the four choices, and what stands under More."""
        settings = self.context.settings
        panel.title(texts.CHOICES_TITLE)
        if self._begun and not self._challenge:
            panel.aside(texts.CHOICES_LATER)
        panel.gap(8)
        more = settings.more_flights
        left, right = panel.beside((1, 1), _LEAST) if more or self._curve else (panel.beside((1,), _LEAST)[0], None)
        self._describe_help(left)
        if not self._challenge:
            self._describe_starts(left)
        left.button(texts.CHOICES_LESS if more else texts.CHOICES_MORE, self._switch_more, colour=INK)
        if right is None:
            return
        if self._curve:
            right.picture(_CHART, self._draw_skill)
            right.aside(said(self._skill.becoming.estimate(self._kind)))
            for words, figure in self._figures():
                right.pair(words, figure, MUTE)
            right.gap(8)
        if more:
            self._describe_more(left, right)

    def _describe_help(self, column: Column) -> None:
        """Add the three words of help, and a fourth where the dial is elsewhere."""
        helped, now = self._helped, word_of(self._helped)
        words = [*HELP, *([OTHER] if now == OTHER else [])]
        labels = [texts.HELP.get(word, texts.CHOICES_MORE) for word in words]
        column.choice(texts.CHOICES_HELP, labels, words.index(now), lambda index: self._choose_help(words[index]))
        column.aside(lambda: means(helped))

    def _choose_help(self, word: str) -> None:
        if word != OTHER:
            choose(self._helped, word)
        self._follow_hand()

    def _follow_hand(self) -> None:
        """Save the help that was chosen by hand; it no longer fades."""
        if self._helped is self.context.settings:
            fading.follow_hand(self.context.settings)
        self.context.apply_settings()
        self.build()

    def _describe_starts(self, column: Column) -> None:
        settings, hands = self.context.settings, list(HANDS)
        column.choice(
            texts.CHOICES_PADS, texts.CHOICES_PADS_WORDS, int(settings.three_pads),
            lambda index: self._set("three_pads", bool(index)),
        )  # fmt: skip
        column.slider(
            texts.CHOICES_LADDER, max(0.0, settings.rung), (0.0, float(TOP_RUNG)),
            lambda rung: self._set("rung", round(rung)), step=1.0, figure=_rung, aside=texts.CHOICES_LADDER_HELP,
        )  # fmt: skip
        column.choice(
            texts.CHOICES_HANDS, [texts.CHOICES_HANDS_WORDS[name] for name in hands],
            hands.index(settings.hands) if settings.hands in hands else 0,
            lambda index: self._set("hands", hands[index]),
        )  # fmt: skip
        column.aside(lambda: texts.CHOICES_HANDS_HELP.get(settings.hands, ""))

    def _describe_more(self, left: Column, right: Column) -> None:
        """Add all else: the fine dial and its rule, gravity, time, and what follows from flights."""
        helped, settings = self._helped, self.context.settings
        words = HELP if helped.copilot == GUARDIAN else ["off"]
        ticks = {HELP[word]: texts.HELP[word] for word in words}
        left.slider(texts.CHOICES_ASSIST, helped.assist, (0.0, 1.0), self._turn, step=0.1, figure=_percent, ticks=ticks)
        index = MODES.index(helped.copilot) if helped.copilot in MODES else 0
        left.choice(texts.CHOICES_MODE, texts.CHOICES_MODES, index, self._choose_mode)
        left.aside(lambda: texts.CHOICES_MODES_HELP[MODES.index(helped.copilot)])
        if not self._challenge:
            left.slider(
                texts.CHOICES_GRAVITY, settings.gravity, GRAVITY_SHARES,
                lambda share: self._set("gravity", round(share, 2)), step=0.1, figure=_percent,
                aside=texts.CHOICES_GRAVITY_HELP,
            )  # fmt: skip
        right.slider(
            texts.PACE, settings.pace, PACES, lambda pace: self._set("pace", round(pace, 2)), step=0.1,
            figure=_percent, aside=texts.CHOICES_PACE_HELP,
        )  # fmt: skip
        key = pygame.key.name(pygame.K_F1).upper()
        self._toggle(right, "show_thinking", texts.SHOW_THINKING, texts.SHOW_THINKING_HELP.format(key=key))
        if not self._challenge:
            self._toggle(right, "teach", *texts.CHOICES_TEACH)
            right.toggle(texts.FADE_CHOICE[0], settings.fade, self._switch_fading, texts.FADE_CHOICE[1])
            self._toggle(right, "check_flights", *texts.CHOICES_CHECK)

    def _turn(self, assist: float) -> None:
        self._helped.assist = round(assist, 2)
        if self._helped is self.context.settings:
            fading.follow_hand(self.context.settings)
        self.context.apply_settings()

    def _choose_mode(self, index: int) -> None:
        self._helped.copilot = MODES[index]
        self._follow_hand()

    def _switch_more(self) -> None:
        self._set("more_flights", not self.context.settings.more_flights)
        self.build()

    def _switch_fading(self, on: bool) -> None:
        fading.switch(self.context.settings, on=on)
        self.context.apply_settings()

    def _toggle(self, column: Column, name: str, label: str, aside: str) -> None:
        column.toggle(label, getattr(self.context.settings, name), lambda on: self._set(name, on), aside)

    def _set(self, name: str, value: object) -> None:
        setattr(self.context.settings, name, value)
        self.context.apply_settings()

    def actions(self) -> Table:
        """Change a choice, or go back; the key that opened this scene closes it too."""
        return [self.form.changes, self.form.goes_back(texts.HINT_BACK), Action(Command.CHOICES, Pop)]

    def draw_behind(self, canvas: Canvas, alpha: float) -> None:
        """Draw the blurred flight below."""
        self._behind.draw(canvas)

    @property
    def _kind(self) -> str:
        """Kind of start of the flight below, or of the next one, one of `game.flight.becoming.KINDS`."""
        if self._challenge:
            return "missions"
        settings = self.context.settings
        return "hills" if settings.three_pads else "ladder" if settings.rung < TOP_RUNG else "plain"

    def _figures(self) -> list[tuple[str, str]]:
        """Return figures of the player's flights with their words."""
        own = self._skill.own[-RECENT_OWN:]
        rows = [(texts.SKILL_BEST, self._skill.best), (texts.SKILL_TAUGHT, self._taught)]
        found = [(words, str(value)) for words, value in rows if value]
        return [(texts.SKILL_FIGURE.format(count=len(own)), str(sum(own))), *found] if own else found

    def _draw_skill(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw how often the player would land alone, for the kind of start that is chosen."""
        kind, becoming = self._kind, self._skill.becoming
        canvas.text(
            f"{texts.BECOMING_TITLE} · {texts.BECOMING_KINDS[kind].upper()}",
            (box.left, box.top + LABEL), size=LABEL, colour=MUTE, weight="medium", room=box.width,
        )  # fmt: skip
        area = pygame.FRect(box.left, box.top + 28, box.width - 28, box.height - 56)
        for share in (0.0, 0.5, 1.0):
            y = area.bottom - area.height * share
            canvas.line((area.left, y), (area.right, y), FAINT, alpha=0.7)
            canvas.text(str(round(10 * share)), (area.right + 10, y + 4), size=LABEL, colour=MUTE)
        curve = becoming.curves[kind][-_SHOWN:]
        step = area.width / max(20, len(curve))

        def place(number: float, share: float) -> Point:
            return area.left + step * (number - 0.5), area.bottom - area.height * share

        if not curve:
            return
        draw_curve(canvas, curve, place)
        for number, entry in enumerate(becoming.flights[kind][-_SHOWN:], 1):
            if entry.alone:
                good = canvas.palette.good if entry.landed else canvas.palette.warn
                mark: Shape = "check" if entry.landed else "cross"
                canvas.marker(mark, (place(number, 0.0)[0], area.bottom + 16), 7, good)


def _rung(rung: float) -> str:
    return texts.CHOICES_RUNG.format(number=round(rung) + 1) if rung < TOP_RUNG else texts.CHOICES_TOP


def _percent(share: float) -> str:
    return texts.SOUND_SHARE.format(percent=round(100 * share))
