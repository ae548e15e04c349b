"""What the monkey can do: each posts events, or spoils something, and says in a few words what it did."""

from __future__ import annotations

from collections.abc import Callable
from multiprocessing import active_children
from pathlib import Path
from shutil import rmtree
from typing import Any

import numpy as np
import pygame

from game.core.scene import Scene
from game.shell.app import App
from game.ui.form import Form

try:
    import resource
except ImportError:  # there is no such limit on Windows
    resource = None  # type: ignore[assignment]

Rng = np.random.Generator
SIZES = [(1280, 720), (1280, 720), (960, 540), (1000, 800), (640, 360), (1600, 900)]
# Keys that mean something somewhere, as the game comes; the others may be bound to something, too.
_BOUND = [pygame.K_UP, pygame.K_DOWN, pygame.K_LEFT, pygame.K_RIGHT, pygame.K_w, pygame.K_a, pygame.K_s, pygame.K_d,
          pygame.K_SPACE, pygame.K_RETURN, pygame.K_KP_ENTER, pygame.K_TAB, pygame.K_TAB, pygame.K_ESCAPE, pygame.K_p,
          pygame.K_BACKSPACE, pygame.K_AC_BACK, pygame.K_r, pygame.K_PERIOD, pygame.K_MINUS, pygame.K_PLUS, pygame.K_n,
          pygame.K_b, pygame.K_PAGEUP, pygame.K_PAGEDOWN, pygame.K_c, pygame.K_g, pygame.K_DELETE]  # fmt: skip
_OTHERS = [*range(pygame.K_SPACE, pygame.K_z + 1), *range(pygame.K_F1, pygame.K_F11), pygame.K_DELETE, pygame.K_HOME,
           pygame.K_END, pygame.K_INSERT, pygame.K_LSHIFT, pygame.K_CAPSLOCK, pygame.K_MENU, 0]  # fmt: skip
_MODS = (0, 0, 0, pygame.KMOD_SHIFT, pygame.KMOD_CTRL, pygame.KMOD_ALT, pygame.KMOD_META)
_TEXTS = ("a", "7", " ", ".", "é", "月", "🚀", "CON", "../..", "", "\x00", "\u202e", "x" * 300, "NUL.txt", "-1e999",
          "nan")  # fmt: skip
_PAD_BUTTONS = [*range(21), *range(15), *range(8)]
_PAD_AXES = [*range(6), 7]
_WINDOW = ("WINDOWFOCUSLOST", "WINDOWFOCUSGAINED", "WINDOWMINIMIZED", "WINDOWRESTORED", "WINDOWEXPOSED",
           "WINDOWENTER", "WINDOWLEAVE", "WINDOWHIDDEN", "WINDOWSHOWN", "WINDOWMAXIMIZED", "WINDOWMOVED",
           "WINDOWDISPLAYCHANGED", "WINDOWSIZECHANGED", "WINDOWRESIZED", "WINDOWTAKEFOCUS", "CLIPBOARDUPDATE",
           "KEYMAPCHANGED", "RENDER_TARGETS_RESET", "APP_LOWMEMORY", "LOCALECHANGED")  # fmt: skip
_STRANGE = (pygame.DROPFILE, pygame.FINGERDOWN, pygame.FINGERUP, pygame.USEREVENT, pygame.JOYBUTTONDOWN,
            pygame.AUDIODEVICEREMOVED, pygame.AUDIODEVICEADDED)  # fmt: skip
_NONSENSE = (b"", b"\x00\xff\xfe" * 200, b"{", b"[]", b"null", b'{"format": 1e999}', b"NaN\n" * 50, b"[" * 5000)
_FULL = 40  # frames that the disk stays full


