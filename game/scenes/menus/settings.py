"""Settings: four groups, one at a time; each setting takes effect, and is saved, the moment it is changed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Final

from game.audio.instruments import GROUPS, altitude_key
from game.core import catalogue, texts
from game.core.names import LibraryError
from game.core.scene import Push, Transition, push
from game.core.settings import PACES
from game.drawing.tokens import INK, TEXT_SIZES
from game.flight.progress import Progress
from game.input.controls import Command, Held
from game.scenes.menus.colours import HEIGHT, draw_scene
from game.scenes.menus.dialogs import QuestionDialog
from game.ui.actions import Table
from game.ui.panel_scene import PanelScene

if TYPE_CHECKING:
    from game.drawing.cursor import Cursor
    from game.ui.context import Context
    from game.ui.panel import Column, Panel
    from game.ui.rows import SliderRow, ToggleRow

GROUPS_OF_SETTINGS: Final = ("picture", "sound", "controls", "flights")
_VOLUMES: Final = ("master", *GROUPS)
# Sample sound played when a volume is changed, besides the slider's click and sounds that play anyway.
_SAMPLES: Final = {"effects": "touchdown", "altitude": altitude_key(9)}
_LEAST: Final = 380.0  # points of a column


class SettingsScene(PanelScene):
    """Settings of one group, below the names of all groups.

    Attributes:
        group: the group that is shown, of `GROUPS_OF_SETTINGS`.

    """

    def __init__(self, context: Context, group: str = "picture") -> None:
        super().__init__(context)
        self.group = group
        self._progress = Progress(context.user_dir, context.settings)
        self.build()

    def enter(self) -> None:
        """Name the keys anew, for the player may have changed them."""
        self.build()

    def describe(self, panel: Panel) -> None:
        """Add the names of the groups, and the settings of one."""
        panel.title(texts.SETTINGS_TITLE)
        panel.gap(8)
        words = [texts.SETTINGS_GROUPS[name] for name in GROUPS_OF_SETTINGS]
        panel.choice("", words, GROUPS_OF_SETTINGS.index(self.group), self._show, size=18.0)
        panel.gap(4)
        panel.line()
        panel.gap(12)
        left, right = panel.beside((1, 1), _LEAST)
        {
            "picture": self._describe_picture, "sound": self._describe_sound, "controls": self._describe_controls,
            "flights": self._describe_flights,
        }[self.group](left, right)  # fmt: skip

    def update(self) -> Transition | None:
        """Animate the widgets, and follow what keys have changed."""
        for name in ("full_screen", "muted"):
            if widget := self._switches.get(name):
                widget.value = getattr(self.context.settings, name)
        return super().update()

    def actions(self) -> Table:
        """Change a setting, or go back."""
        return [self.form.changes, self.form.goes_back(texts.HINT_BACK)]

    def _show(self, number: int) -> None:
        """Show another group."""
        self.group = GROUPS_OF_SETTINGS[number]
        self.build()

    # The groups

    def _describe_picture(self, left: Column, right: Column) -> None:
        settings = self.context.settings
        self._toggle(left, "full_screen")
        sizes = list(TEXT_SIZES)
        index = sizes.index(settings.text_size) if settings.text_size in sizes else 0
        left.choice(
            texts.TEXT_SIZE, [texts.TEXT_SIZES[name] for name in sizes], index,
            lambda number: self._set("text_size", sizes[number]),
        )  # fmt: skip
        names = catalogue.languages(catalogue.LOCALE)
        codes = list(names)
        spoken, choose = codes.index(texts.LANGUAGE), lambda number: self._set("language", codes[number])
        left.choice(texts.LANGUAGE_CHOICE, list(names.values()), spoken, choose)
        self._toggle(left, "reduced_motion")
        self._toggle(left, "show_hints")
        self._toggle(right, "colour_safe")
        right.gap(6)
        right.picture(HEIGHT, draw_scene)

    def _describe_sound(self, left: Column, right: Column) -> None:
        sound = self.context.sound
        self._toggle(left, "muted")
        if sound.problem:
            left.add(self._write_problem)
        for number, group in enumerate(_VOLUMES):
            self._volume(left if number < 3 else right, group)

    def _describe_controls(self, left: Column, right: Column) -> None:
        left.button(texts.BINDINGS_OPEN, lambda: push("bindings"), texts.BINDINGS_LINE, colour=INK)
        self._toggle(left, "analogue")
        left.aside(lambda: texts.ASSISTS_FINE.format(key=self.context.controls.word(Held.FINE)))
        self._toggle(right, "toggle_thrust")
        self._toggle(right, "one_switch")

    def _describe_flights(self, left: Column, right: Column) -> None:
        self._toggle(left, "wider_pads")
        self._toggle(left, "untimed")
        left.slider(texts.PACE, self.context.settings.pace, PACES,
                    lambda pace: self._set("pace", round(pace, 2)), step=0.1, figure=_percent)  # fmt: skip
        left.gap(6)
        left.aside(texts.ASSISTS_COUNTED)
        flown = texts.TUTORIAL_FLOWN if self.context.settings.first_flown else ""
        right.button(texts.TUTORIAL_OPEN, partial(push, "tutorial"), figure=flown, colour=INK)
        right.button(texts.PROGRESS_RESET, self._ask_to_reset, colour=INK)
        if self._progress.restorable:
            right.button(texts.PROGRESS_RESTORE, self._restore, colour=INK)

    def _write_problem(self, cursor: Cursor) -> None:
        """Write why nothing is heard, beside a mark."""
        if canvas := cursor.canvas:
            canvas.marker("triangle", (cursor.left + 6, cursor.y + 10), 9, canvas.palette.warn)
        words = replace(cursor, left=cursor.left + 20, width=cursor.width - 20)
        words.text(texts.SOUND_PROBLEM)
        cursor.y = words.y

    # Settings

    def build(self) -> None:
        """Describe the rows anew."""
        self._switches: dict[str, ToggleRow] = {}
        super().build()

    def _toggle(self, column: Column, name: str) -> None:
        label, aside = texts.SETTINGS[name]
        controls = self.context.controls
        keys = {"full_screen": Command.FULLSCREEN, "muted": Command.MUTE}
        if name in keys:
            aside = aside.format(key=(*controls.key_names(keys[name]), texts.BINDINGS_NONE)[0])
        value = getattr(self.context.settings, name)
        self._switches[name] = column.toggle(label, value, lambda on: self._set(name, on), aside)

    def _set(self, name: str, value: object) -> None:
        setattr(self.context.settings, name, value)
        self.context.apply_settings()

    def _volume(self, column: Column, group: str) -> SliderRow:
        context, name = self.context, f"{group}_volume"

        def change(value: float) -> None:
            self._set(name, value)
            if group in _SAMPLES:
                context.sound.play(_SAMPLES[group])

        aside = texts.SOUND_ALTITUDE if group == "altitude" else ""
        label, value = texts.SOUND_GROUPS[group], getattr(context.settings, name)
        return column.slider(label, value, (0.0, 1.0), change, step=0.1, figure=_loudness, aside=aside)

    # Progress

    def _ask_to_reset(self) -> Transition:
        """Ask before all progress is put away, and say what that is."""
        told = self._progress.told
        more = " ".join([
            texts.PROGRESS_FLIGHTS.format(count=told.flights), texts.PROGRESS_MEDALS.format(count=told.medals),
            texts.PROGRESS_CHAPTERS.format(count=told.chapters), texts.PROGRESS_STAYS,
        ])  # fmt: skip
        answers: list[tuple[str, Callable[[], None]]] = [
            (texts.PROGRESS_NO, lambda: None), (texts.PROGRESS_YES, self._reset),
        ]  # fmt: skip
        return Push(QuestionDialog(self, texts.PROGRESS_QUESTION, more, answers))

    def _reset(self) -> None:
        self._attempt(self._progress.reset, texts.PROGRESS_GONE)

    def _restore(self) -> None:
        self._attempt(self._progress.restore, texts.PROGRESS_BACK)
        self.build()

    def _attempt(self, change: Callable[[], None], done: str) -> None:
        """Reset or restore progress, save the settings, and say what came of it."""
        try:
            change()
        except LibraryError as error:
            self.context.note(str(error))
        else:
            self.context.apply_settings()
            self.context.note(done)


def _percent(share: float) -> str:
    return texts.SOUND_SHARE.format(percent=round(100 * share))


def _loudness(volume: float) -> str:
    return _percent(volume) if volume else texts.SOUND_OFF
