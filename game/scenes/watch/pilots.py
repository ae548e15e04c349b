"""Your pilots: the player's own files, to make, edit, measure and fly; and in the same way their own pays."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Final

from ai.pilots.child import ACT, PAY
from ai.pilots.own import LOADING
from ai.pilots.shelf import Measured, Shelf, edit
from game.core import texts
from game.core.scene import Pop, Transition, push
from game.core.worker import Worker, WorkerState
from game.drawing.tokens import HUMAN, INK, MUTE, SMALL, TEXT
from game.explain.figures import percent
from game.flight import networks, own
from game.flight.logbook import Records
from game.ui.context import Context
from game.ui.panel import Column, Panel
from game.ui.panel_scene import PanelScene
from game.ui.widget import OnPress

_LEAST: Final = 360.0  # points of a column
_LATEST: Final = 8  # measurements that are listed


class PilotsScene(PanelScene):
    """The files of one kind, and all about the one that is chosen.

    Args:
        choose: called with the file that is to fly, or to pay, None for the usual pay; the scene then closes.
        kind: `ACT` or `PAY`.
        now: the file that flies or pays already.

    """

    def __init__(
        self, context: Context, choose: Callable[[Path | None], None], kind: str = ACT, now: Path | None = None
    ) -> None:
        super().__init__(context)
        self._choose, self._words = choose, texts.PILOTS_WORDS[kind]
        self._shelf = Shelf(context.user_dir, kind)
        self._name, self._said = now.stem if now else "", ""
        self._worker: Worker | None = None
        self._share, self._flown = 0.0, False  # how much is measured, and whether the file itself is
        self.enter()

    def enter(self) -> None:
        """Look again at what files there are, and how they were measured."""
        self._files: dict[str, Path] = {}
        self._measured: list[Measured] = []
        try:
            self._files, self._measured = self._shelf.files(), self._shelf.measured()
        except OSError as error:
            self._said = texts.PILOTS_UNREADABLE.format(path=self._shelf.folder, reason=error.strerror or error)
        self._own = own.own(self._measured)
        if self._name not in self._files:
            self._name = next(iter(self._files), "")
        self.build()

    def close(self) -> None:
        """End a measurement."""
        if self._worker:
            self._worker.close()

    def describe(self, panel: Panel) -> None:
        """Add the files on the left, and the chosen one on the right."""
        title, what, new, _ = self._words
        panel.title(title)
        panel.aside(what)
        panel.aside(texts.PILOTS_NO_SANDBOX)
        panel.gap()
        left, right = panel.beside((1, 1.5), _LEAST)
        for name in self._files:
            latest = next((each for each in self._own if each.name == name), None)
            left.button(
                name,
                partial(self._show, name),
                figure=percent(latest.landed) if latest else "",
                colour=INK if name == self._name else MUTE,
            )
        left.button(new, self._new)
        if self._shelf.kind == PAY:
            left.button(texts.PILOTS_USUAL, self._use_none)
        if self._said:
            left.gap()
            left.text(self._said, size=TEXT, colour=HUMAN)
        if self._name:
            self._describe_one(right)

    def _describe_one(self, column: Column) -> None:
        path = self._files[self._name]
        column.text(self._name, size=22.0, weight="light")
        column.aside(str(path))
        verbs: list[tuple[str, OnPress]] = [(self._words[3], self._use), (texts.PILOTS_EDIT, self._edit)]
        if self._shelf.kind != ACT:
            column.words(verbs)
            return
        measure = (texts.PILOTS_CANCEL, self.close) if self._worker else (texts.PILOTS_MEASURE, self._measure)
        column.words([*verbs, (texts.PILOTS_RACE, self._race), measure])
        if self._worker:
            words = texts.PILOTS_MEASURING
            column.aside(lambda: words[2 if self._flown else self._share > 0].format(count=own.STARTS, seconds=LOADING))
            column.bar(lambda: self._share)
        if mine := next((each for each in self._own if each.name == self._name), None):
            self._describe_card(column, mine)
            column.gap()
            column.caption(texts.PILOTS_OVER_TIME)
            for each in self._own[:_LATEST]:
                when = time.strftime("%Y-%m-%d %H:%M", time.localtime(each.when))
                column.pair(f"{when}   {each.name}", percent(each.landed, 1))

    def _describe_card(self, column: Column, mine: Measured) -> None:
        """Add the card: this pilot beside those that come with the game, and the player's own hands."""
        column.gap()
        column.caption(texts.PILOTS_CARD.format(count=own.STARTS))
        column.pair(self._name, _figures(mine), HUMAN)
        lost = sorted(zip(mine.lost, texts.PILOTS_LOST, strict=False), reverse=True)
        if counts := " · ".join(words.format(count=count) for count, words in lost if count):
            column.aside(texts.PILOTS_LOST_BY.format(counts=counts))
        if mine.landed >= own.GOOD:
            column.text(texts.PILOTS_GOOD, size=SMALL, colour=HUMAN)
        path = self._files[self._name]
        column.text(lambda: texts.PILOTS_STALE if mine.stale(path) else "", size=SMALL, colour=HUMAN)
        known = own.rivals(self._measured)
        for name in own.RIVALS:
            if name in known:
                column.pair(networks.word(name), _figures(known[name]))
        if hand := own.by_hand(Records(self.context.user_dir).entries()):
            column.pair(texts.PILOTS_YOU.format(count=hand[1]), _figures(hand[0]))

    # What can be done

    def _show(self, name: str) -> None:
        """Choose a file, and go on to what can be done with it."""
        self._name, self._said = name, ""
        self.build()
        self.form.focus(next(each for each in self.form.widgets if each.label == self._words[3]))

    def _new(self) -> None:
        try:
            path = self._shelf.new()
        except OSError as error:
            self._said = texts.PILOTS_NOT_WRITTEN.format(path=self._shelf.folder, reason=error.strerror or error)
            self.build()
            return
        self._name = path.stem
        self.enter()
        self._edit()

    def _edit(self) -> None:
        path = self._files[self._name]
        try:
            edit(path)
            self._said = texts.PILOTS_OPENED.format(path=path)
        except OSError:
            self._said = texts.PILOTS_NO_EDITOR.format(path=path)
        self.build()

    def _use(self) -> Transition:
        self._choose(self._files[self._name])
        return Pop()

    def _use_none(self) -> Transition:
        self._choose(None)
        return Pop()

    def _race(self) -> Transition:
        own.take(self.context, self._files[self._name])
        return push("play", rival=self.context.pilot, rival_name=self._name)

    def _measure(self) -> None:
        context, self._share, self._flown, self._said = self.context, 0.0, False, ""
        self._worker = Worker(own.measure, context.user_dir, context.models_dir, self._files[self._name])
        self.build()

    def update(self) -> Transition | None:
        """Follow a measurement."""
        worker = self._worker
        if worker:
            for news in worker.poll():
                if isinstance(news, Measured):
                    self._flown = True  # it is the first
                    self.enter()
                else:
                    self._share = news
            if worker.state in (WorkerState.ENDED, WorkerState.FAILED) and worker.gone:
                self._worker, self._said = None, worker.problem
                self.enter()
        return super().update()


def _figures(measured: Measured) -> str:
    seconds, fuel = f"{measured.seconds:.1f}", f"{measured.fuel:.1f}"
    return texts.PILOTS_FIGURES.format(landed=percent(measured.landed, 1), seconds=seconds, fuel=fuel)
