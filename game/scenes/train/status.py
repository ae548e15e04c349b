"""What a run has come to so far, for the titles of the two scenes that train."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from game.core import texts
from game.training.run import TrainingRun


class TrainingStatus(NamedTuple):
    """A line of text, and a figure in percent with what it counts; the figure is empty before it is known."""

    line: str
    figure: str
    words: str


def lander_status(lander_run: TrainingRun, moment: int | None = None, row: int = -1) -> TrainingStatus:
    """Return the landers, the time and the decisions so far, and the share that lands.

    `moment`, in decisions, and the `row` of the history say so of an earlier moment.
    """
    history, swarm_state = lander_run.history, lander_run.swarm_state
    if swarm_state is None or not lander_run.measured:
        return TrainingStatus(texts.TRAIN_BEGINS if lander_run.alive else texts.TRAIN_LINE, "", texts.TRAIN_LANDED)
    line = texts.TRAIN_FIGURES.format(
        landers=len(swarm_state.outcome),
        seconds=history["seconds"][row],
        count=int(swarm_state.decisions) if moment is None else moment,
    )
    landed = history["success"][row]
    return TrainingStatus(line, "" if np.isnan(landed) else f"{100 * landed:.0f}", texts.TRAIN_LANDED)


def digit_status(digit_run: TrainingRun) -> TrainingStatus:
    """Return the epoch, the time and the speed, and the share of images that are read rightly."""
    history, tested = digit_run.history, digit_run.test is not None
    line = texts.DIGIT_RUN_LOADING if digit_run.alive else texts.DIGIT_RUN_LINE
    if len(history):
        last = dict(zip(history.columns, history.points[-1].tolist(), strict=True))
        line = texts.DIGIT_RUN_FIGURES.format(
            epoch=last["epoch"], epochs=digit_run.config.epochs, seconds=last["seconds"],
            rate=last["images_per_second"],
        )  # fmt: skip
    scores = history.validations
    if tested and digit_run.kept_epoch is not None:
        read = f"{100 * scores[-1].success:.2f}%" if scores else "–"
        line = texts.DIGIT_RUN_KEPT_BEST.format(epoch=digit_run.kept_epoch, last=read)
    part = digit_run.test if digit_run.test is not None else scores[-1].success if scores else None
    figure = "" if part is None else f"{100 * part:.2f}"
    return TrainingStatus(line, figure, texts.DIGIT_RUN_TESTED if tested else texts.DIGIT_RUN_READ)
