"""Best network of each study, offered among the player's networks. It reads each study's own file, no more."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

from ai.files import brief, inside
from ai.sweep.study import STUDIES, STUDY_FILE, StudyFile
from ai.training.config import LANDER
from game.core import texts

_RUN: Final = re.compile(r"trials/\d{4,6}/seed-\d+")


def studies(user_dir: Path) -> list[Path]:
    """Return the folders of the player's studies, the newest first."""
    try:
        found = [path for path in (user_dir / STUDIES).iterdir() if (path / STUDY_FILE).is_file()]
        return sorted(found, key=lambda path: (-path.stat().st_mtime, path.name))
    except OSError:
        return []


def best_runs(user_dir: Path) -> dict[str, Path]:
    """Return the folder of the best run of each study of the lander, by the name under which it is offered."""
    found = {}
    for study in studies(user_dir):
        try:
            file = StudyFile.read(study)
            if file.plan.settings.get("env") != LANDER or not _RUN.fullmatch(file.run or ""):
                continue
            folder = inside(study, file.run or "")
        except (OSError, ValueError):
            continue
        if folder.is_dir():
            found[texts.STUDY_BEST.format(study=brief(study.name, 40))] = folder
    return found
