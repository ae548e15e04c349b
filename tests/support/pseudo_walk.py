"""Walks through every scene with other catalogues, and writes what it saw as JSON.

A program, because texts are read when the game is imported: python -m tests.support.pseudo_walk FOLDER WINDOW...
"""

from __future__ import annotations

import gc
import json
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

os.environ["SDL_VIDEODRIVER"] = os.environ["SDL_AUDIODRIVER"] = "dummy"
os.environ["PYGAME_HIDE_SUPPORT_PROMPT"] = "1"

from game.core import catalogue

if __name__ == "__main__":
    catalogue.LOCALE = Path(sys.argv[1])

import numpy as np
import pygame

from game.core import texts
from game.core.settings import Settings, SettingsFile
from game.core.worker import WorkerState
from game.drawing.tokens import VIEW_SIZE
from game.scenes import scene_of
from game.scenes.digits.inside import DigitInsideScene
from game.scenes.error_screen import ErrorScene
from game.scenes.learn import pay
from game.scenes.learn.memory import MemoryChapter
from game.scenes.learn.path import FIRST
from game.scenes.learn.runs import DaringChapter, TargetChapter
from game.scenes.learn.scene import ChapterScene
from game.scenes.play.scene import PlayScene
from game.shell.app import App
from game.training.run import TrainingRun
from game.ui.context import Context
from game.ui.rows import ChoiceRow
from tests.game.tour.checkers import IN_HAND
from tests.game.tour.stops import STOPS, Stop
from tests.support import inline_worker
from tests.support.driver import Driver
from tests.support.pen import pad_of, stroke
from tests.support.screens import FLOWN, Make, crashed, reader, seven
from tests.support.small import DIGITS, LANDERS
from tests.support.tour import stock
from tests.support.written import Written, misplaced

SHORT = 2_560  # decisions of a run that shows nothing but its texts
SHORT_RUN = 60  # decisions of small runs
SIZES = ("normal", "large", "largest")
Happens = Callable[[Driver], object]


def trained(driver: Driver) -> None:
    """Train landers for a moment."""
    run = driver.top.run
    learn(driver, run, LANDERS, lambda: len(run.history) >= 2)


def rewound(driver: Driver) -> None:
    """Train landers, with an earlier run beside them, and go back to the middle of the run."""
    trained(driver)
    run, rewind = driver.top.run, driver.top.view.rewind
    run.earlier = run.history.copy()
    driver.frames(20)
    rewind.go_to(run.history["decisions"][-1] / 2)
    driver.frames(5)


def taught_to_read(driver: Driver) -> None:
    """Train a network to read for a moment."""
    run = driver.top.run
    learn(driver, run, DIGITS, lambda: run.confusion and len(run.history))


def knobs_listed(driver: Driver) -> None:
    driver.top.show_all()


def listed(driver: Driver) -> None:
    """Open the list of sabotages."""
    driver.top.knobs.ask(LANDERS)
    driver.top.view.laboratory.open()
    driver.frames(2)


def asked(driver: Driver) -> None:
    """Be asked what a sabotage will do."""
    listed(driver)
    driver.press_on(texts.SABOTAGES["rate_times_100"][0])


def experimented(driver: Driver) -> None:
    """Guess, and fly two runs side by side for a moment."""
    asked(driver)
    driver.press_on(texts.LAB_GUESSES["some"])
    driver.wait(lambda: driver.top.run.twin and len(driver.top.run.twin.history) >= 2)
    driver.press_on(texts.TRAIN_PAUSE)
    driver.frames(5)


def learn(driver: Driver, run: TrainingRun, config: object, enough: Callable[[], object]) -> None:
    driver.top.knobs.ask(config)
    driver.key(pygame.K_RETURN)
    driver.wait(enough)
    driver.key(pygame.K_RETURN)
    driver.wait(lambda: run.state is WorkerState.PAUSED)
    driver.frames(5)


def drawn(driver: Driver) -> None:
    """Draw a seven, and have it read."""
    rect = pad_of(driver)
    stroke(driver, [(rect.x + x * rect.w, rect.y + y * rect.h) for x, y in ((0.3, 0.2), (0.7, 0.2), (0.5, 0.8))])
    driver.frames(30)


