"""Experiments: parts to take away, a guess, and what came of one beside its healthy twin."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import partial
from typing import Final, Literal

from ai.training.config import Config
from ai.training.curves import Curves
from ai.training.experiments import SABOTAGES, VERDICTS, Verdict, differences, verdict
from ai.training.messages import DIVERGED
from game.core import texts
from game.drawing.tokens import HUMAN, INK, NET, SMALL, TITLE
from game.training.run import TrainingRun
from game.training.run_settings import figure, label
from game.ui.panel import Column

_JUDGED: Final = 20  # frames after which an experiment is judged anew


class Laboratory:
    """Experiments of a training scene: which one was chosen, the guess, what has come of it, and their pages.

    Attributes:
        page: which one is shown in the panel; "" for none, so that the knobs are seen.
        sabotage: the experiment that flies or flew last; "" before the first.
        asked: the one of which the player is asked.
        guess: the player's.
        came: what has come of it; None while it is too early to say. It is said once, and stays.

    Args:
        run: an experiment flies beside it.
        start: starts an experiment.

    """

    def __init__(self, run: TrainingRun, start: Callable[[str], None]) -> None:
        self._run, self._start = run, start
        self.page: Literal["", "picks", "guess", "result"] = ""
        self.sabotage = self.asked = ""
        self.guess: Verdict | None = None
        self.came: Verdict | None = None
        self._figures = ""  # what both had landed at the verdict
        self._frame = 0

    @property
    def key(self) -> Hashable:
        """What decides which rows there are."""
        return self.page, self.sabotage, self.asked, self.came

    @property
    def name(self) -> str:
        """Name of the experiment on the screen."""
        return texts.SABOTAGES[self.sabotage][0] if self.sabotage else texts.LAB_HEADING

    def open(self) -> None:
        """Show what has come of the experiment that flies, or what there is to try."""
        self.page = "result" if self._run.twin else "picks"

    def close(self) -> None:
        """Show the knobs."""
        self.page = ""

    def update(self) -> None:
        """Judge both runs by their curves now and then, once there is enough of them."""
        run, twin = self._run, self._run.twin
        self._frame += 1
        if self.page == "result" and twin is None:  # another run has begun
            self.close()
        if twin is None or self.came or self._frame % _JUDGED or not (len(run.history) and len(twin.history)):
            return
        healthy, other = Curves(run.history, run.config), Curves(twin.history, twin.config)
        # Another end than a network that diverged says nothing of the experiment.
        failed = DIVERGED in twin.problem
        landed = texts.LAB_FIGURES_THEN.format(
            count=int(twin.history["decisions"][-1]), other=100 * other.landed(), healthy=100 * healthy.landed()
        )
        self.came, self._figures = verdict(healthy, other, failed=failed), twin.problem if failed else landed

    # Pages

    def describe(self, column: Column) -> None:
        """Add the rows of the page."""
        {"picks": self._picks, "guess": self._guess, "result": self._result}[self.page](column)

    def _picks(self, column: Column) -> None:
        column.text(texts.TRAIN_EXPERIMENTS, size=TITLE)
        for name in SABOTAGES:
            word, what = texts.SABOTAGES[name]
            column.button(word, partial(self._ask, name), what, colour=INK)
        column.button(texts.BACK, self.close)

    def _ask(self, sabotage: str) -> None:
        """Ask for a guess at what a sabotage will do."""
        self.asked, self.page = sabotage, "guess"

    def _guess(self, column: Column) -> None:
        name, what = texts.SABOTAGES[self.asked]
        column.text(name, size=TITLE)
        column.aside(what)
        column.gap()
        column.text(texts.LAB_ASK, size=SMALL)
        run = self._run
        if not run.twin and len(run.history) and (run.alive or run.kept):
            column.aside(texts.LAB_KEPT)
        for kind in VERDICTS:
            column.button(texts.LAB_GUESSES[kind], partial(self.fly, kind), colour=HUMAN)
        column.button(texts.BACK, self.open)

    def fly(self, guess: Verdict) -> None:
        """Fly the sabotage that was asked of, with a guess."""
        self.guess, self.came, self.sabotage = guess, None, self.asked
        self._start(self.sabotage)
        self.open()

    def end(self) -> None:
        """End the experiment, and show what else there is to try."""
        self._run.leave()
        self.open()

    def _result(self, column: Column) -> None:
        twin = self._run.twin
        assert twin is not None
        assert self.guess is not None
        column.caption(texts.LAB_HEADING)
        column.text(self.name, size=TITLE)
        column.aside(listed_differences(self._run.config, twin.config))
        column.gap()
        column.caption(texts.LAB_YOUR_GUESS)
        column.text(texts.LAB_GUESSES[self.guess], size=SMALL, colour=HUMAN)
        column.gap()
        column.caption(texts.LAB_CAME)
        if self.came:
            right = texts.LAB_AS_GUESSED if self.came == self.guess else texts.LAB_NOT_AS_GUESSED
            column.text(f"{self._figures} {right}", size=SMALL, colour=NET)
            why = texts.SABOTAGE_WHY[self.sabotage]
            column.text(texts.LAB_NOT_MISSED.format(why=why) if self.came == "most" else why, size=SMALL)
            names = list(SABOTAGES)
            following = names[(names.index(self.sabotage) + 1) % len(names)]
            words = texts.LAB_NEXT.format(name=texts.SABOTAGES[following][0])
            column.button(words, partial(self._ask, following), colour=HUMAN)
        else:
            column.text(lambda: twin.problem or texts.LAB_TOO_EARLY, size=SMALL, colour=HUMAN)
        column.words([(texts.BACK, self.close), (texts.LAB_END, self.end)])


def listed_differences(before: Config, after: Config) -> str:
    """List what differs between two configurations, with both values."""
    return ", ".join(
        texts.LAB_DIFFERS.format(knob=label(name), before=figure(old), after=figure(new))
        for name, (old, new) in differences(before, after).items()
    )
