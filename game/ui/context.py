"""What every scene is given when it enters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pygame

from game.audio.mixer import Sound
from game.core.assets import ASSETS_DIR, MODELS_DIR
from game.core.settings import Settings, SettingsFile
from game.input.controls import Controls


def _ignore(text: str) -> None:
    """Stand in for `note` until there is a window to show it."""


@dataclass
class Context:
    """The game's shared things: folders, chance, settings, controls, sound.

    Attributes:
        user_dir: the player's own folder; it may not exist yet and may not be writable.
        models_dir: the shipped networks.
        assets_dir: the shipped data.
        rng: the source of every random choice.
        note: shows a short message near the top of the window for a few seconds.
        apply_settings: makes the window and the sound follow the settings, and saves them.
        in_window: turns a rectangle in points into the window's pixels.

    """

    user_dir: Path
    settings: Settings
    models_dir: Path = MODELS_DIR
    assets_dir: Path = ASSETS_DIR
    rng: np.random.Generator = field(default_factory=np.random.default_rng)
    controls: Controls = field(default_factory=Controls)
    sound: Sound = field(default_factory=Sound)
    note: Callable[[str], None] = _ignore
    apply_settings: Callable[[], None] = lambda: None
    in_window: Callable[[pygame.typing.RectLike], pygame.Rect] = pygame.Rect

    @property
    def settings_file(self) -> SettingsFile:
        """The file the settings are kept in."""
        return SettingsFile(self.user_dir)
