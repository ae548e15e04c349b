"""What scenes need first is loaded and read while the menu is seen: their modules, digit networks and test images."""

from __future__ import annotations

import gc
import logging
from importlib import import_module
from threading import Thread
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from game.ui.context import Context

_log = logging.getLogger("tranquility")


def begin(context: Context) -> None:
    """Load and read it in a thread: the first scene of its kind would take a tenth of a second for it."""
    Thread(target=_load, args=(context,), name="ahead", daemon=True).start()


def _load(context: Context) -> None:
    try:
        load(context)
    except Exception:  # the scene that needs it will meet the fault again, and tell of it
        _log.exception("loading ahead")


def load(context: Context) -> None:
    """Load and read it at once."""
    from game.digits.kept import read_ahead
    from game.scenes import ROUTES
    from game.scenes.learn.path import PATH, chapter_type

    for place in ROUTES.values():
        import_module(f"game.scenes.{place.rpartition('.')[0]}")
    for key in PATH:
        chapter_type(key)
    gc.freeze()  # modules live as long as the game
    read_ahead(context.models_dir, context.assets_dir)
