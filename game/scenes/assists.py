"""Assists screen: how the player's hands are read, and how much room a flight gives them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from game.core import texts
from game.core.scene import Pop
from game.core.settings import PACES
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.sky import NightSky
from game.drawing.tokens import LABEL, MARGIN, MUTE, SMALL
from game.input.controls import Held
from game.ui.actions import Table
from game.ui.context import Context
from game.ui.form_scene import FormScene
from game.ui.widgets import Slider, TextButton, Toggle

HANDS: Final = ("analogue", "toggle_thrust", "one_switch")
ROOM: Final = ("wider_pads", "untimed")
_WIDTH: Final = 560
_ROW: Final = 58
_HANDS: Final = 152  # top of the first row
_FINE: Final = _HANDS + len(HANDS) * _ROW + 22  # baseline of the line on turning finely
_ROOM: Final = _FINE + 58
_PACE: Final = _ROOM + len(ROOM) * _ROW + 6
_TOLD: Final = 720  # left end of what is said about the logbook
_TOLD_ROOM: Final = 440


class AssistsScene(FormScene):
    """Page of assists. Each takes effect, and is saved, the moment it is changed."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._sky = NightSky(context.rng, ember=0.4, stars=60)
        form, settings = self.form, context.settings
        for names, top in ((HANDS, _HANDS), (ROOM, _ROOM)):
            for row, name in enumerate(names):
                label, hint = texts.ASSISTS[name]
                box = (MARGIN, top + row * _ROW, _WIDTH, 52)
                form.add(Toggle(form.manager, box, label, getattr(settings, name), self._changes(name), hint=hint))
        form.add(Slider(form.manager, (MARGIN, _PACE, _WIDTH, 34), texts.PACE, settings.pace, PACES,
                        self._changes("pace"), step=0.1, figure=_percent))  # fmt: skip
        form.add(TextButton(form.manager, (MARGIN, 624, 96, 32), texts.BACK, Pop, size=18))

    def actions(self) -> Table:
        """Change an assist, or go back."""
        return [self.form.changes, self.form.goes_back(texts.HINT_BACK)]

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the assists, and what they mean for the logbook."""
        self._sky.draw(canvas)
        canvas.text(texts.ASSISTS_TITLE, (MARGIN, 88), size=34, weight="light")
        for title, top in ((texts.ASSISTS_HANDS, _HANDS), (texts.ASSISTS_ROOM, _ROOM)):
            canvas.text(title, (MARGIN, top - 14), size=LABEL, weight="medium", colour=MUTE)
        canvas.text(self._fine, (MARGIN, _FINE), size=SMALL, colour=MUTE, room=_WIDTH)
        self.form.draw(canvas)
        canvas.text(texts.ASSISTS_COUNT, (_TOLD, _HANDS - 14), size=LABEL, weight="medium", colour=MUTE)
        y = float(_HANDS + 14)
        for paragraph in texts.ASSISTS_TOLD:
            y = draw_wrapped(canvas, paragraph, (_TOLD, y), _TOLD_ROOM, leading=21) + 14
        self.draw_hints(canvas)

    @property
    def _fine(self) -> str:
        """How to turn finely, with the device in use."""
        return texts.ASSISTS_FINE.format(key=self.context.controls.word(Held.FINE))

    def _changes(self, name: str) -> Callable[[object], None]:
        def change(value: object) -> None:
            setattr(self.context.settings, name, round(value, 2) if isinstance(value, float) else value)
            self.context.apply_settings()

        return change


def _percent(pace: float) -> str:
    return texts.SOUND_SHARE.format(percent=round(100 * pace))
