"""Networks scene: saved runs and shipped networks, with the actions on each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Final

import pygame

from game.core import texts
from game.core.names import LONGEST_NAME, LibraryError, fitting
from game.core.scene import Pop, Transition, push
from game.drawing.canvas import Canvas
from game.drawing.tokens import MARGIN, TITLE, VIEW_SIZE
from game.flight import networks
from game.flight.study_runs import studies
from game.input.controls import Command
from game.scenes.train.run_page import draw_run, row, suggestion
from game.training.library import Library, SavedRun, read_run
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.entry import Entry
from game.ui.list_scene import VERB_LINE, VERB_SIZE, ListLayout, ListScene
from game.ui.listing import Row
from game.ui.widget import OnPress, Widget
from game.ui.widgets import TextButton

_LEFT: Final = 824  # of what is said of the chosen run
_LAYOUT: Final = ListLayout(
    box=pygame.Rect(MARGIN, 168, 672, 408),
    columns=(232.0, 112.0, 0.0),
    headings=lambda: texts.RUNS_COLUMNS,
    pitch=34,
    verbs=(_LEFT, 340),
    foot=608,
)
_WIDTH: Final = VIEW_SIZE[0] - MARGIN - _LEFT


class NetworksScene(ListScene[SavedRun]):
    """A list on the left; the chosen run, its figures and its verbs on the right.

    Args:
        choose: called with the name of the chosen network; the scene then closes. Without it, a run can be
            watched, flown with and trained further from here.
        train: function that resumes training from a run's folder; by default, a Train scene of its own.

    """

    takes_files = True

    def __init__(
        self,
        context: Context,
        choose: Callable[[str], None] | None = None,
        train: Callable[[Path], Transition] | None = None,
    ) -> None:
        title = texts.RUNS_CHOOSE_TITLE if choose else texts.RUNS_TITLE
        super().__init__(context, title, _LAYOUT, self._back, empty=texts.RUNS_NOTHING)
        self._choose, self._train = choose, train or _train_on
        self._entry: Entry | None = None
        self._library = Library(context.user_dir)
        known = networks.folders(context.models_dir, context.user_dir)
        flies = known.get(context.settings.model, known.get(networks.DEFAULT))
        self._reload(flies if self._choose else None)

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Leave it to the actions and the widgets; a folder can be dropped here."""
        if event.type == pygame.DROPFILE:
            self._import(Path(event.file))
        return super().handle_event(event)

    def actions(self) -> Table:
        """Move, choose, go back; Delete and F2 do what they do elsewhere. While a name is typed, keep or leave it."""
        if self._entry:
            confirm = texts.HINT_KEEP_NAME if self.form.typing else texts.HINT_CHOOSE
            return [self.form.confirms(confirm), Action(Command.BACK, self._end_naming, texts.HINT_LEAVE_NAME)]
        own = [Action(pygame.K_DELETE, self._delete), Action(pygame.K_F2, self._begin_naming)] if self._is_own else []
        return [*super().actions(), *own]

    # What there is

    @property
    def _is_own(self) -> bool:
        """Whether the chosen run is the player's, and not the game's."""
        return self.chosen is not None and self._owns(self.chosen)

    def _owns(self, run: SavedRun) -> bool:
        return run.folder.parent == self._library.folder

    def _is_shipped(self, run: SavedRun) -> bool:
        return run.folder.is_relative_to(self.context.models_dir)

    def _identity(self, run: SavedRun) -> Path:
        return run.folder

    def _row(self, run: SavedRun) -> Row:
        return row(run, own=not self._is_shipped(run))

    def _reload(self, wanted: Path | None = None) -> None:
        """Reload from disk, and choose a run, by default the one chosen before or now in its place in the list."""
        context = self.context
        own = self._library.runs()
        known = networks.folders(context.models_dir, context.user_dir)
        others = [read_run(folder, name) for name, folder in known.items() if folder.parent != self._library.folder]
        # What a study has found stays as it is: to train it further, there is the command.
        shipped = [replace(run, resumable=run.resumable and self._is_shipped(run)) for run in others]
        self._names = {folder: name for name, folder in known.items()}
        self._line = self._library.problem or (
            texts.RUNS_PLACE.format(folder=self._library.folder) if own else texts.RUNS_NONE
        )
        self._has_studies = bool(studies(context.user_dir))
        self._entry = None
        self._show([*own, *shipped], wanted or (self.chosen and self.chosen.folder), self._list.index)

    def _make_verbs(self) -> list[Widget]:
        """Return the entry of a name, if it is being typed, and buttons for what can be done with the chosen run."""
        if self._entry:
            words: list[tuple[str, OnPress]] = [
                (texts.RUN_KEEP_NAME, self._entry_done),
                (texts.RUN_LEAVE_NAME, self._end_naming),
            ]
            return [self._entry, *self._buttons(words)]
        rows: list[tuple[str, OnPress]] = []
        if run := self.chosen:
            if run.flyable and self._choose:
                rows.append((texts.RUN_CHOOSE, self._take))
            elif run.flyable:
                rows += [(texts.RUN_WATCH, self._watch), (texts.RUN_FLY, self._fly)]
            if run.resumable and not self._choose:
                rows.append((texts.RUN_TRAIN, lambda: self._train(run.folder)))
            if self._is_own:
                rows += [
                    (texts.RUN_RENAME, self._begin_naming),
                    (texts.RUN_EXPORT, self._export),
                    (texts.RUN_DELETE, self._delete),
                ]
        return self._buttons(rows)

    def _below_list(self) -> list[Widget]:
        """Return the button that goes back, and the one that brings back the run deleted last."""
        foot = super()._below_list()
        if self._has_studies and not self._choose:
            box = (_LAYOUT.box.right - 240, _LAYOUT.foot, 240, VERB_LINE)
            foot.append(TextButton(self.form.manager, box, texts.STUDY_OPEN, lambda: push("study"), size=VERB_SIZE))
        if deleted := self._library.last_deleted:
            box = (MARGIN + 120, _LAYOUT.foot, 300 if self._has_studies else 520, VERB_LINE)
            label = texts.RUN_RESTORE.format(name=deleted)
            foot.append(TextButton(self.form.manager, box, label, self._restore, size=18))
        return foot

    # What can be done

    def _choose_row(self) -> None:
        self._entry = None
        self._offer()

    def _press_row(self) -> Transition | None:
        """Choose the network where one is asked for; elsewhere, move the focus to the actions."""
        if self._choose:
            return self._take()
        if self._verbs:
            self.form.focus(self._verbs[0])
        return None

    def _back(self) -> Transition | None:
        if not self._entry:
            return Pop()
        self._end_naming()
        return None

    def _take(self) -> Transition | None:
        if not self.chosen or not self.chosen.flyable or self._choose is None:
            return None
        self._choose(self._names[self.chosen.folder])
        return Pop()

    def _make_pilot(self) -> None:
        assert self.chosen is not None
        self.context.settings.model = self._names[self.chosen.folder]
        self.context.apply_settings()

    def _watch(self) -> Transition:
        self._make_pilot()
        return push("watch")

    def _fly(self) -> Transition:
        self._make_pilot()
        return push("play")

    def _begin_naming(self) -> None:
        run, context = self.chosen, self.context
        assert run is not None
        text = suggestion(self._library, run) if context.controls.gamepad_in_use else run.name
        self._entry = Entry(
            self.form.manager, (_LEFT, 140, _WIDTH, 34), texts.RUN_NAME, text, self._rename,
            on_cancel=self._end_naming, limit=LONGEST_NAME, fits=fitting, size=TITLE,
        )  # fmt: skip
        self._offer()
        self.form.focus(self._entry)
        self._entry.begin()

    def _entry_done(self) -> None:
        assert self._entry is not None
        self._rename(self._entry.text.strip())

    def _rename(self, name: str) -> None:
        """Rename the run; explain an invalid name and let the player edit it."""
        run, context = self.chosen, self.context
        assert run is not None
        try:
            renamed = self._library.rename(run.name, name)
        except LibraryError as error:
            context.note(str(error))
            if self._entry:
                self.form.focus(self._entry)
                self._entry.begin()
            return
        flies = context.settings.model == self._names[run.folder]
        self._reload(renamed)
        self.form.focus(self._list)
        if flies:
            self._make_pilot()

    def _end_naming(self) -> None:
        self._entry = None
        self._offer()
        self.form.focus(self._list)

    def _export(self) -> None:
        run = self.chosen
        assert run is not None
        self.context.note(_result(lambda: texts.RUN_EXPORTED.format(path=self._library.export(run.name))))

    def _delete(self) -> None:
        run = self.chosen
        assert run is not None

        def delete() -> str:
            self._library.delete(run.name)
            return texts.RUN_DELETED.format(name=run.name)

        self._report(_result(delete))

    def _restore(self) -> None:
        def restore() -> str:
            run = self._library.undo_delete()
            self._reload(run)
            return texts.RUN_RESTORED.format(name=run.name) if run else ""

        self.context.note(_result(restore))
        self.form.focus(self._list)

    def _import(self, path: Path) -> None:
        def copy() -> str:
            run = self._library.import_folder(path)
            self._reload(run)
            return texts.RUN_IMPORTED.format(name=run.name)

        self.context.note(_result(copy))

    def _draw_chosen(self, canvas: Canvas) -> None:
        """Draw the chosen run's name and figures."""
        if run := self.chosen:
            flies = self._names.get(run.folder) == (self.context.settings.model or networks.DEFAULT)
            draw_run(canvas, run, _LEFT, _WIDTH, own=not self._is_shipped(run), named=not self._entry, flies=flies)


def _result(deed: Callable[[], str]) -> str:
    """Perform an operation on the library; return what it says of its success, or why it failed."""
    try:
        return deed()
    except LibraryError as error:
        return str(error)


def _train_on(folder: Path) -> Transition:
    return push("train", resume=folder)
