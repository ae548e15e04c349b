"""Of both scenes that train: one that cannot be built leaves nothing behind."""

from pathlib import Path
from typing import Any

import pytest

from game.core.scene import Scene
from game.scenes import digit_training, split_scene, train
from game.training.digit_models import DigitModels, runs_dir
from game.training.library import Library
from game.ui.context import Context


def places(folder: Path) -> tuple[Path, Path]:
    """Where the next run of landers and the next of digits would be kept without a name."""
    collections = Library(folder), DigitModels(runs_dir(folder))
    for each in collections:
        each.hold()
        each.release()
    landers, digits = collections
    return landers.unsaved, digits.unsaved


@pytest.mark.parametrize(
    ("module", "panel", "scene"),
    [
        (split_scene, "LabKnobsPanel", train.TrainScene),
        (digit_training, "KnobsPanel", digit_training.DigitTrainingScene),
    ],
)
def test_one_that_cannot_be_built_lets_go_of_the_place_of_its_runs(
    context: Context, monkeypatch: pytest.MonkeyPatch, module: Any, panel: str, scene: type[Scene]
) -> None:
    def fail(*_: Any, **__: Any) -> None:
        raise ValueError("no knobs")

    before = places(context.user_dir)
    monkeypatch.setattr(module, panel, fail)
    with pytest.raises(ValueError, match="no knobs") as kept:  # and with it, the scene
        scene(context)
    assert places(context.user_dir) == before
    del kept
