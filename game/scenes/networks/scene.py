"""Networks scene: the player's networks, the game's and the player's own files in one list, and what can be done."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Final

import pygame

from game.core import texts
from game.core.scene import Pop, Push, Transition, push
from game.core.shelf import LibraryError
from game.drawing.cursor import LEADING, Cursor
from game.drawing.tokens import HUMAN, LABEL, MUTE, NET, SMALL, TITLE
from game.explain.figures import percent
from game.flight import networks, own
from game.scenes.menus.dialogs import NameDialog, QuestionDialog
from game.scenes.networks.files import OwnFile, OwnFiles
from game.training.library import Library, SavedRun, read_run
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.listing import Row
from game.ui.panel import Column, Panel
from game.ui.panel_scene import PanelScene
from game.ui.widget import OnPress

_LEAST: Final = 300.0  # points of a column
_CELLS: Final = (224.0, 124.0, 0.0)  # from the right end of the list: where landed, decisions and date end
_BAR: Final = 15.0  # points at the right of a list for its scroll bar
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
        self.chosen: SavedRun | OwnFile | None = None
        self._names: dict[Path, str] = {}
        self._read()
        if choose:
            known = networks.folders(context.models_dir, context.user_dir)
            own_file = context.pilot.path if context.pilot and context.pilot.chosen else None
            self._reload(own_file or known.get(context.settings.model, known.get(networks.DEFAULT)))
        else:
            self._reload()

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
        """Move, choose, go back; Delete and F2 do what they do elsewhere."""
        verbs = [Action(pygame.K_DELETE, self._delete), Action(pygame.K_F2, self._rename)] if self._is_own else []
        return [self.form.moves, *super().actions(), *verbs]

    # What there is

    @property
    def _is_own(self) -> bool:
        """Whether a run of the player's is chosen."""
        return isinstance(self.chosen, SavedRun) and self.chosen.folder.parent == self._library.folder

    def _is_shipped(self, run: SavedRun | OwnFile) -> bool:
        return run.folder.is_relative_to(self.context.models_dir)

    def _read(self) -> None:
        """Read from disk what there is."""
        context = self.context
        runs = self._library.runs()
        known = networks.folders(context.models_dir, context.user_dir)
        shipped = [read_run(folder, name) for name, folder in known.items() if folder.parent != self._library.folder]
        self._names = {folder: name for name, folder in known.items()}
        self.items: list[SavedRun | OwnFile] = [*runs, *self.files.read(), *shipped]
        kept = texts.RUNS_PLACE.format(folder=self._library.folder) if runs else texts.RUNS_NONE
        self.line = self._library.problem or kept

    def _reload(self, wanted: Path | None = None) -> None:
        """Read again, and choose a run: by default the one chosen before, or what is in its place now."""
        before = next((n for n, run in enumerate(self.items) if run == self.chosen), 0)
        wanted = wanted or (self.chosen.folder if self.chosen else None)
        self._read()
        place = next((n for n, run in enumerate(self.items) if run.folder == wanted), min(before, len(self.items) - 1))
        self.chosen = self.items[place] if self.items else None
        self.build()
        self.form.focus(self._list)

    # Rows

    def describe(self, panel: Panel) -> None:
        """Add the list, and the chosen run."""
        panel.title(texts.RUNS_CHOOSE_TITLE if self._choose else texts.RUNS_TITLE)
        panel.aside(self.line)
        panel.gap(4)
        left, right = panel.beside((3, 2), _LEAST, 48.0)
        left.add(partial(_write_headings, texts.RUNS_COLUMNS, _CELLS))
        rows = [row(run, self._is_shipped(run)) for run in self.items]
        index = self.items.index(self.chosen) if self.chosen else 0
        self._list = left.listing(
            rows, lambda _: self._press_row(), texts.RUNS_NOTHING, around=_AROUND, columns=_CELLS, pitch=_PITCH,
            on_choose=self._choose_row, index=index,
        )  # fmt: skip
        left.words([(texts.PILOTS_NEW, self._new), (texts.BACK, Pop)])
        if self.files.said and not isinstance(self.chosen, OwnFile):
            left.text(self.files.said, size=SMALL, colour=HUMAN)
        self._describe_chosen(right)

    def _describe_chosen(self, column: Column) -> None:
        """Add the chosen run: its name, its figures, and what can be done with it."""
        run = self.chosen
        if run is None:
            return
        column.text(run.name, size=TITLE)
        if isinstance(run, OwnFile):
            self._describe_verbs(column)
            self.files.describe(column, run)
            return
        if run.problem:
            column.text(run.problem, size=SMALL, colour=HUMAN)
        else:
            column.aside(_made(run))
            for label, figure in zip(texts.RUN_FIGURES, _figures(run), strict=True):
                column.pair(label, figure, MUTE)
            if self._is_own and run.success is not None:
                column.aside(texts.RUN_TESTED)
        saved = time.strftime("%Y-%m-%d %H:%M", time.localtime(run.saved))
        column.aside(texts.RUN_SHIPPED if self._is_shipped(run) else texts.RUN_SAVED.format(when=saved))
        if self._names.get(run.folder) == (self.context.settings.model or networks.DEFAULT):
            column.text(texts.RUN_FLIES, size=SMALL, colour=NET)
        self._describe_verbs(column)

    def _describe_verbs(self, column: Column) -> None:
        column.gap(8)
        for word, press in self.verbs:
            column.button(word, press).pad = 4.0

    @property
    def verbs(self) -> list[tuple[str, OnPress]]:
        """What can be done with the chosen run, in words, and what each does."""
        run, verbs = self.chosen, list[tuple[str, OnPress]]()
        if run is None:
            return verbs
        if isinstance(run, OwnFile):
            path = run.folder
            fly: list[tuple[str, OnPress]] = (
                [(texts.RUN_CHOOSE, self._take)] if self._choose
                else [(texts.RUN_WATCH, lambda: self._fly("watch")), (texts.RUN_FLY, lambda: self._fly("play"))]
            )  # fmt: skip
            measure = (texts.PILOTS_CANCEL, self.files.cancel) if self.files.measuring else (
                texts.PILOTS_MEASURE, lambda: self._do(self.files.measure, path))  # fmt: skip
            edit: tuple[str, OnPress] = (texts.PILOTS_EDIT, lambda: self._do(self.files.edit, path))
            return [*fly, edit, measure, (texts.PILOTS_RACE, partial(self._race, path))]
        if run.flyable and self._choose:
            verbs.append((texts.RUN_CHOOSE, self._take))
        elif run.flyable:
            verbs += [(texts.RUN_WATCH, lambda: self._fly("watch")), (texts.RUN_FLY, lambda: self._fly("play"))]
        if run.resumable and not self._choose:
            verbs.append((texts.RUN_TRAIN, lambda: self._train(run.folder)))
        if self._is_own:
            verbs += [(texts.RUN_RENAME, self._rename), (texts.RUN_DELETE, self._delete)]
        return verbs

    def _choose_row(self, number: int) -> None:
        self.chosen = self.items[number]
        self.build()

    def _press_row(self) -> Transition | None:
        """Choose the network where one is asked for; elsewhere, move the focus to the actions."""
        if self._choose:
            return self._take()
        if verbs := self.verbs:
            self.form.focus(next(each for each in self.form.widgets if each.label == verbs[0][0]))
        return None

    # What can be done

    def _take(self) -> Transition | None:
        chosen, choose = self.chosen, self._choose
        if choose is None or chosen is None:
            return None
        if isinstance(chosen, OwnFile):
            choose(chosen.name, chosen.folder)
        elif chosen.flyable:
            choose(self._names[chosen.folder])
        else:
            return None
        return Pop()

    def _new(self) -> None:
        """Make a file of the player's own, and choose it."""
        self._reload(self.files.new())

    def _do(self, act: Callable[[Path], None], path: Path) -> None:
        act(path)
        self.build()

    def _race(self, path: Path) -> Transition:
        own.take(self.context, path)
        return push("play", rival=self.context.pilot, rival_name=path.name)

    def _fly(self, route: str) -> Transition:
        self._make_pilot()
        return push(route)

    def _make_pilot(self) -> None:
        assert self.chosen is not None
        if isinstance(self.chosen, OwnFile):
            own.take(self.context, self.chosen.folder)
            return
        if self.context.pilot:
            self.context.pilot.chosen = False
        self.context.settings.model = self._names[self.chosen.folder]
        self.context.apply_settings()

    def _rename(self) -> Transition:
        """Ask for another name; a player without a keyboard is offered one made of the figures."""
        run = self.chosen
        assert isinstance(run, SavedRun)
        name = suggestion(self._library, run) if self.context.controls.gamepad_in_use else run.name
        return Push(NameDialog(self, texts.NAMING, name, partial(self._rename_to, run)))

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

    def _delete(self) -> Transition:
        """Ask whether the chosen run is to go for good."""
        run = self.chosen
        assert isinstance(run, SavedRun)
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


