"""A monkey that plays: random keys, mouse, pads, windows and files, in every scene, until something breaks.

It is the real game without a window (SDL draws into memory, a frame lasts 1/60 s of its own clock), and what comes
in are pygame's events. It wanders by them from scene to scene, and now and then is put into one that is drawn by
lot. Meanwhile files of the player's are cut short, emptied, swapped for nonsense or thrown away, training processes
are killed, and the game is closed and opened again.

A fault is any exception, also one that the game survives with its fault screen; a warning about a figure that is
none; and whatever is left behind: a scene that was left for good but is still in memory, a process, a thread, an
open or a temporary file. The same seed makes the same events; only the processes that train have a pace of their own.
"""

from __future__ import annotations

import gc
import logging
import os
import sys
import tempfile
import threading
import time
import traceback
import warnings
from collections import Counter, deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from itertools import count
from multiprocessing import active_children
from pathlib import Path
from shutil import copytree, rmtree
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pygame

from ai.nn import ModelFormatError
from game.core.assets import MODELS_DIR
from game.core.scene import Pop, Push, Scene
from game.core.settings import SettingsFile
from game.scenes import scene_of
from game.scenes.menus.menu import MenuScene
from game.shell.app import App
from game.ui.context import Context
from game.ui.form import Form
from tests.support.screens import FLOWN, OVER_OTHERS, SCREENS
from tests.support.tour import scene_types, stock

ALL = {**SCREENS, **FLOWN}
WAYS = [*ALL, *(name for name in OVER_OTHERS if "Dialog" in name)]  # into any scene
_OF_FILES = {"ReplayScene", "friend"}  # scenes for which files are written and read
_DEEPEST = 7  # scenes one above the other
_JUMP, _JUMP_HOME = 0.015, 0.15  # how often it is put somewhere else, and from the menu, where it soon would quit
_LISTED = 25  # acts before a fault that are listed
# What a training may say when its files are spoilt. It is shown to the player.
_SAID = (OSError, ValueError, EOFError, MemoryError)
_SIZES = [(1280, 720), (1280, 720), (960, 540), (1000, 800), (640, 360), (1600, 900)]
# Keys that mean something somewhere, as the game comes; the others may be bound to something, too.
_BOUND = [pygame.K_UP, pygame.K_DOWN, pygame.K_LEFT, pygame.K_RIGHT, pygame.K_w, pygame.K_a, pygame.K_s, pygame.K_d,
          pygame.K_SPACE, pygame.K_RETURN, pygame.K_KP_ENTER, pygame.K_TAB, pygame.K_TAB, pygame.K_ESCAPE, pygame.K_p,
          pygame.K_BACKSPACE, pygame.K_AC_BACK, pygame.K_r, pygame.K_PERIOD, pygame.K_MINUS, pygame.K_PLUS, pygame.K_n,
          pygame.K_b, pygame.K_PAGEUP, pygame.K_PAGEDOWN, pygame.K_c, pygame.K_g, pygame.K_DELETE]  # fmt: skip
_OTHERS = [*range(pygame.K_SPACE, pygame.K_z + 1), *range(pygame.K_F1, pygame.K_F12 + 1), pygame.K_HOME, pygame.K_END,
           pygame.K_INSERT, pygame.K_LSHIFT, pygame.K_CAPSLOCK, pygame.K_MENU, 0]  # fmt: skip
_MODS = (0, 0, 0, pygame.KMOD_SHIFT, pygame.KMOD_CTRL, pygame.KMOD_ALT, pygame.KMOD_META)
_TEXTS = ("a", "7", " ", ".", "é", "月", "🚀", "CON", "../..", "", "\x00", "\u202e", "x" * 300, "NUL.txt", "-1e999",
          "nan")  # fmt: skip
_PAD_BUTTONS = [*range(21), *range(15), *range(8)]
# Events of the window, and such that the game has no use for.
_STRANGE = ("WINDOWFOCUSLOST", "WINDOWMINIMIZED", "WINDOWEXPOSED", "WINDOWLEAVE", "WINDOWHIDDEN", "WINDOWMAXIMIZED",
            "WINDOWMOVED", "WINDOWDISPLAYCHANGED", "WINDOWSIZECHANGED", "CLIPBOARDUPDATE", "KEYMAPCHANGED",
            "RENDER_TARGETS_RESET", "DROPFILE", "FINGERDOWN", "USEREVENT", "JOYBUTTONDOWN", "AUDIODEVICEREMOVED",
            "AUDIODEVICEADDED")  # fmt: skip
