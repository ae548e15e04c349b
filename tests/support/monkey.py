"""A monkey that plays: random keys, mouse, pads, windows, files and disks, in every scene, until something breaks.

It is the real game without a window (SDL draws into memory, a frame lasts 1/60 s of its own clock), and what comes
in are pygame's events. It wanders by them from scene to scene, and now and then is put into one that is drawn by
lot. Meanwhile files of the player's are cut short, emptied, swapped for nonsense or thrown away, the disk is full,
the sound device is lost, training processes are killed, and the game is closed and opened again.

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

import numpy as np
from numpy.typing import NDArray

from game.audio.instruments import INSTRUMENTS, Instrument
from game.audio.mixer import Sound
from game.core.assets import MODELS_DIR
from game.core.scene import Pop, Push, Scene
from game.core.settings import SettingsFile
from game.core.trash import TRASH
from game.scenes import scene_of
from game.scenes.menus.menu import MenuScene
from game.shell.app import App
from game.ui.context import Context
from tests.support.monkey_deeds import DEEDS, Hands
from tests.support.screens import FLOWN, OVER_OTHERS, SCREENS
from tests.support.tour import scene_types, stock

ALL = {**SCREENS, **FLOWN}
WAYS = [*ALL, *(name for name in OVER_OTHERS if "Dialog" in name)]  # into any scene
_OF_FILES = {"ReplayScene", "StudyScene", "friend"}  # scenes for which files are written and read
_DEEPEST = 7  # scenes one above the other
_JUMP, _JUMP_HOME = 0.015, 0.15  # how often it is put somewhere else, and from the menu, where it soon would quit
_TOLD = 25  # deeds before a fault that are told
# What a training may say when its files are spoilt or its disk is full. It is shown to the player.
_SAID = (OSError, ValueError, EOFError, MemoryError)


class Faults(logging.Handler):
    """Everything that went wrong, wherever it was caught."""

    def __init__(self, deeds: deque[str]) -> None:
        super().__init__(logging.ERROR)
        self.found: list[str] = []
        self._deeds = deeds

    def add(self, what: str) -> None:
        """Note a fault, with what was done before."""
        self.found.append(what + "\n  after: " + "; ".join(self._deeds))

    def emit(self, record: logging.LogRecord) -> None:
        """Take what the game logs: exceptions it has survived, and those of its processes."""
        text = self.format(record) if record.exc_info else record.getMessage()
        if record.exc_info or not _is_told(text):
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


def _is_told(trace: str) -> bool:
    """Whether what ended a process is something that a player is told of, rather than a mistake in the code."""
    name = trace.strip().splitlines()[-1].split(":")[0].rsplit(".", 1)[-1]
    kinds = [kind for root in _SAID for kind in (root, *_heirs(root))]
    return any(kind.__name__ == name for kind in kinds)


def _heirs(kind: type) -> list[type]:
    return [each for heir in kind.__subclasses__() for each in (heir, *_heirs(heir))]


class Recorded(Instrument):
    """An instrument that is played once, for all the games there will be."""

    def render(self, key: str) -> NDArray[np.int16]:
        """Return the sound."""
        return _recording(key)


@cache
def _recording(key: str) -> NDArray[np.int16]:
    return INSTRUMENTS[key].render(key)


class Monkey:
    """Plays one game after another in a folder. `visits` counts the frames in each scene.

    Args:
        folder: empty; the player's, the networks' and the temporary files are put there.
        seed: of all that it does.
        open_sound: whether there is to be a device, which in memory is silent.

    """

    def __init__(self, folder: Path, seed: int = 0, *, open_sound: bool = True) -> None:
        self.rng = np.random.default_rng(seed)
        self.visits: Counter[str] = Counter()
        self.entered: Counter[str] = Counter()
        self.deeds: deque[str] = deque(maxlen=_TOLD)
        self.faults = Faults(self.deeds)
        self.events = self.games = 0
        self._folder, self._open_sound = folder, open_sound
        self._frames = count()
        self._last = ""
        self._forgotten: list[str] = []
        # Of whoever did something in this process before:
        self._others, self._threads = scenes_alive(), set(threading.enumerate())
        self._weights = np.array(list(DEEDS.values())) / sum(DEEDS.values())
        self.app: App
        self.hands: Hands

    def play(self, events: int) -> None:
        """Do something again and again, until so many events have come in."""
        with self.faults.watching():
            self._open()
            while self.events < events:
                self._do_something()
            self.go_home()
            self.hands.come_back()
            for _ in range(10):  # until it is drawn, the game remembers what was drawn before; a new size must settle
                self.hands.pass_frame()
            in_use = [*self._others, *self.app.scenes.stack]
            stale = stale_scenes(in_use)
            self._forgotten = stale if self.hands.goes_on else []  # a game that was left draws no more
            self.close()

    def _do_something(self) -> None:
        before = self.hands.posted
        try:
            if self.rng.random() < (_JUMP_HOME if isinstance(self.app.scenes.top, MenuScene) else _JUMP):
                self.deeds.append(self._jump())
            else:
                deed = list(DEEDS)[self.rng.choice(len(self._weights), p=self._weights)]
                self.deeds.append(deed(self.hands))
            all(self.hands.pass_frame() for _ in range(int(self.rng.choice([0, 0, 1, 1]))))
            goes_on = self.hands.goes_on
        except Exception:
            self.faults.add("out of the game's own hands: " + traceback.format_exc())
            goes_on = False
        self.events += self.hands.posted - before
        if not goes_on:
            self.close()
            self._open()

    def _count(self, top: Scene) -> None:
        name = type(top).__name__
        self.visits[name] += 1
        self.entered[name] += name != self._last
        self._last = name

    def _jump(self) -> str:
        """Go into a scene that is drawn by lot, whatever is on the screen; from deep down, back to the menu first."""
        scenes = self.app.scenes
        if len(scenes.stack) >= _DEEPEST or self.rng.random() < 0.5:
            self.go_home()
        name = WAYS[self.rng.integers(len(WAYS))]
        self.hands.posted += 1
        try:
            scene = ALL[name](self.app.context) if name in ALL else OVER_OTHERS[name](scenes.top)
        except (OSError, ValueError):
            if name not in _OF_FILES:  # which may be spoilt just now
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
        context.sound = Sound({key: Recorded(**vars(each)) for key, each in INSTRUMENTS.items()})
        stock(context)
        self.app = App(context, now=lambda: next(self._frames) / 60, scene_of=scene_of, capped=False)
        self.hands = Hands(self.app, self.rng, self._count)
        if self._open_sound:
            context.sound.open()
        self.games += 1

    def close(self) -> None:
        """Close the game."""
        self.hands.free_disk()
        try:
            self.app.close()
        except Exception:
            self.faults.add("while closing: " + traceback.format_exc())
        del self.app, self.hands

    def left_behind(self) -> list[str]:
        """Say what lives on although the game is closed."""
        wait_for(lambda: not active_children() and self._threads.issuperset(threading.enumerate()), 10.0)
        found = [*self._forgotten, *stale_scenes(self._others)]
        found += [f"process {child}" for child in active_children()]
        found += [f"thread {each.name}" for each in set(threading.enumerate()) - self._threads]
        # A process that was killed in the midst of a save leaves a file, which the next one clears away.
        children = {self._folder / "user" / name for name in ("models", "digits")}
        hidden = (path for path in (self._folder / "user").rglob(".*") if path.name != TRASH)  # what can be restored
        files = [path for path in hidden if children.isdisjoint(path.parents)]
        return found + [f"file {path}" for path in (*files, *Path(tempfile.gettempdir()).iterdir())]


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
        if isinstance(each, type(_recording)) and each.__module__.startswith("game."):
            each.cache_clear()  # pictures, and fonts that keep their files open: so many at the most, but not yet
    alive = Counter(type(each).__name__ for each in scenes_alive() if each not in in_use)
    return [f"{number} × {name} still in memory" for name, number in alive.items()]


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
