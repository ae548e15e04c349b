"""Opens the game in a window."""

from __future__ import annotations

import os
import sys
from pathlib import Path

os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")

from game import texts
from game.app import App, NoDisplayError, log_to
from game.assets import user_dir
from game.context import Context
from game.settings import SettingsFile


def play(folder: Path | None = None, full_screen: bool | None = None) -> int:
    """Open the window on the menu and play until it is closed. Returns the exit code.

    Args:
        folder: the player's folder, in place of the system's own choice.
        full_screen: overrides the setting.

    """
    folder = folder or user_dir()
    log_to(folder)
    file = SettingsFile(folder)
    context = Context(folder, file.load())
    if full_screen is not None:
        context.settings.full_screen = full_screen
    try:
        app = App(context)
    except NoDisplayError as error:
        print(texts.NO_DISPLAY.format(reason=error), file=sys.stderr)
        return 2
    if file.problem:
        context.note(file.problem)
    return app.run()
