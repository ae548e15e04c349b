"""Where the packed program begins: the window, a command, or a process that either has started.

Who starts it by a double click sees no terminal, so what keeps it from starting is said in a window as well.
"""

from __future__ import annotations

import os
import sys
import traceback
from multiprocessing import freeze_support
from pathlib import Path
from tempfile import gettempdir
from textwrap import wrap

FAILED = 70  # the exit code: "internal software error" in sysexits.h
REPORT = "tranquility-failure.txt"
_SHOWN = 600  # tenths of a second


def start() -> int:
    """Run the program. Return its exit code; a failure is told in one sentence, and kept in whole in a file."""
    try:
        from tranquility.__main__ import main

        return main()
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        tell(f"Tranquility could not go on: {reason}\n{_kept(traceback.format_exc())}")
        return FAILED


def tell(message: str) -> None:
    """Write a message to the terminal, and where there is none, show it in a window."""
    if sys.stderr is not None:
        print(message, file=sys.stderr, flush=True)
    if sys.stderr is None or not sys.stderr.isatty():
        _show(message)


def _show(message: str) -> None:
    """Show a small window with the message for a minute, or until a key or the mouse is pressed, if there is a screen.

    Drawn by itself: SDL's own box needs zenity or the X server's fonts, and which of them there are differs.
    """
    if sys.platform == "linux" and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        return
    if os.environ.get("SDL_VIDEODRIVER") in ("dummy", "offscreen"):
        return
    os.environ["PYGAME_HIDE_SUPPORT_PROMPT"] = "1"
    try:
        import pygame

        pygame.display.init()
        pygame.font.init()
        font = pygame.font.Font(None, 22)
        lines = [row for line in message.splitlines() for row in wrap(line, 80)]
        window = pygame.display.set_mode((720, 28 * len(lines) + 40))
        pygame.display.set_caption("Tranquility")
        closing = (pygame.QUIT, pygame.KEYDOWN, pygame.MOUSEBUTTONDOWN)
        for _ in range(_SHOWN):
            window.fill("#0e1324")
            for number, line in enumerate(lines):
                window.blit(font.render(line, True, "white"), (24, 24 + 28 * number))
            pygame.display.flip()
            if any(event.type in closing for event in pygame.event.get()):
                break
            pygame.time.wait(100)
        pygame.display.quit()
    except Exception as error:  # it is the last that can be tried
        print(f"No window can be opened to say so: {error}", file=sys.stderr)


def _kept(trace: str) -> str:
    """Write a traceback to the first folder that takes it. Return where it is, or the traceback itself."""
    for folder in (Path.home(), Path(gettempdir())):
        try:
            (folder / REPORT).write_text(trace, encoding="utf-8")
        except OSError:
            continue
        return f"The details are in {folder / REPORT}."
    return trace


if __name__ == "__main__":
    freeze_support()  # a packaged program is its own interpreter, also for the processes it starts
    sys.exit(start())
