"""Experiments: parts to take away, a guess, and what came of one beside its healthy twin."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Sequence
from functools import cache, partial
from typing import Any, Final, Literal, NamedTuple

from ai.files import read_json
from ai.training.config import PRESETS, Config
from ai.training.experiments import (
    MEASURED,
    SABOTAGES,
    VERDICTS,
    Flown,
    Verdict,
    differences,
    judged_at,
    verdict,
)
from ai.training.messages import DIVERGED
from game.core import texts
from game.core.assets import ASSETS_DIR
from game.core.catalogue import capital
from game.core.scene import Transition
from game.drawing.tokens import HUMAN, INK, MUTE, NET, SMALL, TITLE
from game.scenes.train.knobs import KnobsPanel
from game.training.run import TrainingRun
from game.training.run_settings import figure, label
from game.ui.panel import Column

FILE: Final = ASSETS_DIR / "sabotages.json"  # what `python -m benchmarks.sabotages` measured
_JUDGED: Final = 20  # frames after which an experiment is judged anew
_WAVERS: Final = 10  # percent by which one that has recovered may fall behind its twin


class Chosen(NamedTuple):
    """A sabotage, and the player's guess; None if there was none."""

    sabotage: str
    guess: Verdict | None = None

    @property
    def name(self) -> str:
        """Its name on the screen."""
        return texts.SABOTAGES[self.sabotage][0]


class Laboratory:
    """Experiments of a training scene: which one was chosen, the guess, what has come of it, and their pages.

    Attributes:
        page: which one is shown in the panel; "" for none, so that the knobs are seen.
        chosen: what flies or flew last, or is about to.
        came: what has come of it; None while it is too early to say. It is said once, and stays.
        said: the same in words, by subject.

    Args:
        run: an experiment flies beside it.
        knobs: the settings that an experiment changes.
        start: starts the experiment.
        leave: ends the split view.

    """

    def __init__(
        self,
        run: TrainingRun,
        knobs: KnobsPanel,
        start: Callable[[str], Transition | None],
        leave: Callable[[], None],
    ) -> None:
        self._run, self._knobs, self._start, self._leave = run, knobs, start, leave
        self.page: Literal["", "picks", "guess", "result"] = ""
        self.chosen: Chosen | None = None
        self.came: Verdict | None = None
        self._recovered, self._frame = False, 0
        self._landed: Sequence[int | None] = ()  # what both land now, in percent
        self.said = dict.fromkeys(("differs", "figures", "came", "measured"), "")

    @property
    def key(self) -> Hashable:
        """What decides which rows there are."""
        return self.page, self.chosen, self.came

    def open(self) -> None:
        """Show what has come of the experiment that flies, or what there is to try."""
        self.page = "result" if self._run.twin else "picks"

    def close(self) -> None:
        """Show the knobs."""
        self.page = ""

    def follow(self) -> None:
        """Judge both runs by their curves, once there is enough of them; call it when there is news."""
        run, twin, chosen = self._run, self._run.twin, self.chosen
        if twin is None or chosen is None or self.came:
            return
        early = figures = ""
        if len(run.history) and len(twin.history):
            healthy, other = Flown(run.history, run.config), Flown(twin.history, twin.config)
            # Another end than a network that diverged says nothing of the experiment.
            self.came = verdict(healthy, other, failed=DIVERGED in twin.problem)
            judged = judged_at(healthy, other)
            early = texts.LAB_JUDGED_AT.format(count=math.ceil(judged)) if math.isfinite(judged) else ""
            figures = texts.LAB_FIGURES_THEN.format(
                count=int(twin.history["decisions"][-1]), other=100 * other.landed(), healthy=100 * healthy.landed()
            )
        self.said = {
            "differs": listed_differences(run.config, twin.config),
            "figures": figures if self.came else "",
            "came": came_words(self.came, chosen.guess) or ("" if twin.problem else early or texts.LAB_TOO_EARLY),
            "measured": measured(chosen.sabotage) if self.came and run.config == PRESETS[MEASURED] else "",
        }

    def update(self, landed: Sequence[int | None]) -> None:
        """Judge both runs now and then; after it, note whether the experiment has recovered, by what both land."""
        self._landed = landed
        self._frame += 1
        if self._frame % _JUDGED == 0:
            self.follow()
        if self.came:
            self._recovered = has_recovered(landed, was=self._recovered)

    def begin(self) -> None:
        """Show what comes of the experiment that has just started."""
        self.came, self._recovered = None, False
        self.follow()
        self.open()

    # Pages

    def describe(self, column: Column) -> None:
        """Add the rows of the page."""
        {"picks": self._picks, "guess": self._guess, "result": self._result}[self.page](column)

    def _picks(self, column: Column) -> None:
        column.text(texts.TRAIN_EXPERIMENTS, size=TITLE)
        column.aside(texts.LAB_INTRODUCED)
        for name in SABOTAGES:
            word, what = texts.SABOTAGES[name]
            column.button(word, partial(self._ask, name), what, colour=INK)
        column.button(texts.BACK, self.close)

    def _ask(self, sabotage: str) -> None:
        """Ask for a guess at what a sabotage will do."""
        self.chosen, self.page = Chosen(sabotage), "guess"

    def _fly(self, guess: Verdict | None) -> Transition | None:
        """Fly the sabotage that was chosen, with a guess or without one."""
        assert self.chosen is not None
        self.chosen = self.chosen._replace(guess=guess)
        return self._start(self.chosen.sabotage)

    def _guess(self, column: Column) -> None:
        assert self.chosen is not None
        column.caption(texts.LAB_BEFORE)
        column.text(self.chosen.name, size=TITLE)
        column.aside(texts.SABOTAGES[self.chosen.sabotage][1])
        column.gap()
        column.text(texts.LAB_ASK, size=SMALL)
        for kind in VERDICTS:
            column.button(texts.LAB_GUESSES[kind], partial(self._fly, kind), colour=HUMAN)
        column.words([(texts.LAB_SKIP, partial(self._fly, None)), (texts.LAB_ALONE, self._alone)])
        column.button(texts.BACK, self.open)

    def _alone(self) -> None:
        """Propose a run with that part missing, without a twin."""
        assert self.chosen is not None
        self.close()
        self._knobs.load(sabotage=self.chosen.sabotage)

    def _result(self, column: Column) -> None:
        assert self.chosen is not None
        column.caption(texts.LAB_HEADING)
        column.text(self.chosen.name, size=TITLE)
        column.aside(lambda: self.said["differs"])
        column.gap()
        if self.chosen.guess:
            column.caption(texts.LAB_YOUR_GUESS)
            column.text(texts.LAB_GUESSES[self.chosen.guess], size=SMALL, colour=HUMAN)
            column.gap()
        column.caption(texts.LAB_CAME)
        column.text(self._figures, size=SMALL, colour=INK)
        for subject, colour in (("came", NET), ("why", INK), ("measured", MUTE)):
            column.text(partial(self._sentence, subject), size=SMALL, colour=colour)
        column.text(lambda: self._run.twin.problem if self._run.twin else "", size=SMALL, colour=HUMAN)
        if self.came:
            names = list(SABOTAGES)
            following = names[(names.index(self.chosen.sabotage) + 1) % len(names)]
            words = texts.LAB_NEXT.format(name=texts.SABOTAGES[following][0])
            column.button(words, partial(self._ask, following), colour=HUMAN)
        column.words([(texts.LAB_KEEP_RUN, self._leave), (texts.LAB_KNOBS, self.close)])

    def _sentence(self, subject: str) -> str:
        assert self.chosen is not None
        if subject == "why":
            return why(self.came, self.chosen.sabotage, recovered=self._recovered)
        return self.said[subject]

    def _figures(self) -> str:
        """What both landed at the verdict, and what they land now."""
        landed = self._landed
        if len(landed) < 2 or None in landed:
            return self.said["figures"]
        return f"{self.said['figures']} {texts.LAB_FIGURES.format(other=landed[1], healthy=landed[0])}".lstrip()