def frame(number: int) -> Happens:
    """Return what shows a frame of a lesson."""

    def show(driver: Driver) -> None:
        driver.keys(*[pygame.K_RIGHT] * number)
        driver.frames(2)

    return show


def contacts(driver: Driver) -> None:
    """Show an exhibit's contacts."""
    driver.press_on(texts.MORE[0])
    driver.press_on(texts.PHYSICS_CONTACTS)
    driver.skip(130)


def taken_apart(driver: Driver) -> None:
    """Walk through every kind of piece of a step."""
    driver.keys(*[pygame.K_PERIOD] * 5)


def noted(driver: Driver) -> None:
    """Have a long message shown."""
    driver.app.context.note(texts.SETTINGS_UNREADABLE.format(reason=texts.FLIGHT_ACTIONS, name="/settings"))
    driver.frames(2)


def tried(*labels: str, steps: int) -> Happens:
    """Return what tries a chapter: presses on widgets, each for so many steps."""

    def try_it(driver: Driver) -> None:
        scene = driver.top
        assert isinstance(scene, ChapterScene)
        scene.begin()
        for label in labels or ("",):
            if label:
                driver.press_on(label)
            driver.skip(steps)
        driver.frames(2)

    return try_it


def inside(stage: int, driver: Driver) -> None:
    """Follow a unit to another stage."""
    driver.top.sums.choose(stage)
    driver.frames(5)


def half_way(driver: Driver) -> None:
    """Fly with a trigger pulled half way."""
    driver.frames(2)
    driver.axis(pygame.CONTROLLER_AXIS_TRIGGERRIGHT, 14000)
    driver.frames(40)


def reset(driver: Driver) -> None:
    """Put progress away."""
    driver.press_on(texts.PROGRESS_RESET)
    driver.frames(3)
    driver.press_on(texts.PROGRESS_YES)
    driver.frames(5)


OTHERS: dict[str, Make] = {
    "the tutorial": PlayScene,
    "modern inside": lambda context: DigitInsideScene(context, reader("modern"), seven()),
    "error": lambda context: ErrorScene(context, ValueError(), Path("/home/somebody/log")),
}
# Screens in states that take long to reach, or say much: beside those of the tour.
STATES = [
    Stop("daily", "a crash", crashed),
    Stop("friend", "what it earns", lambda driver: driver.skip(240)),
    Stop("Play", "assists", crashed, {"wider_pads": True, "untimed": True, "pace": 0.5, "toggle_thrust": True}),
    Stop("Play", "a share of thrust", half_way),
    Stop("MenuScene", "one switch", lambda driver: driver.skip(30), {"one_switch": True}),
    Stop("flights", "progress put away", reset),
    Stop("the tutorial", settings={"tutored": False}),
    Stop("error"),
    Stop("MenuScene", "a message", noted),
    Stop("TrainScene", "all choices", settings={"opened": "charts more"}),
    Stop("TrainScene", "all knobs", knobs_listed),
    Stop("TrainScene", "the laboratory", listed),
    Stop("TrainScene", "a guess", asked),
    Stop("TrainScene", "training", trained),
    Stop("TrainScene", "an experiment", experimented),
    Stop("TrainScene", "an earlier moment", rewound),
    Stop("DigitTrainingScene", "training to read", taught_to_read),
    *(Stop("LessonScene", f"frame {number + 1}", frame(number)) for number in range(5)),
    Stop("PhysicsScene", "contacts", contacts),
    Stop("PhysicsStepScene", "a step", taken_apart),
    Stop("DigitsScene", "a digit", drawn),
    Stop("DigitsScene", "a digit and more", drawn, {"opened": "digits"}),
    *(Stop("inside, sums", f"inside, {steps}", partial(inside, steps)) for steps in (1, 4, 5)),
    Stop("modern inside", "why not", lambda driver: driver.skip(120)),
    *(
        Stop(f"chapter, {key}" if key != FIRST else "ChapterScene", "tried", tried(*labels, steps=steps))
        for key, labels, steps in (
            ("neuron", [texts.LEARN_NEURON_HINT], 640),
            ("plane", [], 320),
            ("downhill", [], 340),
            ("backwards", [*[texts.LEARN_BACKWARDS_BACK] * 4, texts.LEARN_BACKWARDS_STEP], 2),
            ("pay", [texts.LEARN_PAY_TRAIN], 850),
            ("choice", [], 480),
            ("target", [texts.LEARN_RUNS_START[0]], SHORT_RUN + 5),
            ("memory", [texts.LEARN_MEMORY_START], SHORT_RUN + 5),
            ("daring", [texts.LEARN_RUNS_START[0]], SHORT_RUN + 5),
        )
    ),
]


