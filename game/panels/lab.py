"""Laboratory in the panel of knobs: parts to take away, a guess, and what came of an experiment beside its twin."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Final, NamedTuple

import pygame

from ai.training.config import PRESETS, Config
from ai.training.experiments import MEASURED, VERDICTS, Experiment, Flown, Verdict, differences, judged_at, verdict
from game.core import texts
from game.core.scene import Transition
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import HUMAN, INK, LABEL, MUTE, NET, SMALL, TEXT
from game.training.knob_descriptions import KnobDescription, figure, label
from game.training.run import TrainingRun
from game.ui.widget import OnPress, PointsManager, Widget
from game.ui.widgets import TextButton

TOP: Final = 34  # points from the top of the panel to the line under its head
_GUESSES: Final = 178  # from there to the guesses
_PITCH: Final = 30  # of the guesses
_FOOT: Final = 32  # from the bottom to the words there
_MEANINGS: Final = 96.0  # from the left to what stands beside a label
_LEADING: Final = 16.0
_GAP: Final = 20.0  # between words at the foot

Start = Callable[[Experiment], Transition | None]


class Chosen(NamedTuple):
    """An experiment with its name on the screen, and the player's guess; None if there was none."""

    experiment: Experiment
    name: str
    guess: Verdict | None = None


class Laboratory:
    """Experiments of a training scene: which one was chosen, the guess, and what has come of it.

    Attributes:
        came: what has come of the experiment; None while it is too early to say.
        so_far: how many flights both runs land at this moment.
        too_early: why it is too early to say what has come of it.
        differs: the settings that differ, with both values.

    Args:
        split: the runs; an experiment flies beside a run of theirs.
        start: starts an experiment; may ask the player first.
        leave: ends the split view, and keeps the experiment if that is true.

    """

    def __init__(self, split: TrainingRun, start: Start, leave: Callable[[bool], None]) -> None:
        self.split, self._start, self._leave = split, start, leave
        self.chosen: Chosen | None = None
        self.came: Verdict | None = None
        self.so_far, self.too_early, self.differs = texts.TRAIN_BEGINS, texts.LAB_TOO_EARLY, ""

    @property
    def flies(self) -> bool:
        """Whether an experiment is beside the run."""
        return self.split.twin is not None

    def choose(self, experiment: Experiment, name: str) -> None:
        """Choose an experiment, before the guess."""
        self.chosen = Chosen(experiment, name)

    def fly(self, guess: Verdict | None) -> Transition | None:
        """Start the chosen experiment, with a guess or without one."""
        if self.chosen is None:
            return None
        self.chosen = self.chosen._replace(guess=guess)
        return self._start(self.chosen.experiment)

    def keep(self, experiment: bool) -> None:
        """End the split view, and keep the run, or the experiment."""
        self._leave(experiment)

    def follow(self) -> None:
        """Judge both runs by their curves; call it when there is news."""
        split, twin = self.split, self.split.twin
        self.differs = listed_differences(split.config, twin.config) if twin else ""
        self.too_early = texts.LAB_TOO_EARLY
        if twin is None or not (len(split.history) and len(twin.history)):
            self.came, self.so_far = None, texts.TRAIN_BEGINS
            return
        healthy, other = Flown(split.history, split.config), Flown(twin.history, twin.config)
        self.came = verdict(healthy, other, failed=bool(twin.problem))
        self.so_far = texts.LAB_SO_FAR.format(
            count=int(twin.history["decisions"][-1]), other=100 * other.landed, landed=100 * healthy.landed
        )
        if math.isfinite(judged := judged_at(healthy, other)):
            self.too_early = texts.LAB_JUDGED_AT.format(count=math.ceil(judged))


def experiment_word(experiment: Experiment, description: KnobDescription) -> str:
    """Return the label of an experiment beside its knob."""
    if experiment.kind in ("times", "divided"):
        words = texts.LAB_TIMES if experiment.kind == "times" else texts.LAB_DIVIDED
        return words.format(factor=float(f"{experiment.amount:.2g}"))
    if plain := texts.LAB_PLAIN.get(description.name):
        less = experiment.amount < (description.stops[0] + description.stops[-1]) / 2
        return plain["low" if less else "high"]
    if description.kind == "slider" and experiment.amount == 0:
        return figure(False)
    value = figure(experiment.amount)
    return value if description.kind != "slider" else texts.LAB_TO.format(value=value)


def experiment_name(experiment: Experiment, description: KnobDescription) -> str:
    """Return the name of a knob's experiment, wherever it stands alone."""
    return texts.LAB_NAME.format(knob=description.label, change=experiment_word(experiment, description))


