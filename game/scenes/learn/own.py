"""Chapter 11, your own: train a network, let it fly, hand over to it, race it; what is done ticks itself."""

from __future__ import annotations

import time
from collections.abc import Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
import pygame

from ai.agent.agent import DeepQAgent
from ai.nn import ModelFormatError
from ai.pilots.shelf import Shelf
from ai.training.history import History
from ai.training.loop import Training
from game.core import texts
from game.core.kept import Kept
from game.core.scene import Route, Transition, push
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import FAINT, HUMAN, INK, MUTE, SMALL, TITLE
from game.explain.figures import percent
from game.flight import networks
from game.flight import own as own_pilots
from game.flight.logbook import Records
from game.scenes.learn.chapter import Chapter, Code
from game.scenes.learn.path import Progress
from game.training.library import Library
from game.ui.context import Context
from game.ui.panel import Column

# Where each step is done; a race is begun here.
STEPS: Final = {"train": "train", "land": "runs", "choose": "runs", "hand": "play", "race": "", "file": ""}
_INDENT: Final = 32.0
_HALVES: Final[Kept[float | None]] = Kept(1)  # a page asks twice
_HALF: Final = 0.5  # share of flights that the question asks for
_FLIGHTS: Final = 100  # flights that a share is taken of, once there are so many
_ANSWERS: Final = (5.0, 60.0, 600.0, 3600.0)  # seconds of the answers


class Step(NamedTuple):
    """One step of the list: whether it is done, and what is known of it."""

    done: bool
    sentence: str


