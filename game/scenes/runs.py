"""Networks scene: saved runs and shipped networks, with the actions on each."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Final

import pygame

from game.core import texts
from game.core.collection import LONGEST_NAME, LibraryError, fitting
from game.core.scene import Pop, Transition, push
from game.drawing.canvas import Canvas
from game.drawing.sky import NightSky
from game.drawing.tokens import LABEL, LINE, MARGIN, MUTE, SMALL, TITLE, VIEW_SIZE
from game.flight import networks
from game.input.controls import Command
from game.panels.run_page import draw_run, row, suggestion
from game.training.library import Library, SavedRun, read_run
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.entry import Entry
from game.ui.form_scene import FormScene
from game.ui.listing import Listing, shortened
from game.ui.widget import OnPress, Widget
from game.ui.widgets import TextButton

_LIST: Final = pygame.Rect(MARGIN, 168, 672, 408)
_PITCH: Final = 34
_COLUMNS: Final = (232.0, 112.0, 0.0)  # how far from the list's right end each figure ends
_LEFT: Final = 824  # of what is said of the chosen run
_WIDTH: Final = VIEW_SIZE[0] - MARGIN - _LEFT
_FIRST_WORD: Final = 340
_LINE: Final = 36
_FOOT: Final = 608


class NetworksScene(FormScene):
    """A list on the left; the chosen run, its figures and its verbs on the right.

    Args:
        choose: called with the name of the chosen network; the scene then closes. Without it, a run can be
            watched, flown with and trained further from here.
        train: function that resumes training from a run's folder; by default, a Train scene of its own.

    """

    def __init__(
        self,
        context: Context,
        choose: Callable[[str], None] | None = None,
        train: Callable[[Path], Transition] | None = None,
    ) -> None:
        super().__init__(context, self._back)
        self._choose, self._train = choose, train or _train_on
        self._entry: Entry | None = None
        self.runs: list[SavedRun] = []
        self._build(context)
        known = networks.folders(context.models_dir, context.user_dir)
        flies = known.get(context.settings.model, known.get(networks.DEFAULT))
        self._reload(flies if self._choose else None)

    def enter(self) -> None:
        """Reload the runs, to which one may have been added."""
        self._reload(self.shown.folder if self.shown else None)

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
        return [self.form.moves, *super().actions(), *own]

    # What there is

    @property
    def shown(self) -> SavedRun | None:
        """The run on the right; None if there is none at all."""
        return self.runs[self._list.index] if self.runs else None

    @property
    def _is_own(self) -> bool:
        """Whether the run on the right is the player's, and not the game's."""
        return self.shown is not None and self.shown.folder.parent == self._library.folder

    def _build(self, context: Context) -> None:
        self._library = Library(context.user_dir)
        self._sky = NightSky(context.rng, ember=0.5, stars=70)
        manager = self.form.manager
        self._list = self.form.add(Listing(
            manager, _LIST, [], on_choose=lambda _: self._choose_row(), on_press=lambda _: self._press_row(),
            empty=texts.RUNS_NOTHING, columns=_COLUMNS, pitch=_PITCH,
        ))  # fmt: skip
        self._verbs: list[Widget] = []
        self._foot: list[Widget] = []

    def _reload(self, shown: Path | None) -> None:
        """Reload from disk, and select that run, or the one now in its place in the list."""
        context = self.context
        own = self._library.runs()
        known = networks.folders(context.models_dir, context.user_dir)
        shipped = [read_run(folder, name) for name, folder in known.items() if folder.parent != self._library.folder]
        self._names = {folder: name for name, folder in known.items()}
        self.runs = [*own, *shipped]
        folders = [run.folder for run in self.runs]
        index = folders.index(shown) if shown in folders else self._list.index
        self._list.set_rows([row(run, own=run in own) for run in self.runs], index)
        self._line = self._library.problem or (
            texts.RUNS_PLACE.format(folder=self._library.folder) if own else texts.RUNS_NONE
        )
        self._entry = None
        self._set_verbs()

    def _set_verbs(self) -> None:
        """Add the actions that fit the chosen run, and those below the list."""
        rows: list[tuple[str, OnPress]] = []
        run = self.shown
        if self._entry:
            rows = [(texts.RUN_KEEP_NAME, self._entry_done), (texts.RUN_LEAVE_NAME, self._end_naming)]
        elif run:
            if run.flyable and self._choose:
                rows.append((texts.RUN_CHOOSE, self._take))
            elif run.flyable:
                rows += [(texts.RUN_WATCH, self._watch), (texts.RUN_FLY, self._fly)]
            if run.resumable and not self._choose:
                rows.append((texts.RUN_TRAIN, lambda: self._train(run.folder)))
            if self._is_own:
                rows += [(texts.RUN_RENAME, self._begin_naming), (texts.RUN_EXPORT, self._export),
                         (texts.RUN_DELETE, self._delete)]  # fmt: skip
        manager = self.form.manager
        verbs: list[Widget] = [
            TextButton(manager, (_LEFT, _FIRST_WORD + number * _LINE, 200, _LINE), label, press, size=18)
            for number, (label, press) in enumerate(rows)
        ]
        foot: list[Widget] = [TextButton(manager, (MARGIN, _FOOT, 72, _LINE), texts.BACK, self._back, size=18)]
        if deleted := self._library.last_deleted:
            label = texts.RUN_RESTORE.format(name=deleted)
            foot.append(TextButton(manager, (MARGIN + 120, _FOOT, 520, _LINE), label, self._restore, size=18))
        new = ([self._entry] if self._entry else []) + verbs + foot
        self.form.replace(self._verbs + self._foot, new)
        self._verbs, self._foot = new[: len(new) - len(foot)], foot

    # What can be done

    def _choose_row(self) -> None:
        self._entry = None
        self._set_verbs()

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
        if not self.shown or not self.shown.flyable or self._choose is None:
            return None
        self._choose(self._names[self.shown.folder])
        return Pop()

    def _make_pilot(self) -> None:
        assert self.shown is not None
        self.context.settings.model = self._names[self.shown.folder]
        self.context.apply_settings()

    def _watch(self) -> Transition:
        self._make_pilot()
        return push("watch")

    def _fly(self) -> Transition:
        self._make_pilot()
        return push("play")

    def _begin_naming(self) -> None:
        run, context = self.shown, self.context
        assert run is not None
        text = suggestion(self._library, run) if context.controls.pad_in_use else run.name
        self._entry = Entry(
            self.form.manager, (_LEFT, 140, _WIDTH, 34), texts.RUN_NAME, text, self._rename,
            on_cancel=self._end_naming, limit=LONGEST_NAME, fits=fitting, size=TITLE,
        )  # fmt: skip
        self._set_verbs()
        self.form.focus(self._entry)
        self._entry.begin()

    def _entry_done(self) -> None:
        assert self._entry is not None
        self._rename(self._entry.text.strip())

    def _rename(self, name: str) -> None:
        """Rename the run; explain an invalid name and let the player edit it."""
        run, context = self.shown, self.context
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
        self._set_verbs()
        self.form.focus(self._list)

    def _export(self) -> None:
        assert self.shown is not None
        self._attempt(lambda name: texts.RUN_EXPORTED.format(path=self._library.export(name)), self.shown.name)

    def _delete(self) -> None:
        assert self.shown is not None

        def delete(name: str) -> str:
            self._library.delete(name)
            return texts.RUN_DELETED.format(name=name)

        self._attempt(delete, self.shown.name)
        self._reload(None)
        self.form.focus(self._list)

    def _restore(self) -> None:
        def restore(_: str) -> str:
            run = self._library.undo_delete()
            self._reload(run)
            return texts.RUN_RESTORED.format(name=run.name) if run else ""

        self._attempt(restore, "")
        self.form.focus(self._list)

    def _import(self, path: Path) -> None:
        def copy(_: str) -> str:
            run = self._library.import_folder(path)
            self._reload(run)
            return texts.RUN_IMPORTED.format(name=run.name)

        self._attempt(copy, "")

    def _attempt(self, deed: Callable[[str], str], name: str) -> None:
        """Perform an operation on the library, and report its result."""
        try:
            self.context.note(deed(name))
        except LibraryError as error:
            self.context.note(str(error))

    # The picture

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the list, and the chosen run beside it."""
        self._sky.draw(canvas)
        title = texts.RUNS_CHOOSE_TITLE if self._choose else texts.RUNS_TITLE
        canvas.text(title, (MARGIN, 84), size=34, weight="light")
        canvas.text(shortened(canvas, self._line, SMALL, 700), (MARGIN, 110), size=SMALL, colour=MUTE, room=700)
        self._draw_headings(canvas)
        self.form.draw(canvas)
        if run := self.shown:
            flies = self._names.get(run.folder) == (self.context.settings.model or networks.DEFAULT)
            draw_run(canvas, run, _LEFT, _WIDTH, own=self._is_own, named=not self._entry, flies=flies)
        self.draw_hints(canvas)

    def _draw_headings(self, canvas: Canvas) -> None:
        y = _LIST.top - 14
        name, *others = texts.RUNS_COLUMNS
        canvas.text(name, (_LIST.left, y), size=LABEL, weight="medium", colour=MUTE)
        for label, column in zip(others, _COLUMNS, strict=True):
            place = (self._list.right - column, y)
            canvas.text(label, place, size=LABEL, weight="medium", colour=MUTE, align="right")
        canvas.line((_LIST.left, _LIST.top), (self._list.right, _LIST.top), LINE)


def _train_on(folder: Path) -> Transition:
    return push("train", resume=folder)
