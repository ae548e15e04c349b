"""Runs put beside the one that trains: chosen from those that are saved, renamed, and taken away again."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from game.core import texts
from game.core.scene import Push, Scene, Transition
from game.scenes.dialog import ListDialog, NameDialog, QuestionDialog
from game.training.lander_run import LanderRun
from game.training.training_run import rename_beside, take_away


class Comparing:
    """Dialogs over a scene for the runs beside its own; `ask` shows one after another has closed."""

    def __init__(self, scene: Scene, lander_run: LanderRun, ask: Callable[[Transition], None]) -> None:
        self._scene, self._run, self._ask = scene, lander_run, ask

    def add(self) -> Transition:
        """Ask for a saved run whose curves shall be seen beside these."""
        runs = self._run.library.runs()

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
