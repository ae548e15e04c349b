"""The whole thing in one file: `examples/microlander.py`, part by part, each with the module that it grew up to be."""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping
from typing import Final

from game.core import texts
from game.core.assets import MICROLANDER
from game.core.source import Source
from game.drawing.tokens import TITLE
from game.explain.code_listing import add_listing, listing_height
from game.ui.context import Context
from game.ui.panel import Panel
from game.ui.panel_scene import PanelScene

_PART: Final = re.compile(r" *# \d+\. .+: (\S+)$")  # with its module
_SHARES, _LEAST, _APART = (1.0, 3.2), 200.0, 36.0  # of the columns of parts and of code
_AROUND, _PITCH = 180.0, 28.0  # points above and below the list, and of a row of it


def parts() -> list[Source]:
    """Return the parts of the file, in their order, each named by the module that it grew up to be.

    Each begins with a numbered comment.
    """
    lines = [*enumerate(MICROLANDER.read_text(encoding="utf-8").splitlines(), 1)]
    begins = [(number, found) for number, line in lines if (found := _PART.fullmatch(line))]
    ends = [number for number, _ in begins[1:]] + [len(lines) + 1]
    path = f"examples/{MICROLANDER.name}"
    return [
        Source(path, found[1], tuple(lines[number - 1 : end - 1]), ast.Module([], []))
        for (number, found), end in zip(begins, ends, strict=True)
    ]


class OneFileScene(PanelScene):
    """The parts of the file, and the chosen one's lines beside them, or below them in a narrow window.

    Attributes:
        chosen: the part that is shown, from 0 on.

    """

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._parts = parts()
        self.chosen = 0
        self.build()

    def describe(self, panel: Panel) -> None:
        panel.title(texts.ONE_FILE)
        panel.aside(texts.ONE_FILE_LINE)
        panel.gap(8)
        left, right = panel.beside(_SHARES, _LEAST, _APART)
        left.listing(
            [(title,) for title in texts.ONE_FILE_PARTS], lambda _: None, around=_AROUND, index=self.chosen,
            on_choose=self._choose, pitch=_PITCH,
        )  # fmt: skip
        right.title(lambda: texts.ONE_FILE_PARTS[self.chosen], TITLE + 4)
        right.aside(lambda: texts.ONE_FILE_GROWN.format(place=self._parts[self.chosen].name))
        right.gap(8)
        add_listing(right, self._height, self._shown)

    def _choose(self, index: int) -> None:
        self.chosen = index

    def _shown(self) -> tuple[Source, int | None, Mapping[int, str]]:
        return self._parts[self.chosen], None, {}

    def _height(self, width: float) -> float:
        return listing_height(self._parts[self.chosen], width)
