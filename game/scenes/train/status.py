"""What a run has come to so far, for the title over its display."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from game.core import texts
from game.training.run import TrainingRun


class TrainingStatus(NamedTuple):
    """Title of the screen, a line of text, and a figure in percent with what it counts, empty before it is known."""

    title: str
    line: str
    figure: str
    words: str


def lander_status(run: TrainingRun, moment: int | None = None, row: int = -1) -> TrainingStatus:
    """Return the landers, the time and the decisions so far, and the share that lands.

    `moment`, in decisions, and the `row` of the history say so of an earlier moment.
    """
    history, swarm_state = run.history, run.swarm_state
    if swarm_state is None or not len(run.history):
        line = texts.TRAIN_BEGINS if run.alive else texts.TRAIN_LINE
        return TrainingStatus(texts.TRAIN_TITLE, line, "", texts.TRAIN_LANDED)
    line = texts.TRAIN_FIGURES.format(
        landers=len(swarm_state.outcome),
        seconds=history["seconds"][row],
        count=int(swarm_state.decisions) if moment is None else moment,
    )
    landed = history["success"][row]
    figure = "" if np.isnan(landed) else f"{100 * landed:.0f}"
    return TrainingStatus(texts.TRAIN_TITLE, line, figure, texts.TRAIN_LANDED)


def digit_status(run: TrainingRun) -> TrainingStatus:
    """Return the epoch, the time and the speed, and the share of images that are read rightly."""
    history, scores = run.history, run.history.validations
    line = texts.DIGIT_RUN_LOADING if run.alive else texts.DIGIT_RUN_LINE
    if len(history):
        line = texts.DIGIT_RUN_FIGURES.format(
            epoch=history["epoch"][-1], epochs=run.config.epochs, seconds=history["seconds"][-1],
            rate=history["images_per_second"][-1],
        )  # fmt: skip
    part, words = scores[-1].success if scores else None, texts.DIGIT_RUN_READ
    if run.test is not None:
        if run.kept_epoch is not None:
            read = f"{100 * scores[-1].success:.2f} %" if scores else "–"
            line = texts.DIGIT_RUN_KEPT_BEST.format(epoch=run.kept_epoch, last=read)
        part, words = run.test, texts.DIGIT_RUN_TESTED
    return TrainingStatus(texts.DIGIT_RUN_TITLE, line, "" if part is None else f"{100 * part:.2f}", words)