def came_words(came: Verdict | None, guess: Verdict | None) -> str:
    """Say what came, and whether that was the guess; empty while it is too early."""
    if came is None or guess is None:
        return texts.LAB_CAME_OF[came] if came else ""
    return f"{texts.LAB_CAME_OF[came]} {texts.LAB_AS_GUESSED if came == guess else texts.LAB_NOT_AS_GUESSED}"


def has_recovered(landed: Sequence[int | None], *, was: bool = False) -> bool:
    """Whether an experiment lands as often as its twin by now, given both shares in percent; one that did may waver."""
    healthy, other = landed if len(landed) == 2 else (None, None)
    if healthy is None or other is None:
        return was
    return 0 < healthy <= other + (_WAVERS if was else 0)


def why(came: Verdict | None, sabotage: str, *, recovered: bool = False) -> str:
    """Say what the part is for that was taken away, once there is a verdict: why it was missed, or why not here."""
    if came is None:
        return ""
    if came == "as_well":
        return texts.LAB_NOT_MISSED.format(why=texts.SABOTAGE_WHY[sabotage])
    return texts.LAB_RECOVERED if recovered else texts.SABOTAGE_WHY[sabotage]


def listed_differences(before: Config, after: Config) -> str:
    """List what differs between two configurations, with both values."""
    found = []
    for name, (old, new) in differences(before, after).items():
        head, _, part = name.partition(".")
        word = capital(texts.REWARD_PARTS[part][0]) if part in texts.REWARD_PARTS else label(head)
        found.append(texts.LAB_DIFFERS.format(knob=word, before=figure(old), after=figure(new)))
    return ", ".join(found)


@cache
def measurements() -> dict[str, Any]:
    """Return decisions and seeds, and for each run its mean share that landed, and its interval's ends."""
    found = read_json(FILE)
    assert isinstance(found, dict)
    return found


def measured(name: str) -> str:
    """Say what was measured of a sabotage, beside the preset that nothing was taken from."""
    found = measurements()
    other, healthy = ([100 * part for part in found["shares"][each]] for each in (name, MEASURED))
    figures = dict(zip(("other", "low", "high", "healthy", "least", "most"), (*other, *healthy), strict=True))
    return texts.LAB_MEASURED.format(decisions=found["decisions"], seeds=found["seeds"], **figures)
