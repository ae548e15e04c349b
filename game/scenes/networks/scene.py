"""Networks scene: the player's networks, the game's and the player's own files in one list, and what can be done."""

from __future__ import annotations

import time
from collections.abc import Callable, Hashable
from functools import partial
from pathlib import Path
from typing import Final

import pygame

from game.core import texts
from game.core.scene import Pop, Push, Transition, push
from game.core.shelf import LibraryError
from game.drawing.tokens import HUMAN, MUTE, NET, SMALL, TITLE
from game.flight import networks, own
from game.scenes.menus.dialogs import NameDialog, QuestionDialog
from game.scenes.networks.files import OwnFiles
from game.training.library import Library, SavedRun, read_run
from game.ui.actions import Table
from game.ui.context import Context
from game.ui.panel import Column, Panel
from game.ui.panel_scene import PanelScene
from game.ui.widget import OnPress

_LEAST: Final = 300.0  # points of a column
_CELLS: Final = (124.0, 0.0)  # from the right end of the list: where landed and date end
_PITCH, _AROUND = 30.0, 190.0  # points of a row of the list, and of all around the list


class NetworksScene(PanelScene):
    """A list; beside it, or below, the chosen run, its figures and what can be done with it.

    Args:
        choose: called with the name of what is chosen, and with its path if it is a file of the player's own; the
            scene then closes. Without it, a network can be watched, flown with and trained further from here.
        train: function that resumes training from a run's folder; by default, a Train scene of its own.

    Attributes:
        items: what is listed.
        chosen: what is chosen; None if there is nothing.
        files: the player's own files.

    """

    takes_files = True

    def __init__(
        self,
        context: Context,
        choose: Callable[..., None] | None = None,
        train: Callable[[Path], Transition] | None = None,
    ) -> None:
        super().__init__(context)
        self._choose, self._train = choose, train or (lambda folder: push("train", resume=folder))
        self._library = Library(context.user_dir)
        self.files = OwnFiles(context)
        self.items: list[SavedRun] = []
        self.chosen: SavedRun | None = None
        flies = None
        if choose:
            known = networks.folders(context.models_dir, context.user_dir)
            flies = known.get(context.settings.model, known.get(networks.DEFAULT))
            if context.pilot and context.pilot.chosen:
                flies = context.pilot.path
        self._reload(flies)

    def enter(self) -> None:
        """Read again what there is, which the scene above may have changed."""
        self._reload()

    def close(self) -> None:
        """End a measurement."""
        self.files.cancel()

    def update(self) -> Transition | None:
        """Follow a measurement."""
        if self.files.update():
            self._reload()
        return super().update()

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Leave it to the actions and the widgets; a folder can be dropped here."""
        if event.type == pygame.DROPFILE:
            self._import(Path(event.file))
        return super().handle_event(event)

    def actions(self) -> Table:
        return [self.form.moves, *super().actions()]

    # What there is

    def _is_own(self, run: SavedRun) -> bool:
        """Whether a run is the player's."""
        return run.folder.parent == self._library.folder

    def _is_file(self, run: SavedRun) -> bool:
        """Whether it is a file of the player's own."""
        return not self._is_own(run) and run.folder not in self._names

    def _reload(self, wanted: Path | None = None) -> None:
        """Read from disk what there is, and choose a run: the one chosen before, or what is in its place now."""
        context, own_runs = self.context, self._library.folder
        before = self.items.index(self.chosen) if self.chosen else 0
        wanted = wanted or (self.chosen.folder if self.chosen else None)
        known = networks.folders(context.models_dir, context.user_dir)
        self._names = {folder: name for name, folder in known.items()}
        shipped = [read_run(folder, name) for name, folder in known.items() if folder.parent != own_runs]
        self.items = [*self._library.runs(), *self.files.read(), *shipped]
        place = next((n for n, run in enumerate(self.items) if run.folder == wanted), min(before, len(self.items) - 1))
        self.chosen = self.items[place] if self.items else None
        self.build()
        self.form.focus(self._list)

    # Rows

    def state(self) -> Hashable:
        return super().state(), self.chosen, self.files.measuring

    def describe(self, panel: Panel) -> None:
        """Add the list, and the chosen run."""
        panel.title(texts.RUNS_CHOOSE_TITLE if self._choose else texts.RUNS_TITLE)
        panel.aside(self._library.problem or texts.RUNS_PLACE.format(folder=self._library.folder))
        panel.gap(4)
        left, right = panel.beside((3, 2), _LEAST, 48.0)
        self._list = left.listing(
            [(run.name, _landed(run), self._saved(run)) for run in self.items], lambda _: self._press_row(),
            texts.RUNS_NOTHING, around=_AROUND, columns=_CELLS, pitch=_PITCH, on_choose=self._choose_row,
            index=self.items.index(self.chosen) if self.chosen else 0,
        )  # fmt: skip
        left.words([(texts.PILOTS_NEW, self._new), (texts.BACK, Pop)])
        if self.chosen:
            self._describe_chosen(right, self.chosen)

    def _saved(self, run: SavedRun) -> str:
        """Return when a run was saved, or whence it is."""
        if self._is_file(run):
            return texts.RUNS_FILE
        return time.strftime("%Y-%m-%d", time.localtime(run.saved)) if self._is_own(run) else texts.RUNS_SHIPPED

    def _describe_chosen(self, column: Column, run: SavedRun) -> None:
        """Add the chosen run: its name, its figures, and what can be done with it."""
        column.text(run.name, size=TITLE)
        if run.problem:
            column.text(run.problem, size=SMALL, colour=HUMAN)
        else:
            if self._is_own(run):
                made = texts.RUN_SETTINGS if run.changes else texts.RUN_AS_IS
                column.aside(made.format(preset=run.preset, count=run.changes))
            figures = (_landed(run),) if self._is_file(run) else (_landed(run), *_learnt(run))
            for label, figure in zip(texts.RUN_FIGURES, figures, strict=False):
                column.pair(label, figure, MUTE)
        if self._names.get(run.folder) == (self.context.settings.model or networks.DEFAULT):
            column.text(texts.RUN_FLIES, size=SMALL, colour=NET)
        column.gap(8)
        for word, press in self.verbs:
            column.button(word, press).pad = 4.0
        if self._is_file(run):
            self.files.describe(column, run.folder)

    @property
    def verbs(self) -> list[tuple[str, OnPress]]:
        """What can be done with the chosen run, in words, and what each does."""
        run, verbs = self.chosen, list[tuple[str, OnPress]]()
        if run is None:
            return verbs
        if run.flyable and self._choose:
            verbs.append((texts.RUN_CHOOSE, self._take))
        elif run.flyable:
            verbs += [(texts.RUN_WATCH, partial(self._fly, "watch")), (texts.RUN_FLY, partial(self._fly, "play"))]
        if run.resumable and not self._choose:
            verbs.append((texts.RUN_TRAIN, lambda: self._train(run.folder)))
        if self._is_own(run):
            verbs += [(texts.RUN_RENAME, partial(self._rename, run)), (texts.RUN_DELETE, partial(self._delete, run))]
        if self._is_file(run):
            verbs.append((texts.PILOTS_EDIT, partial(self.files.edit, run.folder)))
            verbs.append(
                (texts.PILOTS_CANCEL, self.files.cancel) if self.files.measuring
                else (texts.PILOTS_MEASURE, partial(self.files.measure, run.folder))
            )  # fmt: skip
        return verbs

    def _choose_row(self, number: int) -> None:
        self.chosen = self.items[number]

    def _press_row(self) -> Transition | None:
        """Choose the network where one is asked for; elsewhere, move the focus to the actions."""
        if self._choose:
            return self._take()
        if verbs := self.verbs:
            self.form.focus(next(each for each in self.form.widgets if each.label == verbs[0][0]))
        return None

    # What can be done

    def _take(self) -> Transition | None:
        run = self.chosen
        if self._choose is None or run is None or not run.flyable:
            return None
        self._choose(*((run.name, run.folder) if self._is_file(run) else (self._names[run.folder],)))
        return Pop()

    def _new(self) -> None:
        """Make a file of the player's own, and choose it."""
        self._reload(self.files.new())

    def _fly(self, route: str) -> Transition:
        self._make_pilot()
        return push(route)

    def _make_pilot(self) -> None:
        run = self.chosen
        assert run is not None
        if self._is_file(run):
            own.take(self.context, run.folder)
            return
        if self.context.pilot:
            self.context.pilot.chosen = False
        self.context.settings.model = self._names[run.folder]
        self.context.apply_settings()

    def _rename(self, run: SavedRun) -> Transition:
        """Ask for another name."""
        return Push(NameDialog(self, texts.NAMING, run.name, partial(self._rename_to, run)))

    def _rename_to(self, run: SavedRun, name: str) -> str:
        """Rename a run; return why that failed, or ""."""
        flies = self.context.settings.model == self._names.get(run.folder)
        try:
            renamed = self._library.rename(run.name, name)
        except LibraryError as error:
            return str(error)
        self._reload(renamed)
        if flies:
            self._make_pilot()
        return ""

    def _delete(self, run: SavedRun) -> Transition:
        """Ask whether a run is to go for good."""
        answers: list[tuple[str, Callable[[], None]]] = [
            (texts.RUN_KEEP, lambda: None),
            (texts.RUN_DELETE, partial(self._delete_now, run)),
        ]
        return Push(QuestionDialog(self, texts.RUN_DELETE_QUESTION.format(name=run.name), "", answers))

    def _delete_now(self, run: SavedRun) -> None:
        try:
            self._library.delete(run.name)
        except LibraryError as error:
            self.context.note(str(error))
        self._reload()

    def _import(self, path: Path) -> None:
        try:
            folder = self._library.import_folder(path)
        except LibraryError as error:
            self.context.note(str(error))
            return
        self._reload(folder)
        self.context.note(texts.RUN_IMPORTED.format(name=folder.name))


def _landed(run: SavedRun) -> str:
    """Return the share that landed in tests, with its unit."""
    return "–" if run.success is None or run.problem else f"{100 * run.success:.1f} %"


def _learnt(run: SavedRun) -> tuple[str, str]:
    """Return the decisions and the time of a run, each with its unit."""
    count = f"{run.decisions / 1e6:.1f} M" if run.decisions >= 1_000_000 else f"{run.decisions / 1e3:.0f} k"
    took = f"{run.seconds:.0f} s" if run.seconds < 120 else f"{run.seconds / 60:.0f} min"
    return count if run.decisions >= 1000 else str(run.decisions), took
