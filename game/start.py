"""Start of the game in a window."""

from __future__ import annotations

import gc
import os
import sys
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from game.core.scene import Route
    from game.flight.futures import FuturesProcess

_HINTS: Final[dict[str, str]] = {
    "PYGAME_HIDE_SUPPORT_PROMPT": "1",
    "SDL_APP_NAME": "Tranquility",
    "SDL_VIDEO_X11_WMCLASS": "tranquility",
    "SDL_VIDEO_MINIMIZE_ON_FOCUS_LOSS": "0",
    "SDL_WINDOWS_DPI_AWARENESS": "permonitorv2",
    "SDL_MOUSE_FOCUS_CLICKTHROUGH": "1",
}
if sys.platform == "linux":
    # Frames are drawn by the processor. Copying one straight to the window takes less than 1 ms; by way of a
    # texture, with drivers that render in software, 6 ms.
    _HINTS["SDL_FRAMEBUFFER_ACCELERATION"] = "0"


def play(folder: Path | None = None, full_screen: bool | None = None, begin: Route | None = None) -> int:
    """Open the window on the menu and play until it is closed. Return the exit code.

    Args:
        folder: the player's folder, in place of the system's default.
        full_screen: overrides the setting.
        begin: a scene to open over the menu at once.

    """
    tell_sdl()
    from ai.cli.command_line import stoppable
    from ai.files.folder import user_dir
    from game.core import texts
    from game.core.settings import SettingsFile
    from game.drawing.paint_cache import A_FRAME, spread
    from game.scenes import ahead, scene_of
    from game.shell.app import App, log_to
    from game.shell.window import NoDisplayError
    from game.ui.context import Context

    spread(A_FRAME)
    folder = folder or user_dir()
    log_to(folder)
    file = SettingsFile(folder)
    context = Context(folder, file.load(), ahead=_ahead)
    texts.choose(context.settings.language)
    if full_screen is not None:
        context.settings.full_screen = full_screen
    try:
        app = App(context, scene_of=scene_of)
    except NoDisplayError as error:
        print(texts.NO_DISPLAY.format(reason=error), file=sys.stderr)
        return 2
    context.sound.open()
    if file.problem:
        context.note(file.problem)
    if begin is not None:
        app.show(begin)
    # Exclude objects that live as long as the game from garbage collection, which took 20 ms each time.
    gc.freeze()
    gc.set_threshold(20_000, 20, 50)
    ahead.begin(context)
    with stoppable("SIGHUP") as stop:
        return app.run(stop)


@cache
def _ahead() -> FuturesProcess:
    from game.flight.futures import FuturesProcess

    return FuturesProcess()


def tell_sdl() -> None:
    """Set SDL's hints, which are read when pygame is imported; the player's own environment takes precedence."""
    for name, value in _HINTS.items():
        os.environ.setdefault(name, value)
