"""Dialogs of the Train scene: on runs beside the one that trains, and on one that the last visit has left."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from game.core import texts
from game.core.names import LibraryError
from game.core.scene import Push, Scene, Transition
from game.scenes.menus.dialogs import ListDialog, NameDialog, QuestionDialog
from game.training.beside import rename_beside, take_away
from game.training.library import Library, SavedRun
from game.training.run import TrainingRun


class TrainDialogs:
    """Dialogs over a scene; `ask` shows one after another has closed, `go_on` resumes the run of a folder."""

    def __init__(
        self,
        scene: Scene,
        lander_run: TrainingRun,
        library: Library,
        ask: Callable[[Transition], None],
        go_on: Callable[[Path], None],
    ) -> None:
        self._scene, self._run, self._library, self._ask, self._go_on = scene, lander_run, library, ask, go_on

    def add(self) -> Transition:
        """Ask for a saved run whose curves shall be seen beside these."""
        runs = self._library.runs()

        def put(number: int) -> None:
            if note := self._run.compare(runs[number].name, runs[number].folder):
                self._scene.context.note(note)

        return Push(ListDialog(self._scene, texts.TRAIN_COMPARE_WITH, [(run.name,) for run in runs], put))

    def choose(self, style: int) -> Transition | None:
        """Ask what becomes of the run of a line style; the current one stays as it is."""
        name = next((each.name for each in self._run.earlier if each.style == style), None)
        if name is None:
            return None

        def rename() -> None:
            self._ask(self._rename(style, name))

        remove = partial(take_away, self._run.earlier, style)
        answers: list[tuple[str, Callable[[], None]]] = [(texts.COMPARE_RENAME, rename), (texts.COMPARE_REMOVE, remove)]
        return Push(QuestionDialog(self._scene, name, "", answers))

    def _rename(self, style: int, name: str) -> Transition:
        return Push(
            NameDialog(self._scene, texts.COMPARE_NAMING, name, partial(rename_beside, self._run.earlier, style))
        )

    def ask_what_becomes_of(self, left: SavedRun) -> Transition:
        """Offer the run that was left without a name by the last visit, or by a game that ended too early."""
        more = texts.TRAIN_LEFT_YOUNG if left.success is None else texts.TRAIN_LEFT_FIGURES
        more = left.problem or more.format(seconds=left.seconds, percent=100 * (left.success or 0.0))
        answers = [(texts.TRAIN_LEFT_DISCARD, partial(self._discard, left.name))]
        if left.resumable:
            answers.insert(0, (texts.TRAIN_LEFT_GO_ON, partial(self._go_on, left.folder)))
        return Push(QuestionDialog(self._scene, texts.TRAIN_LEFT, more, answers))

    def _discard(self, name: str) -> None:
        try:
            self._run.collection.discard_rescued()
        except LibraryError as error:
            self._scene.context.note(str(error))
        else:
            self._scene.context.note(texts.TRAIN_LEFT_DISCARDED.format(name=name))