class Hands:
    """The monkey's hands on one game: they know what they hold down, and where the mouse is.

    Attributes:
        posted: events that have come in.
        goes_on: whether the game does.

    """

    def __init__(self, app: App, rng: Rng, count: Callable[[Scene], None]) -> None:
        self.app, self.rng, self._count = app, rng, count
        self.posted = 0
        self.goes_on = True
        self._keys: list[int] = []
        self._buttons: list[tuple[int, int]] = []
        self._mouse = (0, 0)
        self._full_until = 0
        self._frame = 0

    def post(self, kind: int, **values: Any) -> None:
        """Let an event come in."""
        pygame.event.post(pygame.event.Event(kind, values))
        self.posted += 1

    def pass_frame(self) -> bool:
        """Play a frame; False when the game is over."""
        self._frame += 1
        self._count(self.app.scenes.top)
        if self._full_until and self._frame >= self._full_until:
            self.free_disk()
        self.goes_on = self.app.tick()
        return self.goes_on

    def free_disk(self) -> None:
        """Let there be room on the disk again."""
        if self._full_until:
            self._limit_files(None)
            self._full_until = 0

    # Keys and text

    def press(self, key: int) -> str:
        mod = self._one(_MODS)
        letter = chr(key) if 32 <= key < 127 else ""
        self.post(pygame.KEYDOWN, key=key, mod=mod, unicode=letter, scancode=0)
        if self.rng.random() < 0.7:
            self.post(pygame.KEYUP, key=key, mod=mod, unicode=letter, scancode=0)
        else:
            self._keys.append(key)
        return f"key {pygame.key.name(key) or key}"

    def bound_key(self) -> str:
        return self.press(self._one(_BOUND))

    def other_key(self) -> str:
        return self.press(self._one(_OTHERS))

    def let_go(self) -> str:
        key = self._keys.pop() if self._keys else self._one(_BOUND)
        self.post(pygame.KEYUP, key=key, mod=0, unicode="", scancode=0)
        return "key up"

    def type_text(self) -> str:
        text = self._one(_TEXTS)
        if self.rng.random() < 0.2:
            self.post(pygame.TEXTEDITING, text=text, start=0, length=len(text))
        self.post(pygame.TEXTINPUT, text=text)
        return f"text {text[:10]!r}"

    # The mouse

    def click(self) -> str:
        self._move(self._target())
        button = int(self.rng.choice([1, 1, 1, 1, 2, 3, 4, 6]))
        for _ in range(int(self.rng.choice([1, 1, 1, 2]))):
            self.post(pygame.MOUSEBUTTONDOWN, pos=self._mouse, button=button, touch=False)
            if self.rng.random() < 0.95:
                self.post(pygame.MOUSEBUTTONUP, pos=self._mouse, button=button, touch=False)
        return f"click {button} at {self._mouse}"

    def drag(self) -> str:
        self._move(self._target())
        self.post(pygame.MOUSEBUTTONDOWN, pos=self._mouse, button=1, touch=False)
        start, end = self._mouse, self._target()
        for share in np.linspace(0, 1, int(self.rng.integers(2, 9))):
            x, y = ((1 - share) * a + share * b for a, b in zip(start, end, strict=True))
            self._move((round(x), round(y)), (1, 0, 0))
            self.pass_frame()
        if self.rng.random() < 0.9:
            self.post(pygame.MOUSEBUTTONUP, pos=self._mouse, button=1, touch=False)
        return f"drag to {end}"

    def wheel(self) -> str:
        x, y = (int(each) for each in self.rng.integers(-9, 10, 2))
        self.post(pygame.MOUSEWHEEL, x=x, y=y, precise_x=float(x), precise_y=float(y), flipped=False, touch=False)
        return "wheel"

    def hover(self) -> str:
        self._move(self._target())
        return f"move to {self._mouse}"

    def _move(self, place: tuple[int, int], buttons: tuple[int, int, int] = (0, 0, 0)) -> None:
        rel = (place[0] - self._mouse[0], place[1] - self._mouse[1])
        self._mouse = place
        self.post(pygame.MOUSEMOTION, pos=place, rel=rel, buttons=buttons, touch=False)

    def _target(self) -> tuple[int, int]:
        """Draw a place in the window: the middle of a widget, anywhere, or beyond its edge."""
        forms = [each for each in vars(self.app.scenes.top).values() if isinstance(each, Form) and each.widgets]
        if forms and self.rng.random() < 0.6:
            widgets = forms[0].widgets
            rect = widgets[self.rng.integers(len(widgets))].rect
            x, y = self.app.canvas.in_window(rect).topleft + self.rng.random(2) * (rect.size)
            return round(x), round(y)
        low, high = (-50, 1.1) if self.rng.random() < 0.05 else (0, 1.0)
        x, y = (int(self.rng.integers(low, max(1, round(high * length)))) for length in self.app.window.size)
        return x, y

    # Pads

    def pad_button(self) -> str:
        pad, button = int(self.rng.integers(2)), self._one(_PAD_BUTTONS)
        self.post(pygame.CONTROLLERBUTTONDOWN, instance_id=pad, button=button)
        if self.rng.random() < 0.7:
            self.post(pygame.CONTROLLERBUTTONUP, instance_id=pad, button=button)
        return f"pad button {button}"

    def pad_axis(self) -> str:
        value = int(self.rng.choice([-32768, 32767, 0, 0, int(self.rng.integers(-32768, 32768))]))
        axis = self._one(_PAD_AXES)
        self.post(pygame.CONTROLLERAXISMOTION, instance_id=int(self.rng.integers(2)), axis=axis, value=value)
        return f"pad axis {axis}: {value}"

    def pad_comes_or_goes(self) -> str:
        if self.rng.random() < 0.5:
            self.post(pygame.CONTROLLERDEVICEADDED, device_index=int(self.rng.integers(4)), guid="")
        else:
            self.post(pygame.CONTROLLERDEVICEREMOVED, instance_id=int(self.rng.integers(3)))
        return "a pad comes or goes"

    # The window, sound and the like

    def window(self) -> str:
        name = self._one(_WINDOW)
        self.post(getattr(pygame, name), x=0, y=0, window=None, display_index=0)
        return name

    def come_back(self) -> str:
        self.post(pygame.WINDOWRESTORED, window=None)
        self.post(pygame.WINDOWFOCUSGAINED, window=None)
        return "window is back"

    def resize(self) -> str:
        size = self._one(SIZES)
        self.app.window.size = size
        self.posted += 1
        return f"resize to {size}"

    def strange(self) -> str:
        kind = self._one(_STRANGE)
        self.post(kind, file="/nowhere", x=0.5, y=0.5, dx=0.0, dy=0.0, finger_id=1, touch_id=1, button=0, which=0,
                  iscapture=False)  # fmt: skip
        return pygame.event.event_name(kind)

    def close_window(self) -> str:
        self.post(pygame.QUIT)
        return "close"

    def wait(self) -> str:
        self.posted += 1
        frames = int(self.rng.integers(10, 120))
        all(self.pass_frame() for _ in range(frames))
        return f"wait {frames}"

    # Bad days

    def damage(self) -> str:
        context = self.app.context
        files = [
            path
            for folder in (context.user_dir, context.models_dir)
            for path in sorted(folder.rglob("*"))
            if path.is_file() and path.suffix != ".log"
        ]
        self.posted += 1
        return f"{self._spoil(files[self.rng.integers(len(files))])}" if files else "nothing to damage"

    def _spoil(self, path: Path) -> str:
        how = self._one(("short", "nonsense", "gone", "folder", "bits", "tree"))
        try:
            data = bytearray(path.read_bytes())
            if how == "short":
                path.write_bytes(data[: len(data) // 2])
            elif how == "nonsense":
                path.write_bytes(self._one(_NONSENSE))
            elif how == "gone":
                path.unlink()
            elif how == "folder":
                path.unlink()
                path.mkdir()
            elif how == "bits" and data:
                data[self.rng.integers(len(data))] ^= 0xFF
                path.write_bytes(data)
            elif how == "tree" and self.rng.random() < 0.1:
                rmtree(path.parent)
        except OSError as error:  # the disk is full just now, or a training replaces it at this moment
            return f"{how} {path.name}: {error}"
        return f"{how} {path.parent.name}/{path.name}"

    def fill_disk(self) -> str:
        self._limit_files(0)
        self._full_until = self._frame + _FULL
        self.posted += 1
        return "the disk is full"

    def _limit_files(self, size: int | None) -> None:
        """Let the system refuse, in this process, to write a file beyond that size; None for no limit."""
        if resource:
            _, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
            resource.setrlimit(resource.RLIMIT_FSIZE, (hard if size is None else size, hard))

    def kill_child(self) -> str:
        children = active_children()
        for child in children[:1]:
            child.kill()
        self.posted += 1
        return f"kill one of {len(children)}"

    def _one(self, choices: Any) -> Any:
        return choices[self.rng.integers(len(choices))]


Deed = Callable[[Hands], str]
# What is done, and how often beside the others.
DEEDS: dict[Deed, float] = {
    Hands.bound_key: 24, Hands.other_key: 3, Hands.let_go: 8, Hands.type_text: 2, Hands.click: 12, Hands.drag: 3,
    Hands.wheel: 3, Hands.hover: 6, Hands.wait: 0.5, Hands.pad_button: 8, Hands.pad_axis: 6,
    Hands.pad_comes_or_goes: 0.3, Hands.window: 0.6, Hands.come_back: 0.6, Hands.strange: 0.4,
    Hands.resize: 0.05, lambda hands: hands.press(pygame.K_F11): 0.03,
    lambda hands: hands.press(pygame.K_F12): 0.03, Hands.close_window: 0.02,
    Hands.damage: 0.15, Hands.fill_disk: 0.05, Hands.kill_child: 0.05,
}  # fmt: skip