def listed_differences(before: Config, after: Config) -> str:
    """List what differs between two configurations, with both values."""
    found = []
    for name, (old, new) in differences(before, after).items():
        head, _, part = name.partition(".")
        word = texts.KNOB_WEIGHTS[part][0] if part in texts.KNOB_WEIGHTS else label(head)
        found.append(texts.LAB_DIFFERS.format(knob=word, before=figure(old), after=figure(new)))
    return ", ".join(found)


# Pages


def guess_widgets(laboratory: Laboratory, manager: PointsManager, box: pygame.Rect, alone: OnPress) -> list[Widget]:
    """Make the words of the page that asks for a guess; `alone` flies the sabotage without a twin."""
    top = box.top + TOP + _GUESSES
    found: list[Widget] = [
        TextButton(manager, (box.left, top + _PITCH * row, box.width - 20, 26), texts.LAB_GUESSES[kind],
                   partial(laboratory.fly, kind), colour=HUMAN)
        for row, kind in enumerate(VERDICTS)
    ]  # fmt: skip
    return found + words_of(manager, box, [(texts.LAB_SKIP, partial(laboratory.fly, None)), (texts.LAB_ALONE, alone)])


def words_of(manager: PointsManager, box: pygame.Rect, words: list[tuple[str, OnPress]]) -> list[Widget]:
    """Make buttons side by side at the foot of a page, narrower where there is no room for all."""
    widths = [typeface.width(word, SMALL, "regular") for word, _ in words]
    share = min(1.0, (box.width - _GAP * (len(words) - 1)) / sum(widths))
    found: list[Widget] = []
    x: float = box.left
    for (word, press), width in zip(words, widths, strict=True):
        place = (x, box.bottom - _FOOT, share * width, 24)
        found.append(TextButton(manager, place, word, press, size=SMALL, colour=NET))
        x += share * width + _GAP
    return found


def draw_guess(canvas: Canvas, box: pygame.Rect, chosen: Chosen) -> None:
    """Draw the question, above the guesses."""
    x, y = box.left, box.top + TOP
    canvas.text(texts.LAB_BEFORE, (x, y + 25), size=LABEL, weight="medium", colour=MUTE)
    canvas.text(chosen.name, (x, y + 54), size=TEXT)
    draw_wrapped(canvas, texts.SABOTAGES[chosen.experiment.sabotage][1], (x, y + 76), box.width, colour=MUTE)
    draw_wrapped(canvas, texts.LAB_ASK, (x, y + _GUESSES - 34), box.width)


def draw_result(canvas: Canvas, box: pygame.Rect, laboratory: Laboratory) -> None:
    """Draw what differs, the guess, and what has come so far."""
    twin, chosen = laboratory.split.twin, laboratory.chosen
    if twin is None or chosen is None:
        return
    x, y = box.left, float(box.top + TOP)
    canvas.text(texts.LAB_HEADING, (x, y + 25), size=LABEL, weight="medium", colour=MUTE)
    canvas.text(chosen.name, (x, y + 52), size=TEXT)
    y = draw_wrapped(canvas, laboratory.differs, (x, y + 74), box.width, colour=MUTE, most=3)
    y += 10
    for heading, told in _found(laboratory, chosen):
        canvas.text(heading, (x, y), size=SMALL, colour=MUTE, room=_MEANINGS - 8)
        y = draw_wrapped(canvas, told, (x + _MEANINGS, y), box.width - _MEANINGS, colour=INK, leading=_LEADING) + 5


def _found(laboratory: Laboratory, chosen: Chosen) -> list[tuple[str, str]]:
    """Return headings with what stands beside them."""
    came, sabotage = laboratory.came, chosen.experiment.sabotage
    twin = laboratory.split.twin
    lines = [(texts.LAB_YOUR_GUESS, texts.LAB_GUESSES[chosen.guess])] if chosen.guess else []
    if twin is not None and twin.problem:
        lines.append((texts.LAB_NOW, twin.problem))
    else:
        lines.append((texts.LAB_NOW, laboratory.so_far))
    if came is None:
        return [*lines, (texts.LAB_CAME, laboratory.too_early)]
    told = texts.LAB_CAME_OF[came]
    if chosen.guess:
        told += " " + (texts.LAB_AS_GUESSED if chosen.guess == came else texts.LAB_NOT_AS_GUESSED)
    lines.append((texts.LAB_CAME, told))
    if sabotage:
        lines.append((texts.LAB_WHY, texts.SABOTAGE_WHY[sabotage]))
        if laboratory.split.config == PRESETS[MEASURED]:
            lines.append((texts.LAB_MEASURED, texts.SABOTAGES[sabotage][2]))
    return lines
