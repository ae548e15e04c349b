"""Settings scene: each setting takes effect, and is saved, the moment it is changed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import pygame

from game.audio.instruments import GROUPS, altitude_key
from game.core import texts
from game.core.names import LibraryError
from game.core.scene import Pop, Push, Transition, push
from game.drawing.canvas import Canvas
from game.drawing.sky import NightSky
from game.drawing.tokens import INK, LABEL, LINE, MARGIN, MUTE, SMALL, TEXT, TEXT_SIZES, VIEW_SIZE
from game.input.controls import Command, Held, names
from game.play.progress import Progress
from game.scenes.dialog import QuestionDialog
from game.ui.actions import Table
from game.ui.context import Context
from game.ui.form import Form
from game.ui.form_scene import FormScene
from game.ui.widget import OnPress
from game.ui.widgets import Choice, Slider, TextButton, Toggle

ROWS: Final = ("full_screen", "reduced_motion", "colour_safe", "show_hints")
_WIDTH: Final = 416
_FIRST_ROW: Final = 124
_ROW: Final = 56
_TEXT: Final = _FIRST_ROW + len(ROWS) * _ROW
_SOUND: Final = 414  # top of the first row on sound
_SOUND_ROW: Final = 31
_VOLUMES: Final = ("master", *GROUPS)
_BACK: Final = 624
# Sample sound played when a volume is changed, besides the slider's click and sounds that play anyway.
_SAMPLES: Final = {"effects": "touchdown", "altitude": altitude_key(9)}
_KEYS_LEFT: Final = 704
_KEYS_ROW: Final = 31
_KEYS_WORD: Final = 500
_KEYS: Final = (
    Held.MAIN, Held.LEFT, Held.RIGHT, Held.FINE, Command.HANDOVER, Command.RETRY, Command.PAUSE, Command.CHOICES,
    Command.FULLSCREEN, Command.SCREENSHOT, Command.MUTE,
)  # fmt: skip


class SettingsScene(FormScene):
    """Toggles and volumes on the left, the keys on the right."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._sky = NightSky(context.rng, ember=0.5, stars=70)
        self._progress = Progress(context.user_dir, context.settings)
        self._build()

    def enter(self) -> None:
        """Name the keys anew, for the player may have changed them."""
        self._build()

    def _build(self) -> None:
        """Build a toggle for every row, and a slider for every volume."""
        context = self.context
        self.form = Form(context, on_back=Pop)
        for number, name in enumerate(ROWS):
            box = (MARGIN, _FIRST_ROW + number * _ROW, _WIDTH, 56)
            label, hint = texts.SETTINGS[name]
            hint = hint.format(key=(*context.controls.key_names(Command.FULLSCREEN), texts.BINDINGS_NONE)[0])
            value = getattr(context.settings, name)
            self.form.add(Toggle(self.form.manager, box, label, value, self._changes(name), hint=hint))
        sizes, size = list(TEXT_SIZES), context.settings.text_size
        words = [texts.TEXT_SIZES[name] for name in sizes]
        self.form.add(Choice(
            self.form.manager, (MARGIN, _TEXT, _WIDTH, 36), texts.TEXT_SIZE, words,
            sizes.index(size) if size in sizes else 0, lambda index: self._set("text_size", sizes[index]),
            label_width=142,
        ))  # fmt: skip
        key = (*context.controls.key_names(Command.MUTE), texts.BINDINGS_NONE)[0]
        mute = Toggle(self.form.manager, (MARGIN, _SOUND, _WIDTH, 28), texts.SOUND_MUTE.format(key=key),
                      context.settings.muted, self._changes("muted"))  # fmt: skip
        self._mute = self.form.add(mute)
        for number, group in enumerate(_VOLUMES, 1):
            self.form.add(self._volume(group, (MARGIN, _SOUND + number * _SOUND_ROW, _WIDTH, 28)))
        self.form.add(TextButton(self.form.manager, (MARGIN, _BACK, 96, 32), texts.BACK, Pop, size=18))
        links: list[tuple[str, OnPress]] = [
            (texts.BINDINGS_OPEN, _open_bindings), (texts.ASSISTS_OPEN, _open_assists),
            (texts.TUTORIAL_OPEN, _fly_first_flight), (texts.PROGRESS_RESET, self._ask_to_reset),
        ]  # fmt: skip
        if self._progress.restorable:
            links.append((texts.PROGRESS_RESTORE, self._restore))
        for number, (label, press) in enumerate(links):
            box = (_KEYS_LEFT, _KEYS_WORD + number * _KEYS_ROW, 280, 28)
            self.form.add(TextButton(self.form.manager, box, label, press, size=TEXT + 1))

    def update(self) -> Transition | None:
        """Animate the widgets, and reflect changes by F10 and F11."""
        for name, toggle in zip(ROWS, self.form.widgets, strict=False):
            assert isinstance(toggle, Toggle)
            toggle.value = getattr(self.context.settings, name)
        self._mute.value = self.context.settings.muted
        return self.form.update()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the toggles, what the colours look like, and the keys."""
        self._sky.draw(canvas)
        canvas.text(texts.SETTINGS_TITLE, (MARGIN, 88), size=34, weight="light")
        self.form.draw(canvas)
        self._draw_swatches(canvas, _FIRST_ROW + ROWS.index("colour_safe") * _ROW + 28)
        self._draw_sound(canvas)
        self._draw_keys(canvas)
        self.draw_hints(canvas)

    def actions(self) -> Table:
        """Change a setting, or go back."""
        return [self.form.changes, self.form.goes_back(texts.HINT_BACK)]

    def _changes(self, name: str) -> Callable[[bool], None]:
        return lambda value: self._set(name, value)

    def _set(self, name: str, value: object) -> None:
        setattr(self.context.settings, name, value)
        self.context.apply_settings()

    def _volume(self, group: str, box: pygame.typing.RectLike) -> Slider:
        context, name = self.context, f"{group}_volume"

        def change(value: float) -> None:
            self._set(name, value)
            if group in _SAMPLES:
                context.sound.play(_SAMPLES[group])

        label, value = texts.SOUND_GROUPS[group], getattr(context.settings, name)
        return Slider(self.form.manager, box, label, value, (0.0, 1.0), change, step=0.1, figure=_loudness)

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
        return Push(QuestionDialog(self, texts.PROGRESS_QUESTION, more, answers, height=212))

    def _reset(self) -> None:
        self._attempt(self._progress.reset, texts.PROGRESS_GONE)

    def _restore(self) -> None:
        self._attempt(self._progress.restore, texts.PROGRESS_BACK)
        self._build()

    def _attempt(self, deed: Callable[[], None], done: str) -> None:
        """Reset or restore progress, save the settings, and say what came of it."""
        try:
            deed()
        except LibraryError as error:
            self.context.note(str(error))
        else:
            self.context.apply_settings()
            self.context.note(done)

    def _draw_sound(self, canvas: Canvas) -> None:
        title = canvas.text(texts.SOUND_TITLE, (MARGIN, _SOUND - 12), size=LABEL, weight="medium", colour=MUTE)
        if self.context.sound.problem:
            canvas.marker("triangle", (title.right + 18, _SOUND - 16), 9, canvas.palette.warn)
            canvas.text(texts.SOUND_PROBLEM, (title.right + 30, _SOUND - 12), size=SMALL, colour=canvas.palette.warn)
        below = _SOUND + (len(_VOLUMES) + 1) * _SOUND_ROW + 10
        canvas.text(texts.SOUND_ALTITUDE, (MARGIN, below), size=SMALL, colour=MUTE)

    def _draw_swatches(self, canvas: Canvas, middle: float) -> None:
        left = MARGIN + _WIDTH + 40
        good, warn = canvas.palette.good, canvas.palette.warn
        canvas.marker("check", (left + 5, middle - 13), 10, good)
        canvas.text(texts.SWATCH_GOOD, (left + 20, middle - 8), size=SMALL, colour=good)
        canvas.marker("triangle", (left + 5, middle + 12), 10, warn)
        canvas.text(texts.SWATCH_WARN, (left + 20, middle + 17), size=SMALL, colour=warn)

    def _draw_keys(self, canvas: Canvas) -> None:
        y = float(_FIRST_ROW + 12)
        pad_left = VIEW_SIZE[0] - MARGIN
        canvas.text(texts.KEYS_TITLE, (_KEYS_LEFT, y), size=LABEL, weight="medium", colour=MUTE)
        canvas.text(texts.KEYS_KEYBOARD, (_KEYS_LEFT + 192, y), size=LABEL, weight="medium", colour=MUTE)
        canvas.text(texts.KEYS_PAD, (pad_left, y), size=LABEL, weight="medium", colour=MUTE, align="right")
        canvas.cover(canvas.rect(_KEYS_LEFT, y, pad_left - _KEYS_LEFT, _KEYS_ROW * len(_KEYS)))  # no star in the table
        controls = self.context.controls
        for meaning in _KEYS:
            canvas.line((_KEYS_LEFT, y + 10), (pad_left, y + 10), LINE, 1)
            y += _KEYS_ROW
            canvas.text(texts.BINDINGS[meaning.name], (_KEYS_LEFT, y), size=TEXT - 1, colour=INK)
            canvas.text(names(controls.key_names(meaning)), (_KEYS_LEFT + 192, y), size=TEXT - 1, colour=MUTE)
            signs = names(controls.gamepad_signs(meaning)) or texts.BINDINGS_NONE
            canvas.text(signs, (pad_left, y), size=TEXT - 1, colour=MUTE, align="right")


def _open_assists() -> Transition:
    return push("assists")


def _loudness(volume: float) -> str:
    return texts.SOUND_SHARE.format(percent=round(100 * volume)) if volume else texts.SOUND_OFF


def _fly_first_flight() -> Transition:
    from game.play.tutorial import Tutorial

    return push("play", 0, challenge=Tutorial())


def _open_bindings() -> Transition:
    return push("bindings")