_NONSENSE = (b"", b"\x00\xff\xfe" * 200, b"{", b"[]", b"null", b'{"format": 1e999}', b"NaN\n" * 50, b"[" * 5000)


class Faults(logging.Handler):
    """Everything that went wrong, wherever it was caught."""

    def __init__(self, acts: deque[str]) -> None:
        super().__init__(logging.ERROR)
        self.found: list[str] = []
        self._acts = acts

    def add(self, what: str) -> None:
        """Note a fault, with what was done before."""
        self.found.append(what + "\n  after: " + "; ".join(self._acts))

    def emit(self, record: logging.LogRecord) -> None:
        """Take what the game logs: exceptions it has survived, and those of its processes."""
        text = self.format(record) if record.exc_info else record.getMessage()
        if record.exc_info or not _is_for_player(text):
            self.add(text)

    @contextmanager
    def watching(self) -> Iterator[None]:
        """Hear of everything meanwhile: what is logged, what ends a thread, what no one could catch."""
        log = logging.getLogger("tranquility")
        before = threading.excepthook, sys.unraisablehook, log.propagate
        threading.excepthook = lambda args: self.add("in a thread: " + "".join(traceback.format_exception(*args[:3])))
        sys.unraisablehook = lambda args: self.add(f"unraisable: {args.exc_value!r} in {args.object!r}")
        log.addHandler(self)
        log.propagate = False
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error", RuntimeWarning)
                yield
        finally:
            threading.excepthook, sys.unraisablehook, log.propagate = before
            log.removeHandler(self)


def _is_for_player(trace: str) -> bool:
    """Whether what ended a process is something to show a player, rather than a mistake in the code."""
    name = trace.strip().splitlines()[-1].split(":")[0].rsplit(".", 1)[-1]
    kinds = [kind for root in _SAID for kind in (root, *_heirs(root))]
    return any(kind.__name__ == name for kind in kinds)


def _heirs(kind: type) -> list[type]:
    return [each for heir in kind.__subclasses__() for each in (heir, *_heirs(heir))]


