"""Your pilots: the player's own files, to make, edit, measure and fly."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from threading import Thread
from typing import Final

from ai.pilots.folder import Measured, PilotFolder
from ai.pilots.own import LOADING
from game.core import texts
from game.core.scene import Pop, Transition, push
from game.core.worker import Worker, WorkerState
from game.drawing.tokens import HUMAN, INK, MUTE, TEXT
from game.explain.figures import percent
from game.flight import own
from game.ui.context import Context
from game.ui.panel import Column, Panel
from game.ui.panel_scene import PanelScene

_LEAST: Final = 360.0  # points of a column


class PilotsScene(PanelScene):
    """The player's pilots, and all about the one that is chosen.

    Args:
        choose: called with the file that is to fly; the scene then closes.
        now: the file that flies already.

    """

    def __init__(self, context: Context, choose: Callable[[Path], None], now: Path | None = None) -> None:
        super().__init__(context)
        self._choose = choose
        self._own = PilotFolder(context.user_dir)
        self._name, self._said = now.stem if now else "", ""
        self._worker: Worker | None = None
        self._share = 0.0  # how much is measured
        self.enter()

    def enter(self) -> None:
        """Look again at what files there are, and how they were measured last."""
        self._files: dict[str, Path] = {}
        self._measured: dict[str, Measured] = {}
        try:
            self._files = self._own.files()
            self._measured = {each.name: each for each in self._own.measured()}
        except OSError as error:
            self._said = texts.PILOTS_UNREADABLE.format(path=self._own.folder, reason=error.strerror or error)
        if self._name not in self._files:
            self._name = next(iter(self._files), "")
        self.build()

    def close(self) -> None:
        """End a measurement."""
        if self._worker:
            self._worker.close()

    def describe(self, panel: Panel) -> None:
        """Add the files on the left, and the chosen one on the right."""
        panel.title(texts.PILOTS_OPEN)
        panel.aside(texts.PILOTS_WHAT)
        panel.aside(texts.PILOTS_NO_SANDBOX)
        panel.gap()
        left, right = panel.beside((1, 1.5), _LEAST)
        for name in self._files:
            latest = self._measured.get(name)
            left.button(
                name,
                partial(self._show, name),
                figure=percent(latest.landed) if latest else "",
                colour=INK if name == self._name else MUTE,
            )
        left.button(texts.PILOTS_NEW, self._new)
        if self._said:
            left.gap()
            left.text(self._said, size=TEXT, colour=HUMAN)
        if self._name:
            self._describe_one(right)

    def _describe_one(self, column: Column) -> None:
        path = self._files[self._name]
        column.text(self._name, size=22.0, weight="light")
        column.aside(str(path))
        measure = (texts.PILOTS_CANCEL, self.close) if self._worker else (texts.PILOTS_MEASURE, self._measure)
        fly, change = (texts.PILOTS_FLY, self._use), (texts.PILOTS_EDIT, self._edit)
        column.words([fly, change, (texts.PILOTS_RACE, self._race), measure])
        if self._worker:
            words = texts.PILOTS_MEASURING
            column.aside(lambda: words[self._share > 0].format(count=own.STARTS, seconds=LOADING))
            column.bar(lambda: self._share)
        elif latest := self._measured.get(self._name):
            column.text(lambda: texts.PILOTS_STALE if latest.stale(path) else _figures(latest), size=TEXT, colour=HUMAN)

    # What can be done

    def _show(self, name: str) -> None:
        """Choose a file, and go on to what can be done with it."""
        self._name, self._said = name, ""
        self.build()
        self.form.focus(next(each for each in self.form.widgets if each.label == texts.PILOTS_FLY))

    def _new(self) -> None:
        try:
            path = self._own.new()
        except OSError as error:
            self._said = texts.PILOTS_NOT_WRITTEN.format(path=self._own.folder, reason=error.strerror or error)
            self.build()
            return
        self._name = path.stem
        self.enter()
        self._edit()

    def _edit(self) -> None:
        path = self._files[self._name]
        try:
            edit(path)
            self._said = texts.PILOTS_OPENED.format(path=path)
        except OSError:
            self._said = texts.PILOTS_NO_EDITOR.format(path=path)
        self.build()

    def _use(self) -> Transition:
        self._choose(self._files[self._name])
        return Pop()

    def _race(self) -> Transition:
        own.take(self.context, self._files[self._name])
        return push("play", rival=self.context.pilot, rival_name=self._name)

    def _measure(self) -> None:
        self._share, self._said = 0.0, ""
        self._worker = Worker(own.measure, self.context.user_dir, self._files[self._name])
        self.build()

    def update(self) -> Transition | None:
        """Follow a measurement."""
        worker = self._worker
        if worker:
            for share in worker.poll():
                self._share = share
            if worker.state in (WorkerState.ENDED, WorkerState.FAILED) and worker.gone:
                self._worker, self._said = None, worker.problem
                self.enter()
        return super().update()


def _figures(measured: Measured) -> str:
    """Say in one line how a pilot flew."""
    landed, seconds, fuel = percent(measured.landed, 1), f"{measured.seconds:.1f}", f"{measured.fuel:.1f}"
    return texts.PILOTS_FIGURES.format(count=own.STARTS, landed=landed, seconds=seconds, fuel=fuel)


def edit(path: Path) -> None:
    """Open a file in the system's editor; raises OSError if there is none. It never runs the file."""
    if sys.platform == "win32":
        os.startfile(path, "edit")  # "open" would run it
        return
    command = ["open", "-t"] if sys.platform == "darwin" else ["xdg-open"]
    void = subprocess.DEVNULL
    editor = subprocess.Popen([*command, str(path)], stdin=void, stdout=void, stderr=void, start_new_session=True)
    Thread(target=editor.wait, daemon=True).start()