class OwnChapter(Chapter):
    """A list of steps with the player's own network, read from their files whenever the chapter comes to the top.

    Attributes:
        steps: the steps by their names in `STEPS`.

    """

    key, door, shape, listed = "own", Route("watch"), 0.0, True

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._library, self._records = Library(context.user_dir), Records(context.user_dir)
        self._shelf = Shelf(context.user_dir)
        self.restart()

    def restart(self) -> None:
        self._runs = [run for run in self._library.runs() if not run.problem or run.flyable]
        self.steps = self._found()
        self.tried = bool(self._runs or self._library.rescued())
        self.complete = all(step.done for step in self.steps.values())

    def enter(self) -> None:
        self.restart()

    def controls(self, column: Column) -> None:
        for name, route in STEPS.items():
            press = partial(push, route) if route else self._open_files if name == "file" else self.race
            column.button(texts.LEARN_OWN_DOORS[name], press)

    def _open_files(self) -> Transition:
        return push("pilots", partial(own_pilots.take, self.context))

    def race(self) -> Transition | None:
        """Race the latest of the player's networks that can be read."""
        for run in self._runs:
            policy = networks.load(run.name, run.folder).policy if run.flyable else None
            if policy is not None:
                Progress(self.context.settings).note(self.key, raced=int(time.time()) + 1)
                self.context.apply_settings()
                return push("play", rival=policy, rival_name=run.name)
        self.context.note(texts.LEARN_OWN_NONE)
        return None

    def _found(self) -> dict[str, Step]:
        """Return the steps, in the order of `STEPS`: whether each is done, and what is known of it."""
        runs, rescued, context = self._runs, self._library.rescued(), self.context
        first = runs[0] if runs else rescued
        measured = [run for run in (*runs, rescued) if run and run.success is not None]
        best = max(measured, key=lambda run: run.success or 0.0, default=None)
        landed = best.success or 0.0 if best else 0.0

        folders = networks.folders(context.models_dir, context.user_dir)
        own = {name for name, folder in folders.items() if folder.parent == context.user_dir / networks.PLAYERS}
        flies = context.settings.model

        flown = self._records.entries()
        shared = next((entry for entry in reversed(flown) if entry.network in own and entry.human < 1.0), None)
        raced_at = Progress(context.settings).raced
        raced = raced_at is not None and any(entry.when >= raced_at for entry in flown)

        files = []
        with suppress(OSError):
            files = self._shelf.measured()
        pilot = max(files, key=lambda each: each.landed, default=None)
        good = pilot is not None and pilot.landed >= own_pilots.GOOD
        return {
            "train": _step(
                bool(runs), "trained" if runs else "unnamed" if rescued else "untrained",
                name=first.name if first else "", decisions=f"{first.decisions if first else 0:,}",
            ),
            "land": _step(
                landed > 0, "unmeasured" if best is None else "landed_unnamed" if best is rescued else "landed",
                name=best.name if best else "", share=percent(landed),
            ),
            "choose": _step(flies in own, "chosen" if flies in own else "shipped", name=flies or networks.DEFAULT),
            "hand": _step(
                shared is not None, "handed" if shared else "alone",
                name=shared.network if shared else "", share=percent(1.0 - shared.human if shared else 0.0),
            ),
            "race": _step(raced, "raced" if raced else "unraced"),
            "file": _step(
                good, "written" if good else "flown" if pilot else "unwritten",
                name=pilot.name if pilot else "", share=percent(pilot.landed if pilot else 0.0),
            ),
        }  # fmt: skip

    @property
    def half(self) -> float | None:
        """Seconds of training after which half of the latest run's flights landed; None if that is not known."""
        return _HALVES.get(self._runs[0].folder, partial(_half_of, self._runs[0].folder)) if self._runs else None

    def verdict(self) -> int | None:
        """Return the answer next to the time that half of the flights took, by their ratio; None before they landed."""
        half = self.half
        if half is None:
            return None
        return int(np.argmin(np.abs(np.log(np.array(_ANSWERS) / max(half, 1.0)))))

    def why(self) -> str:
        if not self._runs:
            return self.steps["train"].sentence
        run, half = self._runs[0], self.half
        sentence = texts.LEARN_OWN_WHY.format(name=run.name, seconds=run.seconds, decisions=f"{run.decisions:,}")
        came = "" if half is None else texts.LEARN_OWN_HALF.format(seconds=max(round(half), 1))
        return " ".join(filter(None, (sentence, came, self.steps["land"].sentence)))

    def code(self) -> Sequence[Code]:
        return [Code(Training.advance, DeepQAgent.train_step), Code(DeepQAgent.train_step), Code(DeepQAgent.learn)]

    def below(self, column: Column) -> None:
        for name in STEPS:
            column.add(partial(self._write_step, name))
        column.text(
            lambda: texts.LEARN_OWN_DONE.format(done=sum(step.done for step in self.steps.values()), count=len(STEPS)),
            colour=MUTE,
        )

    def _write_step(self, name: str, cursor: Cursor) -> None:
        """Write a step behind a ring, or a full one once it is done."""
        step, size = self.steps[name], TITLE - 3
        if canvas := cursor.canvas:
            x, y = cursor.left + 10, cursor.y + 0.7 * size
            if step.done:
                canvas.dot((x, y), 8, canvas.palette.good)
                canvas.marker("check", (x, y), 9, (0, 0, 0))
            else:
                canvas.outline((x - 7, y - 7, 14, 14), 7, FAINT, 1.5)
        cursor.styled(texts.LEARN_OWN_STEPS[name], size, INK if step.done else MUTE, "light", indent=_INDENT)
        cursor.styled(step.sentence, SMALL, HUMAN if step.done else MUTE, indent=_INDENT)
        cursor.gap(14)

    def draw(self, canvas: Canvas, box: pygame.FRect, alpha: float) -> None:
        """Draw nothing: the list is all there is."""


def _step(done: bool, key: str, **figures: str) -> Step:
    return Step(done, texts.LEARN_OWN_TOLD[key].format(**figures))


def _half_of(folder: Path) -> float | None:
    """Return the seconds after which half of a run's flights landed, by its history; None if they never did."""
    try:
        history = History.read(folder)
    except ModelFormatError:
        return None
    reached = np.flatnonzero((history["success"] >= _HALF) & (history["episodes"] >= _FLIGHTS))
    return float(history["seconds"][reached[0]]) if len(reached) else None
