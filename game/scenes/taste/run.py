"""The run that is brought up, as the window knows it."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from ai.training.config import Config
from ai.training.taste_session import Asked, TasteSession
from ai.training.upbringing import UPBRINGING
from game.core import texts
from game.training.library import Library
from game.training.run import TrainingRun
from game.training.run_kind import RunKind

PACE: Final = 45.0  # decisions a second: three times as fast as life
_FOLDER: Final = ".taste"  # among the player's networks, until it has a name: Train has its own place

RAISED: Final = RunKind(TasteSession, Config, {"taste": UPBRINGING}, lambda: texts.PRESETS, first=(), knobs={})


class Nursery(Library):
    """The player's networks, with a place of its own for the one that is brought up."""

    def __init__(self, user_dir: Path) -> None:
        super().__init__(user_dir)
        self.unsaved = self.folder / _FOLDER


class TasteRun(TrainingRun):
    """Run that is brought up. `asked` is the latest question; None before the first, and while an answer is learned."""

    def __init__(self, nursery: Nursery) -> None:
        super().__init__(RAISED, nursery)
        self.asked: Asked | None = None

    def _clear(self) -> None:
        super()._clear()
        self.asked = None

    def _launch(self, config: Any, seed: int, resume: Path | None) -> None:
        super()._launch(config, seed, resume)
        if self._worker:
            self._worker.set_pace(PACE)

    def _hear(self, message: Any) -> None:
        if isinstance(message, Asked):
            self.asked = message
        super()._hear(message)
