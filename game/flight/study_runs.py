"""Best network of each study, offered among the player's networks. It reads each study's small summary, no more."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final

from ai.files import Count, Share, Sized, brief, inside, read_as, read_json
from ai.training.config import LANDER
from game.core import texts

STUDIES: Final = "studies"  # folder of the studies, in the player's
_STUDY: Final = "study.json"
_SUMMARY: Final = "summary.json"
_RUN: Final = re.compile(r"trials/\d{4,6}/seed-\d+")


@dataclass(frozen=True)
class Summary:
    """Summary of a study, as its command writes it.

    Attributes:
        finished, trials: trials that are finished, and those asked for.
        metric: what they are compared by.
        env: environment of its runs; None for digits.
        best: value of the best trial, as text; None before there is one.
        run: folder of the best run, within the study's.
        importance: share of the differences that each knob explains, once the study is over.

    """

    finished: Count
    trials: Count
    metric: Annotated[str, Sized(200)]
    env: str | None = None
    best: Annotated[str, Sized(200)] | None = None
    run: Annotated[str, Sized(200)] | None = None
    importance: dict[str, Share] | None = None


def studies(user_dir: Path) -> list[Path]:
    """Return the folders of the player's studies, the newest first."""
    try:
        found = [path for path in (user_dir / STUDIES).iterdir() if (path / _STUDY).is_file()]
        return sorted(found, key=lambda path: (-path.stat().st_mtime, path.name))
    except OSError:
        return []


def summary_of(study: Path) -> Summary | None:
    """Return the summary of a study; None without one that can be read."""
    try:
        return read_as(Summary, read_json(study / _SUMMARY))
    except (OSError, ValueError, RecursionError):
        return None


def best_runs(user_dir: Path) -> dict[str, Path]:
    """Return the folder of the best run of each study of the lander, by the name under which it is offered."""
    found = {}
    for study in studies(user_dir):
        summary = summary_of(study)
        if summary and summary.env == LANDER and summary.run and _RUN.fullmatch(summary.run):
            try:
                folder = inside(study, summary.run)
            except (OSError, ValueError):
                continue
            if folder.is_dir():
                found[texts.STUDY_BEST.format(study=brief(study.name, 40))] = folder
    return found
