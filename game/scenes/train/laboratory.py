"""Experiments: parts to take away and knobs to turn, a guess, and what came of one beside its healthy twin."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Literal, NamedTuple

from ai.training.config import PRESETS, Config
from ai.training.experiments import (
    MEASURED,
    VERDICTS,
    Experiment,
    Flown,
    Verdict,
    differences,
    experiment_of,
    experiments,
    judged_at,
    verdict,
)
from game.core import texts
from game.core.scene import Transition
from game.drawing.tokens import HUMAN, INK, MUTE, NET, SMALL, TITLE
from game.scenes.train.cards import CARDS, measured
from game.scenes.train.knobs import KnobsPanel
from game.training.knob_descriptions import KnobDescription, figure, label
from game.training.run import TrainingRun
from game.training.run_settings import LANDER
from game.ui.panel import Column

Page = Literal["", "picks", "guess", "result"]
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


class ExperimentPages:
    """Pages of the panel: the experiments to choose from, the guess, and what has come of one.

    Attributes:
        page: which one is shown; "" for none, so that the knobs are seen.

    """

    def __init__(self, laboratory: Laboratory, knobs: KnobsPanel) -> None:
        self.laboratory, self._knobs = laboratory, knobs
        self.page: Page = ""

    def open(self) -> None:
        """Show what has come of the experiment that flies, or what there is to try."""
        self.page = "result" if self.laboratory.flies else "picks"

    def close(self) -> None:
        """Show the knobs."""
        self.page = ""

    def describe(self, column: Column) -> None:
        """Add the rows of the page."""
        {"picks": self._picks, "guess": self._guess, "result": self._result}[self.page](column)

    def _picks(self, column: Column) -> None:
        column.text(texts.TRAIN_EXPERIMENTS, size=TITLE)
        column.aside(texts.LAB_INTRODUCED)
        for name in CARDS:
            word, told = texts.SABOTAGES[name]
            column.button(word, partial(self._ask, name, word), told, colour=INK)
        descriptions = {each.name: each for each in LANDER.knob_descriptions}
        for name in self._knobs.first:
            column.aside(texts.LAB_TURN.format(knob=descriptions[name].label))
            column.words([
                (experiment_word(each, descriptions[name]), partial(self._try, each, descriptions[name]))
                for each in experiments(self._knobs.config, name)
            ])  # fmt: skip
        column.button(texts.BACK, self.close)

    def _ask(self, sabotage: str, word: str) -> None:
        """Ask for a guess at what a sabotage will do."""
        self.laboratory.choose(experiment_of(self._knobs.config, sabotage), word)
        self.page = "guess"

    def _try(self, experiment: Experiment, description: KnobDescription) -> Transition | None:
        """Fly a knob's experiment beside the run."""
        self.laboratory.choose(experiment, experiment_name(experiment, description))
        return self.laboratory.fly(None)

    def _guess(self, column: Column) -> None:
        chosen = self.laboratory.chosen
        assert chosen is not None
        column.caption(texts.LAB_BEFORE)
        column.text(chosen.name, size=TITLE)
        column.aside(texts.SABOTAGES[chosen.experiment.sabotage][1])
        column.gap()
        column.text(texts.LAB_ASK, size=SMALL)
        for kind in VERDICTS:
            column.button(texts.LAB_GUESSES[kind], partial(self.laboratory.fly, kind), colour=HUMAN)
        column.words([(texts.LAB_SKIP, partial(self.laboratory.fly, None)), (texts.LAB_ALONE, self._alone)])
        column.button(texts.BACK, self.open)

    def _alone(self) -> None:
        """Propose a run with that part missing, without a twin."""
        assert self.laboratory.chosen is not None
        self.close()
        self._knobs.load_sabotage(self.laboratory.chosen.experiment.sabotage)

    def _result(self, column: Column) -> None:
        laboratory, chosen = self.laboratory, self.laboratory.chosen
        assert chosen is not None
        column.caption(texts.LAB_HEADING)
        column.text(chosen.name, size=TITLE)
        column.aside(lambda: laboratory.differs)
        column.gap()
        if chosen.guess:
            column.caption(texts.LAB_YOUR_GUESS)
            column.text(texts.LAB_GUESSES[chosen.guess], size=SMALL, colour=HUMAN)
        column.gap()
        column.caption(texts.LAB_NOW)
        column.text(lambda: self._told("now"), size=SMALL)
        column.gap()
        column.caption(texts.LAB_CAME)
        column.text(lambda: self._told("came"), size=SMALL, colour=NET)
        column.text(lambda: self._told("why"), size=SMALL)
        column.text(lambda: self._told("measured"), size=SMALL, colour=MUTE)
        column.words([
            (texts.LAB_KEEP_RUN, partial(laboratory.keep, experiment=False)),
            (texts.LAB_KEEP_EXPERIMENT, partial(laboratory.keep, experiment=True)),
            (texts.LAB_KNOBS, self.close),
        ])  # fmt: skip

    def _told(self, what: Literal["now", "came", "why", "measured"]) -> str:
        """Say what has come so far; empty for what is not known yet."""
        laboratory, chosen, twin = self.laboratory, self.laboratory.chosen, self.laboratory.split.twin
        if chosen is None:
            return ""
        came, sabotage = laboratory.came, chosen.experiment.sabotage
        if what == "now":
            return twin.problem if twin and twin.problem else laboratory.so_far
        if what == "came":
            if came is None:
                return laboratory.too_early
            right = texts.LAB_AS_GUESSED if chosen.guess == came else texts.LAB_NOT_AS_GUESSED
            return f"{texts.LAB_CAME_OF[came]} {right}" if chosen.guess else texts.LAB_CAME_OF[came]
        if came is None or not sabotage:
            return ""
        if what == "why":
            return "" if came == "as_well" else texts.SABOTAGE_WHY[sabotage]
        return measured(sabotage) if sabotage in CARDS and laboratory.split.config == PRESETS[MEASURED] else ""
