"""Progress of a study: a live table in a terminal, a line for each new best in a log."""

from __future__ import annotations

import shutil
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, TextIO

from ai.sweep.results import FinishedTrial
from ai.sweep.space import shown_value
from ai.sweep.study import Study

_EVERY: Final = 0.5  # seconds between two drawings
_ROWS: Final = 12  # of running trials
_BEST: Final = 3


@dataclass
class _Running:
    params: dict[str, Any]
    at: int
    value: str


class Table:
    """Table of the trials that run, the best so far, and the time left; redrawn in place in a terminal."""

    def __init__(
        self,
        study: Study,
        workers: int,
        stream: TextIO | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._study, self._workers, self._clock = study, workers, clock
        self._stream = sys.stderr if stream is None else stream
        self._live = self._stream.isatty()
        self._running: dict[int, _Running] = {}
        self._began = self._drawn = clock()
        self._work = 0.0  # decisions or epochs that have been trained since then
        self._lines = 0
        self._best: float | None = None
        self._said = ""

    def begin(self, number: int, params: dict[str, Any]) -> None:
        """Show a trial that runs."""
        self._running[number] = _Running(params, self._study.plan.span(number)[0], "–")

    def progress(self, trial: FinishedTrial) -> None:
        """Show how far a trial is."""
        if running := self._running.get(trial.number):
            self._work += max(0, trial.at - running.at)
            running.at, running.value = trial.at, self._study.shown(trial.value)

    def finish(self, trial: FinishedTrial) -> None:
        """Take a trial out that is over; in a log, name it if it is the best so far."""
        self.progress(trial)
        self.drop(trial.number)
        best = self._study.best()
        if best and best.number == trial.number and best.value != self._best and not self._live:
            done = f"{len(self._study.trials)} of {self._study.plan.trials} trials"
            self._print(f"{done}: best {self._study.shown(best.value)}, trial {best.number}: {settings(best.params)}")
        self._best = best.value if best else None

    def drop(self, number: int) -> None:
        """Take a trial out."""
        self._running.pop(number, None)

    def say(self, words: str) -> None:
        """Print a sentence, once, above the table."""
        if words != self._said:
            self._said = words
            self.clear()
            self._print(words)

    def seconds_left(self) -> float | None:
        """Return about how long the study still takes, by what it took so far; None before anything is known."""
        plan, spent = self._study.plan, self._clock() - self._began
        if not self._work:
            return None
        ended = list(self._study.trials.values())
        length = plan.budget / plan.generations
        if plan.stop_early and ended:  # as long as trials were on average
            length = sum(trial.at for trial in ended) / len(ended)
        under_way = sum(max(0, each.at - plan.span(number)[0]) for number, each in self._running.items())
        left = max(0.0, (plan.trials - len(ended)) * length - under_way)
        return left * spent / self._work

    def draw(self, now: bool = False) -> None:
        """Draw the table anew, in a terminal, a few times a second at the most."""
        if not self._live or (not now and self._clock() - self._drawn < _EVERY):
            return
        self._drawn = self._clock()
        width = shutil.get_terminal_size().columns - 1
        self.clear()
        lines = [line[:width] for line in self.lines()]
        self._print("\n".join(lines))
        self._lines = len(lines)

    def clear(self) -> None:
        """Take the table away."""
        if self._lines:
            self._stream.write(f"\x1b[{self._lines}A\x1b[J")
            self._stream.flush()
            self._lines = 0

    def lines(self) -> list[str]:
        """Return the lines of the table."""
        study, plan = self._study, self._study.plan
        left = self.seconds_left()
        head = f"{study.folder.name}: {len(study.trials)} of {plan.trials} trials, {len(self._running)} running"
        time_left = "" if left is None else f"about {duration(left)} left, "
        lines = [f"{head}, {time_left}{plan.metric}, {plan.judge} of {len(plan.seeds)}"]
        for number, running in sorted(self._running.items())[:_ROWS]:
            begun, end = plan.span(number)
            share = (running.at - begun) / (end - begun)
            lines.append(f"  {number:>5} {bar(share)} {running.value:>12}  {settings(running.params)}")
        if len(self._running) > _ROWS:
            lines.append(f"        and {len(self._running) - _ROWS} more")
        for each in study.ranked()[:_BEST]:
            lines += [f"  best {each.number:>4} {study.shown(each.value):>12}  {settings(each.params)}"]
        return lines

    def _print(self, text: str) -> None:
        print(text, file=self._stream, flush=True)


def bar(share: float, width: int = 12) -> str:
    """Return a bar of letters for a share from 0 to 1."""
    full = round(min(1.0, max(0.0, share)) * width)
    return "━" * full + "─" * (width - full)


def settings(params: dict[str, Any]) -> str:
    """Return the settings of a trial in one line."""
    return " ".join(f"{name}={shown_value(value)}" for name, value in params.items())


def duration(seconds: float) -> str:
    """Return a length of time as a person says it."""
    minutes = round(seconds / 60)
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{minutes} min" if minutes < 120 else f"{minutes // 60} h {minutes % 60:02} min"