class Monkey:
    """Plays one game after another in a folder, empty at first.

    Attributes:
        visits, entered: frames in each scene, and how often it was come to.
        events, games: what has come in, and how many games were opened.

    """

    def __init__(self, folder: Path, seed: int = 0) -> None:
        self.rng = np.random.default_rng(seed)
        self.visits: Counter[str] = Counter()
        self.entered: Counter[str] = Counter()
        self.acts: deque[str] = deque(maxlen=_LISTED)
        self.faults = Faults(self.acts)
        self.events = self.games = 0
        self._folder, self._frames, self._last = folder, count(), ""
        self._goes_on, self._mouse, self._keys = True, (0, 0), list[int]()
        self._forgotten: list[str] = []
        # Of whoever did something in this process before:
        self._others, self._threads = scenes_alive(), set(threading.enumerate())
        self.app: App

    def play(self, events: int) -> None:
        """Do something again and again, until so many events have come in."""
        with self.faults.watching():
            self._open()
            while self.events < events:
                self._do_something()
            self.go_home()
            self._come_back()
            for _ in range(10):  # until it is drawn, the game remembers what was drawn before; a new size must last
                self._pass_frame()
            stale = stale_scenes([*self._others, *self.app.scenes.stack])
            self._forgotten = stale if self._goes_on else []  # a game that was left draws no more
            self.close()

    def _do_something(self) -> None:
        try:
            if self.rng.random() < (_JUMP_HOME if isinstance(self.app.scenes.top, MenuScene) else _JUMP):
                self.acts.append(self._jump())
            else:
                act = list(ACTS)[self.rng.choice(len(_CHANCES), p=_CHANCES)]
                self.acts.append(act(self))
            all(self._pass_frame() for _ in range(int(self.rng.choice([0, 0, 1, 1]))))
        except Exception:
            self.faults.add("out of the game's own hands: " + traceback.format_exc())
            self._goes_on = False
        if not self._goes_on:
            self.close()
            self._open()

    def _jump(self) -> str:
        """Go into a scene that is drawn by lot, whatever is on the screen; from deep down, back to the menu first."""
        scenes = self.app.scenes
        if len(scenes.stack) >= _DEEPEST or self.rng.random() < 0.5:
            self.go_home()
        name = self._one(WAYS)
        self.events += 1
        try:
            scene = ALL[name](self.app.context) if name in ALL else OVER_OTHERS[name](scenes.top)
        except ModelFormatError:  # which may be spoilt just now; the game says so, and stays where it is
            return f"no {name}"
        except (OSError, ValueError):
            if name not in _OF_FILES:
                raise
            return f"no {name}"
        scenes.apply(Push(scene))
        return f"jump to {name}"

    def go_home(self) -> None:
        """Leave all scenes but the first one."""
        if (depth := len(self.app.scenes.stack)) > 1:
            self.app.scenes.apply(Pop(depth - 1))

    def _open(self) -> None:
        """Open the game, as it is opened from outside, on what the last one has left."""
        gc.unfreeze()
        gc.collect()
        models, user = self._folder / "models", self._folder / "user"
        rmtree(models, ignore_errors=True)
        copytree(MODELS_DIR, models)
        context = Context(user, SettingsFile(user).load(), models, rng=np.random.default_rng(self.rng.integers(2**31)))
        stock(context)
        self.app = App(context, now=lambda: next(self._frames) / 60, scene_of=scene_of, capped=False)
        self._goes_on, self._keys = True, []
        self.games += 1

    def close(self) -> None:
        """Close the game."""
        try:
            self.app.close()
        except Exception:
            self.faults.add("while closing: " + traceback.format_exc())
        del self.app

    def left_behind(self) -> list[str]:
        """Say what lives on although the game is closed."""
        wait_for(lambda: not active_children() and self._threads.issuperset(threading.enumerate()), 10.0)
        found = [*self._forgotten, *stale_scenes(self._others)]
        found += [f"process {child}" for child in active_children()]
        found += [f"thread {each.name}" for each in set(threading.enumerate()) - self._threads]
        # A process that was killed in the midst of a save leaves a file, which the next one clears away.
        children = {self._folder / "user" / name for name in ("models", "digits")}
        files = [path for path in (self._folder / "user").rglob(".*") if children.isdisjoint(path.parents)]
        return found + [f"file {path}" for path in (*files, *Path(tempfile.gettempdir()).iterdir())]

    # What it can do: each says in a few words what it did

    def _one(self, choices: Any) -> Any:
        return choices[self.rng.integers(len(choices))]

    def _post(self, kind: int, **values: Any) -> None:
        pygame.event.post(pygame.event.Event(kind, values))
        self.events += 1

    def _pass_frame(self) -> bool:
        """Play a frame; False when the game is over."""
        name = type(self.app.scenes.top).__name__
        self.visits[name] += 1
        self.entered[name] += name != self._last
        self._last = name
        self._goes_on = self.app.tick()
        return self._goes_on

    def _key(self, keys: Any = _BOUND) -> str:
        """Press a key, and let go of it now or some day."""
        key, mod = self._one(keys), self._one(_MODS)
        values = {"key": key, "mod": mod, "unicode": chr(key) if 32 <= key < 127 else "", "scancode": 0}
        self._post(pygame.KEYDOWN, **values)
        if self.rng.random() < 0.7:
            self._post(pygame.KEYUP, **values)
        else:
            self._keys.append(key)
        return f"key {pygame.key.name(key) or key}"

    def _let_go(self) -> str:
        """Let go of a key, or of one that was never pressed."""
        key = self._keys.pop() if self._keys else self._one(_BOUND)
        self._post(pygame.KEYUP, key=key, mod=0, unicode="", scancode=0)
        return "key up"

    def _type(self) -> str:
        text = self._one(_TEXTS)
        if self.rng.random() < 0.2:
            self._post(pygame.TEXTEDITING, text=text, start=0, length=len(text))
        self._post(pygame.TEXTINPUT, text=text)
        return f"text {text[:10]!r}"

    def _click(self) -> str:
        self._move(self._target())
        button = int(self.rng.choice([1, 1, 1, 1, 2, 3, 4, 6]))
        for _ in range(int(self.rng.choice([1, 1, 1, 2]))):
            self._post(pygame.MOUSEBUTTONDOWN, pos=self._mouse, button=button, touch=False)
            if self.rng.random() < 0.95:
                self._post(pygame.MOUSEBUTTONUP, pos=self._mouse, button=button, touch=False)
        return f"click {button} at {self._mouse}"

    def _drag(self) -> str:
        self._move(self._target())
        self._post(pygame.MOUSEBUTTONDOWN, pos=self._mouse, button=1, touch=False)
        start, end = self._mouse, self._target()
        for share in np.linspace(0, 1, int(self.rng.integers(2, 9))):
            x, y = ((1 - share) * a + share * b for a, b in zip(start, end, strict=True))
            self._move((round(x), round(y)), (1, 0, 0))
            self._pass_frame()
        if self.rng.random() < 0.9:
            self._post(pygame.MOUSEBUTTONUP, pos=self._mouse, button=1, touch=False)
        return f"drag to {end}"

    def _wheel(self) -> str:
        x, y = (int(each) for each in self.rng.integers(-9, 10, 2))
        self._post(pygame.MOUSEWHEEL, x=x, y=y, precise_x=float(x), precise_y=float(y), flipped=False, touch=False)
        return "wheel"

    def _hover(self) -> str:
        self._move(self._target())
        return f"move to {self._mouse}"

    def _move(self, place: tuple[int, int], buttons: tuple[int, int, int] = (0, 0, 0)) -> None:
        rel = (place[0] - self._mouse[0], place[1] - self._mouse[1])
        self._mouse = place
        self._post(pygame.MOUSEMOTION, pos=place, rel=rel, buttons=buttons, touch=False)

    def _target(self) -> tuple[int, int]:
        """Draw a place in the window: the middle of a widget, anywhere, or beyond its edge."""
        form = getattr(self.app.scenes.top, "form", None)
        if isinstance(form, Form) and form.widgets and self.rng.random() < 0.6:
            canvas = self.app.canvas.reading
            rect = canvas.rect(*self._one(form.widgets).box)
            x, y = rect.topleft + self.rng.random(2) * rect.size
            return round(x), round(y)
        low, high = (-50, 1.1) if self.rng.random() < 0.05 else (0, 1.0)
        x, y = (int(self.rng.integers(low, max(1, round(high * length)))) for length in self.app.window.size)
        return x, y

    def _pad_button(self) -> str:
        pad, button = int(self.rng.integers(2)), self._one(_PAD_BUTTONS)
        self._post(pygame.CONTROLLERBUTTONDOWN, instance_id=pad, button=button)
        if self.rng.random() < 0.7:
            self._post(pygame.CONTROLLERBUTTONUP, instance_id=pad, button=button)
        return f"pad button {button}"

    def _pad_axis(self) -> str:
        value, axis = self._one([-32768, 32767, 0, 0, int(self.rng.integers(-32768, 32768))]), self._one(range(8))
        self._post(pygame.CONTROLLERAXISMOTION, instance_id=int(self.rng.integers(2)), axis=axis, value=value)
        return f"pad axis {axis}: {value}"

    def _plug(self) -> str:
        """Plug a pad in, or pull one out that may have been there."""
        if self.rng.random() < 0.5:
            self._post(pygame.CONTROLLERDEVICEADDED, device_index=int(self.rng.integers(4)), guid="")
        else:
            self._post(pygame.CONTROLLERDEVICEREMOVED, instance_id=int(self.rng.integers(3)))
        return "a pad comes or goes"

    def _strange(self) -> str:
        name = self._one(_STRANGE)
        self._post(getattr(pygame, name), x=0, y=0, dx=0.0, dy=0.0, window=None, display_index=0, file="/nowhere",
                   finger_id=1, touch_id=1, button=0, which=0, iscapture=False)  # fmt: skip
        return str(name)

    def _come_back(self) -> str:
        """Let the window be seen and used."""
        self._post(pygame.WINDOWRESTORED, window=None)
        self._post(pygame.WINDOWFOCUSGAINED, window=None)
        return "window is back"

    def _resize(self) -> str:
        size = self.app.window.size = self._one(_SIZES)
        return f"resize to {size}"

    def _quit(self) -> str:
        self._post(pygame.QUIT)
        return "close"

    def _wait(self) -> str:
        frames = int(self.rng.integers(10, 120))
        all(self._pass_frame() for _ in range(frames))
        return f"wait {frames}"

    def _damage(self) -> str:
        """Spoil a file of the player's or a shipped network."""
        folders = self.app.context.user_dir, self.app.context.models_dir
        files = [path for folder in folders for path in sorted(folder.rglob("*")) if path.is_file()]
        path, how = self._one(files), self._one(("short", "nonsense", "gone", "folder", "bits"))
        try:
            data = bytearray(path.read_bytes())
            if how == "short":
                path.write_bytes(data[: len(data) // 2])
            elif how == "nonsense":
                path.write_bytes(self._one(_NONSENSE))
            elif how == "bits" and data:
                data[self.rng.integers(len(data))] ^= 0xFF
                path.write_bytes(data)
            elif how in ("gone", "folder") and path.suffix != ".log":
                path.unlink()
                if how == "folder":
                    path.mkdir()
        except OSError as error:  # a training replaces it at this moment
            return f"{how} {path.name}: {error}"
        return f"{how} {path.parent.name}/{path.name}"

    def _kill_child(self) -> str:
        """Kill a process that trains."""
        children = active_children()
        for child in children[:1]:
            child.kill()
        return f"kill one of {len(children)}"


# What is done, and how often beside the others.
ACTS: dict[Callable[[Monkey], str], float] = {
    Monkey._key: 24, lambda monkey: monkey._key(_OTHERS): 3, Monkey._let_go: 8, Monkey._type: 2, Monkey._click: 12,
    Monkey._drag: 3, Monkey._wheel: 3, Monkey._hover: 6, Monkey._wait: 0.5, Monkey._pad_button: 8, Monkey._pad_axis: 6,
    Monkey._plug: 0.3, Monkey._strange: 0.8, Monkey._come_back: 0.6, Monkey._resize: 0.05, Monkey._quit: 0.02,
    Monkey._damage: 0.15, Monkey._kill_child: 0.05,
}  # fmt: skip
_CHANCES = np.array(list(ACTS.values())) / sum(ACTS.values())


def scenes_alive() -> list[Scene]:
    """Return the scenes that are in memory, whether or not anybody uses them."""
    gc.unfreeze()
    gc.collect()
    kinds = tuple(scene_types())
    return [each for each in gc.get_objects() if isinstance(each, kinds)]


def stale_scenes(in_use: list[Scene]) -> list[str]:
    """Say which scenes are in memory although they are not in use."""
    gc.unfreeze()  # or what a game has kept from the collector would not be found
    for each in gc.get_objects():
        if isinstance(each, type(_a_cache)) and each.__module__.startswith("game."):
            each.cache_clear()  # pictures, and fonts that keep their files open: so many at the most, but not yet
    alive = Counter(type(each).__name__ for each in scenes_alive() if each not in in_use)
    return [f"{number} × {name} still in memory" for name, number in alive.items()]


@cache
def _a_cache() -> None:
    """Be of the type of all that keeps."""


def wait_for(holds: Callable[[], object], seconds: float) -> bool:
    """Wait until something holds; whether it does."""
    end = time.monotonic() + seconds
    while not holds() and time.monotonic() < end:
        time.sleep(0.02)
    return bool(holds())


@contextmanager
def playground() -> Iterator[Path]:
    """A folder for everything that the game may write: the player's, their documents, temporary files."""
    before = {name: os.environ.get(name) for name in ("HOME", "TMPDIR")}
    with TemporaryDirectory(prefix="monkey-") as name:
        folder = Path(name)
        for variable, inside in (("HOME", "home"), ("TMPDIR", "tmp")):
            (folder / inside).mkdir()
            os.environ[variable] = str(folder / inside)
        tempfile.tempdir = None
        try:
            yield folder
        finally:
            for variable, value in before.items():
                os.environ.pop(variable) if value is None else os.environ.update({variable: value})
            tempfile.tempdir = None
            gc.collect()
            gc.freeze()  # the monkey looks through all there is
