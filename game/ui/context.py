"""Context: the shared services that every scene gets when it enters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pygame

from game.audio.mixer import Sound
from game.core import texts
from game.core.assets import ASSETS_DIR, MODELS_DIR
from game.core.settings import Settings, SettingsFile
from game.drawing.canvas import Canvas
from game.drawing.tokens import VIEW_SIZE
from game.input.controls import Controls

if TYPE_CHECKING:
    from ai.pilots.own import OwnPilot


def _ignore(text: str) -> None:
    """Replace `note` until there is a window to show it."""


@cache
def _page() -> Canvas:
    """Return the canvas of a page, until there is a window."""
    return Canvas(pygame.Surface(VIEW_SIZE)).reading


@dataclass
class Context:
    """Shared services of the game: folders, random numbers, settings, controls and sound.

    Attributes:
        user_dir: the player's own folder; it may not exist yet and may not be writable.
        models_dir: the shipped networks.
        assets_dir: the shipped data.
        rng: random generator for every random choice.
        note: shows a short message near the top of the window for a few seconds.
        ahead: returns the `game.flight.futures.FuturesProcess` of a guardian; None where there is none.
        apply_settings: applies the settings to the window and the sound, and saves them.
        film: the `game.export.film.Export` of a flight that goes on; None while there is none.
        pilot: the player's own file that flies, once it was chosen by name in this game.
        chapter: key of the chapter of Learn that was left last; empty once its list has chosen it.
        reading: returns the window's canvas for text that flows, whose size and scale layouts go by.

    """

    user_dir: Path
    settings: Settings
    models_dir: Path = MODELS_DIR
    assets_dir: Path = ASSETS_DIR
    rng: np.random.Generator = field(default_factory=np.random.default_rng)
    controls: Controls = field(default_factory=Controls)
    sound: Sound = field(default_factory=Sound)
    note: Callable[[str], None] = _ignore
    ahead: Callable[[], Any] = lambda: None
    apply_settings: Callable[[], None] = lambda: None
    film: Any = None
    pilot: OwnPilot | None = None
    chapter: str = ""
    reading: Callable[[], Canvas] = _page

    def unfold(self, part: str) -> None:
        """Open a part of a screen for this player from now on, or close it."""
        self.settings.unfold(part)
        self.apply_settings()

    def toggle_full_screen(self) -> None:
        """Switch between the full screen and a window."""
        self.settings.full_screen = not self.settings.full_screen
        self.apply_settings()

    def toggle_mute(self) -> None:
        """Switch all sound off or on, and say so."""
        self.settings.muted = not self.settings.muted
        self.apply_settings()
        self.note(texts.SOUND_NOW_OFF if self.settings.muted else texts.SOUND_NOW_ON)

    @property
    def settings_file(self) -> SettingsFile:
        return SettingsFile(self.user_dir)
