"""Settings: four groups, one at a time; each setting takes effect, and is saved, the moment it is changed."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final

from game.audio.instruments import GROUPS
from game.core import catalogue, texts
from game.core.scene import Push, Transition, push
from game.core.settings import PACES
from game.core.shelf import reason
from game.drawing.cursor import Cursor
from game.drawing.tokens import INK, TEXT_SIZES
from game.flight.progress import put_away
from game.input.controls import Command
from game.scenes.menus.dialogs import QuestionDialog
from game.ui.actions import Table
from game.ui.hints import Hint
from game.ui.panel_scene import PanelScene
from game.ui.rows import percent

if TYPE_CHECKING:
    from game.ui.context import Context
    from game.ui.panel import Column, Panel

GROUPS_OF_SETTINGS: Final = ("picture", "sound", "controls", "flights")
_VOLUMES: Final = ("master", *GROUPS)
_LEAST: Final = 380.0  # points of a column


class SettingsScene(PanelScene):
    """Settings of one group, below the names of all groups.

    Attributes:
        group: the group that is shown, of `GROUPS_OF_SETTINGS`.

    """

    def __init__(self, context: Context, group: str = "picture") -> None:
        super().__init__(context)
        self.group = group
        self.build()

    def enter(self) -> None:
        """Name the keys anew, for the player may have changed them."""
        self.build()

    def describe(self, panel: Panel) -> None:
        self._keyed = self._by_key
        panel.title(texts.SETTINGS_TITLE)
        panel.gap(8)
        words = [texts.SETTINGS_GROUPS[name] for name in GROUPS_OF_SETTINGS]
        panel.choice("", words, GROUPS_OF_SETTINGS.index(self.group), self._show, size=18.0)
        panel.gap(4)
        panel.line()
        panel.gap(12)
        left, right = panel.beside((1, 1), _LEAST)
        groups = {
            "picture": self._describe_picture, "sound": self._describe_sound,
            "controls": self._describe_controls, "flights": self._describe_flights,
        }  # fmt: skip
        groups[self.group](left, right)
        panel.gap()

    def update(self) -> Transition | None:
        if self._keyed != self._by_key:
            self.build()
        return super().update()

    @property
    def _by_key(self) -> tuple[bool, bool]:
        """What a key changes here as anywhere."""
        return self.context.settings.full_screen, self.context.settings.muted

    def actions(self) -> Table:
        groups, arrows = self.form.widgets[0], self.context.controls.arrows_aside
        change = Hint(arrows, texts.HINT_CHOOSE) if self.form.focused is groups else self.form.changes
        return [change, self.form.goes_back(texts.HINT_BACK)]

    def _show(self, number: int) -> None:
        self.group = GROUPS_OF_SETTINGS[number]
        self.build()

    # The groups

    def _describe_picture(self, left: Column, right: Column) -> None:
        sizes, chosen = list(TEXT_SIZES), self.context.settings.text_size
        self._toggles(left, "full_screen")
        words, now = [texts.TEXT_SIZES[name] for name in sizes], sizes.index(chosen) if chosen in sizes else 0
        left.choice(texts.TEXT_SIZE, words, now, lambda number: self._set("text_size", sizes[number]))
        names = catalogue.languages(catalogue.LOCALE)
        codes = list(names)
        spoken, choose = codes.index(texts.LANGUAGE), lambda number: self._set("language", codes[number])
        left.choice(texts.LANGUAGE_CHOICE, list(names.values()), spoken, choose)
        self._toggles(left, "reduced_motion", "show_hints")
        self._toggles(right, "colour_safe")
        right.gap(6)
        right.add(_write_colours)

    def _describe_sound(self, left: Column, right: Column) -> None:
        self._toggles(left, "muted")
        if self.context.sound.problem:
            left.text(texts.SOUND_PROBLEM)
        for number, group in enumerate(_VOLUMES):
            column, label = left if number < 2 else right, texts.SOUND_GROUPS[group]
            value, change = getattr(self.context.settings, f"{group}_volume"), partial(self._set_volume, group)
            column.slider(label, value, (0.0, 1.0), change, step=0.1, figure=_loudness)

    def _describe_controls(self, left: Column, right: Column) -> None:
        left.button(texts.BINDINGS_OPEN, lambda: push("bindings"), texts.BINDINGS_LINE, colour=INK)
        self._toggles(left, "analogue")
        self._toggles(right, "toggle_thrust", "one_switch")

    def _describe_flights(self, left: Column, right: Column) -> None:
        settings = self.context.settings
        self._toggles(left, "wider_pads", "untimed")
        left.slider(
            texts.PACE, settings.pace, PACES, lambda pace: self._set("pace", round(pace, 2)), step=0.1, figure=percent
        )
        left.gap(6)
        left.aside(texts.ASSISTS_COUNTED)
        flown = texts.TUTORIAL_FLOWN if settings.first_flown else ""
        right.button(texts.TUTORIAL_OPEN, partial(push, "tutorial"), figure=flown, colour=INK)
        right.button(texts.PROGRESS_RESET, self._ask_to_reset, colour=INK)

    def _toggles(self, column: Column, *names: str) -> None:
        """Add switches, the words on which may name a key."""
        keys = {"full_screen": Command.FULLSCREEN, "muted": Command.MUTE}
        for name in names:
            label, aside = texts.SETTINGS[name]
            if name in keys:
                aside = aside.format(key=(*self.context.controls.key_names(keys[name]), texts.BINDINGS_NONE)[0])
            value = getattr(self.context.settings, name)
            column.toggle(label, value, partial(self._set, name), aside)

    def _set(self, name: str, value: object) -> None:
        setattr(self.context.settings, name, value)
        self.context.apply_settings()

    def _set_volume(self, group: str, value: float) -> None:
        self._set(f"{group}_volume", value)
        if group == "effects":  # of which nothing plays here otherwise
            self.context.sound.play("touchdown")

    # Progress

    def _ask_to_reset(self) -> Transition:
        answers = [(texts.PROGRESS_NO, lambda: None), (texts.PROGRESS_YES, self._reset)]
        return Push(QuestionDialog(self, texts.PROGRESS_QUESTION, texts.PROGRESS_STAYS, answers))

    def _reset(self) -> None:
        """Put all progress away, save the settings, and say where it is, or why it stays."""
        try:
            box = put_away(self.context.user_dir, self.context.settings)
        except OSError as error:
            self.context.note(texts.PROGRESS_FAILED.format(reason=reason(error)))
            return
        self.context.apply_settings()
        self.context.note(texts.PROGRESS_GONE.format(folder=box))


def _write_colours(cursor: Cursor) -> None:
    """Write a speed within limits and one beyond them in the player's colours."""
    cursor.pair(texts.SWATCH_GOOD, f"0.8 {texts.SWATCH_UNIT}", cursor.palette.good)
    cursor.pair(texts.SWATCH_WARN, f"2.6 {texts.SWATCH_UNIT}", cursor.palette.warn)


def _loudness(volume: float) -> str:
    return percent(volume) if volume else texts.SOUND_OFF