def _write_headings(words: Sequence[str], columns: Sequence[float], cursor: Cursor) -> None:
    """Write the headings of a list: the first on the left, the others over the ends of their columns."""
    small = cursor.in_style(LABEL, MUTE, "medium")
    if canvas := cursor.canvas:
        ends = [cursor.right - column - _BAR for column in columns]
        canvas.text(words[0], (cursor.left, small.baseline), size=LABEL, colour=MUTE, weight="medium")
        for word, end in zip(words[1:], ends, strict=True):
            canvas.text(word, (end, small.baseline), size=LABEL, colour=MUTE, weight="medium", align="right")
    cursor.gap(LEADING * LABEL)


def row(run: SavedRun | OwnFile, shipped: bool) -> Row:
    """Return the row of a network: name, landing rate, decisions learnt from, and date saved."""
    if isinstance(run, OwnFile):
        measured = run.measured
        landed = percent(measured.landed, 1) if measured and not measured.stale(run.folder) else "–"
        return run.name, landed, "–", texts.RUNS_FILE
    saved = texts.RUNS_SHIPPED if shipped else time.strftime("%Y-%m-%d", time.localtime(run.saved))
    landed, decisions, _ = ("–", "–", "") if run.problem else _figures(run)
    return run.name, landed, decisions, saved


def suggestion(library: Library, run: SavedRun) -> str:
    """Suggest a name from a run's figures, for players without a keyboard."""
    if run.problem:
        return library.free_name(run.name)
    landed, decisions, _ = (figure.replace(" ", "").removesuffix("%") for figure in _figures(run))
    return library.free_name(texts.RUN_SUGGESTION.format(preset=run.preset, decisions=decisions, percent=landed))


def _made(run: SavedRun) -> str:
    settings = texts.RUN_SETTINGS if run.changes else texts.RUN_AS_IS
    return texts.RUN_SEED.format(settings=settings.format(preset=run.preset, count=run.changes), seed=run.seed)


def _figures(run: SavedRun) -> tuple[str, str, str]:
    """Return the share that landed, the decisions and the time of a run, each with its unit."""
    landed = "–" if run.success is None else f"{100 * run.success:.1f} %"
    count = f"{run.decisions / 1e6:.1f} M" if run.decisions >= 1_000_000 else f"{run.decisions / 1e3:.0f} k"
    took = f"{run.seconds:.0f} s" if run.seconds < 120 else f"{run.seconds / 60:.0f} min"
    return landed, count if run.decisions >= 1000 else str(run.decisions), took
