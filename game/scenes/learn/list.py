"""Learn scene: the path's chapters, in any order, and four things to do with a network of one's own; what is done."""

from __future__ import annotations

from contextlib import suppress
from functools import partial
from typing import Final

from ai.pilots.folder import PilotFolder
from game.core import texts
from game.core.scene import Transition, push
from game.drawing.tokens import INK, MUTE, SMALL, TITLE
from game.flight import networks
from game.flight import own as own_pilots
from game.flight.logbook import Records
from game.scenes.learn.path import FIRST, PATH, is_done
from game.training.library import Library
from game.ui.actions import Table
from game.ui.context import Context
from game.ui.listing import Row
from game.ui.panel import Column, Panel
from game.ui.panel_scene import PanelScene
from game.ui.widget import OnPress

_KEYS: Final = tuple(PATH)
_LEAST, _AROUND = 300.0, 230.0  # points of a column, and of what is seen with the list
_PITCH: Final = 34.0  # of a row of the list


class LearnScene(PanelScene):
    """Learn scene: the chapters, and the chosen one's question beside them, or below them in a narrow window.

    Attributes:
        chosen: key of the chapter whose question is shown.
        own: what the player has done with a network of their own, by the keys of `LEARN_OWN`.

    """

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        context.chapter = ""
        self.chosen = next((key for key in PATH if not is_done(context.settings, key)), FIRST)
        self.build()
        self.form.focus(self.form.widgets[1])  # the list

    def enter(self) -> None:
        """Choose the chapter that was left last."""
        self.chosen, self.context.chapter = self.context.chapter or self.chosen, ""
        self.build()

    def actions(self) -> Table:
        return [self.form.moves, *super().actions()]

    def describe(self, panel: Panel) -> None:
        panel.title(texts.LEARN_TITLE)
        done = sum(is_done(self.context.settings, key) for key in PATH)
        panel.aside(texts.LEARN_LINE.format(done=done, count=len(PATH)))
        panel.gap(8)
        panel.button(texts.ONE_FILE, partial(push, "one_file"), texts.ONE_FILE_ASIDE, colour=INK)
        panel.gap(8)
        left, right = panel.beside((5, 4), _LEAST)
        left.listing(
            [self._row(key) for key in PATH], lambda _: self._open(), around=_AROUND, index=_KEYS.index(self.chosen),
            on_choose=self._choose, pitch=_PITCH,
        )  # fmt: skip
        right.text(lambda: texts.LEARN[self.chosen]["question"])
        right.gap(6)
        right.button(texts.LEARN_OPEN, self._open, size=TITLE, colour=INK)
        right.gap()
        self._describe_own(right)
        left.gap()
        left.button(texts.LEARN_PHYSICS, partial(push, "physics"))

    def _describe_own(self, column: Column) -> None:
        """Add what to do with a network of one's own: each leads to where it is done, and is ticked once it was."""
        self.own = done_with_own(self.context)
        doors: dict[str, OnPress] = {
            "train": partial(push, "train"), "land": partial(push, "runs"), "hand": partial(push, "play"),
            "file": partial(push, "runs"),
        }  # fmt: skip
        column.caption(texts.LEARN_OWN_TITLE)
        for name, press in doors.items():
            done = self.own[name]
            column.button(texts.LEARN_OWN[name], press, texts.LEARN_DONE if done else "", size=SMALL + 1,
                          colour=MUTE if done else INK)  # fmt: skip

    def _row(self, key: str) -> Row:
        title = f"{_KEYS.index(key) + 1}   {texts.LEARN[key]['title']}"
        return title, texts.LEARN_DONE if is_done(self.context.settings, key) else ""

    def _choose(self, index: int) -> None:
        self.chosen = _KEYS[index]

    def _open(self) -> Transition:
        return push("chapter", self.chosen)


def done_with_own(context: Context) -> dict[str, bool]:
    """Return what the player has done with a network or a pilot of their own, read from their files."""
    library = Library(context.user_dir)
    runs = [run for run in library.runs() if not run.problem or run.flyable]
    folders = networks.folders(context.models_dir, context.user_dir)
    own = {name for name, folder in folders.items() if folder.parent == context.user_dir / networks.PLAYERS}
    pilots = []
    with suppress(OSError):
        pilots = PilotFolder(context.user_dir).measured()
    return {
        "train": bool(runs),
        "land": any(run.success for run in (*runs, library.rescued()) if run),
        "hand": any(entry.network in own and entry.human < 1.0 for entry in Records(context.user_dir).entries()),
        "file": any(pilot.landed >= own_pilots.GOOD for pilot in pilots),
    }
