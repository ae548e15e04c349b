"""The real game in a real window: a screen of its own, real keys, pictures of what is seen."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

import pygame
import pytest

ROOT = Path(__file__).resolve().parents[2]
_NEEDED = ("Xvfb", "xdotool", "import")


def skip_without_a_screen() -> None:
    missing = [tool for tool in _NEEDED if shutil.which(tool) is None]
    if missing and os.environ.get("TRANQUILITY_WINDOW_TESTS") == "required":
        pytest.fail(f"these tests may not skip here, and need {', '.join(missing)}")
    if missing:
        pytest.skip(f"needs {', '.join(missing)} to open and see a real window")


@contextmanager
def screen(size: str = "1280x800x24") -> Iterator[str]:
    """A virtual screen on a free display; yields the display's name."""
    read_end, write_end = os.pipe()
    command = ["Xvfb", "-displayfd", str(write_end), "-screen", "0", size, "-nolisten", "tcp", "-noreset"]
    server = subprocess.Popen(command, pass_fds=[write_end], stderr=subprocess.DEVNULL)
    os.close(write_end)
    try:
        with os.fdopen(read_end) as number:
            yield f":{number.readline().strip()}"
    finally:
        server.terminate()
        server.wait(60)


class Window:
    """One run of the game on a display: of this checkout, or of the copy that `command` starts.

    Args:
        display: name of the display.
        user_dir: the player's folder; pictures are put beside it.
        arguments: further arguments of the checkout's command.
        command: the whole command of another copy.
        seconds: how long its window may take to open.

    """

    def __init__(
        self, display: str, user_dir: Path, *arguments: str, command: Sequence[str] = (), seconds: float = 15
    ) -> None:
        self.user_dir = user_dir
        self._environment = {
            **{k: v for k, v in os.environ.items() if not k.startswith("SDL_")},
            "DISPLAY": display,
            "SDL_VIDEODRIVER": "x11",
            "SDL_AUDIODRIVER": "dummy",
        }
        command = command or [sys.executable, str(ROOT / "main.py"), "--user-dir", str(user_dir), *arguments]
        self.process = subprocess.Popen(
            command, env=self._environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        try:
            self.id = self._find(seconds)
            self.wait_for(self.picture_is_bright, "the first picture", seconds)
        except BaseException:
            self.end()  # or its pipe would be found by another test
            raise

    def key(self, *names: str) -> None:
        """Press and let go of keys, named as xdotool does: Return, Escape, Down, F11, alt+Return."""
        for name in names:
            self._xdotool("windowfocus", "--sync", self.id, "key", name)
            time.sleep(0.06)

    def hold(self, name: str, seconds: float) -> None:
        self._xdotool("windowfocus", "--sync", self.id, "keydown", name)
        time.sleep(seconds)
        self._xdotool("keyup", name)

    def click(self, x: int, y: int) -> None:
        self._xdotool("mousemove", "--window", self.id, str(x), str(y))
        time.sleep(0.3)  # a hand is no quicker
        self._xdotool("mousedown", "1")
        time.sleep(0.1)
        self._xdotool("mouseup", "1")
        time.sleep(0.1)

    def drag(self, points: Sequence[tuple[int, int]]) -> None:
        """Draw a stroke through points, with the mouse held down."""
        for number, (x, y) in enumerate(points):
            self._xdotool("mousemove", "--window", self.id, str(x), str(y), *(("mousedown", "1") if not number else ()))
            time.sleep(0.02)
        self._xdotool("mouseup", "1")

    def resize(self, width: int, height: int) -> None:
        self._xdotool("windowsize", self.id, str(width), str(height))
        time.sleep(0.2)

    def picture(self) -> pygame.Surface:
        """What the window shows now."""
        path = self.user_dir.parent / "seen.bmp"  # ImageMagick takes seconds to pack a PNG
        subprocess.run(["import", "-window", self.id, str(path)], env=self._environment, check=True, timeout=120)
        return pygame.image.load(path)

    def picture_is_bright(self) -> bool:
        return bool((pygame.surfarray.array3d(self.picture()).min(axis=2) > 180).any())

    def close(self) -> int:
        """Close the game from outside, and return the exit code.

        SDL turns this signal into the event that the window's close button makes; without a window
        manager there is no button.
        """
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(60)

    def interrupt(self) -> int:
        """Send what Ctrl-C sends, and return the exit code."""
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(60)

    def end(self) -> None:
        """End the process by force if it still runs, and let go of its output."""
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait(60)
        if self.process.stdout:
            self.process.stdout.close()

    def output(self) -> str:
        assert self.process.stdout is not None
        return self.process.stdout.read()

    def wait_for(self, happened: Callable[[], object], what: str, seconds: float = 120) -> None:
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            with suppress(OSError, subprocess.SubprocessError, ValueError):
                if happened():
                    return
            assert self.process.poll() is None, f"the game ended early: {self.output()}"
            time.sleep(0.05)
        raise AssertionError(f"waited {seconds} s for {what}")

    def _find(self, seconds: float) -> str:
        found = ""

        def visible() -> bool:
            nonlocal found
            found = self._xdotool("search", "--onlyvisible", "--class", "tranquility").strip()
            return bool(found)

        self.wait_for(visible, "the window", seconds)
        return found.splitlines()[0]

    def _xdotool(self, *arguments: str) -> str:
        finished = subprocess.run(
            ["xdotool", *arguments],
            env=self._environment,
            capture_output=True,
            check=False,
            text=True,
            timeout=120,
        )
        return finished.stdout


@contextmanager
def start(display: str, user_dir: Path, *arguments: str) -> Iterator[Window]:
    """The game, ended by force if a test leaves it running."""
    window = Window(display, user_dir, *arguments)
    try:
        yield window
    finally:
        window.end()