class Walk:
    """One walk; `seen` is what was written, `wrong` what met or left its place, each with where that was first."""

    def __init__(self, user_dir: Path, windows: Sequence[str] = ()) -> None:
        self.user_dir = user_dir
        self._windows = [tuple(map(int, each.split("x"))) for each in windows]
        self.seen: dict[str, str] = {}
        self.wrong: dict[str, str] = {}
        self._written = Written(setattr)
        self._whole = {text for text in strings(vars(texts)) if text.endswith("…")}

    def visit(self, stop: Stop) -> None:
        """Open a screen; note what stands there at all sizes of text, and at the largest with each widget's options."""
        driver = stop.open(self._open, Context(self.user_dir, Settings(), rng=np.random.default_rng(1)))
        try:
            for size in ("largest",) if stop.state else (*SIZES[:2], "largest"):
                driver.write_in(size)
                self._note(driver, f"{stop}, {size}")
            for window in self._windows:
                driver.resize(window)
                self._note(driver, f"{stop}, {window}")
            driver.resize(VIEW_SIZE)
            held = str(stop) in IN_HAND  # another widget in focus would let go of the lander
            for place, widget in enumerate([] if held else list(self._widgets(driver))):
                if widget not in self._widgets(driver):
                    break
                driver.form.focus(widget)
                self._note(driver, f"{stop}, widget {place}")
                for number in range(len(widget.options)) if isinstance(widget, ChoiceRow) else ():
                    widget.choose(number)
                    self._note(driver, f"{stop}, widget {place}, option {number}")
        finally:
            driver.app.close()

    def _widgets(self, driver: Driver) -> list[Any]:
        form = getattr(driver.top, "form", None)
        return form.widgets if form else []

    def _open(self, make: Make) -> Driver:
        context, frames = (
            Context(self.user_dir, SettingsFile(self.user_dir).load(), rng=np.random.default_rng(1)),
            count(),
        )
        return Driver(App(context, make, now=lambda: next(frames) / 60, scene_of=scene_of, capped=False))

    def _note(self, driver: Driver, place: str) -> None:
        driver.frames(3)
        page = self._written.turn(driver.app.canvas)
        driver.app.draw()
        for note in page.notes:
            if note.code:
                continue
            self.seen.setdefault(note.text, place)
        for text, how in misplaced(page, driver.app.canvas.view):
            if how != "is cut short" or text not in self._whole:
                self.wrong.setdefault(f"{text} {how}", place)


def strings(value: object) -> Iterator[str]:
    """Yield all texts in a group of texts."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict | tuple):
        for each in value.values() if isinstance(value, dict) else value:
            yield from strings(each)


def main() -> None:
    """Walk, and write what was seen and what was wrong."""
    inline_worker.install(setattr)
    gc.freeze()  # as the game does: each scene that is left collects once
    setattr(pay, "DECISIONS", SHORT)  # noqa: B010 - it is final for all others
    for chapter in (TargetChapter, MemoryChapter, DaringChapter):
        chapter.LENGTH = SHORT_RUN
    with TemporaryDirectory() as folder:
        walk = Walk(Path(folder), sys.argv[2:])
        stock(Context(Path(folder), Settings(), rng=np.random.default_rng(1)))
        FLOWN.update(OTHERS)
        for stop in (*STOPS, *STATES):
            walk.visit(stop)
        json.dump({"seen": walk.seen, "wrong": walk.wrong}, sys.stdout)


if __name__ == "__main__":
    main()
